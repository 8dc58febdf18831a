"""Readers and writers of character files."""
