"""The live page: what the watch sees, pushed to browsers (server-sent events), on loopback by default.

The server has a thread and an event loop of its own. The watch hands a frame over and goes on; each browser has a queue
of a few frames, of which the oldest is lost when it is full. So a page that is slow, or asleep, loses frames and holds
up nobody.
"""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import json
import socket
import threading
import time
from collections import deque
from importlib import resources
from pathlib import Path
from types import TracebackType
from typing import Any

from sms.errors import InputError
from sms.io.json_files import plain
from sms.watch.watch import Status

QUEUE = 8
"""Frames that wait for one browser."""
EVERY = 0.2
"""s between two frames, but for those with an alarm that is new."""
COURSE = 720
"""Looks whose evidence is kept for who opens the page: an hour."""
TESTS = 10
"""Of the highest that are shown."""
MOST_BROWSERS = 32


class Client:
    """The queue of one browser."""

    def __init__(self) -> None:
        self.frames: deque[str] = deque(maxlen=QUEUE)
        self.lost = 0
        self.woken = asyncio.Event()

    def put(self, frame: str) -> None:
        """Never waits."""
        self.lost += len(self.frames) == QUEUE
        self.frames.append(frame)
        self.woken.set()


class Page:
    """A page at an address, while the context is open."""

    def __init__(self, host: str, port: int, title: str, out: Path | None = None) -> None:
        self.host, self.port, self.title, self.out = host, port, title, out
        self.clients: set[Client] = set()
        self.course: deque[tuple[float, float]] = deque(maxlen=COURSE)
        self._next = 0.0
        self._last: tuple[Any, ...] = ()
        self._latest: str | None = None
        self._loop = asyncio.new_event_loop()
        self._started = threading.Event()
        self._stop: asyncio.Event | None = None
        self._problem: OSError | None = None
        self._thread = threading.Thread(target=self._serve, daemon=True)

    @classmethod
    def at(cls, text: str, title: str, out: Path | None = None) -> Page:
        """A page at "127.0.0.1:8765". InputError for what is no address, or without the library for it."""
        try:
            import aiohttp  # noqa: F401, PLC0415 (an optional extra)
        except ImportError:
            raise InputError(
                '--page: a live page needs one more package; pip install "sms[watch]"'
            ) from None
        host, colon, port = text.rpartition(":")
        if not colon or not port.isdigit() or not 0 <= int(port) < 65536 or not host:
            raise InputError(f"--page {text}: write ADDRESS:PORT, as 127.0.0.1:8765")
        return cls(host.strip("[]"), int(port), title, out)

    @property
    def address(self) -> str:
        """ "http://127.0.0.1:8765"."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{host}:{self.port}"

    @property
    def is_open_to_others(self) -> bool:
        """Whether more than this computer can read it."""
        with contextlib.suppress(ValueError):
            return not ipaddress.ip_address(self.host).is_loopback
        return self.host != "localhost"

    def __enter__(self) -> Page:
        self._thread.start()
        self._started.wait()
        if self._problem is not None:
            raise InputError(
                f"--page: {self.host}:{self.port} cannot be listened on ({self._problem.strerror}); "
                "give another port"
            )
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._stop is not None:
            self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join(timeout=5.0)

    # ---- what is shown ---------------------------------------------------------------------------

    def show(self, status: Status) -> None:
        """Hand over what there is; never waits."""
        if status.look is not None:
            point = (status.look.end, status.look.highest)
            if not self.course or self.course[-1] != point:
                self.course.append(point)
        key = (status.phase, status.condition, status.alarm and status.alarm.number, status.verdict)
        now = time.monotonic()
        if key == self._last and now < self._next:
            return
        self._last, self._next = key, now + EVERY
        text = json.dumps(plain(frame_of(status)), allow_nan=False)
        self._latest = text
        with contextlib.suppress(RuntimeError):  # the server has ended
            self._loop.call_soon_threadsafe(self._broadcast, text)

    def _broadcast(self, text: str) -> None:
        for client in self.clients:
            client.put(text)

    # ---- the server ------------------------------------------------------------------------------

    def _serve(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self._served())
        self._loop.close()

    async def _served(self) -> None:
        from aiohttp import web  # noqa: PLC0415

        self._stop = asyncio.Event()
        app = web.Application(middlewares=[self._only_asked_for])
        app.router.add_get("/", self._index)
        app.router.add_get("/events", self._events)
        app.router.add_get("/alarm/{number:[0-9]{1,6}}", self._report)
        runner = web.AppRunner(app, access_log=None, shutdown_timeout=1.0)
        await runner.setup()
        try:
            site = web.TCPSite(runner, self.host, self.port)
            await site.start()
            bound = runner.addresses[0]
            self.port = int(bound[1])
        except (OSError, socket.gaierror) as problem:
            self._problem = problem
            self._started.set()
            await runner.cleanup()
            return
        self._started.set()
        await self._stop.wait()
        for client in self.clients:
            client.woken.set()
        await runner.cleanup()

    @property
    def _only_asked_for(self) -> Any:
        """Refuses a page of elsewhere that has its name lead to this address (DNS rebinding)."""
        from aiohttp import web  # noqa: PLC0415

        @web.middleware
        async def check(request: web.Request, handler: Any) -> web.StreamResponse:
            name = request.host.rpartition(":")[0].strip("[]") or request.host
            if not self.is_open_to_others and name not in (self.host, "localhost", "127.0.0.1"):
                raise web.HTTPForbidden(text="this page is for this computer only\n")
            answer: web.StreamResponse = await handler(request)
            return answer

        return check

    async def _index(self, request: Any) -> Any:
        from aiohttp import web  # noqa: PLC0415

        text = (resources.files("sms.watch") / "page.html").read_text(encoding="utf-8")
        policy = "default-src 'self'; style-src 'unsafe-inline'; script-src 'unsafe-inline'"
        return web.Response(
            text=text, content_type="text/html", headers={"Content-Security-Policy": policy}
        )

    async def _report(self, request: Any) -> Any:
        """The report of an alarm's diagnosis."""
        from aiohttp import web  # noqa: PLC0415

        folder = f"alarm_{int(request.match_info['number']):04d}"
        path = None if self.out is None else self.out / folder / "report.html"
        if path is None or not path.is_file():
            raise web.HTTPNotFound(text="there is no report of this alarm yet\n")
        return web.FileResponse(path)

    async def _events(self, request: Any) -> Any:
        from aiohttp import web  # noqa: PLC0415

        if len(self.clients) >= MOST_BROWSERS:
            raise web.HTTPServiceUnavailable(text=f"{MOST_BROWSERS} browsers show this page\n")
        response = web.StreamResponse(
            headers={"Content-Type": "text/event-stream", "Cache-Control": "no-store"}
        )
        await response.prepare(request)
        client = Client()
        begin = {"title": self.title, "course": list(self.course)}
        client.put(json.dumps(plain(begin), allow_nan=False))
        if self._latest is not None:
            client.put(self._latest)
        self.clients.add(client)
        assert self._stop is not None
        try:
            while not self._stop.is_set():
                await client.woken.wait()
                client.woken.clear()
                while client.frames:
                    await response.write(f"data: {client.frames.popleft()}\n\n".encode())
        except (ConnectionError, asyncio.CancelledError):
            pass
        finally:
            self.clients.discard(client)
        return response


def frame_of(status: Status) -> dict[str, Any]:
    """What a browser is told."""
    frame: dict[str, Any] = {
        "phase": status.phase,
        "condition": status.condition,
        "time": status.time,
        "segments": status.segments,
        "learned": status.learned,
        "wanted": status.wanted,
        "waiting": status.waiting,
        "lost": status.lost,
        "late": status.late,
        "diagnosing": status.diagnosing,
    }
    look = status.look
    if look is not None:
        frame["look"] = {"end": look.end, "highest": look.highest}
        best = look.exceeds.max(axis=0)
        order = best.argsort()[::-1][:TESTS]
        frame["tests"] = [[status.tests[k], float(best[k])] for k in order]
    if status.alarm is not None:
        a = status.alarm
        frame["alarm"] = {
            "number": a.number,
            "raised": a.raised,
            "since": a.since,
            "places": [[n, of, z] for n, of, z in a.places],
            "guesses": [str(g) for g in a.guesses],
            "chi_square": [g.chi_square for g in a.guesses],
        }
    if status.verdict is not None:
        v = status.verdict
        frame["verdict"] = {"alarm": v.alarm, "verdict": v.verdict, "sentence": v.sentence}
    return frame
