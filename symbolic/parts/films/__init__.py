"""Lubricant films between the bodies of a contact, and the laws of their steady thickness."""
