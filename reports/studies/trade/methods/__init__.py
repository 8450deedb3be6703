"""What is measured: problems, methods with their settings, and the error of each beside its time."""
