"""Undo and redo."""

from __future__ import annotations

from polypod.studio.history import MOST, History


def test_undo_and_redo_go_back_and_forth() -> None:
    history = History()
    assert not history.can_undo
    history.note({"n": 0}, None)
    history.note({"n": 1}, None)
    assert history.undo({"n": 2}) == {"n": 1}
    assert history.undo({"n": 1}) == {"n": 0}
    assert history.undo({"n": 0}) is None
    assert history.can_redo
    assert history.redo({"n": 0}) == {"n": 1}
    assert history.redo({"n": 1}) == {"n": 2}
    assert history.redo({"n": 2}) is None


def test_a_drag_is_one_step_and_a_change_forgets_what_was_undone() -> None:
    history = History()
    for n in range(5):
        history.note({"n": n}, "drag")
    assert history.undo({"n": 5}) == {"n": 0}
    assert not history.can_undo
    history.note({"n": 0}, "drag")
    assert not history.can_redo
    # After an undo the same gesture begins another step.
    assert history.undo({"n": 9}) == {"n": 0}


def test_it_does_not_grow_for_ever() -> None:
    history = History()
    for n in range(MOST + 50):
        history.note({"n": n}, None)
    steps = 0
    while history.undo({}) is not None:
        steps += 1
    assert steps == MOST
