"""The studio's routes: the page, its skins, what is given and what is taken away.

Everything passes `Guarded` first; docs/studio-protocol.md lists the routes.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeVar

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route, WebSocketRoute

from polypod.errors import PolypodError, SettingError
from polypod.studio.document import Document
from polypod.studio.exports import ALL, EXPORTS, WALKS, ended_tape, zip_of_walks
from polypod.studio.gate import Gate
from polypod.studio.guard import TooLargeError, inline_hashes, parse_json, read_bounded
from polypod.studio.link import Hub
from polypod.studio.rig_limits import LARGEST_FILE
from polypod.studio.rigs_given import GivenRigs
from polypod.studio.scene_folder import LARGEST_SCENE, ZIP, MissingFilesError
from polypod.studio.scenes import document_of
from polypod.studio.seam import Running
from polypod.studio.world_files import WorldFiles

PAGE = Path(__file__).parent / "page"
KINDS = {".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8"}
LARGEST_QUESTION = 64 << 10  # bytes
BYTES = "application/octet-stream"
T = TypeVar("T")


class Studio:
    """What the routes do."""

    def __init__(self, runner: Running, rigs: GivenRigs, files: WorldFiles, token: str):
        self.runner, self.rigs, self.files, self.token = runner, rigs, files, token
        self.hub = Hub(runner)
        self._judging = asyncio.Lock()
        self._three = three_file().read_bytes()

    async def index(self, request: Request) -> Response:
        """Answer `GET /`."""
        page = (PAGE / "index.html").read_text(encoding="utf-8")
        return Response(page.replace("TOKEN", self.token), media_type="text/html")

    async def module(self, request: Request) -> Response:
        """Answer `GET /page/NAME`: a name out of the folder's list, never a path."""
        name = request.path_params["name"]
        listed = {file.name: file for file in PAGE.iterdir() if file.suffix in KINDS}
        file = listed.get(name)
        if file is None or file.is_symlink() or not file.is_file():
            raise HTTPException(404, "there is no such file")
        return Response(file.read_bytes(), media_type=KINDS[file.suffix])

    async def three(self, request: Request) -> Response:
        """Answer `GET /vendor/three.js`."""
        return Response(self._three, media_type=KINDS[".js"])

    async def skin(self, request: Request) -> Response:
        """Answer `GET /skin/N`."""
        return _arrays(self.runner.skin(_number(request)))

    async def ground(self, request: Request) -> Response:
        """Answer `GET /ground/N`."""
        return _arrays(self.runner.ground(_number(request)))

    async def rig(self, request: Request) -> Response:
        """Answer `POST /rig`: take a rig in, and say what was found in it."""
        data = await _body(request, LARGEST_FILE, "a rig")
        name = request.query_params.get("name", "rig")
        await self._use()
        return JSONResponse(await self._judge(lambda: self._take(data, name)))

    async def judge(self, request: Request) -> Response:
        """Answer `POST /judge`: say what would be found in a rig."""
        asked = await _json(request)
        return JSONResponse(await self._judge(lambda: self.rigs.judge(asked)))

    async def scene(self, request: Request) -> Response:
        """Answer `POST /scene`: a scene file, or a zip of one, becomes the document."""
        data = await _body(request, LARGEST_FILE, "a scene with its files")
        if not data.startswith(ZIP) and len(data) > LARGEST_SCENE:
            raise TooLargeError(f"a scene file may have {LARGEST_SCENE >> 20} MiB")
        name = request.query_params.get("name", "scene.toml")
        before = await self._use()
        document = await self._judge(
            partial(document_of, data, name, before, self.rigs, self.files)
        )
        await self._between_frames(lambda conductor: conductor.take(document))
        return JSONResponse({"document": document})

    async def mesh(self, request: Request) -> Response:
        """Answer `POST /mesh`: take in a mesh that is to stand about, split into convex parts."""
        data = await _body(request, LARGEST_FILE, "a mesh")
        name = request.query_params.get("name", "mesh.glb")
        await self._use()
        found = await self._judge(partial(self.files.take, data, name))
        await self._between_frames(lambda conductor: conductor.tell_files())
        return JSONResponse(found)

    async def surface(self, request: Request) -> Response:
        """Answer `GET /mesh/NAME`."""
        return _arrays(await asyncio.to_thread(self.files.surface, request.path_params["mesh"]))

    async def file(self, request: Request) -> Response:
        """Answer `POST /file`: keep a file for the scene that will name it."""
        data = await _body(request, LARGEST_FILE, "a file")
        name = request.query_params.get("name", "")
        kept = await self._judge(partial(self.files.waiting.keep, data, name))
        return JSONResponse({"name": kept})

    async def export(self, request: Request) -> Response:
        """Answer `GET /export/NAME`."""
        name, creature = request.path_params["name"], request.query_params.get("creature", "0")
        export = EXPORTS.get(name)
        if export is None:
            raise HTTPException(404, f"there is no such export; there are {', '.join(EXPORTS)}")
        if creature == ALL and name in WALKS:
            tape = await self._between_frames(ended_tape)
            content = await asyncio.to_thread(
                zip_of_walks, tape, name, export, self.rigs, self.files
            )
            return _file(content, "application/zip", "walks.zip")
        if not (creature.isascii() and creature.isdigit() and len(creature) < 6):
            raise SettingError("creature: must be a creature's number, or of a walk: all")
        found = await self._between_frames(partial(export.read, creature=int(creature)))
        content = await asyncio.to_thread(export.write, found, self.rigs, self.files)
        return _file(content, export.kind, name)

    async def _use(self) -> Document:
        """Return the document, and have what it names stay."""
        document = await self._between_frames(lambda conductor: conductor.stage.document)
        self.rigs.use({one["rig"] for one in (document["creature"], *document["crowd"])})
        meshes = {one["file"] for one in document["obstacle"] if one["shape"] == "mesh"}
        self.files.use(meshes | {(document["terrain"] or {}).get("given", "")})
        return document

    async def _between_frames(self, work: Callable[[Any], T]) -> T:
        return await asyncio.wrap_future(self.runner.call(work))

    async def _judge(self, work: Callable[[], T]) -> T:
        """Do what may take seconds beside the event loop, one after the other."""
        async with self._judging:
            return await asyncio.to_thread(work)

    def _take(self, data: bytes, name: str) -> dict[str, Any]:
        return self.rigs.judge({"rig": self.rigs.take(data, name)})


def make_app(runner: Running, rigs: GivenRigs, files: WorldFiles, token: str, port: int) -> Gate:
    """Return the studio as an ASGI application.

    Args:
        runner: the simulation; started and stopped elsewhere.
        rigs: that were given.
        files: of the world.
        token: that the page carries.
        port: on which it will be reached.

    Raises:
        SettingError: three.js is not there.
    """
    studio = Studio(runner, rigs, files, token)

    async def link(websocket: Any) -> None:
        await studio.hub.serve(websocket)

    routes = [
        Route("/", studio.index),
        Route("/page/{name}", studio.module),
        Route("/vendor/three.js", studio.three),
        Route("/skin/{number}", studio.skin),
        Route("/ground/{number}", studio.ground),
        Route("/rig", studio.rig, methods=["POST"]),
        Route("/judge", studio.judge, methods=["POST"]),
        Route("/scene", studio.scene, methods=["POST"]),
        Route("/mesh", studio.mesh, methods=["POST"]),
        Route("/mesh/{mesh}", studio.surface),
        Route("/file", studio.file, methods=["POST"]),
        Route("/export/{name}", studio.export),
        WebSocketRoute("/link", link),
    ]
    refusals: dict[Any, Any] = {
        HTTPException: _say_status,
        TooLargeError: _say_too_large,
        MissingFilesError: _say_missing,
        PolypodError: _say_refusal,
    }
    inner = Starlette(routes=routes, exception_handlers=refusals)
    page = (PAGE / "index.html").read_text(encoding="utf-8")
    return Gate(inner, port, token, inline_hashes(page))


def three_file() -> Path:
    """Return the file of three.js, out of NiceGUI's wheel.

    Raises:
        SettingError: it is not there.
    """
    spec = find_spec("nicegui")
    folder = Path(spec.origin).parent if spec is not None and spec.origin else Path()
    file = folder / "elements" / "scene" / "dist" / "index.js"
    if not file.is_file():
        raise SettingError('three.js is not there; pip install "polypod[studio]" brings it')
    return file


def _number(request: Request) -> int:
    text = request.path_params["number"]
    if not (text.isascii() and text.isdigit() and len(text) < 12):
        raise HTTPException(404, "there is nothing of that number")
    return int(text)


def _file(content: bytes, kind: str, name: str) -> Response:
    disposition = f'attachment; filename="{name}"'
    return Response(content, media_type=kind, headers={"Content-Disposition": disposition})


def _arrays(content: bytes | None) -> Response:
    if content is None:
        # No fault: while somebody undoes quickly, what is asked for is gone before it is.
        return Response(status_code=204)
    return Response(content, media_type=BYTES)


async def _body(request: Request, limit: int, what: str) -> bytes:
    return await read_bounded(request.stream(), request.headers.get("content-length"), limit, what)


async def _json(request: Request) -> Any:
    body = await _body(request, LARGEST_QUESTION, "a question")
    try:
        return parse_json(body.decode())
    except UnicodeDecodeError:
        raise SettingError("it is no UTF-8 text") from None


async def _say_status(request: Request, error: HTTPException) -> Response:
    return JSONResponse({"why": error.detail}, error.status_code, error.headers)


async def _say_too_large(request: Request, error: TooLargeError) -> Response:
    # What is still coming is not read: the connection goes with the answer.
    return JSONResponse({"why": str(error)}, 413, {"Connection": "close"})


async def _say_missing(request: Request, error: MissingFilesError) -> Response:
    return JSONResponse({"why": str(error), "wants": error.names}, 422)


async def _say_refusal(request: Request, error: PolypodError) -> Response:
    return JSONResponse({"why": str(error)}, 422)
