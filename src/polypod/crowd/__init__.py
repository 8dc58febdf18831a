"""Creatures among others."""
