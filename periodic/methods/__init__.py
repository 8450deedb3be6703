"""Ways to represent a periodic orbit and to solve for it; `protocol.py` says what each must do."""
