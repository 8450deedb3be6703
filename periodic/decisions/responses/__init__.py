"""What decisions are about: responses, quantities of them, and features followed to other designs."""
