"""Bundle adjustment: all cameras and all points at once, so that every click is explained as well as can be.

problem.py      what goes in: views, points, observations, what is known beforehand
checks.py       what cannot be solved, by name, and what is worth saying
gauge.py        what holds the world in place where no measured point does
parameters.py   views as rows of numbers, and back
residuals.py    projection, its derivatives, the robust cost
normal.py       normal equations with the points eliminated (Schur's complement)
solver.py       Levenberg and Marquardt's steps
adjusting.py    the variants, and the one function to call: `adjust`
triangulating.py  where a point is that several views saw
report.py, holdout.py  what the result is worth
"""
