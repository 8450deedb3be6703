"""Where long work is done: in this process, in others, or on other machines."""
