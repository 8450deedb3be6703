"""Events of an orbit: what switches are, the modes between events, and how their pattern changes."""
