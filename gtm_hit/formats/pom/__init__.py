"""The POM file of rectangles."""
