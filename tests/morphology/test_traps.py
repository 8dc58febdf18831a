"""Each trap that real files set, in a small file that has it."""

import numpy as np
import pytest
from authored_rigs import Bone, Rig, arthropod, biped, matrix, middle_of_foot, quadruped

from polypod.morphology.describe import extensions
from polypod.morphology.load import load_rig

PAWS = [f"{end}Upper.{side}:{end}Foot.{side}" for end in ("Hind", "Fore") for side in "LR"]


def joints_of(morphology, k):
    legs = morphology.legs
    return [morphology.joint_name[row] for row in legs.joint[k, : legs.joint_count[k]]]


def places(morphology):
    return dict(zip(morphology.joint_name, morphology.joint_rest, strict=True))


def assert_rest_as_authored(morphology, rig, scale=1.0):
    """Every joint lies where the author put it, seen from the hips' middle."""
    found = places(morphology)
    authored = {bone.name: scale * np.array(bone.place) for bone in rig.bones}
    shift = None
    compared = 0
    for name, place in found.items():
        shift = authored[name] - place if shift is None else shift
        assert place + shift == pytest.approx(authored[name], abs=2e-6 * scale)
        compared += 1
    assert compared == len(morphology.joint_name) > 10


def assert_sole_fixed_to_its_node(morphology):
    source = morphology.source
    row = {int(node): i for i, node in enumerate(morphology.joint_node)}
    for k, node in enumerate(morphology.foot_node):
        rest = source.body_from_file @ source.joint_rest_file[row[int(node)]]
        place = rest[:3, :3] @ morphology.foot_offset[k] + rest[:3, 3]
        assert place == pytest.approx(morphology.legs.sole_rest[k], abs=1e-6)


def test_a_plain_rig_is_read_as_authored(tmp_path):
    rig = quadruped()
    morphology = load_rig(rig.write(tmp_path), legs=PAWS)
    assert_rest_as_authored(morphology, rig)
    assert_sole_fixed_to_its_node(morphology)
    legs = morphology.legs
    assert [joints_of(morphology, k) for k in range(4)] == [
        [f"{end}Upper.{side}", f"{end}Lower.{side}"] for end in ("Hind", "Fore") for side in "LR"
    ]
    assert [morphology.joint_name[row] for row in legs.foot_joint] == list(morphology.foot_name)
    assert legs.side.tolist() == [1, -1, 1, -1]
    assert legs.row.tolist() == [0, 0, 1, 1]
    assert legs.upright.all()
    # The paw's box is 8 cm wide and 14 long, its middle 4 cm ahead of the ankle.
    assert legs.foot_half_size == pytest.approx(np.tile([0.04, 0.07], (4, 1)), abs=1e-6)
    assert middle_of_foot(legs, 0) == pytest.approx([0.15, -0.6, -0.36], abs=1e-6)
    assert middle_of_foot(legs, 3) == pytest.approx([-0.15, -0.6, 0.44], abs=1e-6)
    section = np.hypot(0.28, 0.12)
    assert legs.length[0] == pytest.approx(
        section + np.hypot(0.27, 0.12) + np.hypot(0.05, 0.04), abs=1e-6
    )
    assert np.isnan(legs.bend_limit).all()
    assert np.isnan(legs.hip_limit).all()


def test_parents_come_first_in_the_joint_table(tmp_path):
    morphology = load_rig(quadruped(detached=True).write(tmp_path), legs=PAWS)
    assert (morphology.joint_parent < np.arange(len(morphology.joint_parent))).all()
    assert (morphology.joint_parent >= 0).sum() == len(morphology.joint_parent) - 1


def test_a_detached_foot_is_found_at_the_mark_of_the_chains_tip(tmp_path):
    morphology = load_rig(quadruped(detached=True).write(tmp_path), legs=PAWS)
    for k, leg in enumerate(PAWS):
        hip, foot = leg.split(":")
        assert joints_of(morphology, k) == [hip, hip.replace("Upper", "Lower")]
        assert morphology.joint_name[morphology.legs.foot_joint[k]] == foot
    assert middle_of_foot(morphology.legs, 0) == pytest.approx([0.15, -0.6, -0.36], abs=1e-6)


def test_naming_the_mark_finds_the_detached_foot_too(tmp_path):
    legs = [leg.split(":")[0] + ":" + leg.split(":")[0].replace("Upper", "Lower") for leg in PAWS]
    path = quadruped(detached=True).write(tmp_path)
    morphology = load_rig(path, legs=[f"{leg}_end" for leg in legs])
    feet = [morphology.joint_name[row] for row in morphology.legs.foot_joint]
    assert feet == [leg.split(":")[1] for leg in PAWS]
    assert morphology.foot_name[0] == "HindLower.L_end"


def test_a_detached_foot_below_a_helper_rides_with_the_helper(tmp_path):
    rig = quadruped(detached=True)
    for bone in list(rig.bones):
        if "Foot" in bone.name:
            ankle, paw = bone.place, bone.box
            rig.bones.remove(bone)
            rig.add(f"IK{bone.name}", None, ankle, tip=np.array(ankle) - [0, 0.02, 0])
            lower = np.add(ankle, [0, -0.02, 0.03])
            rig.add(bone.name, f"IK{bone.name}", lower, box=paw)
    morphology = load_rig(rig.write(tmp_path), legs=PAWS)
    names, legs = morphology.joint_name, morphology.legs
    assert [names[row] for row in legs.foot_joint] == [f"IK{leg.split(':')[1]}" for leg in PAWS]
    for k, row in enumerate(legs.foot_joint):
        hoof = names.index(PAWS[k].split(":")[1])
        assert morphology.joint_parent[hoof] == row
        assert joints_of(morphology, k)[-1] == PAWS[k].split(":")[0].replace("Upper", "Lower")


def test_a_skinned_tip_under_a_detached_foot_rides_on_the_foot(tmp_path):
    rig = quadruped(detached=True, markers=False)
    for end, z in (("Hind", -0.4), ("Fore", 0.4)):
        for side, x in (("L", 0.15), ("R", -0.15)):
            heel = ((x - 0.02, 0.0, z - 0.06), (x + 0.02, 0.04, z - 0.03))
            rig.add(f"{end}Heel.{side}", f"{end}Lower.{side}", (x, 0.05, z), box=heel)
    by_foot = load_rig(rig.write(tmp_path), legs=PAWS)
    by_heel = load_rig(rig.write(tmp_path), legs=[leg.replace("Foot", "Heel") for leg in PAWS])
    for morphology in (by_foot, by_heel):
        for k in range(4):
            foot = morphology.legs.foot_joint[k]
            assert morphology.joint_name[foot] == PAWS[k].split(":")[1]
            heel = morphology.joint_name.index(PAWS[k].split(":")[1].replace("Foot", "Heel"))
            assert morphology.joint_parent[heel] == foot


def test_a_detached_foot_without_any_joint_at_its_place_hangs_on_the_skin_it_touches(tmp_path):
    morphology = load_rig(quadruped(detached=True, markers=False).write(tmp_path), legs=PAWS)
    assert joints_of(morphology, 0) == ["HindUpper.L", "HindLower.L"]
    assert morphology.joint_name[morphology.legs.foot_joint[0]] == "HindFoot.L"
    assert any("no joint is at its place" in guess for guess in morphology.guesses)


POSES = {
    "PawLifted": {"ForeUpper.L": matrix(turn_x=-40), "ForeLower.L": matrix(turn_x=70)},
    "WholeBodyTilted": {"Pelvis": matrix(turn_x=12, shift=(0.1, -0.1, 0.2))},
    "EveryJointTurned": {bone.name: matrix(turn_x=7, turn_y=-9) for bone in quadruped().bones[1:]},
}


@pytest.mark.parametrize("pose", list(POSES))
@pytest.mark.parametrize("turns", [0.0, 17.0])
def test_the_rest_is_the_bind_pose_not_the_node_pose(tmp_path, pose, turns):
    rig = quadruped()
    morphology = load_rig(rig.write(tmp_path, pose=POSES[pose], turns=turns), legs=PAWS)
    assert_rest_as_authored(morphology, rig)
    assert_sole_fixed_to_its_node(morphology)


SPACES = {
    "MetresInCentimetres": {"space": matrix(0.01)},
    "CentimetresInMetres": {"space": matrix(100.0)},
    "MeshNodeLeadsThere": {"space": matrix(100, -90), "mesh_node": matrix(100, -90)},
    "MeshNodeMisleads": {"space": matrix(0.01, 90), "mesh_node": matrix(3.0)},
    "MeshNodeUnderArmature": {"armature": matrix(0.01, -90), "space": matrix(0.01, -90)},
    "ArmatureScaled": {"armature": matrix(100, -90), "mesh_node": matrix(0.5, 30)},
}


@pytest.mark.parametrize("space", list(SPACES))
@pytest.mark.parametrize("pose", [None, *POSES])
def test_inverse_binds_may_live_in_any_space(tmp_path, space, pose):
    rig = quadruped()
    path = rig.write(tmp_path, turns=10.0, pose=POSES.get(pose), **SPACES[space])
    morphology = load_rig(path, legs=PAWS)
    assert_rest_as_authored(morphology, rig)
    assert middle_of_foot(morphology.legs, 0) == pytest.approx([0.15, -0.6, -0.36], abs=1e-5)
    assert_sole_fixed_to_its_node(morphology)


@pytest.mark.parametrize("name", [None, "Bone"])
def test_joints_without_or_with_equal_names_are_named_by_index(tmp_path, name):
    rig = quadruped()
    row = {bone.name: i for i, bone in enumerate(rig.bones)}
    legs = [":".join(f"#{row[node]}" for node in leg.split(":")) for leg in PAWS]
    morphology = load_rig(rig.write(tmp_path, names=[name] * len(rig.bones)), legs=legs)
    assert morphology.foot_name == tuple(leg.split(":")[1] for leg in legs)
    assert morphology.joint_node[morphology.legs.foot_joint].tolist() == [
        row[leg.split(":")[1]] for leg in PAWS
    ]


def test_names_may_hold_spaces_and_colons(tmp_path):
    rig = quadruped().renamed(lambda name: f"mix:{name}".replace("Foot", " IK Foot"))
    legs = [f"mix:{h}:mix:{f}".replace("Foot", " IK Foot") for h, f in (x.split(":") for x in PAWS)]
    morphology = load_rig(rig.write(tmp_path), legs=legs)
    assert morphology.foot_name[1] == "mix:Hind IK Foot.R"


def test_straight_legs_crouch_in_stance(tmp_path):
    morphology = load_rig(quadruped(straight=True).write(tmp_path), legs=PAWS)
    at_rest, in_stance = extensions(morphology)
    assert at_rest == pytest.approx(np.ones(4), abs=1e-6)
    assert in_stance == pytest.approx(np.full(4, 0.9), abs=1e-6)
    # A leg of 0.55 m at nine tenths: the body comes down by the tenth.
    assert morphology.body.height == pytest.approx(0.6 - 0.055, abs=1e-6)
    assert any("nearly straight" in guess for guess in morphology.guesses)


def test_bent_legs_stand_as_they_rest(tmp_path):
    morphology = load_rig(arthropod().write(tmp_path))
    legs = morphology.legs
    assert legs.sole_stance == pytest.approx(legs.sole_rest, abs=1e-6)


@pytest.mark.parametrize(("turn", "forward"), [(0, "+z"), (180, "-z"), (90, "+x"), (-90, "-x")])
@pytest.mark.parametrize("named", [True, False])
def test_the_front_may_be_anywhere(tmp_path, turn, forward, named):
    rig = quadruped()
    spin = matrix(turn_y=turn)
    for i, bone in enumerate(rig.bones):
        place, tip = (p if p is None else spin[:3, :3] @ p for p in (bone.place, bone.tip))
        box = None if bone.box is None else np.array(bone.box) @ spin[:3, :3].T
        if box is not None:
            box = (box.min(axis=0), box.max(axis=0))
        rig.bones[i] = Bone(bone.name, bone.parent, place, tip, box, width=bone.width)
    names = None if named else [None] * len(rig.bones)
    morphology = load_rig(rig.write(tmp_path, names=names))
    legs = morphology.legs
    assert middle_of_foot(legs, 0) == pytest.approx([0.15, -0.6, -0.36], abs=1e-6)
    assert middle_of_foot(legs, 3) == pytest.approx([-0.15, -0.6, 0.44], abs=1e-6)
    assert any(f"it faces {forward}" in guess for guess in morphology.guesses)
    other = load_rig(rig.write(tmp_path, names=names), forward=forward)
    assert other.joint_rest == pytest.approx(morphology.joint_rest)
    assert not any("it faces" in guess for guess in other.guesses)


def test_spine_and_girdles_may_be_siblings(tmp_path):
    rig = quadruped(girdle=True)
    for bone in rig.bones:
        if bone.name.endswith(("Girdle.L", "Girdle.R")):
            bone.parent = "Root"
    morphology = load_rig(rig.write(tmp_path), legs=PAWS)
    names = morphology.joint_name
    assert [names[row] for row in morphology.spine] == ["Pelvis", "Chest", "Neck", "Head"]
    girdle = names.index("ForeGirdle.L")
    assert morphology.joint_parent[names.index("ForeUpper.L")] == girdle
    assert names[morphology.joint_parent[girdle]] == "Root"


def test_a_leg_without_a_joint_at_its_tip_ends_in_its_lowest_skin(tmp_path):
    legs = [f"Coxa{row}.{side}:Tibia{row}.{side}" for row in range(3) for side in "LR"]
    morphology = load_rig(arthropod(marks=False).write(tmp_path), legs=legs)
    table = morphology.legs
    assert joints_of(morphology, 0) == ["Coxa0.L", "Femur0.L", "Tibia0.L"]
    assert (table.foot_joint == -1).all()
    assert table.sole_rest[0] == pytest.approx([0.5, -0.208, -0.4], abs=1e-6)
    assert table.point_rest[0, 3] == pytest.approx(table.sole_rest[0])
    assert_sole_fixed_to_its_node(morphology)


def test_a_mark_without_skin_is_the_sole(tmp_path):
    legs = [f"Coxa{row}.{side}:Tip{row}.{side}" for row in range(3) for side in "LR"]
    morphology = load_rig(arthropod().write(tmp_path), legs=legs)
    assert joints_of(morphology, 5) == ["Coxa2.R", "Femur2.R", "Tibia2.R"]
    assert (morphology.legs.foot_joint == -1).all()
    # The mark is in the middle of the tip; the skin hangs 8 mm lower.
    assert morphology.legs.sole_rest[5] == pytest.approx([-0.5, -0.208, 0.4], abs=1e-6)
    assert not morphology.legs.upright.any()


def test_several_roots_and_helpers_without_weight_do_no_harm(tmp_path):
    rig = quadruped()
    rig.bones = [bone for bone in rig.bones if bone.name != "Root"]
    rig.bones[0].parent = None
    for side, x in (("L", 0.15), ("R", -0.15)):
        rig.add(f"PoleTarget.{side}", None, (x, 0.5, 2.0))
        rig.add(f"Goal.{side}", None, (x, 0.05, 0.4))
    rig.add("Origin", None, (0, 0, 0))
    named = load_rig(rig.write(tmp_path), legs=PAWS)
    detected = load_rig(rig.write(tmp_path))
    assert named.foot_name == detected.foot_name == tuple(leg.split(":")[1] for leg in PAWS)
    assert detected.legs.length == pytest.approx(named.legs.length)
    assert "PoleTarget.L" in named.joint_name


def test_a_rest_that_is_no_stance_is_replaced(tmp_path):
    rig = Rig().add("Body", None, (0, 0.3, 0), box=((-0.2, 0.28, -0.2), (0.2, 0.5, 0.2)))
    for end, z in (("Back", -1), ("Front", 1)):
        for side, x in (("L", 1), ("R", -1)):
            out = np.array([x, 0, z]) / np.sqrt(2.0)
            at = [0.3 * np.array([0, 1, 0]) + s * out for s in (0.2, 0.6, 1.0)]
            rig.add(f"{end}A.{side}", "Body", at[0], tip=at[1])
            rig.add(f"{end}B.{side}", f"{end}A.{side}", at[1], tip=at[2])
            rig.add(f"{end} goal.{side}", f"{end}B.{side}", at[2])
    morphology = load_rig(rig.write(tmp_path))
    assert morphology.foot_name == ("Back goal.L", "Back goal.R", "Front goal.L", "Front goal.R")
    stance = morphology.legs.sole_stance
    spread = 0.2 / np.sqrt(2.0) + 0.6 * 0.8 / np.sqrt(2.0)
    assert stance[0] == pytest.approx([spread, -0.47 * 0.8, -spread], abs=1e-5)
    assert stance[::2, [1, 2]] == pytest.approx(stance[1::2, [1, 2]])
    assert stance[::2, 0] == pytest.approx(-stance[1::2, 0])
    assert extensions(morphology)[1].max() < 0.9
    assert any("no stance" in guess for guess in morphology.guesses)


def test_a_lifted_foot_is_put_down_like_its_partner(tmp_path):
    rig = quadruped()
    for bone in rig.bones:
        if bone.name in ("ForeLower.L", "ForeFoot.L"):
            bone.parent, up = bone.parent, np.array([0, 0.25, 0])
            bone.place = tuple(bone.place + (up if bone.name == "ForeFoot.L" else 0.2 * up))
            bone.tip = bone.tip if bone.tip is None else tuple(bone.tip + up)
            bone.box = bone.box if bone.box is None else tuple(corner + up for corner in bone.box)
    morphology = load_rig(rig.write(tmp_path), legs=PAWS)
    stance = morphology.legs.sole_stance
    assert np.ptp(stance[:, 1]) < 1e-9
    assert stance[2] == pytest.approx(stance[3] * [-1, 1, 1])
    assert any("off the ground" in guess for guess in morphology.guesses)


def test_rigid_meshes_on_a_joint_count_as_its_skin(tmp_path):
    rig = quadruped()
    plain = load_rig(rig.write(tmp_path), legs=PAWS)
    rigid = load_rig(rig.write(tmp_path, unskinned=("Chest", "Head"), turns=15.0), legs=PAWS)
    assert rigid.body.thickness == pytest.approx(plain.body.thickness, abs=1e-6)
    assert rigid.body.half_size == pytest.approx(plain.body.half_size, abs=1e-6)


def test_twist_bones_and_doubled_joints_do_not_bend(tmp_path):
    rig = biped()
    for bone in rig.bones:
        if bone.name.endswith("Leg") and "Up" not in bone.name:
            side = bone.name.removesuffix("Leg")
            bone.parent = f"{side}UpLegTwist"
    for side, x in (("Left", 0.1), ("Right", -0.1)):
        rig.add(f"{side}UpLegTwist", f"{side}UpLeg", (x, 0.7, 0.005))
    morphology = load_rig(rig.write(tmp_path), legs=["LeftUpLeg:LeftFoot", "RightUpLeg:RightFoot"])
    assert joints_of(morphology, 0) == ["LeftUpLeg", "LeftLeg"]
    twist = morphology.joint_name.index("LeftUpLegTwist")
    assert morphology.joint_name[morphology.joint_parent[twist]] == "LeftUpLeg"


@pytest.mark.parametrize("height", [0.003, 1.0, 9.0])
def test_sizes_follow_the_height_asked_for(tmp_path, height):
    plain = load_rig(quadruped().write(tmp_path), legs=PAWS)
    scaled = load_rig(quadruped().write(tmp_path), legs=PAWS, height=height)
    ratio = height / 0.9
    for name in ("length", "sole_stance", "point_rest", "foot_half_size"):
        found, wanted = (getattr(m.legs, name) for m in (scaled, plain))
        assert found == pytest.approx(ratio * wanted, rel=1e-5, abs=1e-6 * height)
    assert scaled.body.thickness == pytest.approx(ratio * plain.body.thickness)
    assert_sole_fixed_to_its_node(scaled)


def test_the_body_height_asked_for_is_kept(tmp_path):
    morphology = load_rig(quadruped().write(tmp_path), legs=PAWS, body_height=0.5)
    assert morphology.body.height == pytest.approx(0.5)
    assert morphology.legs.sole_stance[:, 1] == pytest.approx(np.full(4, -0.5))


def test_the_users_order_of_legs_is_kept(tmp_path):
    morphology = load_rig(quadruped().write(tmp_path), legs=[PAWS[3], PAWS[0], PAWS[2], PAWS[1]])
    assert morphology.foot_name == ("ForeFoot.R", "HindFoot.L", "ForeFoot.L", "HindFoot.R")
    assert morphology.legs.side.tolist() == [-1, 1, 1, -1]
    assert morphology.legs.row.tolist() == [1, 0, 1, 0]
