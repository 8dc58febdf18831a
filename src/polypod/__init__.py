"""Polypod makes any legged creature walk."""

__version__ = "0.1.0"
