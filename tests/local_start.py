"""A whole local start in processes of its own, on a small dataset."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import REPOSITORY
from tests.services import free_port

SEED = "from tests.work_scene import make_dataset; make_dataset('demo')"


def environment(data: Path, **variables: str) -> dict[str, str]:
    return {"PATH": os.environ["PATH"], "DATA_DIR": str(data), "PYTHONUNBUFFERED": "1", **variables}


def prepared(data: Path) -> None:
    """The dataset is there, so that no start has to render the demo scene."""
    for arguments in (["migrate", "-v0"], ["shell", "-v0", "-c", SEED]):
        subprocess.run(
            [sys.executable, "manage.py", *arguments],
            cwd=REPOSITORY,
            env=environment(data, SECRET_KEY="s" * 50),
            check=True,
        )


@dataclass
class Start:
    data: Path
    host: str
    port: int
    process: subprocess.Popen[bytes]
    log: Path

    def says(self, text: str, seconds: float = 90) -> bool:
        return until(lambda: text in self.log.read_text(encoding="utf-8"), seconds)

    def connect(self) -> socket.socket:
        return socket.create_connection((self.host, self.port), timeout=30)

    def status(self, path: str = "/login/") -> str:
        """The first line of the answer."""
        with self.connect() as connection:
            connection.sendall(f"GET {path} HTTP/1.0\r\nHost: localhost\r\n\r\n".encode())
            return connection.recv(4096).decode("latin-1").split("\r\n")[0]

    def parts(self) -> list[int]:
        """All processes that hold the data."""
        return [pid for pid in all_processes() if pid != self.process.pid and self._uses_data(pid)]

    def part(self, word: str) -> int | None:
        """The first process of the start whose command has the word; None while there is none."""
        return min((pid for pid in self.parts() if word in command(pid)), default=None)

    def _uses_data(self, pid: int) -> bool:
        try:
            return f"DATA_DIR={self.data}".encode() in Path(f"/proc/{pid}/environ").read_bytes()
        except OSError:
            return False

    def end(self) -> None:
        self.process.terminate()
        try:
            self.process.wait(30)
        finally:
            for pid in self.parts():
                os.kill(pid, signal.SIGKILL)


def begin(data: Path, host: str = "127.0.0.1", **variables: str) -> Start:
    port = free_port()
    data.mkdir(exist_ok=True)
    log = data.parent / f"{data.name}-{port}.log"
    with log.open("wb") as output:
        process = subprocess.Popen(
            [sys.executable, "-m", "annotator.local", "--host", host, "--port", str(port)],
            cwd=REPOSITORY,
            env=environment(data, **variables),
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    return Start(data, host, port, process, log)


def until(holds: Callable[[], object], seconds: float) -> bool:
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if holds():
            return True
        time.sleep(0.1)
    return False


def all_processes() -> list[int]:
    return [int(folder.name) for folder in Path("/proc").glob("[0-9]*")]


def command(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace")
    except OSError:
        return ""
