"""The written GLB plays what was recorded, and nothing of the user's file is lost."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from sample_rigs import (
    as_gltf_folder,
    morphology_of,
    nasty_rig,
    pack_glb,
    pack_text,
    random_walk,
    two_joint_rig,
)

from polypod.errors import RigError, SettingError
from polypod.rigs.export import glb_bytes, write_glb
from polypod.rigs.gltf import GltfDocument
from polypod.rigs.playback import Playback
from polypod.rigs.tracks import joint_matrices, motion_matrices

REAL_RIGS = {
    "khronos_fox/Fox.glb": 0.01,
    "quaternius/spider.glb": 0.2,
    "quaternius/horse.glb": 0.4,
    "quaternius/triceratops.glb": 0.4,
    "quaternius/mech_george.glb": 0.3,
    "spider_bot/spider_bot_model.gltf": 0.1,
}


def played(data: bytes, times: np.ndarray) -> tuple[GltfDocument, np.ndarray]:
    document = GltfDocument.from_bytes(data, "out.glb")
    return document, Playback(document).world_matrices(times)


def assert_lands(recording: Any, data: bytes, tolerance: float = 2e-6) -> None:
    """Every joint is within `tolerance` of the largest coordinate of where the record says."""
    _, world = played(data, recording.time)
    found = world[..., :3, 3][:, recording.morphology.joint_node]
    largest = np.abs(recording.joint_position).max()
    assert found.shape[1] > 0
    assert np.abs(found - recording.joint_position).max() <= tolerance * largest


def contained(part: Any, whole: Any, path: str = "") -> list[str]:
    """Return the paths at which `whole` lacks something of `part`; lists may only grow."""
    if isinstance(part, dict) and isinstance(whole, dict):
        lost = [f"{path}.{key}" for key in part if key not in whole]
        kept = [key for key in part if key in whole]
        return lost + [
            at for key in kept for at in contained(part[key], whole[key], f"{path}.{key}")
        ]
    if isinstance(part, list) and isinstance(whole, list) and len(part) <= len(whole):
        pairs = zip(part, whole[: len(part)], strict=True)
        return [at for i, (a, b) in enumerate(pairs) for at in contained(a, b, f"{path}[{i}]")]
    return [] if part == whole and type(part) is type(whole) else [path]


def test_nasty_rig_lands_where_recorded() -> None:
    recording = random_walk(morphology_of(nasty_rig().document()))
    assert_lands(recording, glb_bytes(recording))


@pytest.mark.parametrize("name", REAL_RIGS)
def test_real_rigs_land_where_recorded(name: str, shared_rig: Any) -> None:
    document = GltfDocument.read(shared_rig(name))
    recording = random_walk(morphology_of(document, REAL_RIGS[name]), frames=30)
    data = glb_bytes(recording)
    assert_lands(recording, data)
    written = GltfDocument.from_bytes(data, "out.glb")
    assert bytes(written.binary[: len(document.binary)]) == document.binary


def test_skinned_vertices_follow_the_rigid_motions() -> None:
    document = nasty_rig().document()
    recording = random_walk(morphology_of(document))
    written, world = played(glb_bytes(recording), recording.time)
    skin = written.skins()[0]
    rows = {int(node): row for row, node in enumerate(recording.morphology.joint_node)}
    for at, node in enumerate(skin.joints):
        drawn = world[:, node] @ skin.inverse_bind[at]
        wanted = joint_matrices(recording, rows[int(node)]) @ skin.inverse_bind[at]
        np.testing.assert_allclose(drawn, wanted, atol=2e-5)


def test_what_is_no_joint_rides_rigidly() -> None:
    document = nasty_rig().document()
    recording = random_walk(morphology_of(document))
    written, world = played(glb_bytes(recording), recording.time)
    shell = np.linalg.inv(world[:, 3]) @ world[:, 8]
    np.testing.assert_allclose(
        shell, np.broadcast_to(document.node_local_matrices()[8], shell.shape), atol=1e-5
    )
    carried = motion_matrices(recording) @ document.node_world_matrices()[9]
    np.testing.assert_allclose(world[:, 9], carried, rtol=1e-5, atol=2e-5)
    assert written.node_parents()[10] == -1  # the lamp is no part of the creature


def test_nothing_is_lost() -> None:
    sample = nasty_rig()
    original = GltfDocument.from_bytes(sample.glb(((0x58585858, b"keep me!"),)), "nasty.glb")
    before = copy.deepcopy(original.json)
    data = glb_bytes(random_walk(morphology_of(original)))
    written = GltfDocument.from_bytes(data, "out.glb")
    assert original.json == before
    assert written.binary.startswith(original.binary)
    assert written.other_chunks == ((0x58585858, b"keep me!"),)
    changed = contained(original.json, written.json)
    assert sorted(changed) == [".buffers[0].byteLength", ".nodes[2].matrix", ".scenes[0].nodes"]
    assert written.json["scenes"][0]["nodes"] == [10, 11]
    assert written.json["animations"][0] == original.json["animations"][0]
    assert [a["name"] for a in written.json["animations"]] == ["Polypod walk", "Polypod walk 2"]
    np.testing.assert_allclose(
        written.node_world_matrices()[:11], original.node_world_matrices(), atol=1e-12
    )


def test_a_root_that_holds_everything_is_used() -> None:
    sample = two_joint_rig()
    sample.json["nodes"].append({"name": "All", "scale": [2, 2, 2], "children": [0, 2]})
    sample.json["scenes"] = [{"nodes": [3]}]
    recording = random_walk(morphology_of(sample.document()))
    data = glb_bytes(recording)
    written = GltfDocument.from_bytes(data, "out.glb")
    assert len(written.json["nodes"]) == 4
    assert contained(sample.json, written.json) == [".buffers[0].byteLength"]
    assert_lands(recording, data)


def test_samplers_are_as_promised() -> None:
    recording = random_walk(morphology_of(nasty_rig().document()))
    written = GltfDocument.from_bytes(glb_bytes(recording), "out.glb")
    animation = written.json["animations"][-1]
    moved = {(c["target"]["node"], c["target"]["path"]) for c in animation["channels"]}
    assert len(moved) == len(animation["channels"]) > 6
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        assert sampler["interpolation"] == "LINEAR"
        times = written.accessor(sampler["input"])
        np.testing.assert_array_equal(times, recording.time.astype(np.float32))
        values = written.accessor(sampler["output"])
        assert len(values) == len(times)
        if channel["target"]["path"] == "rotation":
            np.testing.assert_allclose(np.linalg.norm(values, axis=1), 1.0, atol=2e-7)
            assert (np.einsum("fi,fi->f", values[1:], values[:-1]) > 0.0).all()
    # A joint rigid on its parent whose place in the file is right gets no channel for its scale.
    assert (1, "scale") not in moved


def test_what_other_clips_move_has_a_track() -> None:
    """Blender leaves what has no track as the clip before put it."""
    sample = nasty_rig()
    sampler = dict(sample.json["animations"][0]["samplers"][0])
    sampler["output"] = sample.accessor([[1, 1, 1], [2, 2, 2]])
    targets = [(3, "scale"), (7, "scale"), (7, "translation"), (8, "scale"), (10, "translation")]
    sample.json["animations"].append(
        {
            "channels": [{"sampler": 0, "target": {"node": n, "path": p}} for n, p in targets],
            "samplers": [sampler],
        }
    )
    recording = random_walk(morphology_of(sample.document()))
    data = glb_bytes(recording)
    animation = GltfDocument.from_bytes(data, "out.glb").json["animations"][-1]
    keyed = [(c["target"]["node"], c["target"]["path"]) for c in animation["channels"]]
    assert len(set(keyed)) == len(keyed)
    # All but the lamp, which is no part of the creature.
    assert set(targets) - set(keyed) == {(10, "translation")}
    assert_lands(recording, data)


def test_joints_land_below_a_joint_of_uneven_scale() -> None:
    sample = nasty_rig()
    sample.json["nodes"][7]["scale"] = [1.0, 3.0, 0.5]
    recording = random_walk(morphology_of(sample.document()))
    assert_lands(recording, glb_bytes(recording))


def test_json_as_deep_as_can_be_read_is_written_or_refused() -> None:
    sample = two_joint_rig()
    for depth in (100, 400, 900, 990):
        sample.finish()
        content = json.loads(json.dumps(sample.json))
        text = json.dumps(content).replace('"hip"', '"hip", "extras": ' + "[" * depth + "]" * depth)
        try:
            document = GltfDocument.from_bytes(pack_text(text, sample.binary), "deep.glb")
            data = glb_bytes(random_walk(morphology_of(document), frames=2))
        except RigError:
            assert depth > 500
        else:
            assert b"[" * depth in data


def test_a_still_creature_in_its_rest_pose_moves_only_its_motion_node() -> None:
    morphology = morphology_of(two_joint_rig().document(), 1.0)
    recording = random_walk(morphology, frames=5)
    still = copy.copy(recording)
    rest = np.broadcast_to(morphology.joint_rest, recording.joint_position.shape)
    turn = np.broadcast_to([0.0, 0.0, 0.0, 1.0], recording.joint_rotation.shape)
    for name, value in {
        "body_position": np.zeros((5, 3)),
        "body_rotation": turn[:, 0],
        "joint_position": rest,
        "joint_rotation": turn,
    }.items():
        object.__setattr__(still, name, value)
    written = GltfDocument.from_bytes(glb_bytes(still), "out.glb")
    channels = written.json["animations"][-1]["channels"]
    assert {c["target"]["node"] for c in channels} == {3}
    assert_lands(still, glb_bytes(still))


@pytest.mark.parametrize("metres_per_unit", [1e-5, 1e-3, 1.0, 100.0])
def test_sizes_from_mites_to_towers(metres_per_unit: float) -> None:
    morphology = morphology_of(nasty_rig().document(), metres_per_unit)
    recording = random_walk(morphology, far=0.0)
    assert_lands(recording, glb_bytes(recording), 1e-6)


def test_a_walk_of_a_kilometre_still_lands() -> None:
    recording = random_walk(morphology_of(nasty_rig().document()), far=1000.0)
    assert_lands(recording, glb_bytes(recording), 2e-7)


def test_outside_files_are_embedded(tmp_path: Path) -> None:
    Image.new("RGB", (2, 2), (255, 0, 0)).save(tmp_path / "i.png")
    path = as_gltf_folder(nasty_rig(), tmp_path, (tmp_path / "i.png").read_bytes())
    document = GltfDocument.read(path)
    recording = random_walk(morphology_of(document))
    out = tmp_path / "elsewhere"
    out.mkdir()
    write_glb(recording, out / "walk.glb")
    written = GltfDocument.read(out / "walk.glb")
    changed = contained(document.json, written.json)
    allowed = (".buffers[0].", ".images[0].uri", ".nodes[2].matrix", ".scenes[0].nodes")
    assert all(place.startswith(allowed) for place in changed)
    assert "uri" not in written.json["buffers"][0]
    assert written.json["buffers"][1] == document.json["buffers"][1]
    assert written.json["images"][0]["uri"].startswith("data:image/png;base64,")
    assert written.binary.startswith(document.binary)
    assert_lands(recording, (out / "walk.glb").read_bytes())


def test_a_file_without_buffers_gets_one() -> None:
    sample = two_joint_rig().json
    sample = {key: sample[key] for key in ("asset", "nodes", "scenes")}
    sample["nodes"] = [
        {k: v for k, v in n.items() if k not in ("mesh", "skin")} for n in sample["nodes"]
    ]
    bare = GltfDocument.from_bytes(pack_glb(sample, b""), "bare.glb")
    skinned = morphology_of(two_joint_rig().document(), 1.0)
    source = type(skinned.source)(
        bare, skinned.source.body_from_file, skinned.source.joint_rest_file
    )
    morphology = type(skinned)(**{**skinned.__dict__, "source": source})
    recording = random_walk(morphology, far=2.0)
    assert_lands(recording, glb_bytes(recording))


def test_writing_twice_gives_equal_bytes() -> None:
    recording = random_walk(morphology_of(nasty_rig().document()))
    assert glb_bytes(recording) == glb_bytes(recording)


def test_an_output_can_be_an_input_again() -> None:
    first = random_walk(morphology_of(nasty_rig().document()))
    again = GltfDocument.from_bytes(glb_bytes(first), "again.glb")
    recording = random_walk(morphology_of(again), frames=12)
    data = glb_bytes(recording)
    written = GltfDocument.from_bytes(data, "out.glb")
    assert len(written.json["nodes"]) == len(again.json["nodes"])
    assert len(written.json["animations"]) == len(again.json["animations"]) + 1
    assert_lands(recording, data)


def test_missing_folder_and_wrong_suffix(tmp_path: Path) -> None:
    recording = random_walk(morphology_of(two_joint_rig().document()), frames=2)
    with pytest.raises(SettingError, match="does not exist"):
        write_glb(recording, tmp_path / "missing" / "walk.glb")
    with pytest.raises(SettingError, match=r"\.glb"):
        write_glb(recording, tmp_path / "walk.gltf")
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_write_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "walk.glb"
    path.write_bytes(b"before")
    recording = random_walk(morphology_of(two_joint_rig().document()), frames=2)

    def interrupt(*_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_glb(recording, path)
    assert path.read_bytes() == b"before"
    assert [found.name for found in tmp_path.iterdir()] == ["walk.glb"]


def test_a_parent_of_scale_zero_is_refused() -> None:
    sample = two_joint_rig()
    morphology = morphology_of(sample.document(), 1.0)
    sample.json["nodes"].append({"name": "Flat", "scale": [0, 0, 0], "children": [0, 2]})
    sample.json["scenes"] = [{"nodes": [3]}]
    flat = GltfDocument.from_bytes(pack_glb(sample.json, sample.binary), "flat.glb")
    object.__setattr__(morphology.source, "document", flat)
    with pytest.raises(RigError, match="scale zero"):
        glb_bytes(random_walk(morphology, frames=2))


def test_json_of_the_output_is_plain() -> None:
    data = glb_bytes(random_walk(morphology_of(nasty_rig().document())))
    length = int.from_bytes(data[12:16], "little")
    parsed = json.loads(data[20 : 20 + length], parse_constant=lambda text: pytest.fail(text))
    assert parsed["extensions"] == {"EXT_unheard_of": {"deep": [{"a": 1.0}]}}
