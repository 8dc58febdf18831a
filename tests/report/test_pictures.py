"""Pictures: the renderer in closed form, the skin, and what a strip must show."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import synthetic
from PIL import Image

from polypod.environment.environment import Environment
from polypod.environment.obstacles import Obstacle
from polypod.errors import SettingError
from polypod.report.captions import length_text, round_length
from polypod.report.plots import write_plots
from polypod.report.raster import PAPER, SOIL, Scene, camera_along, corner_normals, render
from polypod.report.scenery import BOX_TRIANGLES, foot_colours, obstacle_surface
from polypod.report.shading import PLAIN, fill_triangles
from polypod.report.skin import flesh_of, pose
from polypod.report.strip import draw_strip, stride_frames, write_strip

AHEAD = np.array([0.0, 0.0, 1.0])
SMALL = {"columns": 2, "width": 160, "oversampling": 1}


def drawn(*triangles):
    depth = np.full((20, 20), np.inf)
    owner = np.full((20, 20), -1, np.int64)
    share = np.zeros((20, 20, 2))
    fill_triangles(np.array(triangles, float), -math.inf, 0.0, depth, owner, share)
    return depth, owner, share


def test_triangle_covers_its_own_pixels():
    """Pixel centres (c + 1/2, r + 1/2) inside the triangle x, y >= 2, x + y <= 12.25."""
    _, owner, _ = drawn([[2, 2, 1], [10.25, 2, 1], [2, 10.25, 1]])
    row, column = np.mgrid[:20, :20]
    inside = (row >= 2) & (column >= 2) & (row + column + 1.0 <= 12.25)
    assert np.array_equal(owner == 0, inside)


def test_nearer_triangle_wins_whichever_comes_first():
    near = [[0, 0, 1], [20, 0, 1], [0, 20, 1]]
    far = [[0, 0, 2], [20, 0, 2], [20, 20, 2]]
    for pair, index in (((near, far), 0), ((far, near), 1)):
        depth, owner, _ = drawn(*pair)
        assert owner[2, 10] == index  # both cover it
        assert depth[2, 10] == pytest.approx(1.0)
        assert depth[10, 16] == pytest.approx(2.0)  # only the far one does


def test_shares_interpolate_linearly():
    """With corner depths 0, 10, 20 at (0, 0), (10, 0), (0, 10), depth is x + 2 y."""
    depth, _, share = drawn([[0, 0, 0], [10, 0, 10], [0, 10, 20]])
    assert depth[3, 4] == pytest.approx(4.5 + 2 * 3.5)
    assert share[3, 4] == pytest.approx([1.0 - 0.45 - 0.35, 0.45])


@pytest.mark.parametrize(
    ("azimuth", "elevation", "point", "where"),
    [
        (0.0, 0.0, (0, 1, 0), (50, 30, 0)),  # up is up
        (0.0, 0.0, (0, 0, 1), (70, 50, 0)),  # ahead is right
        (0.0, 0.0, (1, 0, 0), (50, 50, 1)),  # left of the creature is far
        (0.0, math.pi / 2, (1, 0, 0), (50, 30, 0)),  # from above its left is up
        (math.pi / 2, 0.0, (0, 0, 1), (50, 50, -1)),  # from its front, ahead is near
    ],
)
def test_camera(azimuth, elevation, point, where):
    camera = camera_along(AHEAD, azimuth, elevation, np.zeros(3), 20.0, (100, 100))
    assert camera.project(np.array(point, float)) == pytest.approx(np.array(where), abs=1e-9)


def test_plain_colour_comes_out_as_it_went_in():
    scene = Scene()
    square = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], float)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    camera = camera_along(np.array([1.0, 0.0, 0.0]), 0.0, 0.0, np.zeros(3), 1.0, (4, 4))
    scene.add(square + np.array([0.0, 0.0, -30.0]), faces, np.array([0.5, 0.5, 0.5]))
    scene.add(square, faces, np.array([0.8, 0.2, 0.4]), PLAIN)
    picture = render(scene, camera, grid=1.0, oversampling=1)
    assert np.abs(picture.astype(int) - np.array([204, 51, 102])).max() <= 1


def test_crate_shades_the_ground_on_the_side_away_from_the_sun():
    """Seen from above the sun stands to the upper left or right: the shadow falls opposite."""
    scene = Scene()
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (0, 2) for z in (-1, 1)], float)
    scene.add(corners, BOX_TRIANGLES, np.array([0.9, 0.9, 0.9]))
    ground = np.array([[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], float)
    scene.add(ground, np.array([[0, 2, 1], [0, 3, 2]]), np.array([0.9, 0.9, 0.9]))
    camera = camera_along(AHEAD, 0.0, math.pi / 2, np.zeros(3), 20.0, (120, 120))
    grey = render(scene, camera, grid=1.0, oversampling=1).mean(axis=2)
    left, right = grey[50:70, 36], grey[50:70, 84]
    assert abs(left.mean() - right.mean()) > 40.0


def test_box_triangles_face_outward():
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    middle = corners[BOX_TRIANGLES].mean(axis=1)
    normal = corner_normals(corners, BOX_TRIANGLES)[:, 0]
    # Across the creases of a cube nothing is smoothed: normals are axes, outward.
    assert np.abs(normal).max(axis=1) == pytest.approx(np.ones(12))
    assert ((normal * middle).sum(axis=1) > 0.9).all()


def test_surface_of_a_box_is_cut_out_of_its_planes():
    box = Obstacle.box((0.4, 0.2, 0.6), (1.0, 0.3, 2.0), yaw=0.3)
    positions, triangles = obstacle_surface(Environment(obstacles=[box]).table, 0)
    corners = {tuple(np.round(corner, 9)) for corner in box.corners()}
    assert {tuple(np.round(place, 9)) for place in positions} == corners
    a, b, c = positions[triangles].transpose(1, 0, 2)
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert area.sum() == pytest.approx(2 * (0.4 * 0.2 + 0.2 * 0.6 + 0.4 * 0.6))
    outward = np.cross(b - a, c - a)
    assert ((outward * (a - np.array([1.0, 0.3, 2.0]))).sum(axis=1) > 0.0).all()


def test_skin_is_where_its_joints_carry_it():
    """A vertex x of joint j is at p_j + q_j (x - rest_j); here every vertex has one joint."""
    body = synthetic.morphology()
    recording = synthetic.walk(seconds=0.5)
    parts = body.source.document.mesh_parts()
    total = 0
    for flesh, part in zip(flesh_of(body), parts, strict=True):
        world = pose(flesh, recording, 7)
        assert flesh.place[:, 0] == pytest.approx(part.positions, abs=1e-6)
        sole = np.flatnonzero(flesh.row[:, 0] == body.legs.joint[0, 1])
        ends = world[sole].reshape(-1, 3)
        # The lower bone's box ends about the knee and about the sole.
        to_sole = np.linalg.norm(ends - recording.foot_position[7, 0], axis=1)
        to_knee = np.linalg.norm(ends - recording.joint_position[7, body.legs.joint[0, 1]], axis=1)
        assert np.minimum(to_sole, to_knee) == pytest.approx(0.014 * math.sqrt(2), abs=1e-6)
        total += len(sole)
    assert total == 24  # a box of its own


def scene_with(forbidden):
    boxes = [Obstacle.box((0.15, 0.03, 0.15), (0.0, 0.015, z), 0.2, forbidden) for z in (0.3, 0.9)]
    return Environment(obstacles=boxes).table


def strip_of(forbidden=False, **changes):
    table = scene_with(forbidden)
    recording = synthetic.walk(seconds=3.0, obstacle_count=2)
    places = {
        "obstacle_position": np.repeat(table.position[None], 91, axis=0),
        "obstacle_rotation": np.repeat(table.rotation[None], 91, axis=0),
    }
    return dataclasses.replace(recording, **places, **changes), table


def share_of(picture, colour, tolerance=24):
    gap = np.abs(picture.astype(int) - np.round(255 * np.asarray(colour)).astype(int))
    return float((gap.max(axis=2) <= tolerance).mean())


def test_strip_shows_feet_and_only_forbidden_crates_in_red():
    pictures = {}
    for forbidden in (False, True):
        recording, table = strip_of(forbidden)
        pictures[forbidden] = draw_strip([recording], table, 2, 240, 1)

    def redness(picture):
        red, green, blue = picture.astype(int).transpose(2, 0, 1)
        return float(((red > 110) & (green < 0.5 * red) & (blue < 0.5 * red)).mean())

    assert redness(pictures[True]) > redness(pictures[False]) + 0.002
    for colour in foot_colours(6):
        assert share_of(pictures[False], colour) > 0.0


def test_strip_is_the_same_every_time_and_whole(tmp_path):
    recording, table = strip_of()
    write_strip(recording, table, tmp_path / "a.png", **SMALL)
    write_strip([recording], table, tmp_path / "b.png", **SMALL)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size[0] == SMALL["width"]
    with pytest.raises(SettingError, match="does not exist"):
        write_strip(recording, table, tmp_path / "nowhere" / "a.png", **SMALL)


def test_frames_are_a_stride_in_the_middle():
    recording = synthetic.walk(seconds=8.0)
    frames = stride_frames(recording, 8)
    step = synthetic.STRIDE_S * 30 / 8
    assert np.diff(frames) == pytest.approx(np.full(7, step), abs=1.0)
    assert np.mean(frames) == pytest.approx(120, abs=step)


def test_single_frame_and_rig_without_surface_are_drawn(tmp_path):
    recording, table = strip_of()
    arrays = {
        field.name: getattr(recording, field.name)[:1]
        for field in dataclasses.fields(recording)
        if field.name != "morphology"
    }
    still = dataclasses.replace(recording, **arrays)
    write_strip(still, table, tmp_path / "still.png", **SMALL)
    assert (tmp_path / "still.png").stat().st_size > 1000


def test_plots_are_written(tmp_path):
    recording, _ = strip_of()
    write_plots(recording, tmp_path / "plots.png")
    with Image.open(tmp_path / "plots.png") as picture:
        assert picture.size == (1320, 880)


@pytest.mark.parametrize(
    ("metres", "rounded", "text"),
    [(0.3, 0.2, "20 cm"), (7.0, 5.0, "5 m"), (0.0019, 0.001, "1 mm"), (0.05, 0.05, "5 cm")],
)
def test_scale_bars_are_round(metres, rounded, text):
    assert round_length(metres) == pytest.approx(rounded)
    assert length_text(round_length(metres)) == text


def test_of_two_surfaces_in_one_plane_the_first_stays():
    """The second is nearer by less than the tie, as rounding makes it."""
    depth, owner = np.full((4, 4), np.inf), np.full((4, 4), -1, np.int64)
    plane = np.array([[[-9, -9, 1], [30, -9, 1], [-9, 30, 1]]] * 2, float)
    plane[1, :, 2] -= 1e-6
    fill_triangles(plane, -math.inf, 1e-4, depth, owner, np.zeros((4, 4, 2)))
    assert (owner == 0).all()


def test_cut_ground_is_soil_and_the_sky_above_it_is_not():
    """A floor seen at 30 degrees is cut one metre before the middle; a bar hangs over its back."""
    scene = Scene()
    floor = np.array([[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], float)
    faces = np.array([[0, 2, 1], [0, 3, 2]])
    scene.add(floor * 0.5, faces, np.array([0.2, 0.9, 0.2]), PLAIN)
    bar = np.array([[0, 7, -9], [0, 7, 9], [0, 7.5, 9], [0, 7.5, -9]], float)
    scene.add(bar, np.array([[0, 1, 2], [0, 2, 3]]), np.array([0.2, 0.2, 0.9]), PLAIN)
    camera = camera_along(AHEAD, 0.0, math.radians(30.0), np.zeros(3), 10.0, (20, 160))
    picture = render(scene, camera, grid=1.0, nearest=-1.0, oversampling=1)
    # Depth on the floor changes by cos 30 a metre, its row by 10 sin 30: the cut is at row 85.8.
    column = picture[:, 10].astype(int)
    paper, soil = np.round(255 * PAPER), np.round(255 * SOIL)
    # The bar is at height 7 to 7.5, rows 80 - 10 * 7.5 cos 30 = 15 to 19.4; sky is below it.
    assert column[17].argmax() == 2
    assert np.abs(column[40] - paper).max() <= 3  # bright tones are rolled off a little
    assert column[84].argmax() == 1
    assert np.abs(column[87] - soil).max() <= 1
    assert np.abs(column[159] - soil).max() <= 1
