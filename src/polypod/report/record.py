"""The record of a walk: plain arrays, one file a creature, the same frames as the GLB."""
