"""What a trace leaves: points, branches, files, journals, plots."""
