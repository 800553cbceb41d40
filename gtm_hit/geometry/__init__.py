"""Cameras, the ground grid, and cylinders standing on it. Pure numpy and OpenCV; knows no Django.

Frames of reference
    world   metres; X and Y span the ground, Z points up, the ground is Z = 0
    camera  metres; OpenCV's axes: x right, y down, z along the optical axis (its depth)
    image   pixels; u right, v down, (0, 0) is the centre of the top left pixel
Arrays of points are (N, 2) or (N, 3), x before y. NaN means "no such point".
"""
