"""How good somebody's work is: by known truth, by planted faults, and all together, with its uncertainty."""
