"""One concave surface split into convex parts: the other side of `splitting`, in its own process.

Reads an .npz from standard input and writes one with the corners of each part to standard output.
"""

from __future__ import annotations

import io
import os
import sys

import coacd
import numpy as np

SEED = 0
# How long cuts are looked for: half the time of the library's own, and as many parts.
SEARCH = {"nodes": 10, "iterations": 60, "depth": 2}


def main() -> None:
    """Split what standard input holds."""
    # The library writes to standard output: that is kept for the answer alone.
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    coacd.set_log_level("off")
    with np.load(io.BytesIO(sys.stdin.buffer.read()), allow_pickle=False) as given:
        mesh = coacd.Mesh(given["points"], given["faces"])
        # What bounds a solid needs no remeshing, which takes minutes and wraps it in a skin.
        parts = coacd.run_coacd(
            mesh,
            threshold=float(given["concavity"]),
            preprocess_mode="off",
            mcts_nodes=SEARCH["nodes"],
            mcts_iterations=SEARCH["iterations"],
            mcts_max_depth=SEARCH["depth"],
            seed=SEED,
        )
    made = io.BytesIO()
    np.savez(made, **{f"{i:06d}": corners for i, (corners, _) in enumerate(parts)})
    with answer:
        answer.write(made.getvalue())


if __name__ == "__main__":
    main()
