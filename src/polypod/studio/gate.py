"""The gate before all routes: who comes in, and what goes with every answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from starlette.datastructures import Headers, MutableHeaders, QueryParams
from starlette.responses import JSONResponse
from starlette.websockets import WebSocket

from polypod.studio.guard import (
    RefusalError,
    headers,
    judge_host,
    judge_origin,
    judge_site,
    judge_token,
    our_hosts,
)

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

# What anybody on this computer may read: the page itself, in which the token is.
OPEN_PATHS = ("/page/", "/vendor/")
READING = ("GET", "HEAD")


class Gate:
    """An ASGI application around another."""

    def __init__(self, inner: ASGIApp, port: int, token: str, inline: tuple[str, ...]):
        self.inner, self.port, self.token, self.inline = inner, port, token, inline

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request in, or answer 403 with the reason."""
        if scope["type"] not in ("http", "websocket"):
            await self.inner(scope, receive, send)
            return
        path: str = scope["path"]
        free = scope["type"] == "http" and (path == "/" or path.startswith(OPEN_PATHS))
        asked = Headers(scope=scope)
        host = (asked.get("host") or "").lower()
        known = host if host in our_hosts(self.port) else our_hosts(self.port)[0]
        own = headers(known, self.inline, secret=path == "/" or not free)

        async def send_with_headers(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                MutableHeaders(raw=message.setdefault("headers", [])).update(own)
            await send(message)

        try:
            self._judge(scope, asked, free)
        except RefusalError as refusal:
            answer = JSONResponse({"why": str(refusal)}, 403)
            if scope["type"] == "http":
                await answer(scope, receive, send_with_headers)
            else:
                socket = WebSocket(scope, receive, send_with_headers)
                await socket.send_denial_response(answer)
            return
        await self.inner(scope, receive, send_with_headers)

    def _judge(self, scope: Scope, asked: Headers, free: bool) -> None:
        judge_host(asked.get("host"), self.port)
        reading = scope["type"] == "http" and scope["method"] in READING
        judge_origin(asked.get("origin"), self.port, needed=not reading)
        if scope["path"] != "/":
            # A link on another page may lead to ours; nothing else of it may.
            judge_site(asked.get("sec-fetch-site"))
        if not free:
            given = asked.get("x-polypod-token")
            if given is None:
                given = QueryParams(scope["query_string"]).get("token")
            judge_token(given, self.token)
