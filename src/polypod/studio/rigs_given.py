"""Rigs that users give: taken in, found again, and judged for the page.

A rig of the document is a built-in's name, or `upload:` and the SHA-256 of a file. Each file lies
in a folder of that name, in one of the studio's own that is deleted at its end; its own name, by
which the creature is called, is cleaned of all but letters, digits and the like.
"""

from __future__ import annotations

import hashlib
import re
import shutil
import tempfile
import threading
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from polypod.environment.scene_values import SceneTable, shown
from polypod.errors import PolypodError, RigError, SettingError, choices
from polypod.morphology.builtin import NAMES as BUILT_IN
from polypod.morphology.builtin import build as build_builtin
from polypod.morphology.creature import read_creature
from polypod.morphology.load import load_rig
from polypod.morphology.names import find_node
from polypod.morphology.skeleton import Skeleton, read_skeleton
from polypod.morphology.types import Morphology
from polypod.rigs.container import MAGIC
from polypod.rigs.gltf import GltfDocument
from polypod.studio.rig_limits import judge_upload

UPLOAD = "upload:"
MOST_UPLOADS = 16
LONGEST_NAME = 80  # characters of a file's name
LONGEST_WORD = 1000  # characters of a reason: a stranger's joints may have names without end
ASKED = ("rig", "leg", "spine", "forward", "height")
# What sentences for the command line end with.
OPTIONS = re.compile(
    r"; --[a-z-]+( HIP:FOOT| J,J,\.\.\.)? (says otherwise|names (another|others|all legs|one))"
)
NAMING = re.compile(r" with --leg HIP:FOOT| \(--height\)")


class Upload(NamedTuple):
    """A file that somebody gave."""

    file: Path
    name: str  # as its owner calls it, for people only
    own: bool  # it lies in the studio's folder, and goes with it


class GivenRigs:
    """The rigs that were given. Its methods may be called from any thread."""

    def __init__(self) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="polypod-studio-"))
        self._uploads: dict[str, Upload] = {}  # the one used last is the last
        self._in_use: frozenset[str] = frozenset()
        self._lock = threading.Lock()

    def close(self) -> None:
        """Delete all files that were taken in."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def take(self, data: bytes, name: str) -> str:
        """Take a rig in and return what a document calls it.

        Args:
            data: a GLB, or a .gltf that holds everything.
            name: of its owner's file.

        Raises:
            RigError: it is no rig, or too large to be looked through; it is not kept.
            SettingError: so many rigs are in use that none can go.
        """
        title = clean_name(name, ".glb" if data[:4] == MAGIC else ".gltf")
        judge_upload(data, title)
        read_skeleton(GltfDocument.from_bytes(data, title))
        digest = hashlib.sha256(data).hexdigest()
        file = self._folder / digest / title
        with self._lock:
            rig = UPLOAD + digest
            if rig in self._uploads:
                self._uploads[rig].file.rename(file)
            else:
                self._make_room()
                file.parent.mkdir()
                file.write_bytes(data)
            self._note(rig, Upload(file, title, True))
        return rig

    def point_to(self, file: Path) -> str:
        """Return what a document calls a file of the user's own, which stays where it is."""
        with self._lock:
            rig = UPLOAD + hashlib.sha256(str(file.absolute()).encode()).hexdigest()
            self._note(rig, Upload(file.absolute(), file.name, False))
        return rig

    def use(self, rigs: Collection[str]) -> None:
        """Say which rigs the document has: they stay."""
        with self._lock:
            self._in_use = frozenset(rigs)

    def find(self, rig: str) -> str:
        """Return a built-in's name as it is, and an upload's file.

        Raises:
            SettingError: there is no such rig.
        """
        if rig in BUILT_IN:
            return rig
        return str(self._upload(rig).file)

    def name(self, rig: str) -> str:
        """Return what people call a rig: a built-in's name, or that of a file.

        Raises:
            SettingError: there is no such rig.
        """
        return rig if rig in BUILT_IN else self._upload(rig).name

    def named(self, name: str) -> str | None:
        """Return what a document calls the rig of this name, None where there is none."""
        if name in BUILT_IN:
            return name
        with self._lock:
            found = [rig for rig, upload in self._uploads.items() if upload.name == name]
        return found[-1] if found else None

    def has(self, name: str) -> bool:
        """Return whether there is a rig of this name."""
        return self.named(name) is not None

    def judge(self, asked: Mapping[str, Any]) -> dict[str, Any]:
        """Return what is found in a rig, and whether it walks.

        Args:
            asked: `rig`, and as in a document `leg`, `spine`, `forward` and `height`.

        Raises:
            PolypodError: there is no such rig, what is asked is none of these, or its file is
                no rig at all.
        """
        judge_asked(asked)
        rig = asked["rig"]
        options = {"legs" if key == "leg" else key: asked.get(key) for key in ASKED[1:]}
        answer: dict[str, Any] = {"rig": rig, "name": self.name(rig)}
        try:
            morphology = load_rig(self.find(rig), **options)
        except PolypodError as error:
            answer |= {"walks": False, "why": self.plain(rig, str(error))}
            answer |= {"legs": [], "spine": [], "guesses": [], "forward": asked.get("forward")}
            skeleton = read_skeleton(self._document(rig))
            answer["height"] = asked.get("height") or skeleton.top - skeleton.ground
        else:
            skeleton = read_skeleton(morphology.source.document)
            answer |= {"walks": True, **self._found(rig, morphology, skeleton)}
        answer["joints"] = list_joints(skeleton)
        return answer

    def plain(self, rig: str, why: str) -> str:
        """Return a sentence that was meant for the command line as one for the page."""
        if rig not in BUILT_IN:
            upload = self._upload(rig)
            why = why.replace(str(upload.file), upload.name)
        return NAMING.sub("", OPTIONS.sub("", why))[:LONGEST_WORD]

    def _found(self, rig: str, morphology: Morphology, skeleton: Skeleton) -> dict[str, Any]:
        legs, nodes = morphology.legs, morphology.joint_node
        matrix = morphology.source.body_from_file[:3, :3]
        scale = float(abs(matrix[1, 1]))
        ahead = matrix[2] / scale
        axis = max((0, 2), key=lambda i: abs(ahead[i]))
        return {
            "height": scale * (skeleton.top - skeleton.ground),
            "forward": ("+" if ahead[axis] > 0.0 else "-") + "xyz"[axis],
            "legs": [
                {
                    "hip": int(nodes[legs.joint[k, 0]]),
                    "foot": find_node(skeleton, foot, "foot"),
                    "name": foot[:LONGEST_NAME],
                    "row": int(legs.row[k]),
                    "side": int(legs.side[k]),
                }
                for k, foot in enumerate(morphology.foot_name)
            ],
            "spine": [int(nodes[row]) for row in morphology.spine],
            "guesses": [self.plain(rig, guess) for guess in morphology.guesses],
        }

    def _document(self, rig: str) -> GltfDocument:
        if rig in BUILT_IN:
            return GltfDocument.from_bytes(build_builtin(rig).glb, f"{rig}.glb")
        file = Path(self.find(rig))
        if file.suffix.lower() == ".toml":
            creature = read_creature(file)
            return (
                self._document(creature.rig)
                if creature.rig in BUILT_IN
                else GltfDocument.read(creature.rig)
            )
        return GltfDocument.read(file)

    def _upload(self, rig: str) -> Upload:
        with self._lock:
            upload = self._uploads.pop(rig, None)
            if upload is None:
                known = choices((*BUILT_IN, *(other.name for other in self._uploads.values())))
                raise SettingError(
                    f"there is no rig {shown(rig)} in the studio now: drop its file on the page, "
                    f"or choose one of {known}"
                )
            self._uploads[rig] = upload
            return upload

    def _note(self, rig: str, upload: Upload) -> None:
        self._uploads.pop(rig, None)
        self._uploads[rig] = upload

    def _make_room(self) -> None:
        """Let the upload go that was not used for longest, where there are many."""
        own = [rig for rig, upload in self._uploads.items() if upload.own]
        if len(own) < MOST_UPLOADS:
            return
        free = [rig for rig in own if rig not in self._in_use]
        if not free:
            raise SettingError(f"{MOST_UPLOADS} rigs are in use; the studio takes no more")
        shutil.rmtree(self._uploads.pop(free[0]).file.parent, ignore_errors=True)


def judge_asked(asked: Mapping[str, Any]) -> None:
    """Judge what the page asks of a rig.

    Raises:
        SceneError: a key that is none, or a value that is not of its kind.
    """
    table = SceneTable("the rig", asked, ASKED)
    table.text("rig")
    for key in ("leg", "spine"):
        names = asked.get(key)
        if names is not None and not (
            isinstance(names, list) and all(isinstance(name, str) for name in names)
        ):
            table.fail(key, "null or a list of texts")
    if asked.get("forward") is not None:
        table.text("forward")
    if asked.get("height") is not None:
        table.number("height", None, 1e-6, 1000.0)


def list_joints(skeleton: Skeleton) -> list[dict[str, Any]]:
    """Return the joints and the nodes below them, with their places in the file's own space.

    A node that only shows a mesh is no joint, though it hangs below one.
    """
    shows = [place.has("mesh") for place in skeleton.document.root.parts("nodes")]
    listed = skeleton.is_joint.copy()
    for node in range(len(listed)):
        if not shows[node]:
            listed[node] |= any(skeleton.is_joint[above] for above in skeleton.above(node))
    if not skeleton.is_joint.any():
        raise RigError(f"{skeleton.document.name}: its skin names no joint")
    found = []
    for node in (int(n) for n in listed.nonzero()[0]):
        parents = [above for above in skeleton.above(node) if listed[above]]
        found.append(
            {
                "node": node,
                "name": skeleton.name[node][:LONGEST_NAME],
                "parent": parents[0] if parents else -1,
                "place": [float(v) for v in skeleton.rest_file[node, :3, 3]],
            }
        )
    return found


def clean_name(name: str, suffix: str) -> str:
    """Return the last part of a file's name with nothing in it that a folder may not take."""
    last = re.split(r"[\\/]", name)[-1]
    stem = last[: -len(Path(last).suffix)] if Path(last).suffix else last
    kept = "".join(c for c in stem if c.isalnum() or c in " ._-").strip(". ")[: LONGEST_NAME - 5]
    # Some systems keep these names for devices.
    device = re.fullmatch(r"(con|prn|aux|nul|(com|lpt)[0-9])(\..*)?", kept, re.IGNORECASE)
    return f"{'rig' if not kept or device else kept}{suffix}"
