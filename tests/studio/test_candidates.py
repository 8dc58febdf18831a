"""The places that the planner looked at are shown for the foot that they are of."""

from __future__ import annotations

import numpy as np

from polypod.studio.document import default_document
from polypod.studio.overlays import candidates
from polypod.studio.stage import STEP, Stage


def rough_stage(crowd: int = 0) -> Stage:
    document = default_document()
    document["terrain"] = {"generator": "rocks", "height": 0.2, "share": 0.7}
    document["crowd"] = [{"rig": "spider", "count": crowd}] if crowd else []
    return Stage(document, lambda rig: rig)


def test_each_foots_target_is_the_place_it_chose_out_of_its_own() -> None:
    stage = rough_stage()
    herd = stage.herd
    candidates(stage, herd, 0)  # from now on they are kept
    seen: dict[int, int] = {}
    for _ in range(240):
        before = herd.state.foot_target[0].copy()
        stage.step(STEP)
        planned = np.any(herd.state.foot_target[0] != before, axis=1) & herd.state.swinging[0]
        arrays = candidates(stage, herd, 0)
        for foot in np.flatnonzero(planned):
            place = arrays["place"][arrays["foot"] == foot]
            off = np.linalg.norm(place - herd.state.foot_target[0, foot], axis=1)
            # The place that was chosen is among them, in the world's own axes.
            assert off.min() < 1e-4
            assert np.linalg.norm(place - herd.state.foot[0, foot], axis=1).max() < 1.0
            seen[int(foot)] = max(seen.get(int(foot), 0), len(place))
        assert set(arrays["foot"]) <= set(
            np.flatnonzero(herd.state.swinging[0] | (herd.state.waiting[0] > 0.0))
        )
        assert ((arrays["score"] >= 0.0) & (arrays["score"] <= 1.0)).all()
    assert set(seen) == set(range(8)), "feet that lift together are all there"
    assert max(seen.values()) > 5


def test_the_others_of_a_crowd_are_not_mixed_in() -> None:
    stage = rough_stage(crowd=6)
    crowd = stage.herds[1]
    candidates(stage, crowd, 4)
    for _ in range(90):
        stage.step(STEP)
    arrays = candidates(stage, crowd, 4)
    assert len(arrays["place"])
    here = crowd.state.position[4, [0, 2]]
    assert np.linalg.norm(arrays["place"][:, [0, 2]] - here, axis=1).max() < 1.0
    # Another is watched: what was of the one before is gone.
    assert len(candidates(stage, crowd, 2)["place"]) == 0
