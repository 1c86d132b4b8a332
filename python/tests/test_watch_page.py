"""The live page: pushed, bounded, and never in the way."""

from __future__ import annotations

import http.client
import json
import socket
import time
from collections.abc import Iterator

import numpy as np
import pytest
from sms.errors import InputError
from sms.watch.detector import Look
from sms.watch.page import COURSE, QUEUE, Client, Page
from sms.watch.watch import Status

pytest.importorskip("aiohttp", reason="the live page needs the extra sms[watch]")


def status(number: int) -> Status:
    look = Look(5.0 * number, 5.0 * number + 5.0, np.ones((1, 2)), np.array([[0.2, 0.7]]), (1,))
    tests = ("moving_mass", "<script>alert(1)</script>")
    return Status(
        *("watching", "running", 5.0 * number, number, 600.0, 600.0, 0, 0, False), tests, look
    )


@pytest.fixture
def page() -> Iterator[Page]:
    with Page.at("127.0.0.1:0", "A bench") as shown:
        yield shown


def asked(page: Page, path: str, host: str | None = None) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection(page.host, page.port, timeout=10.0)
    connection.request("GET", path, headers={} if host is None else {"Host": host})
    return connection.getresponse()


def frames(answer: http.client.HTTPResponse) -> Iterator[dict[str, object]]:
    while line := answer.readline():
        if line.startswith(b"data: "):
            yield json.loads(line[6:])


def test_what_is_shown_is_pushed(page: Page) -> None:
    assert b"<title>" in asked(page, "/").read()
    page.show(status(1))
    told = frames(asked(page, "/events"))
    first, second = next(told), next(told)
    assert first == {"title": "A bench", "course": [[10.0, 0.7]]}
    assert second["tests"] == [["<script>alert(1)</script>", 0.7], ["moving_mass", 0.2]]
    time.sleep(0.25)
    page.show(status(2))
    assert next(told)["segments"] == 2
    assert asked(page, "/alarm/1").status == 404
    assert asked(page, "/../../etc/passwd").status == 404


def test_another_name_for_this_computer_is_refused(page: Page) -> None:
    assert asked(page, "/", host="evil.example").status == 403
    assert asked(page, "/", host=f"localhost:{page.port}").status == 200


def test_a_browser_that_reads_nothing_holds_up_nobody(page: Page) -> None:
    """Its queue is full, its socket too; the watch hands over thousands of frames meanwhile."""
    with socket.create_connection((page.host, page.port)) as asleep:
        asleep.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1024)
        asleep.sendall(f"GET /events HTTP/1.1\r\nHost: {page.host}:{page.port}\r\n\r\n".encode())
        end = time.monotonic() + 10.0
        while not page.clients and time.monotonic() < end:
            time.sleep(0.01)
        (client,) = page.clients
        text = json.dumps({"much": "x" * 4000})
        for k in range(5000):
            page._loop.call_soon_threadsafe(page._broadcast, text)
            page.show(status(k))
        while not client.lost and time.monotonic() < end:
            time.sleep(0.01)
        assert client.lost > 0
        assert len(client.frames) <= QUEUE
        assert len(page.course) <= COURSE
        awake = frames(asked(page, "/events"))
        assert next(awake)["title"] == "A bench"


def test_a_full_queue_loses_its_oldest_frame() -> None:
    client = Client()
    for k in range(QUEUE + 5):
        client.put(str(k))
    assert list(client.frames) == [str(k) for k in range(5, QUEUE + 5)]
    assert client.lost == 5


@pytest.mark.parametrize(
    "text", ["8765", "127.0.0.1", "127.0.0.1:http", ":8765", "localhost:99999"]
)
def test_what_is_no_address_is_one_sentence(text: str) -> None:
    with pytest.raises(InputError, match="ADDRESS:PORT"):
        Page.at(text, "A bench")


def test_a_port_that_is_taken_is_one_sentence(page: Page) -> None:
    with pytest.raises(InputError, match="another port"), Page.at(f"127.0.0.1:{page.port}", "B"):
        pass


def test_who_can_read_it() -> None:
    assert not Page.at("127.0.0.1:0", "").is_open_to_others
    assert not Page.at("[::1]:0", "").is_open_to_others
    assert Page.at("0.0.0.0:0", "").is_open_to_others
