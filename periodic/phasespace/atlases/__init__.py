"""What an atlas is made of: branches with their stable stretches, what is said of them, their page."""
