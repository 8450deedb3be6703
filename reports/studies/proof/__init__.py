"""What is proven of the scenes and of some well-known cycles, and what is not."""
