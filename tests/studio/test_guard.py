"""Who may talk to the studio, how much, how fast."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Coroutine
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.testclient import WebSocketDenialResponse

from polypod.studio import app, guard
from polypod.studio.guard import RefusalError, TooLargeError
from studio.server import HOME, OURS, PORT, TOKEN, Served

HOSTS = [f"127.0.0.1:{PORT}", f"localhost:{PORT}", f"[::1]:{PORT}", f"LOCALHOST:{PORT}"]
STRANGERS = [
    "evil.example", f"evil.example:{PORT}", "127.0.0.1", "127.0.0.1:1", "localhost", "",
    f"127.0.0.1:{PORT}.evil.example", f"127.0.0.1:{PORT}@evil.example", f"127.0.0.2:{PORT}",
    f"0.0.0.0:{PORT}", f"http://127.0.0.1:{PORT}",
]  # fmt: skip
WITH_TOKEN = ["/skin/3", "/ground/4", "/export/scene.toml", "/export/creature.toml"]


@pytest.mark.parametrize("host", HOSTS)
def test_our_hosts_and_origins_are_let_in(host: str) -> None:
    guard.judge_host(host, PORT)
    guard.judge_origin(f"http://{host}", PORT, needed=True)


@pytest.mark.parametrize("host", STRANGERS)
def test_strangers_are_not(host: str) -> None:
    with pytest.raises(RefusalError, match=f"http://127.0.0.1:{PORT}"):
        guard.judge_host(host, PORT)
    with pytest.raises(RefusalError, match="own page"):
        guard.judge_origin(f"http://{host}" if host else "", PORT, needed=False)


def test_other_origins_are_not() -> None:
    for origin in ("null", "file://", f"https://127.0.0.1:{PORT}", f"{HOME}/", f"{HOME} {HOME}"):
        with pytest.raises(RefusalError):
            guard.judge_origin(origin, PORT, needed=False)
    guard.judge_origin(None, PORT, needed=False)
    for needed_or_host in (
        lambda: guard.judge_origin(None, PORT, True),
        lambda: guard.judge_host(None, PORT),
    ):
        with pytest.raises(RefusalError):
            needed_or_host()


@pytest.mark.parametrize("given", [None, "", "another", TOKEN[:-1], TOKEN + "x", "\udcff"])
def test_other_tokens_are_refused(given: str | None) -> None:
    guard.judge_token(TOKEN, TOKEN)
    with pytest.raises(RefusalError, match="reload"):
        guard.judge_token(given, TOKEN)


def test_every_answer_carries_the_headers(studio: Served) -> None:
    answers = [
        studio.client.get("/"),
        studio.client.get("/page/main.js"),
        studio.client.get("/page/nosuch.js"),
        studio.client.get("/skin/3"),
        studio.client.get("/skin/3", headers=OURS),
        studio.client.post("/judge", headers=OURS, content="{"),
        studio.client.put("/rig", headers=OURS),
        studio.client.get("/", headers={"Host": "evil.example"}),
    ]
    assert [a.status_code for a in answers] == [200, 200, 404, 403, 200, 422, 405, 403]
    for answer in answers:
        policy = dict(
            p.split(" ", 1) for p in answer.headers["Content-Security-Policy"].split("; ")
        )
        assert policy["default-src"] == "'self'"
        assert policy["frame-ancestors"] == "'none'"
        assert "unsafe" not in answer.headers["Content-Security-Policy"]
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
        assert answer.headers["X-Frame-Options"] == "DENY"
        assert answer.headers["Referrer-Policy"] == "no-referrer"
        assert answer.headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert "Access-Control-Allow-Origin" not in answer.headers
    stored = [a.headers["Cache-Control"] for a in answers]
    assert stored[0] == stored[3] == stored[4] == "no-store"
    assert stored[1] == "no-cache"


def test_the_page_carries_the_token_and_its_one_inline_script_is_allowed(studio: Served) -> None:
    page = studio.client.get("/")
    assert f'content="{TOKEN}"' in page.text
    hashes = guard.inline_hashes(page.text)
    assert len(hashes) == 1
    assert hashes[0] in page.headers["Content-Security-Policy"]
    # Known from elsewhere: `printf 'alert(1)' | openssl dgst -sha256 -binary | base64`.
    known = "'sha256-bhHHL3z2vDgxUt0W3dWQOrprscmda2Y5pLsLg4GF+pI='"
    assert guard.inline_hashes("<script>alert(1)</script><script src=x></script>") == (known,)


@pytest.mark.parametrize("path", WITH_TOKEN)
def test_nothing_but_the_page_is_read_without_the_token(studio: Served, path: str) -> None:
    assert studio.client.get(path).status_code == 403
    assert studio.client.get(f"{path}?token=x").json()["why"].startswith("the page is from")
    assert studio.client.get(path, headers={"X-Polypod-Token": TOKEN}).status_code == 200
    assert studio.client.get(f"{path}?token={TOKEN}").status_code == 200
    # The header counts where both are given.
    mixed = studio.client.get(f"{path}?token={TOKEN}", headers={"X-Polypod-Token": "x"})
    assert mixed.status_code == 403


@pytest.mark.parametrize("path", ["/", "/page/main.js", "/vendor/three.js", "/skin/3"])
def test_a_page_from_elsewhere_reads_nothing(studio: Served, path: str) -> None:
    token = {"X-Polypod-Token": TOKEN}
    for headers in (
        {"Origin": "http://evil.example"},
        {"Origin": f"http://127.0.0.1:{PORT + 1}"},
        {"Origin": "null"},
        {"Host": "evil.example"},
        {"Host": f"evil.example:{PORT}", "Origin": f"http://evil.example:{PORT}"},
    ):
        answer = studio.client.get(path, headers=headers | token)
        assert answer.status_code == 403
        assert "studio" in answer.json()["why"]
    linked = studio.client.get(path, headers=token | {"Sec-Fetch-Site": "cross-site"})
    assert linked.status_code == (200 if path == "/" else 403)
    neighbour = studio.client.get("/skin/3", headers=token | {"Sec-Fetch-Site": "same-site"})
    assert neighbour.status_code == 403


@pytest.mark.parametrize("path", ["/rig", "/judge", "/scene"])
def test_a_page_from_elsewhere_sends_nothing(studio: Served, path: str) -> None:
    for headers in (
        {"X-Polypod-Token": TOKEN},
        {"Origin": "http://evil.example", "X-Polypod-Token": TOKEN},
        {"Origin": HOME},
        {"Origin": HOME, "X-Polypod-Token": "x"},
        {**OURS, "Host": "evil.example"},
        {**OURS, "Sec-Fetch-Site": "cross-site"},
    ):
        answer = studio.client.post(path, headers=headers, content=b"{}")
        assert answer.status_code == 403
        assert answer.json()["why"]


@pytest.mark.parametrize(
    ("headers", "token"),
    [
        ({}, TOKEN),
        ({"Origin": "http://evil.example"}, TOKEN),
        ({"Origin": "null"}, TOKEN),
        ({"Origin": HOME}, "x"),
        ({"Origin": HOME}, ""),
        ({"Origin": HOME, "Host": "evil.example"}, TOKEN),
        ({"Origin": HOME, "Sec-Fetch-Site": "same-site"}, TOKEN),
    ],
)
def test_a_foreign_websocket_is_not_opened(
    studio: Served, headers: dict[str, str], token: str
) -> None:
    with (
        pytest.raises(WebSocketDenialResponse) as denial,
        studio.client.websocket_connect(
            f"/link?token={token}", headers={"Host": f"127.0.0.1:{PORT}", **headers}
        ),
    ):
        pass
    assert denial.value.status_code == 403
    assert denial.value.json()["why"]
    assert studio.runner.listeners == []


def test_only_files_of_the_page_are_given_out(
    studio: Served, tmp_path: Path, monkeypatch: Any
) -> None:
    (tmp_path / "page").mkdir()
    secret = tmp_path / "secret.js"
    secret.write_text("secret")
    (tmp_path / "page" / "main.js").write_text("main")
    (tmp_path / "page" / "notes.txt").write_text("notes")
    (tmp_path / "page" / "link.js").symlink_to(secret)
    (tmp_path / "page" / "folder.js").mkdir()
    monkeypatch.setattr(app, "PAGE", tmp_path / "page")
    assert studio.client.get("/page/main.js").text == "main"
    for name in (
        "../secret.js", "%2e%2e/secret.js", "..%2fsecret.js", "%2e%2e%2fsecret.js",
        f"{secret}", f"/{secret}", f"%2f{str(secret)[1:]}", "link.js", "folder.js", "notes.txt",
        "main.js%00", "MAIN.JS/", "./main.js%2f..%2f..%2fsecret.js",
    ):  # fmt: skip
        answer = studio.client.get(f"{HOME}/page/{name}", headers=OURS)
        assert answer.status_code == 404, name
        assert "secret" not in answer.text.replace(name, "")


def test_numbers_in_paths(studio: Served) -> None:
    assert studio.client.get("/skin/3", headers=OURS).content == b"skin"
    assert studio.client.get("/ground/4", headers=OURS).content == b"ground"
    assert studio.client.get("/skin/4", headers=OURS).status_code == 204
    for number in ("-3", "3.0", "٣", "9" * 5000, "x", "3x"):
        assert studio.client.get(f"/skin/{number}", headers=OURS).status_code == 404, number


async def _pieces(*pieces: bytes) -> AsyncIterator[bytes]:
    for piece in pieces:
        yield piece


def run(reading: Coroutine[Any, Any, bytes]) -> bytes:
    """Return what is read, in a thread: where browsers are tried too, this one has a loop."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, reading).result()


def test_bodies_are_cut_off_at_the_limit() -> None:
    def read(declared: str | None, *pieces: bytes) -> bytes:
        return run(guard.read_bounded(_pieces(*pieces), declared, 10, "it"))

    assert read("10", b"12345", b"67890") == b"1234567890"
    assert read(None, b"") == b""
    for declared, pieces in (("11", ()), (None, (b"1" * 11,)), ("3", (b"12345", b"678901"))):
        with pytest.raises(TooLargeError):
            read(declared, *pieces)
    for declared in ("-1", "ten", "1e1", "", "٣", "9" * 30):
        with pytest.raises(RefusalError, match="no number"):
            read(declared, b"")


def test_what_is_too_large_is_not_read_on() -> None:
    read = 0

    async def endless() -> AsyncIterator[bytes]:
        nonlocal read
        while True:
            read += 1
            yield b"x" * 1000

    with pytest.raises(TooLargeError, match="may have"):
        run(guard.read_bounded(endless(), None, 1 << 20, "a rig"))
    assert read == (1 << 20) // 1000 + 1


BAD_JSON = [
    "", "{", "nul", "{'a': 1}", '{"a": NaN}', '{"a": Infinity}', '{"a": -Infinity}',
    '{"a": 1e999}', '{"a": -1e999}', '{"a": 1, "a": 2}', '[{"a": {"b": 1, "b": 1}}]',
    "[" * 100_000, '{"a":' * 100_000, '"\\ud800"', '{"\\uDFFF": 1}', "9007199254740993",
    "9" * 5000, "-" + "9" * 5000, '{"a": 1,}', "\x00",
]  # fmt: skip


@pytest.mark.parametrize("text", BAD_JSON, ids=lambda text: text[:20])
def test_json_is_read_strictly(text: str) -> None:
    with pytest.raises(RefusalError) as refusal:
        guard.parse_json(text)
    assert len(str(refusal.value)) < 200


JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**53) + 1, 2**53 - 1)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters(exclude_categories=["Cs"])),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), inner, max_size=4)
    ),
    max_leaves=20,
)


@given(JSON, st.booleans())
def test_json_comes_back_as_it_was(value: Any, escaped: bool) -> None:
    assert guard.parse_json(json.dumps(value, ensure_ascii=escaped)) == value


@given(st.text() | JSON.map(json.dumps))
def test_an_order_is_a_known_one_or_refused(text: str) -> None:
    known = {"edit": 100, "open": 200}
    try:
        order = guard.parse_order(text, known)
    except RefusalError:
        order = {"do": "edit"}
    assert order["do"] in known


@given(st.fixed_dictionaries({"do": st.sampled_from(["edit", "open"]), "to": JSON}))
def test_orders_come_as_they_were_sent(order: dict[str, Any]) -> None:
    assert guard.parse_order(json.dumps(order), {"edit": 1 << 20, "open": 1 << 20}) == order


def test_orders_are_bounded_by_their_kind() -> None:
    known = {"edit": 100, "open": 200}
    long = json.dumps({"do": "edit", "to": "x" * 100})
    assert guard.parse_order(long.replace("edit", "open"), known)["do"] == "open"
    for text in (long, json.dumps({"do": "open", "to": "é" * 200}, ensure_ascii=False)):
        with pytest.raises(RefusalError, match="more"):
            guard.parse_order(text, known)
    for id_ in ("1", 1.0, True, None, [1]):
        with pytest.raises(RefusalError, match="id"):
            guard.parse_order(json.dumps({"do": "edit", "id": id_}), known)


@given(st.lists(st.floats(0.0, 0.1), min_size=1, max_size=400))
def test_no_second_has_more_messages_than_the_rate_and_a_burst(gaps: list[float]) -> None:
    rate, now, allowed = guard.Rate(20.0, 40.0), 0.0, []
    for gap in gaps:
        now += gap
        if rate.allows(now):
            allowed.append(now)
    for i, start in enumerate(allowed):
        within = sum(1 for t in allowed[i:] if t <= start + 1.0)
        assert within <= 60 + 1


def test_the_rate_is_exact() -> None:
    rate = guard.Rate(2.0, 3.0)
    assert [rate.allows(0.0) for _ in range(4)] == [True, True, True, False]
    assert [rate.allows(t) for t in (0.25, 0.5, 0.75, 1.0)] == [False, True, False, True]
    assert [rate.allows(100.0) for _ in range(4)] == [True, True, True, False]


def test_faults_are_counted_for_a_while() -> None:
    faults = guard.Faults(most=2, within=10.0)
    assert [faults.too_many(t) for t in (0.0, 1.0, 2.0)] == [False, False, True]
    assert [faults.too_many(t) for t in (11.5, 12.5, 12.6)] == [False, False, True]
    assert not guard.Faults().too_many(0.0)
