"""Legs nobody named: strangers' rigs of many builds."""

import numpy as np
import pytest
from authored_rigs import Rig, arthropod, biped, middle_of_foot, quadruped

from polypod.errors import RigError
from polypod.morphology.load import load_rig
from polypod.morphology.names import side_hint


def legs_of(morphology):
    legs = morphology.legs
    found = []
    for k, foot in enumerate(morphology.foot_name):
        joints = [morphology.joint_name[row] for row in legs.joint[k, : legs.joint_count[k]]]
        found.append(f"{joints[0]}:{foot}")
    return found


def lizard():
    """Sprawling, four toes a foot, a tail that drags."""
    rig = Rig().add("hips", None, (0, 0.06, -0.1), tip=(0, 0.06, 0), width=0.03)
    rig.add("chest", "hips", (0, 0.06, 0), tip=(0, 0.06, 0.1), width=0.03)
    rig.add("head", "chest", (0, 0.06, 0.12), box=((-0.02, 0.04, 0.12), (0.02, 0.08, 0.2)))
    parent = "hips"
    for i in range(5):
        at, to = (0, 0.05 - 0.01 * i, -0.15 - 0.06 * i), (0, 0.04 - 0.009 * i, -0.2 - 0.06 * i)
        rig.add(f"tail{i}", parent, at, tip=to, width=0.008 - 0.001 * i)
        parent = f"tail{i}"
    for end, z, trunk in (("hind", -0.08, "hips"), ("front", 0.1, "chest")):
        for side, sign in (("l", 1), ("r", -1)):
            hip, knee, ankle = (0.03 * sign, 0.05, z), (0.08 * sign, 0.06, z), (0.1 * sign, 0.01, z)
            rig.add(f"{end}_upper_{side}", trunk, hip, tip=knee, width=0.008)
            rig.add(f"{end}_lower_{side}", f"{end}_upper_{side}", knee, tip=ankle, width=0.006)
            palm = ((0.1 * sign - 0.005, 0, z - 0.005), (0.1 * sign + 0.005, 0.015, z + 0.01))
            rig.add(f"{end}_foot_{side}", f"{end}_lower_{side}", ankle, box=palm)
            for toe in range(4):
                x = 0.1 * sign + 0.006 * (toe - 1.5)
                at, to = (x, 0.005, z + 0.012), (x + 0.004 * (toe - 1.5), 0.002, z + 0.03)
                rig.add(f"{end}_toe{toe}_{side}", f"{end}_foot_{side}", at, tip=to, width=0.002)
    return rig


def bird():
    """Three leg sections, toes that branch at the end of the last, wings."""
    rig = Rig().add("pelvis", None, (0, 0.5, 0), tip=(0, 0.55, 0.1), width=0.08)
    rig.add("neck", "pelvis", (0, 0.6, 0.15), tip=(0, 0.75, 0.2))
    rig.add("head", "neck", (0, 0.8, 0.2), box=((-0.03, 0.78, 0.18), (0.03, 0.85, 0.3)))
    for side, sign in (("L", 1), ("R", -1)):
        x = 0.06 * sign
        points = [(x, 0.48, 0), (x, 0.38, 0.08), (x, 0.2, -0.06), (x, 0.02, 0.0)]
        parent = "pelvis"
        for i, part in enumerate(("femur", "tibia", "meta")):
            rig.add(f"{part}.{side}", parent, points[i], tip=points[i + 1], width=0.01)
            parent = f"{part}.{side}"
        for toe in range(3):
            to = (x + 0.03 * (toe - 1), 0.008, 0.07)
            rig.add(f"toe{toe}.{side}", parent, points[3], tip=to, width=0.008)
        rig.add(f"toe3.{side}", parent, points[3], tip=(x, 0.008, -0.04), width=0.008)
        rig.add(f"wing.{side}", "pelvis", (0.08 * sign, 0.6, 0.05), tip=(0.4 * sign, 0.0, 0.0))
    return rig


def radial(count):
    """A robot with legs all around."""
    rig = Rig().add("body", None, (0, 0.3, 0), box=((-0.1, 0.25, -0.1), (0.1, 0.4, 0.1)))
    for i in range(count):
        angle = 2 * np.pi * i / count
        out = np.array([np.sin(angle), 0, np.cos(angle)])
        hip, knee, tip = 0.1 * out + [0, 0.3, 0], 0.3 * out + [0, 0.4, 0], 0.5 * out
        rig.add(f"a{i}", "body", hip, tip=knee, width=0.01)
        rig.add(f"b{i}", f"a{i}", knee, tip=tip, width=0.01)
        rig.add(f"c{i}", f"b{i}", tip, joint=False)
    return rig


def hopper():
    """One leg."""
    rig = Rig().add("Trunk", None, (0, 1, 0), box=((-0.1, 0.9, -0.1), (0.1, 1.3, 0.1)))
    rig.add("Thigh", "Trunk", (0, 0.9, 0), tip=(0, 0.5, 0.1))
    rig.add("Shin", "Thigh", (0, 0.5, 0.1), tip=(0, 0.05, 0))
    return rig.add("Foot", "Shin", (0, 0.05, 0), box=((-0.05, 0, -0.05), (0.05, 0.06, 0.15)))


def person_with_everything():
    """Twist bones, weightless goals, a skirt that reaches the ground, a root."""
    rig = biped()
    rig.add("root", None, (0, 0, 0))
    rig.bones[0].parent = "root"
    for side, sign in (("Left", 1), ("Right", -1)):
        twist = f"{side}ThighTwist"
        rig.add(twist, f"{side}UpLeg", (0.1 * sign, 0.7, 0), tip=(0.1 * sign, 0.55, 0))
        rig.add(f"ik_{side}", "root", (0.1 * sign, 0.09, -0.02))
        rig.add(f"Skirt{side}", "Hips", (0.2 * sign, 0.95, 0.1), tip=(0.25 * sign, 0.02, 0.15))
    return rig


def pairs(pattern, rows, sides=("L", "R")):
    return [pattern.format(r=row, s=side) for row in rows for side in sides]


CREATURES = {
    "quadruped": (quadruped(), pairs("{r}Upper.{s}:{r}Foot.{s}", ("Hind", "Fore"))),
    "girdled": (quadruped(girdle=True), pairs("{r}Upper.{s}:{r}Foot.{s}", ("Hind", "Fore"))),
    "detached": (quadruped(detached=True), pairs("{r}Upper.{s}:{r}Foot.{s}", ("Hind", "Fore"))),
    "unmarked": (
        quadruped(detached=True, markers=False),
        pairs("{r}Upper.{s}:{r}Foot.{s}", ("Hind", "Fore")),
    ),
    "ant": (arthropod(3), pairs("Coxa{r}.{s}:Tip{r}.{s}", range(3))),
    "spider": (arthropod(4, marks=False), pairs("Coxa{r}.{s}:Tibia{r}.{s}", range(4))),
    "centipede": (arthropod(20), pairs("Coxa{r}.{s}:Tip{r}.{s}", range(20))),
    "person": (biped(), ["LeftUpLeg:LeftFoot", "RightUpLeg:RightFoot"]),
    "dressed": (person_with_everything(), ["LeftUpLeg:LeftFoot", "RightUpLeg:RightFoot"]),
    "lizard": (lizard(), pairs("{r}_upper_{s}:{r}_foot_{s}", ("hind", "front"), "lr")),
    "bird": (bird(), ["femur.L:toe0.L", "femur.R:toe0.R"]),
    "pentapod": (radial(5), ["a2:c2", "a3:c3", "a1:c1", "a4:c4", "a0:c0"]),
    "hopper": (hopper(), ["Thigh:Foot"]),
}


@pytest.mark.parametrize("name", list(CREATURES))
def test_hips_and_feet_are_found_back_to_front(tmp_path, name):
    rig, wanted = CREATURES[name]
    assert legs_of(load_rig(rig.write(tmp_path))) == wanted


@pytest.mark.parametrize("name", ["quadruped", "detached", "ant", "lizard", "person"])
def test_names_are_not_needed(tmp_path, name):
    rig, wanted = CREATURES[name]
    named = load_rig(rig.write(tmp_path), forward="+z")
    nameless = load_rig(rig.write(tmp_path, names=[None] * len(rig.bones)), forward="+z")
    assert len(wanted) == len(nameless.foot_name)
    assert nameless.legs.joint.tolist() == named.legs.joint.tolist()
    assert nameless.legs.sole_stance == pytest.approx(named.legs.sole_stance)


@pytest.mark.parametrize("name", ["quadruped", "ant", "lizard", "person", "pentapod"])
def test_named_and_detected_legs_are_the_same(tmp_path, name):
    rig, wanted = CREATURES[name]
    detected = load_rig(rig.write(tmp_path))
    named = load_rig(rig.write(tmp_path), legs=wanted)
    for one, other in zip(named.legs, detected.legs, strict=True):
        assert np.array_equal(one, other, equal_nan=True)
    assert any("were detected" in guess for guess in detected.guesses)
    assert not any("were detected" in guess for guess in named.guesses)


def test_a_bird_stands_on_all_its_toes(tmp_path):
    morphology = load_rig(bird().write(tmp_path))
    foot = morphology.legs.foot_joint[0]
    for toe in (1, 2, 3):
        assert morphology.joint_parent[morphology.joint_name.index(f"toe{toe}.L")] == foot
    # The toes reach 7 cm forward, 4 back and 3 to either side, plus the skin.
    assert middle_of_foot(morphology.legs, 0)[2] == pytest.approx(0.015, abs=1e-6)
    assert morphology.legs.foot_half_size[0] == pytest.approx([0.038, 0.063], abs=1e-6)


def test_a_trailing_cane_is_no_leg(tmp_path):
    rig = biped().add("RightCane", "RightForeArm", (-0.7, 1.45, 0), tip=(-0.7, 0.02, 0))
    morphology = load_rig(rig.write(tmp_path))
    assert legs_of(morphology) == ["LeftUpLeg:LeftFoot", "RightUpLeg:RightFoot"]
    assert any('"RightCane"' in guess for guess in morphology.guesses)


def test_a_rig_without_legs_is_refused_in_one_sentence(tmp_path):
    rig = Rig().add("Body", None, (0, 0.5, 0), box=((-0.2, 0.0, -0.2), (0.2, 1.0, 0.2)))
    rig.add("Lid", "Body", (0, 1.0, 0), box=((-0.2, 1.0, -0.2), (0.2, 1.1, 0.2)))
    with pytest.raises(RigError, match=r"no legs were found.*--leg HIP:FOOT, from Body, Lid"):
        load_rig(rig.write(tmp_path))


@pytest.mark.parametrize(
    ("name", "side"),
    [
        ("FrontLeg.L", 1),
        ("thigh_r", -1),
        ("b_LeftUpperArm_09", 1),
        ("mixamorig:RightFoot", -1),
        ("Bip001 L Thigh", 1),
        ("leg0BackRight", -1),
        ("LFCoxa", 1),
        ("RH_HAA", -1),
        ("左足", 1),
        ("Root", 0),
        ("Leg", 0),
        ("LowerBack", 0),
        ("Rib", 0),
    ],
)
def test_sides_are_read_from_names(name, side):
    assert side_hint(name) == side
