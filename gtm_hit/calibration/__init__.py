"""From pictures of boards, measured points and clicks to cameras one can trust. No Django.

Pixels are those of the picture as it was taken, lens included, x before y, the centre of the upper left pixel
at (0, 0). Lengths are metres, whatever unit a file has. Poses are world to camera, as in `geometry.camera`.
An RMS is OpenCV's: sqrt(sum(dx² + dy²) / points).
"""
