"""Vectors, quaternions, circle intervals and curves, as kernels speak them."""
