"""Robots beyond the simulator: what the studio needs of one, and the one door to all of them."""
