"""What becomes of submitted work: transitions, comments, appeals, and the choice of what is looked at."""
