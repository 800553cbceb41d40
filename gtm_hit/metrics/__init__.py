"""How good ground truth is, and what a paper prints about a dataset. Pure numpy and scipy; knows no Django.

Places are metres on the ground, (N, 2), x before y. Scores are fractions, never per cent; NaN is a score
that is not defined, such as the precision of nothing. "Truth" and "found" are the two sides of a comparison:
any two layers, or a ground truth and the detections of a program.
"""
