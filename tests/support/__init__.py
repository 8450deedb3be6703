"""What tests share: models, branches traced once, generators of random input."""
