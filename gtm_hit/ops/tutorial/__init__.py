"""The lesson every worker can take, and the exercise it is made from."""
