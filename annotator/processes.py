"""The processes of a local start: begun together, begun again when one dies, and none left behind."""

from __future__ import annotations

import ctypes
import fcntl
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

GRACE_SECONDS = 10
SHORT_LIFE = 10.0  # seconds; what dies sooner again and again is broken
MOST_SHORT_LIVES = 3
PR_SET_PDEATHSIG = 1


class AlreadyRunning(Exception):
    """Another start uses the same data; `pid` is its process."""

    def __init__(self, pid: str) -> None:
        super().__init__(pid)
        self.pid = pid


@dataclass
class Part:
    """A server of the start, and how often it ended soon after its beginning."""

    name: str
    command: list[str]
    short_lives: int = 0
    begun: float = 0.0
    process: subprocess.Popen[bytes] | None = None

    def alive(self) -> bool:
        return self.process is not None and self.process.poll() is None


@dataclass(frozen=True)
class Claim:
    """The data are ours: one lock is this process's, the other is handed on to all it starts."""

    folder: Path
    own: int = field(repr=False)
    shared: int = field(repr=False)


def claim(data: Path) -> Claim:
    """Take the data folder for this start, and end what a killed one has left on it.

    Raises AlreadyRunning.
    """
    own, shared = (
        os.open(data / name, os.O_RDWR | os.O_CREAT, 0o600) for name in ("start.lock", "parts.lock")
    )
    if not locked(own):
        raise AlreadyRunning(os.read(own, 20).decode().strip() or "?")
    os.truncate(own, 0)
    os.write(own, f"{os.getpid()}\n".encode())
    if not locked(shared):
        print("Ending what a start that was killed has left …", flush=True)
        end_holders(data / "parts.lock", lambda: locked(shared))
    return Claim(data, own, shared)


def locked(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def end_holders(lock: Path, free: Callable[[], bool]) -> None:
    """End the process groups that hold the lock open, first kindly."""
    for number, seconds in ((signal.SIGTERM, GRACE_SECONDS), (signal.SIGKILL, GRACE_SECONDS)):
        for group in holders(lock):
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(group, number)
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            if free():
                return
            time.sleep(0.1)


def holders(lock: Path) -> set[int]:
    """Process groups, but for this one's, with the file open."""
    wanted, found = lock.stat(), set()
    for folder in Path("/proc").glob("[0-9]*/fd"):
        with suppress(OSError):  # gone in the meantime, or another account's
            if any(os.path.samestat(each.stat(), wanted) for each in folder.iterdir() if each.exists()):
                found.add(os.getpgid(int(folder.parent.name)))
    return found - {os.getpgrp()}


@contextmanager
def running(claim: Claim, *parts: Part) -> Iterator[None]:
    """Run the parts, each in a session of its own, and stop all they started at the end."""
    try:
        for part in parts:
            begin(part, claim)
        yield
    finally:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN)  # a second Ctrl-C must not leave a process behind
        print("\nStopping …", flush=True)
        stop([part.process for part in parts if part.process])


def run_once(claim: Claim, command: list[str]) -> int:
    """Run a command to its end; an interruption ends it and all it started, and waits until they are gone."""
    part = Part("", command)
    begin(part, claim)
    assert part.process is not None
    try:
        return part.process.wait()
    except BaseException:
        stop([part.process], signal.SIGINT)  # a command tidies up after itself then
        raise


def begin(part: Part, claim: Claim) -> None:
    parent = os.getpid()
    libc = ctypes.CDLL(None)

    def with_parent() -> None:
        """However the start ends, its parts do too."""
        libc.prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != parent:
            os._exit(1)

    part.begun = time.monotonic()
    part.process = subprocess.Popen(
        part.command, start_new_session=True, pass_fds=[claim.shared], preexec_fn=with_parent
    )


def stop(processes: list[subprocess.Popen[bytes]], number: signal.Signals = signal.SIGTERM) -> None:
    for process in processes:
        send(process, number)
    deadline = time.monotonic() + GRACE_SECONDS
    for process in processes:
        with suppress(subprocess.TimeoutExpired):
            process.wait(max(0.1, deadline - time.monotonic()))
        # The leader may be gone while a child of it still runs.
        send(process, signal.SIGKILL)
        process.wait()


def send(process: subprocess.Popen[bytes], number: signal.Signals) -> None:
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        return


def keep_alive(claim: Claim, parts: list[Part]) -> int:
    """Begin again what dies; wait for an interruption, or for a part that dies again and again."""
    while True:
        for part in parts:
            if not part.alive() and not revive(part, claim):
                return 1
        time.sleep(0.2)


def revive(part: Part, claim: Claim) -> bool:
    assert part.process is not None
    code = part.process.returncode
    send(part.process, signal.SIGKILL)  # what it started must not work beside the next one
    soon = time.monotonic() - part.begun < SHORT_LIFE
    part.short_lives = part.short_lives + 1 if soon else 0
    if part.short_lives >= MOST_SHORT_LIVES:
        print(f"The {part.name} ends again and again, at last with {code}; stopping.", file=sys.stderr)
        return False
    print(f"The {part.name} ended with {code}; starting it again.", file=sys.stderr, flush=True)
    begin(part, claim)
    return True
