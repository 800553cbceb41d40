"""Bundle adjustment: all cameras and all points at once, so that every click is explained as well as can be.

problem.py      what goes in: views, points, observations, what is known beforehand
correspondences.py  points out of feet and heads clicked picture by picture
checks.py       what cannot be solved, by name, and what is worth saying
gauge.py        what holds the world in place where no measured point does
parameters.py   views as rows of numbers, and back
residuals.py    projection, its derivatives, the robust cost
system.py       a problem as the solver sees it
normal.py       normal equations with the points eliminated (Schur's complement)
one_thread.py   products and solutions with the same bytes on any machine's cores
solver.py       Levenberg and Marquardt's steps
settling.py     where each point lies best while the cameras stand still
state.py        where it has come to, to go on later
adjusting.py    the variants, and the one function to call: `adjust`
covariance.py   how far each number of the result may be off
report.py, holdout.py, telling.py  what it is worth, in numbers, words and JSON
"""
