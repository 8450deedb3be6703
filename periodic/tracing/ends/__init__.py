"""Where branches end of themselves."""
