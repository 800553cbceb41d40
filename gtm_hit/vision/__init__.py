"""Programs that look for people: boxes in pictures, people on the ground, moves of centimetres. No Django.

Pictures are BGR, uint8, (H, W, 3), as OpenCV reads them, of the size the camera was calibrated for or a
smaller one of the same shape. Boxes are pixels of the calibrated size, x before y. Places are metres on the
ground. Nothing here is an annotation: everything found is a proposal until a human accepts it.
"""
