"""Who may talk to the studio, how much, and how fast.

A server on this computer can be reached by every page that its browser shows. A page elsewhere may
send requests, forms and websockets here, or have its own name lead to 127.0.0.1; so Host, Origin
and a token that only our page carries are judged, and whatever comes is bounded.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import json
import math
import re
from collections import deque
from collections.abc import AsyncIterator, Mapping
from typing import Any, NoReturn

from polypod.errors import PolypodError

LARGEST_ORDER = 64 << 10  # bytes
LARGEST_DOCUMENT = 1 << 20  # bytes, of an order that opens one
LARGEST_WHOLE = 1 << 53  # what JavaScript counts to

MESSAGES_A_SECOND = 200.0
MESSAGES_AT_ONCE = 400.0
MOST_FAULTS = 20
FAULTS_WITHIN = 10.0  # s

# Of a page that another site has a part in, as browsers say it themselves.
STRANGE_SITES = ("cross-site", "same-site")


class RefusalError(PolypodError):
    """A request or a message that the studio does not take; the text says why."""


class TooLargeError(RefusalError):
    """More bytes than are taken."""


def our_hosts(port: int) -> tuple[str, ...]:
    """Return the names under which this computer reaches a port of its own."""
    return (f"127.0.0.1:{port}", f"localhost:{port}", f"[::1]:{port}")


def judge_host(host: str | None, port: int) -> None:
    """Refuse a Host that is not ours: a stranger's name that leads to this computer.

    Raises:
        RefusalError: it is none of `our_hosts`.
    """
    if host is None or host.lower() not in our_hosts(port):
        raise RefusalError(f"the studio is at http://127.0.0.1:{port} and at no other address")


def judge_origin(origin: str | None, port: int, needed: bool) -> None:
    """Refuse what a page from elsewhere asks for.

    Args:
        origin: the header; browsers leave it out where a page reads from its own server.
        port: ours.
        needed: it must be there, as it is with every websocket and every POST of a browser.

    Raises:
        RefusalError: another origin, or none where one is needed.
    """
    if origin is None:
        if needed:
            raise RefusalError("a request without an Origin is not taken here")
        return
    if origin.lower() not in {f"http://{host}" for host in our_hosts(port)}:
        raise RefusalError("only the studio's own page may ask for this")


def judge_site(site: str | None) -> None:
    """Refuse what a browser itself says was asked for by another site's page.

    Raises:
        RefusalError: the header Sec-Fetch-Site names another site or another port.
    """
    if site is not None and site.lower() in STRANGE_SITES:
        raise RefusalError("only the studio's own page may ask for this")


def judge_token(given: str | None, token: str) -> None:
    """Refuse whoever does not carry the page's token; how long it takes says nothing about it.

    Raises:
        RefusalError: another token, or none.
    """
    if not hmac.compare_digest((given or "").encode("utf-8", "replace"), token.encode()):
        raise RefusalError("the page is from an earlier start of the studio: reload it")


def inline_hashes(page: str) -> tuple[str, ...]:
    """Return the hash, as a policy writes it, of each script that stands in a page itself."""
    scripts = re.findall(r"<script(?![^>]*\bsrc=)[^>]*>(.*?)</script>", page, re.DOTALL)
    digests = (hashlib.sha256(script.encode()).digest() for script in scripts)
    return tuple(f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests)


def headers(host: str, inline: tuple[str, ...], secret: bool) -> dict[str, str]:
    """Return what goes with every answer.

    Args:
        host: ours, as it was asked for.
        inline: hashes of the scripts that stand in the page itself.
        secret: the answer is for who carries the token, or carries it: nobody keeps a copy.
    """
    # A policy cannot name an address in brackets; there 'self' has to do.
    socket = "" if host.startswith("[") else f" ws://{host}"
    policy = {
        "default-src": "'self'",
        "script-src": " ".join(("'self'", *inline)),
        "connect-src": f"'self'{socket} blob:",
        "img-src": "'self' blob: data:",
        "media-src": "blob:",
        "object-src": "'none'",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": "'none'",
    }
    return {
        "Content-Security-Policy": "; ".join(f"{key} {value}" for key, value in policy.items()),
        "X-Content-Type-Options": "nosniff",
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cache-Control": "no-store" if secret else "no-cache",
    }


async def read_bounded(
    pieces: AsyncIterator[bytes], declared: str | None, limit: int, what: str
) -> bytes:
    """Return a body, of which never more than the limit and a piece is held.

    Args:
        pieces: the body as it comes.
        declared: the header Content-Length, None where there is none.
        limit: bytes.
        what: for the message.

    Raises:
        TooLargeError: it says that it is larger, or it is.
        RefusalError: a length that is no number.
    """
    too_large = TooLargeError(f"{what} may have {limit / (1 << 20):g} MiB, and this one has more")
    if declared is not None:
        if not re.fullmatch(r"[0-9]{1,18}", declared):
            raise RefusalError("its Content-Length is no number")
        if int(declared) > limit:
            raise too_large
    body = bytearray()
    async for piece in pieces:
        body += piece
        if len(body) > limit:
            raise too_large
    return bytes(body)


def parse_json(text: str) -> Any:
    """Return what a JSON text says, read strictly.

    Raises:
        RefusalError: no JSON, NaN or an infinity, a number beyond what JavaScript counts to, a key
            given twice, brackets without end, or half a character.
    """
    try:
        parsed = json.loads(
            text,
            parse_constant=_refuse_constant,
            parse_float=_finite,
            parse_int=_whole,
            object_pairs_hook=_distinct,
        )
        if "\\ud" in text.lower():
            # The halves of a character beyond U+FFFF may come apart, and nothing can write them.
            json.dumps(parsed, ensure_ascii=False).encode()
        return parsed
    except RecursionError:
        raise RefusalError("its brackets are nested too deeply") from None
    except ValueError as fault:  # UnicodeEncodeError is one
        raise RefusalError(f"it is no JSON: {str(fault)[:120]}") from None


def parse_order(text: str, known: Mapping[str, int]) -> dict[str, Any]:
    """Return an order from the page, judged as far as it can be without knowing the world.

    Args:
        text: as it came.
        known: the bytes that an order may have, by its `do`.

    Raises:
        RefusalError: too long, no strict JSON, no object, or no order that there is.
    """
    size = len(text.encode("utf-8", "replace"))
    if size > max(known.values()):
        raise RefusalError(f"a message may have {max(known.values()) >> 10} KiB, this one has more")
    order = parse_json(text)
    if not isinstance(order, dict):
        raise RefusalError("a message must be a JSON object")
    do = order.get("do")
    if not isinstance(do, str) or do not in known:
        raise RefusalError(f"do: must be one of {', '.join(known)}")
    if size > known[do]:
        raise RefusalError(f"{do}: a message may have {known[do] >> 10} KiB, this one has more")
    number = order.get("id", 0)
    if not isinstance(number, int) or isinstance(number, bool):
        raise RefusalError("id: must be a whole number")
    return order


class Rate:
    """Counts messages: so many a second, after a burst of so many."""

    def __init__(self, a_second: float = MESSAGES_A_SECOND, at_once: float = MESSAGES_AT_ONCE):
        self.a_second, self.at_once = a_second, at_once
        self.left = at_once
        self.last: float | None = None

    def allows(self, now: float) -> bool:
        """Count a message that comes at `now`, s; tell whether it is still within bounds."""
        if self.last is not None:
            self.left = min(self.at_once, self.left + self.a_second * (now - self.last))
        self.last = now
        if self.left < 1.0:
            return False
        self.left -= 1.0
        return True


class Faults:
    """Counts messages that could not be understood."""

    def __init__(self, most: int = MOST_FAULTS, within: float = FAULTS_WITHIN):
        self.most, self.within = most, within
        self.times: deque[float] = deque()

    def too_many(self, now: float) -> bool:
        """Count a fault at `now`, s; tell whether there were more than the most of late."""
        self.times.append(now)
        while self.times[0] < now - self.within:
            self.times.popleft()
        return len(self.times) > self.most


def _refuse_constant(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is no number")


def _finite(digits: str) -> float:
    value = float(digits)
    return value if math.isfinite(value) else _refuse_constant(digits[:20])


def _whole(digits: str) -> int:
    value = int(digits) if len(digits) < 20 else LARGEST_WHOLE
    return value if abs(value) < LARGEST_WHOLE else _refuse_constant(digits[:20])


def _distinct(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a key is given twice")
    return found
