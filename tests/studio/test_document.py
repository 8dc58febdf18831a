"""Documents are judged whole: what is let through can be walked, what is refused is said."""

from __future__ import annotations

import contextlib
import copy
import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from polypod.errors import PolypodError
from polypod.morphology.creature import read_creature
from polypod.studio.document import SETTINGS, default_document, edited, judged
from polypod.studio.toml_text import tables_by_name

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
        ["creature"], ["creature", "limit"], ["creature", "height"], ["crowd"],
        ["crowd", 0], ["gait"], ["spacing"], ["spacing", 0],
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
        (["creature", "limit"], {"Knee": {"bend": [0.5, -0.5]}}, r"limit\.Knee\.bend.*least first"),
        (["creature", "limit"], {"Knee": {"bend": [math.nan, 0.5]}}, r"Knee\.bend.*number"),
        (["creature", "limit"], {"Knee": {"bend": [-4.0, 0.5]}}, "within -pi and pi"),
        (["creature", "limit"], {"Knee": {"bend": 0.5}}, "2 numbers"),
        (["creature", "limit"], {"Hip": {"flexion": 0.0}}, "above 0"),
        (["creature", "limit"], {"Hip": {"flexion": 10**400}}, "number"),
        (["creature", "limit"], {"Back": {"yaw": True}}, "number"),
        (["creature", "limit"], {"Back": {"swing": 1.0}}, "no key here"),
        (["creature", "limit"], {"Back": 1.0}, "must be a table"),
        (["creature", "limit"], [], "tables by name"),
        (["creature", "limit"], {str(n): {} for n in range(1001)}, "1001 joints"),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(at: list[Any], to: Any, words: str) -> None:
    with pytest.raises(PolypodError, match=words):
        edited(default_document(), at, to)


angles = st.floats(-4.0, 4.0) | st.sampled_from([0.0, math.pi, -math.pi, math.nan, math.inf])
limits = st.dictionaries(
    st.text(st.characters(codec="utf-8"), max_size=6),
    st.dictionaries(
        st.sampled_from(["bend", "flexion", "sideways", "twist", "yaw", "pitch", "roll", "swing"]),
        angles | st.lists(angles, min_size=1, max_size=3) | st.integers(-4, 4) | st.booleans(),
        max_size=3,
    ),
    max_size=3,
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(limits)
def test_limits_are_those_that_a_creature_file_may_have(
    tmp_path: Path, asked: dict[str, Any]
) -> None:
    text = "\n".join(['rig = "spider"', *tables_by_name("limit", asked)])
    file = tmp_path / "creature.toml"
    file.write_text(text, encoding="utf-8")
    try:
        document = edited(default_document(), ["creature", "limit"], asked)
    except PolypodError:
        with pytest.raises(PolypodError):
            read_creature(file)
        return
    read = read_creature(file).limit
    assert list(read) == list(document["creature"]["limit"])
    for name, said in document["creature"]["limit"].items():
        for key, value in said.items():
            assert read[name][key] == tuple(value if isinstance(value, list) else [value])


def test_ground_is_chosen_and_made_flat_again() -> None:
    hills = edited(default_document(), ["terrain"], {"generator": "hills", "relief": 0.2})
    higher = edited(hills, ["terrain", "relief"], 0.4)
    assert higher["terrain"] == {"generator": "hills", "relief": 0.4}
    assert edited(higher, ["terrain", "relief"], None)["terrain"] == {"generator": "hills"}
    assert edited(higher, ["terrain"], None)["terrain"] is None
