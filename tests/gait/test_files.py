from __future__ import annotations

import contextlib
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from walker import paired

from polypod.errors import GaitError
from polypod.gait.draw import describe, draw_gait
from polypod.gait.files import read_gait, write_gait
from polypod.gait.library import make_gait, names
from polypod.gait.pattern import Gait

SOUND = """
name = "limp"
period = 1.2
family = "run"
duty = [0.4, 0.7]
[[foot]]
start = 0.65
extent = 0.35
[[foot]]
start = 0
extent = 0.5
lag_per_duty = -1.0
"""


def same(one: Gait, other: Gait) -> bool:
    return (
        one.name == other.name
        and one.family == other.family
        and (one.duty_low, one.duty_high) == (other.duty_low, other.duty_high)
        and (one.period == other.period or (math.isnan(one.period) and math.isnan(other.period)))
        and all(
            np.array_equal(getattr(one, field), getattr(other, field))
            for field in ("swing_start", "swing_extent", "lag_per_duty")
        )
    )


def test_a_file_says_what_it_means(tmp_path: Path) -> None:
    path = tmp_path / "limp.toml"
    path.write_text(SOUND)
    gait = read_gait(path, 2)
    assert same(gait, Gait("limp", [0.65, 0.0], [0.35, 0.5], 0.4, 0.7, "run", [0, -1], 1.2))


def test_what_is_left_out_has_a_plain_meaning(tmp_path: Path) -> None:
    path = tmp_path / "own-gait.toml"
    path.write_text("[[foot]]\nstart = 0.0\nextent = 0.4\n[[foot]]\nstart = 0.5\nextent = 0.4\n")
    gait = read_gait(path)
    assert (gait.name, gait.family) == ("own-gait", "walk")
    assert gait.duty_low == gait.duty_high == pytest.approx(0.6)
    assert math.isnan(gait.period)
    assert (gait.lag_per_duty == 0.0).all()


@pytest.mark.parametrize("name", names())
def test_every_gait_of_the_library_comes_back_to_the_last_bit(name: str, tmp_path: Path) -> None:
    for count in (2, 5, 8):
        gait = make_gait(name, *paired(count))
        write_gait(gait, tmp_path / "gait.toml")
        assert same(read_gait(tmp_path / "gait.toml", count), gait)
    assert [path.name for path in tmp_path.iterdir()] == ["gait.toml"]


printable = st.text(min_size=1, max_size=30).filter(lambda t: t.isprintable() and t.strip() != "")


@given(
    printable,
    st.lists(
        st.tuples(
            st.floats(0.0, 1.0, exclude_max=True), st.floats(0.05, 0.95), st.floats(-2.0, 2.0)
        ),
        min_size=1,
        max_size=12,
    ),
    st.one_of(st.just(math.nan), st.floats(1e-3, 1e3)),
    st.sampled_from(["walk", "run", "arthropod"]),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_gait_comes_back_to_the_last_bit(
    tmp_path: Path, name: str, feet: list[tuple[float, float, float]], period: float, family: str
) -> None:
    start, extent, lag = np.array(feet).T
    gait = Gait(name, start, extent, family=family, lag_per_duty=lag, period=period)
    write_gait(gait, tmp_path / "gait.toml")
    assert same(read_gait(tmp_path / "gait.toml", len(feet)), gait)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('name = "limp"', 'nmae = "limp"', "the gait has no key 'nmae'; choose from name, period"),
        ("lag_per_duty = -1.0", "lag = 1", "foot 1 has no key 'lag'; choose from start, extent"),
        ("start = 0.65", "", "foot 0: start is missing"),
        ("extent = 0.5", "", "foot 1: extent is missing"),
        ("start = 0.65", "start = 1.65", "foot 0 starts its swing at 1.65"),
        ("start = 0.65", "start = nan", "finite numbers"),
        ("start = 0.65", 'start = "early"', "foot 0: start must be a number, not 'early'"),
        ("start = 0.65", "start = true", "foot 0: start must be a number, not 'True'"),
        ("extent = 0.35", "extent = 0", "foot 0 swings for 0 of the cycle"),
        ("extent = 0.35", "extent = -0.35", "foot 0 swings for -0.35 of the cycle"),
        ("period = 1.2", "period = 0", "a period of 0.0 s"),
        ("period = 1.2", "period = nan", "period must be a number of seconds"),
        ("period = 1.2", "period = " + "9" * 400, "period must be a number"),
        ("period = 1.2", "period = " + "9" * 5000, "not valid TOML"),
        ('family = "run"', 'family = "swim"', "family 'swim'; choose from walk, run, arthropod"),
        ('family = "run"', "family = [1]", "choose from walk, run, arthropod"),
        ('name = "limp"', 'name = ""', "name must be printable"),
        ('name = "limp"', "name = 7", "name must be printable"),
        ("duty = [0.4, 0.7]", "duty = 0.5", "duty must be"),
        ("duty = [0.4, 0.7]", "duty = [0.4]", "duty must be"),
        ("duty = [0.4, 0.7]", "duty = [0.7, 0.4]", "rise from lowest to highest"),
        ("duty = [0.4, 0.7]", "duty = [0.65, 0.7]", "outside of its own range"),
        ("duty = [0.4, 0.7]", 'duty = ["a", "b"]', "duty must be a number"),
        ("[[foot]]", "[[feet]]", "no key 'feet'"),
        ("[[foot]]", "[foot", "not valid TOML"),
        (SOUND, "", r"needs a \[\[foot\]\] table for each foot"),
        (SOUND, "foot = 3", r"needs a \[\[foot\]\] table"),
        (SOUND, "foot = [3]", r"needs a \[\[foot\]\] table"),
        (SOUND, "a = " + "[" * 20000, "not valid TOML"),
    ],
)
def test_a_mistake_is_named_with_its_file_and_place(
    old: str, new: str, words: str, tmp_path: Path
) -> None:
    path = tmp_path / "limp.toml"
    path.write_text(SOUND.replace(old, new))
    with pytest.raises(GaitError, match=words) as caught:
        read_gait(path, 2)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_gait_for_other_feet_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "limp.toml"
    path.write_text(SOUND)
    with pytest.raises(GaitError, match=r"has 2 \[\[foot\]\] tables; this creature has 8 feet"):
        read_gait(path, 8)


def test_files_that_cannot_be_read_or_written(tmp_path: Path) -> None:
    for path, words in (
        (tmp_path / "missing.toml", "cannot be read: No such file"),
        (tmp_path, "cannot be read: Is a directory"),
        ("a\0b", "cannot be read"),
    ):
        with pytest.raises(GaitError, match=words):
            read_gait(path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(GaitError, match="is not UTF-8 text"):
        read_gait(tmp_path / "binary.toml")
    (tmp_path / "huge.toml").write_bytes(b"#" * 1_000_001)
    with pytest.raises(GaitError, match="larger than a gait"):
        read_gait(tmp_path / "huge.toml")
    for path in (tmp_path / "no-folder" / "g.toml", tmp_path, "a\0b"):
        with pytest.raises(GaitError, match="cannot be written"):
            write_gait(make_gait("trot", *paired(4)), path)


pieces = st.sampled_from(
    [
        *("[[foot]]\n", "[foot]\n", "start", "extent", "duty", "name", "period", "family", " = "),
        *("0.5", "1e999", "-1", "nan", "true", '"walk"', "[0.1, 0.9]", "\n", "[", "]", '"', "'"),
        *("{a = 1}", "1979-05-27", "#", "\\", "0x_", "\x00", "é", ".", ","),
    ]
)
texts = st.one_of(
    st.text(max_size=200),
    st.lists(pieces, max_size=40).map("".join),
    st.tuples(st.integers(0, len(SOUND)), pieces, st.integers(0, 12)).map(
        lambda cut: SOUND[: cut[0]] + cut[1] + SOUND[cut[0] + cut[2] :]
    ),
)


@given(st.one_of(texts.map(lambda text: text.encode("utf-8", "ignore")), st.binary(max_size=100)))
@settings(max_examples=400, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_no_file_raises_anything_but_a_gait_error(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "any.toml"
    path.write_bytes(data)
    with contextlib.suppress(GaitError):
        gait = read_gait(path)
        # What is accepted is a gait and can be written.
        write_gait(gait, tmp_path / "again.toml")
        assert same(read_gait(tmp_path / "again.toml"), gait)


def test_a_description_shows_each_foots_cycle() -> None:
    gait = Gait("two", [0.75, 0.25], [0.25, 0.5])
    lines = describe(gait, ("left", "right")).splitlines()
    assert lines[0] == "two: walk, 2 feet, duty 0.62 (0.62 to 0.62)"
    bars = [line.split("|")[1] for line in lines if "|" in line]
    assert bars == ["#" * 36 + "." * 12, "#" * 12 + "." * 24 + "#" * 12]
    assert [line.split("|")[0].strip() for line in lines if "|" in line] == ["left", "right"]
    assert lines[-1].startswith("feet down: 1 to 2 of 2, 1.25 on the mean; in flight 0 %")


def test_a_description_names_feet_that_have_no_name() -> None:
    gait = make_gait("trot", *paired(4))
    assert "foot 3 |" in describe(gait)
    assert "foot 1 |" in describe(gait, ("a", "", "c", "d"))


@pytest.mark.parametrize("count", [2, 9])
def test_a_picture_has_a_disk_and_a_bar_for_each_foot(count: int, tmp_path: Path) -> None:
    from matplotlib.image import imread

    gait = make_gait("wave", *paired(count))
    path = tmp_path / "gait.png"
    draw_gait(gait, path, needle=0.3)
    picture = imread(path)[..., :3]
    orange = np.abs(picture - np.array([0xE8, 0x83, 0x3A]) / 255).max(axis=2) < 0.02
    blue = np.abs(picture - np.array([0x2F, 0x4B, 0x6E]) / 255).max(axis=2) < 0.02
    # The swing sectors' share of the disks' area; discs are 1.05 of 1.1 in half width.
    assert orange.sum() > 200 * count
    assert blue.sum() > 1000 * count
    with pytest.raises(GaitError, match="cannot be written"):
        draw_gait(gait, tmp_path / "none" / "gait.png")
