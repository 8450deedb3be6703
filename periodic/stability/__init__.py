"""What Floquet multipliers tell, and how they wind."""
