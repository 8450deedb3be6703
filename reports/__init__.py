"""What people read: scenes, the command line, pictures and reports."""
