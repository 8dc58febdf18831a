"""Documents are judged whole: what is let through can be walked, what is refused is said."""

from __future__ import annotations

import contextlib
import copy
import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polypod.errors import PolypodError
from polypod.studio.document import SETTINGS, default_document, edited, judged

BOX = {"shape": "box", "size": [0.3, 0.2, 0.3], "position": [0.0, 0.1, 1.0]}

json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**6), 10**6)
    | st.floats(allow_nan=True, allow_infinity=True)
    | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4)
    ),
    max_leaves=8,
)
places = st.sampled_from(
    [
        ["command", "speed"], ["command", "heading"], ["command"], ["creature", "leg"],
        ["creature"], ["crowd"], ["crowd", 0], ["gait"], ["spacing"], ["spacing", 0],
        ["settings", "spine"], ["path"], ["path", 0], ["terrain"], ["obstacle"], ["obstacle", 0],
        ["obstacle", 0, "size"], ["nothing"], [0], ["command", "speed", 0],
    ]
)  # fmt: skip


def test_the_default_is_a_document_and_stays_one_through_json() -> None:
    document = default_document()
    assert judged(json.loads(json.dumps(document))) == document
    assert set(document["settings"]) == set(SETTINGS)


@given(places, json_values)
def test_any_edit_is_refused_in_words_or_gives_a_document(at: list[Any], to: Any) -> None:
    before = default_document()
    before["obstacle"] = [copy.deepcopy(BOX)]
    kept = copy.deepcopy(before)
    # Whatever else it raised would fail the test.
    with contextlib.suppress(PolypodError):
        after = edited(before, at, to)
        assert judged(after) == after
    assert before == kept, "an edit leaves the document that it is of"


@given(json_values)
def test_anything_opened_is_refused_in_words(values: Any) -> None:
    with pytest.raises(PolypodError):
        judged(values)


def test_lists_grow_at_their_end_and_lose_what_is_made_null() -> None:
    one = edited(default_document(), ["obstacle", 0], BOX)
    two = edited(one, ["obstacle", 1], {**BOX, "forbidden": True})
    assert [len(d["obstacle"]) for d in (one, two)] == [1, 2]
    assert edited(two, ["obstacle", 0], None)["obstacle"] == [{**BOX, "forbidden": True}]
    with pytest.raises(PolypodError, match=r"^the document has no place obstacle\.5"):
        edited(two, ["obstacle", 5], BOX)


@pytest.mark.parametrize(
    ("at", "to", "words"),
    [
        (["command", "speed"], math.nan, "speed"),
        (["command", "speed"], "fast", "speed"),
        (["command", "heading"], None, "heading"),
        (["settings", "spine"], -1.0, "from 0 to 3"),
        (["obstacle", 0], {**BOX, "shape": "mesh", "file": "/etc/passwd"}, "mesh"),
        (["terrain"], {"heightmap": "/etc/passwd"}, "generator"),
        (["terrain"], {"generator": "hills", "relief": -1.0}, "relief"),
        (["crowd"], [{"rig": "ant", "count": 200}], "too many"),
        (["gait"], {"name": "x", "start": [0.1, True], "extent": [0.3, 0.3]}, "start"),
        (["path"], [[0.0, math.inf]], "point 0 of the path"),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(at: list[Any], to: Any, words: str) -> None:
    with pytest.raises(PolypodError, match=words):
        edited(default_document(), at, to)


def test_ground_is_chosen_and_made_flat_again() -> None:
    hills = edited(default_document(), ["terrain"], {"generator": "hills", "relief": 0.2})
    higher = edited(hills, ["terrain", "relief"], 0.4)
    assert higher["terrain"] == {"generator": "hills", "relief": 0.4}
    assert edited(higher, ["terrain", "relief"], None)["terrain"] == {"generator": "hills"}
    assert edited(higher, ["terrain"], None)["terrain"] is None
