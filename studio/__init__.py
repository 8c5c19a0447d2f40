"""The teaching studio: a person moves, Baxter watches, learns and does it again alone."""

__version__ = "0.1.0"
