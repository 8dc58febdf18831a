"""Pictures and normals of strangers' skins, as the page is sent them."""

from __future__ import annotations

import io
import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from polypod.morphology.load import load_rig
from polypod.rigs import colours
from polypod.studio.arrays import TYPES
from polypod.studio.meshes import pack_skin
from rigs.sample_rigs import SampleFile, morphology_of, two_joint_rig
from studio.covered_rigs import covered, framed_png


def unpacked(content: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return the head and the arrays of a message, read as the protocol lays it out."""
    kind, length = struct.unpack_from("<II", content)
    assert kind == 2
    head = json.loads(content[8 : 8 + length])
    at, arrays = 8 + length, {}
    for one in head["arrays"]:
        dtype = np.dtype(TYPES[one["type"]]).newbyteorder("<")
        count = int(np.prod(one["shape"]))
        arrays[one["name"]] = np.frombuffer(content, dtype, count, at).reshape(one["shape"])
        at += (count * dtype.itemsize + 3) // 4 * 4
    return head, arrays


def painted(material: dict[str, Any], picture: bytes, **more: Any) -> SampleFile:
    """Return two joints under a triangle with a material and a picture."""
    sample = two_joint_rig()
    (primitive,) = sample.json["meshes"][0]["primitives"]
    primitive["attributes"]["TEXCOORD_0"] = sample.accessor([[0.25, 0.5], [0.75, 0.5], [1.25, 0]])
    primitive["material"] = 0
    sample.json["materials"] = [material]
    sample.json["textures"] = [{"source": 0, "sampler": 0}]
    sample.json["samplers"] = [more]
    sample.json["images"] = [{"bufferView": sample.view(picture), "mimeType": "image/png"}]
    return sample


def skin_of(sample: SampleFile) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    return unpacked(pack_skin(morphology_of(sample.document())))


def test_a_picture_comes_as_it_is_in_the_file() -> None:
    picture = framed_png()
    seen = {"baseColorFactor": [1, 0.2140411, 0, 1], "baseColorTexture": {"index": 0}}
    material = {"pbrMetallicRoughness": seen, "alphaMode": "MASK", "alphaCutoff": 0.25}
    head, skin = skin_of(painted(material, picture, wrapS=33071, wrapT=33648))
    (part,) = head["parts"]
    assert part == {
        "first": 0, "count": 3, "picture": 0, "wrap": ["clamp", "mirror"], "cutoff": 0.25,
    }  # fmt: skip
    assert skin["picture0"].tobytes() == picture
    assert skin["uv"] == pytest.approx(np.array([[0.25, 0.5], [0.75, 0.5], [1.25, 0]]))
    assert skin["tint"] == pytest.approx(np.array([[255, 128, 0, 255]] * 3), abs=1)


def test_a_picture_may_be_moved_turned_and_scaled() -> None:
    moved = {"offset": [0.5, 0.25], "rotation": np.pi / 2, "scale": [2.0, 1.0]}
    info = {"index": 0, "extensions": {"KHR_texture_transform": moved}}
    material = {"pbrMetallicRoughness": {"baseColorTexture": info}}
    head, skin = skin_of(painted(material, framed_png()))
    assert head["parts"][0]["wrap"] == ["repeat", "repeat"]
    # Scaled to 0.5, 0.5 and turned: what was to the right is now up, which is less.
    assert skin["uv"][0] == pytest.approx([0.5 + 0.5, 0.25 - 0.5], abs=1e-6)


def test_what_has_no_picture_says_so(tmp_path: Path) -> None:
    file = tmp_path / "wolf.glb"
    file.write_bytes(covered("wolf", framed_png()))
    head, skin = unpacked(pack_skin(load_rig(file)))
    assert sum(part["count"] for part in head["parts"]) == skin["triangles"].size
    assert all(part["picture"] == 0 for part in head["parts"])
    assert (skin["colour"][:, 1] > 250).all(), "its vertices are on the frame"
    head, skin = unpacked(pack_skin(load_rig("wolf")))
    assert head["parts"] == []
    assert not {"uv", "tint", "picture0"} & set(skin)


def png_that_says(width: int, height: int) -> bytes:
    data = bytearray(framed_png())
    struct.pack_into(">II", data, 16, width, height)
    struct.pack_into(">I", data, 29, zlib.crc32(data[12:29]))
    return bytes(data)


def other_format() -> bytes:
    content = io.BytesIO()
    Image.new("RGB", (4, 4)).save(content, "BMP")
    return content.getvalue()


@pytest.mark.parametrize(
    "picture",
    [b"", b"<svg xmlns='http://www.w3.org/2000/svg'/>", framed_png()[:20], other_format()],
)
def test_what_is_no_picture_is_not_sent(picture: bytes) -> None:
    material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
    head, skin = skin_of(painted(material, picture + b"\0"))
    assert (head["parts"], "picture0" in skin) == ([], False)


def test_a_picture_of_gigapixels_is_not_sent() -> None:
    material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
    side = 1 + int(np.sqrt(colours.LARGEST_IMAGE))
    assert skin_of(painted(material, png_that_says(side, side)))[0]["parts"] == []
    assert skin_of(painted(material, png_that_says(side, side - 2)))[0]["parts"]


def with_normals(normals: list[list[float]]) -> SampleFile:
    sample = two_joint_rig()
    (primitive,) = sample.json["meshes"][0]["primitives"]
    primitive["attributes"]["NORMAL"] = sample.accessor(normals)
    return sample


def test_normals_are_those_of_the_file() -> None:
    # As this rig is turned by half a turn, what faced -z faces z.
    normals = [[0.0, 0.0, -1.0], [0.6, 0.0, -0.8], [0.0, 0.6, -0.8]]
    expected = np.array([[0.0, 0.0, 1.0], [-0.6, 0.0, 0.8], [0.0, 0.6, 0.8]])
    assert skin_of(with_normals(normals))[1]["normal"] == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("ahead", [1.0, -1.0])
def test_triangles_face_the_way_that_normals_do(ahead: float) -> None:
    _, skin = skin_of(with_normals([[0.0, 0.0, ahead]] * 3))
    corner = skin["place"][skin["triangles"].reshape(-1, 3)[0]]
    face = np.cross(corner[1] - corner[0], corner[2] - corner[0])
    assert face @ skin["normal"][0] > 0.0


def test_normals_that_are_none_are_found_from_the_triangles() -> None:
    _, plain = skin_of(two_joint_rig())
    _, broken = skin_of(with_normals([[0.0, float("nan"), 1.0]] * 3))
    assert np.array_equal(broken["normal"], plain["normal"])
