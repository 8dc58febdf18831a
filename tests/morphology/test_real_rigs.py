"""Third-party rigs: the joints that their notes list, by name and by detection."""

import numpy as np
import pytest

from polypod.morphology.describe import describe, extensions
from polypod.morphology.load import load_rig


def chains(text):
    return [chain.split(" > ") for chain in text]


SPIDER = {
    f"{leg}.{side}": [f"{leg}{part}.{side}" for part in ("", "2", "3")]
    for leg in ("BackLeg", "MidBackLeg", "MidFrontLeg", "FrontLeg")
    for side in "LR"
}
SPIDER_FEET = [name.replace("Leg", "Foot") for name in SPIDER]
SPIDER_FEET[-1] = "FrontFoot2.R"

# File: joints that turn, foot, whether the foot is a joint with its own orientation, forward.
RIGS = {
    "khronos_fox/Fox.glb": (
        [
            ["b_LeftLeg01_015", "b_LeftLeg02_016", "b_LeftFoot01_017"],
            ["b_RightLeg01_019", "b_RightLeg02_020", "b_RightFoot01_021"],
            ["b_LeftUpperArm_09", "b_LeftForeArm_010"],
            ["b_RightUpperArm_06", "b_RightForeArm_07"],
        ],
        ["b_LeftFoot02_018", "b_RightFoot02_022", "b_LeftHand_011", "b_RightHand_08"],
        True,
        "+z",
    ),
    "quaternius/spider.glb": (list(SPIDER.values()), SPIDER_FEET, True, "+z"),
    "quaternius/horse.glb": (
        [[f"Back{part}Leg.{side}" for part in ("", "Upper", "Lower")] for side in "LR"]
        + [[f"Front{part}Leg.{side}" for part in ("Upper", "Lower")] for side in "LR"],
        [f"IK{end}Leg.{side}" for end in ("Back", "Front") for side in "LR"],
        True,
        "+z",
    ),
    "quaternius/triceratops.glb": (
        [
            [f"{end}{part}Leg.{side}" for part in ("Up", "Low")]
            for end in ("Back", "Front")
            for side in "LR"
        ],
        [f"{end}Foot.{side}" for end in ("Back", "Front") for side in "LR"],
        True,
        "+z",
    ),
    "quaternius/mech_george.glb": (
        [[f"{part}Leg.{side}" for part in ("Upper", "Mid", "Lower")] for side in "LR"],
        ["Foot.L", "Foot.R"],
        True,
        "+z",
    ),
    "spider_bot/spider_bot_model.gltf": (
        [
            [f"leg{part}{end}{side}" for part in range(4)]
            for end in ("Back", "Front")
            for side in ("Left", "Right")
        ],
        [f"Foot IK{end}{side}" for end in ("Back", "Front") for side in ("Left", "Right")],
        False,
        "-z",
    ),
}


def assert_as_noted(morphology, name):
    joints, feet, oriented, _ = RIGS[name]
    legs, names = morphology.legs, morphology.joint_name
    assert list(morphology.foot_name) == feet
    found = [[names[row] for row in legs.joint[k] if row >= 0] for k in range(len(feet))]
    assert found == joints
    if oriented:
        assert [names[row] for row in legs.foot_joint] == feet
    else:
        assert (legs.foot_joint == -1).all()
    assert legs.side.tolist() == [1, -1] * (len(feet) // 2)
    assert legs.row.tolist() == [k // 2 for k in range(len(feet))]


@pytest.mark.parametrize("name", list(RIGS))
def test_legs_are_found_by_name(shared_rig, name):
    joints, feet, _, forward = RIGS[name]
    legs = [f"{chain[0]}:{foot}" for chain, foot in zip(joints, feet, strict=True)]
    assert_as_noted(load_rig(shared_rig(name), legs=legs, forward=forward), name)


@pytest.mark.parametrize("name", list(RIGS))
def test_legs_are_found_by_detection(shared_rig, name):
    morphology = load_rig(shared_rig(name))
    assert_as_noted(morphology, name)
    forward = RIGS[name][3]
    assert any(f"it faces {forward} " in guess for guess in morphology.guesses)


@pytest.mark.parametrize("name", list(RIGS))
def test_the_stance_is_level_symmetric_and_within_reach(shared_rig, name):
    morphology = load_rig(shared_rig(name), height=1.0)
    legs, body = morphology.legs, morphology.body
    size = legs.length.max()
    assert legs.sole_stance[:, 1] == pytest.approx(np.full(len(legs.length), -body.height))
    assert extensions(morphology)[1].max() <= 0.9 + 1e-9
    mirrored = legs.sole_stance[1::2] * [-1, 1, 1]
    assert np.abs(legs.sole_stance[::2] - mirrored).max() < 0.01 * size
    assert 0.0 < body.thickness < body.height
    described = describe(morphology)
    assert all(foot in described for foot in morphology.foot_name)


@pytest.mark.parametrize(
    ("name", "spine"),
    [
        ("khronos_fox/Fox.glb", "b_Hip_01 b_Spine01_02 b_Spine02_03 b_Neck_04 b_Head_05"),
        ("quaternius/horse.glb", "Back Torso Torso2 Torso3 Neck1 Neck2 Neck3 Head"),
        ("quaternius/triceratops.glb", "Back Hips Torso Shoulders Neck Head"),
        ("quaternius/mech_george.glb", "Torso Chest Neck Head"),
        ("quaternius/spider.glb", ""),
        ("spider_bot/spider_bot_model.gltf", ""),
    ],
)
def test_spines_run_from_back_to_head(shared_rig, name, spine):
    morphology = load_rig(shared_rig(name))
    assert [morphology.joint_name[row] for row in morphology.spine] == spine.split()


@pytest.mark.parametrize(
    ("name", "joint", "place"),
    [
        # Node poses are frames of a clip; these are places in the bind pose, in file units.
        ("quaternius/triceratops.glb", "BackLowLeg.R", (-2.06, 2.82, -2.75)),
        ("quaternius/spider.glb", "MidFrontLeg2.L", (1.37, 1.84, 0.62)),
        ("quaternius/mech_george.glb", "LowerArm.L", (1.87, 4.85, -0.13)),
        ("spider_bot/spider_bot_model.gltf", "leg2FrontLeft", (-2.41, -0.23, -2.39)),
        ("khronos_fox/Fox.glb", "b_LeftHand_011", (6.94, 6.69, 17.84)),
        ("quaternius/horse.glb", "FrontLowerLeg.L", (0.42, 1.18, 1.41)),
    ],
)
def test_the_rest_is_the_bind_pose(shared_rig, name, joint, place):
    morphology = load_rig(shared_rig(name))
    row = morphology.joint_name.index(joint)
    rest = morphology.source.joint_rest_file[row, :3, 3]
    assert rest == pytest.approx(place, abs=0.006)
    body = morphology.source.body_from_file
    assert body[:3, :3] @ rest + body[:3, 3] == pytest.approx(morphology.joint_rest[row])


def test_a_hoof_below_a_helper_is_found_by_its_own_name(shared_rig):
    legs = [f"FrontUpperLeg.{side}:FF.{side}" for side in "LR"]
    morphology = load_rig(shared_rig("quaternius/horse.glb"), legs=legs)
    names = morphology.joint_name
    assert [names[row] for row in morphology.legs.foot_joint] == ["IKFrontLeg.L", "IKFrontLeg.R"]
    assert names[morphology.joint_parent[names.index("FF.L")]] == "IKFrontLeg.L"
