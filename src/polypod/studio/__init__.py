"""The studio: a page on this computer where a creature walks and everything about it is changed.

Python holds the truth, the page draws it: docs/studio-protocol.md says what goes between them.
Nothing here is imported by the rest of the library.
"""
