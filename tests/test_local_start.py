"""`make run` as a whole: what it listens on, what it bears, and what it leaves behind."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.local_start import Start, begin, prepared, until

READY = "Ctrl-C stops everything"


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("start") / "data"
    prepared(folder)
    return folder


@pytest.fixture
def start(data: Path) -> Iterator[Start]:
    started = begin(data)
    try:
        assert started.says(READY), started.log.read_text()
        yield started
    finally:
        started.end()


def seconds_for_a_page(start: Start) -> float:
    begun = time.monotonic()
    assert "200" in start.status()
    return time.monotonic() - begun


def test_silent_and_half_finished_clients_hold_up_nobody(start: Start) -> None:
    start.status()  # warm
    clients = [start.connect() for _ in range(48)]
    for client in clients[16:32]:
        client.sendall(b"GET /login/ HTTP/1.1\r\nHost: local")
    for client in clients[32:]:
        client.sendall(b"POST /login/ HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\nhalf")
    try:
        time.sleep(0.5)
        assert seconds_for_a_page(start) < 3
    finally:
        for client in clients:
            client.close()


def answer_to_headers(start: Start, path: str, *headers: str, megabytes: int = 100) -> str:
    """What is said to a large body before any of it was sent."""
    with start.connect() as connection:
        lines = [f"POST {path} HTTP/1.1", "Host: localhost", f"Content-Length: {megabytes}000000", *headers]
        connection.sendall("\r\n".join([*lines, "", ""]).encode())
        connection.settimeout(3)
        try:
            return connection.recv(4096).decode("latin-1").split("\r\n")[0]
        except TimeoutError:
            return ""


def test_large_bodies_are_taken_for_archives_only(start: Start) -> None:
    assert "413" in answer_to_headers(start, "/login/", "Cookie: sessionid=x")
    assert answer_to_headers(start, "/api/v1/uploads/", "Cookie: sessionid=x") == ""
    assert "413" in answer_to_headers(start, "/api/v1/uploads/", "Cookie: sessionid=x", megabytes=3000)


def test_a_stranger_sends_no_archive(start: Start) -> None:
    assert "401" in answer_to_headers(start, "/api/v1/uploads/")


def test_a_worker_that_dies_is_started_again_beside_the_web_server(start: Start) -> None:
    web, worker = start.part("annotator.web_server"), start.part("celery")
    assert web is not None and worker is not None
    os.kill(worker, signal.SIGKILL)
    assert start.says("The worker ended with -9; starting it again.", 20)
    assert until(lambda: start.part("celery") not in {worker, None}, 20)
    assert start.part("annotator.web_server") == web
    assert "200" in start.status()


def test_a_start_that_is_killed_leaves_no_process(start: Start) -> None:
    parts = start.parts()
    assert len(parts) >= 2
    start.process.kill()
    start.process.wait()
    assert until(lambda: not start.parts(), 30), start.parts()


def test_what_a_killed_start_left_is_ended_by_the_next(start: Start) -> None:
    worker = start.part("celery")
    os.kill(worker, signal.SIGSTOP)  # it cannot notice that its parent is gone
    start.process.kill()
    start.process.wait()
    following = begin(start.data)
    try:
        assert following.says("Ending what a start that was killed has left")
        assert following.says(READY)
        assert worker not in following.parts()
    finally:
        following.end()


def test_a_second_start_on_the_same_data_is_refused(start: Start) -> None:
    second = begin(start.data)
    assert second.process.wait(30) == 1
    assert f"already (process {start.process.pid})" in second.log.read_text()
    assert "200" in start.status()


def open_to_others(folder: Path) -> list[str]:
    """Files others may touch; messages of the broker come and go while one looks."""
    command = ["find", folder, "-ignore_readdir_race", "-perm", "/077"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def test_nobody_else_may_read_what_it_keeps(data: Path) -> None:
    (data / "gtm.sqlite3").chmod(0o644)
    data.chmod(0o755)
    started = begin(data)
    try:
        assert started.says(READY)
        assert open_to_others(data) == []
    finally:
        started.end()


def test_it_listens_on_an_address_of_ipv6(data: Path) -> None:
    started = begin(data, host="::1")
    try:
        assert started.says(f"runs at  http://[::1]:{started.port}/")
        assert started.says(READY)
        assert "200" in started.status()
    finally:
        started.end()


def test_a_port_in_use_is_told_with_another(data: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        from annotator.local import port_problem

        port = taken.getsockname()[1]
        assert f"make run PORT={port + 1}" in (port_problem("127.0.0.1", port) or "")


def test_an_address_of_another_machine_is_told_without_another_port() -> None:
    from annotator.local import port_problem

    problem = port_problem("192.0.2.1", 8000) or ""
    assert "192.0.2.1" in problem
    assert "make run" not in problem


def test_ending_the_first_start_while_it_renders_leaves_no_process(tmp_path: Path) -> None:
    started = begin(tmp_path / "data")
    try:
        assert started.says("rendering the scene"), started.log.read_text()
        assert until(lambda: len(started.parts()) >= 3, 60)
        started.process.terminate()
        assert started.process.wait(30) == 0
        assert until(lambda: not started.parts(), 5), started.parts()
    finally:
        started.end()


def test_killing_the_first_start_while_it_renders_leaves_no_process(tmp_path: Path) -> None:
    started = begin(tmp_path / "data")
    try:
        assert started.says("rendering the scene"), started.log.read_text()
        started.process.kill()
        started.process.wait()
        assert until(lambda: not started.parts(), 15), started.parts()
    finally:
        started.end()
