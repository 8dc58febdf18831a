"""Wrong input: one sentence that names the file, the place and the choices."""

import json
import re

import numpy as np
import pytest
from authored_rigs import Rig, container, quadruped

from polypod.errors import PolypodError, RigError, SettingError
from polypod.morphology.load import load_rig

HIND = "HindUpper.L:HindFoot.L"


def assert_one_sentence(text):
    assert "\n" not in text
    assert not text.endswith(".")
    assert len(text) < 700


WRONG_LEGS = {
    "NoSuchJoint": (["HindUper.L:HindFoot.L"], r'no node named "HindUper.L".*HindUpper.L'),
    "NoSuchFoot": (["HindUpper.L:Foot.L"], r'no node named "Foot.L".*HindFoot.L'),
    "NoColon": (["HindUpper.L"], r"must be HIP:FOOT"),
    "NoFoot": (["HindUpper.L:"], r"must be HIP:FOOT"),
    "SameTwice": (["HindUpper.L:HindUpper.L"], r"same node.*HindLower.L, HindFoot.L"),
    "OtherLegsFoot": (["HindUpper.L:ForeFoot.R"], r"no chain from the hip.*ends in HindFoot.L"),
    "UpsideDown": (["HindFoot.L:HindUpper.L"], r"no chain from the hip"),
    "NoSuchIndex": (["#3:#999"], r"no node #999; nodes are #0 to #\d+"),
    "Shared": ([HIND, "HindLower.L:HindFoot.L"], r"share .*hip of its own"),
    "Empty": ([], r"at least one"),
}


@pytest.mark.parametrize("case", list(WRONG_LEGS))
def test_wrong_legs(tmp_path, case):
    legs, wanted = WRONG_LEGS[case]
    with pytest.raises(RigError, match=wanted) as caught:
        load_rig(quadruped().write(tmp_path), legs=legs)
    assert str(caught.value).startswith("authored.glb: ")
    assert_one_sentence(str(caught.value))


def test_repeated_names_ask_for_an_index_and_list_the_nodes(tmp_path):
    rig = quadruped()
    names = [re.sub(r"\.[LR]$", "", bone.name) for bone in rig.bones]
    row = {bone.name: i for i, bone in enumerate(rig.bones)}
    first, second = row["HindUpper.L"], row["HindUpper.R"]
    wanted = rf'2 nodes are named "HindUpper"; choose #{first} .*, #{second} '
    with pytest.raises(RigError, match=wanted) as caught:
        load_rig(rig.write(tmp_path, names=names), legs=["HindUpper:HindFoot"])
    assert_one_sentence(str(caught.value))


def test_colons_that_can_be_read_in_two_ways(tmp_path):
    rig = Rig().add("Body", None, (0, 1, 0), box=((-0.1, 0.9, -0.1), (0.1, 1.1, 0.1)))
    rig.add("a", "Body", (0, 0.9, 0), tip=(0, 0.5, 0)).add("a:b", "a", (0, 0.5, 0), tip=(0, 0.3, 0))
    rig.add("b:c", "a:b", (0, 0.3, 0), tip=(0, 0, 0)).add("c", "b:c", (0, 0, 0), joint=False)
    with pytest.raises(RigError, match=r'2 ways, "a" to "b:c", "a:b" to "c"; write #index'):
        load_rig(rig.write(tmp_path), legs=["a:b:c"])


WRONG_SPINES = {
    "NoSuchJoint": (["Pelvis", "Cheast"], r'spine: has no node named "Cheast".*Chest'),
    "InALeg": (["Pelvis", "HindLower.L"], r'"HindLower.L" belongs to a leg'),
    "Twice": (["Pelvis", "Chest", "Pelvis"], r'"Pelvis" is named twice'),
    "NoJoint": (["Pelvis", "Armature"], r'"Armature" is no joint of the skin'),
}


@pytest.mark.parametrize("case", list(WRONG_SPINES))
def test_wrong_spine(tmp_path, case):
    spine, wanted = WRONG_SPINES[case]
    with pytest.raises(RigError, match=wanted) as caught:
        load_rig(quadruped().write(tmp_path), spine=spine)
    assert_one_sentence(str(caught.value))


@pytest.mark.parametrize("name", ["height", "body_height"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf"), 1001.0])
def test_absurd_sizes(tmp_path, name, value):
    with pytest.raises(SettingError, match=rf"^{name}: must be metres above 0") as caught:
        load_rig(quadruped().write(tmp_path), **{name: value})
    assert_one_sentence(str(caught.value))


def test_a_body_height_beyond_the_legs(tmp_path):
    path = quadruped().write(tmp_path)
    with pytest.raises(SettingError, match=r"more than the legs reach; give at most 0\.\d+") as e:
        load_rig(path, body_height=0.8)
    most = float(str(e.value).rsplit(" ", 1)[1])
    assert load_rig(path, body_height=0.999 * most).body.height == pytest.approx(0.999 * most)


def test_a_rig_of_kilometres_asks_for_its_height(tmp_path):
    rig = quadruped()
    for bone in rig.bones:
        bone.place = tuple(5000.0 * np.array(bone.place))
        bone.tip = bone.tip and tuple(5000.0 * np.array(bone.tip))
        bone.box = bone.box and tuple(5000.0 * np.array(corner) for corner in bone.box)
    path = rig.write(tmp_path)
    with pytest.raises(RigError, match=r"give its height"):
        load_rig(path)
    assert load_rig(path, height=0.9).legs.length[0] == pytest.approx(0.664, abs=1e-3)


def test_wrong_forward(tmp_path):
    with pytest.raises(SettingError, match=r"one of \+z, -z, \+x, -x, not 'up'"):
        load_rig(quadruped().write(tmp_path), forward="up")


def test_no_skin(tmp_path):
    path = tmp_path / "bare.glb"
    path.write_bytes(container({"asset": {"version": "2.0"}, "nodes": [{"name": "A"}]}, b""))
    with pytest.raises(RigError, match=r"^bare.glb: has no skin"):
        load_rig(path)


def edited(tmp_path, edit):
    """The plain rig with its JSON changed."""
    data = quadruped().glb()
    size = int.from_bytes(data[12:16], "little")
    document, binary = json.loads(data[20 : 20 + size]), data[28 + size :]
    edit(document)
    path = tmp_path / "edited.glb"
    path.write_bytes(container(document, binary))
    return path


def test_a_skin_that_no_mesh_uses(tmp_path):
    def edit(document):
        for node in document["nodes"]:
            node.pop("skin", None)

    with pytest.raises(RigError, match=r"no mesh uses its skin"):
        load_rig(edited(tmp_path, edit))


def test_a_flat_inverse_bind_matrix(tmp_path):
    data = quadruped().glb()
    size = int.from_bytes(data[12:16], "little")
    document, binary = json.loads(data[20 : 20 + size]), bytearray(data[28 + size :])
    accessor = document["accessors"][document["skins"][0]["inverseBindMatrices"]]
    start = document["bufferViews"][accessor["bufferView"]]["byteOffset"] + 3 * 64
    binary[start : start + 64] = bytes(64)
    path = tmp_path / "flat.glb"
    path.write_bytes(container(document, bytes(binary)))
    name = quadruped().bones[3].name
    with pytest.raises(RigError, match=rf'inverseBindMatrices: .*"{name}" flattens space'):
        load_rig(path)


@pytest.mark.parametrize("rig", ["nothing.glb", "nothing.gltf", "nothing.toml", "dragon", "a.fbx"])
def test_no_such_rig(tmp_path, rig):
    with pytest.raises(RigError, match=r"cannot be read|is no rig: give a file that ends in") as e:
        load_rig(tmp_path / rig if "." in rig else rig)
    assert_one_sentence(str(e.value))


@pytest.mark.parametrize("cut", [0, 3, 12, 19, 200, 5000])
def test_truncated_files(tmp_path, cut):
    path = tmp_path / "cut.glb"
    path.write_bytes(quadruped().glb()[:cut])
    with pytest.raises(PolypodError) as caught:
        load_rig(path)
    assert_one_sentence(str(caught.value))
