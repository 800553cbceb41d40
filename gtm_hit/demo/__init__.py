"""The demo scene: a small software renderer for a sunlit plaza seen by calibrated cameras.

World frame as in `gtm_hit.geometry`: metres, Z up, the ground is Z = 0. X points to the hall with its steps,
Y along the plaza. Colours are linear light, red green blue, until `light.develop` turns them into pixels.
"""
