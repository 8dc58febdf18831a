"""Creature files: what they say holds, and what they may not say is refused."""

import numpy as np
import pytest
from authored_rigs import quadruped

from polypod.errors import RigError, SettingError
from polypod.morphology.describe import describe
from polypod.morphology.load import load_rig

FULL = """
rig = "authored.glb"
leg = ["ForeUpper.R:ForeFoot.R", "ForeUpper.L:ForeFoot.L",
       "HindUpper.R:HindFoot.R", "HindUpper.L:HindFoot.L"]
spine = ["Pelvis", "Chest"]
forward = "+z"
height = 1.8
body_height = 1.1

[body]
centre = [0.0, 1.2, -0.1]
thickness = 0.3
half_size = [0.2, 0.3, 0.8]

[foot."HindFoot.L"]
half_size = [0.1, 0.2]
weight = 2.0

[foot."HindFoot.R"]
weight = 2

[limit."HindUpper.L"]
flexion = 1.2
twist = 0.4

[limit."ForeLower.R"]
bend = [-0.3, 2.0]
"""


def write(tmp_path, text):
    quadruped().write(tmp_path)
    path = tmp_path / "beast.toml"
    path.write_text(text)
    return path


def test_everything_it_says_holds(tmp_path):
    morphology = load_rig(write(tmp_path, FULL))
    legs, names = morphology.legs, morphology.joint_name
    assert morphology.name == "beast"
    assert morphology.foot_name == ("ForeFoot.R", "ForeFoot.L", "HindFoot.R", "HindFoot.L")
    assert [names[row] for row in morphology.spine] == ["Pelvis", "Chest"]
    assert legs.point_rest[3, 0] == pytest.approx([0.3, 0.0, -0.7], abs=1e-6)
    assert morphology.body.height == pytest.approx(1.1)
    assert morphology.body.thickness == 0.3
    assert morphology.body.half_size.tolist() == [0.2, 0.3, 0.8]
    assert legs.foot_half_size[3].tolist() == [0.1, 0.2]
    assert legs.foot_half_size[2] == pytest.approx([0.08, 0.14], abs=1e-6)
    assert legs.weight == pytest.approx([1 / 6, 1 / 6, 1 / 3, 1 / 3])
    assert "with 67% of the weight" in describe(morphology)
    assert legs.hip_limit[3, [0, 2]].tolist() == [1.2, 0.4]
    assert np.isnan(legs.hip_limit[3, 1])
    assert np.isnan(legs.hip_limit[:3]).all()
    assert legs.bend_limit[0, 1].tolist() == [-0.3, 2.0]
    assert np.isnan(legs.bend_limit[1:]).all()
    assert morphology.guesses == ()


def test_arguments_stand_above_the_file(tmp_path):
    legs = ["HindUpper.L:HindFoot.L", "HindUpper.R:HindFoot.R"]
    path = write(tmp_path, FULL.split("[body]")[0])
    morphology = load_rig(path, legs=legs, height=0.9, body_height=0.55)
    assert morphology.foot_name == ("HindFoot.L", "HindFoot.R")
    assert morphology.body.height == pytest.approx(0.55)


def test_it_may_name_a_built_in(tmp_path):
    morphology = load_rig(write(tmp_path, 'rig = "spider"\nheight = 3.0'))
    assert len(morphology.foot_name) == 8
    assert morphology.legs.length.min() > 1.0


WRONG = {
    'rig = "authored.glb"\nlegs = ["A:B"]': r"legs: is no key here; valid are rig, leg, spine",
    "height = 1.0": r"rig: must be there",
    'rig = "authored.glb"\nheight = "tall"': r"height: must be a number above 0",
    'rig = "authored.glb"\nheight = nan': r"height: must be a number above 0",
    'rig = "authored.glb"\nheight = true': r"height: must be a number above 0",
    'rig = "authored.glb"\nleg = "A:B"': r"leg: must be a list of texts",
    'rig = "authored.glb"\n[body]\nmass = 3': r"body.mass: is no key here; valid are centre",
    'rig = "authored.glb"\n[body]\ncentre = [1, 2]': r"body.centre: must be a list of 3 numbers",
    'rig = "authored.glb"\n[limit.Foot]\nbend = [0, 1, 2]': r"Foot.bend: must be a list of 2",
    'rig = "authored.glb"\n[limit.Foot]\nbend = [1, -1]': r"Foot.bend: must be two angles",
    'rig = "authored.glb"\n[limit.Foot]\nbend = [-90, 90]': r"Foot.bend: must be two angles",
    'rig = "authored.glb"\n[limit.Foot]\ntwist = 45': r"Foot.twist: must be radians",
    'rig = "authored.glb"\n[limit.Root]\ntwist = 0.4': r'limit."Root": is no joint that turns',
    'rig = "authored.glb"\n[limit.Knee]\ntwist = 0.4': r'no node named "Knee"',
    'rig = "authored.glb"\n[limit."HindUpper.L"]\nbend = [0, 1]': r"bend: is not for the first",
    'rig = "authored.glb"\n[limit."HindLower.L"]\ntwist = 0.4': r"twist: is not for this joint",
    'rig = "authored.glb"\n[foot.Head]\nhalf_size = [1, 1]': r'foot."Head": is no foot; feet are',
    'rig = "authored.glb"\n[foot.Head]\nhalf_size = [0, 1]': r"half_size: must be a number above",
    'rig = "authored.glb"\n[foot.Head]\nweight = 1': r'foot."Head": is no foot; feet are',
    'rig = "authored.glb"\n[foot.Head]\nweight = 0': r"weight: must be a number above 0",
    'rig = "authored.glb"\n[foot.Head]\nweight = inf': r"weight: must be a number above 0",
    'rig = "authored.glb"\n[foot]\nhalf_size = 3': r"foot.half_size: must be a table",
    'rig = "absent.glb"': r"cannot be read",
    'rig = "dragon"': r"is no rig",
    "rig = authored": r"beast.toml: is no TOML",
}


@pytest.mark.parametrize("text", list(WRONG))
def test_what_it_may_not_say(tmp_path, text):
    with pytest.raises(RigError, match=WRONG[text]) as caught:
        load_rig(write(tmp_path, text))
    assert "\n" not in str(caught.value)


def test_the_description_says_what_holds_and_what_was_guessed(tmp_path):
    told = describe(load_rig(write(tmp_path, FULL)))
    for said in (
        "beast: 4 legs, 19 joints, one file unit is 2 m",
        "ForeFoot.R: row 1 right, upright, 1.328 long, sections 0.6093 0.5909",
        "HindUpper.L > HindLower.L; then the foot HindFoot.L",
        "HindUpper.L: flexion 69, twist 23 degrees",
        "ForeLower.R: bend -17 to 115 degrees about the rest",
        "spine: Pelvis > Chest",
        "guessed: nothing",
    ):
        assert said in told
    guessed = describe(load_rig(quadruped().write(tmp_path)))
    for option in ("--forward", "--leg", "--height", "--spine"):
        assert option in guessed.split("guessed:")[1]


def test_weights_may_be_given_by_the_caller(tmp_path):
    quadruped().write(tmp_path)
    path = tmp_path / "authored.glb"
    legs = load_rig(path, weights={"HindFoot.L": 3.0}).legs
    assert sorted(legs.weight) == pytest.approx([1 / 6, 1 / 6, 1 / 6, 1 / 2])
    with pytest.raises(SettingError, match=r"weights: 'HindFoot.L': must be a number above 0"):
        load_rig(path, weights={"HindFoot.L": 0.0})
    with pytest.raises(RigError, match=r'foot."Head": is no foot'):
        load_rig(path, weights={"Head": 2.0})
