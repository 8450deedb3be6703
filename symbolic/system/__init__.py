"""The compiled system: what `periodic` is given."""
