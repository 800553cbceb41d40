"""Everything on one machine: `python -m annotator.local` prepares and runs web server and worker.

`make run` calls it. The first start makes a secret key, the database, a staff account and the demo
scene below DATA_DIR; later starts find them there. Ctrl-C stops everything it started.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import secrets
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType
from typing import NoReturn

STAFF_NAME = "staff"
GRACE_SECONDS = 10


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=8000)
    options = parser.parse_args()
    if problem := port_problem(options.host, options.port):
        print(problem, file=sys.stderr)
        return 1
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    data = Path(os.environ.setdefault("DATA_DIR", str(Path(__file__).resolve().parent.parent / "var")))
    for folder in (data, data / "broker" / "queue", data / "broker" / "control"):
        folder.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("SECRET_KEY", kept_secret(data / "secret-key", 64))
    prepare()
    password = staff_password(data / "staff-password")
    # A closed terminal or a service manager ends it as Ctrl-C does; a shell's background job starts
    # with SIGINT ignored.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    try:
        with running(web_command(options.host, options.port), worker_command(data)) as processes:
            if not wait_until_answering(options.host, options.port, processes[0]):
                return 1
            welcome(options.host, options.port, password)
            return wait(processes)
    except KeyboardInterrupt:
        return 0


def port_problem(host: str, port: int) -> str | None:
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except OSError as error:
            return f"Port {port} on {host} cannot be used ({error.strerror}). Try: make run PORT={port + 1}"
    return None


def kept_secret(path: Path, length: int) -> str:
    """The secret in the file; made on the first call, readable by its owner only."""
    if not path.exists():
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
            file.write(secrets.token_urlsafe(length))
    return path.read_text().strip()


def prepare() -> None:
    import django
    from django.conf import settings
    from django.core.management import call_command

    django.setup()
    from gtm_hit.models import Dataset

    print("Preparing database and static files …", flush=True)
    call_command("migrate", verbosity=0)
    collect_static()
    if not Dataset.objects.filter(slug=settings.TUTORIAL_DATASET).exists():
        print("Making the demo scene (once) …", flush=True)
        call_command("makedemo", slug=settings.TUTORIAL_DATASET)


def collect_static() -> None:
    """Hash and compress the static files, unless they are those of the start before."""
    from django.conf import settings
    from django.contrib.staticfiles.finders import get_finders
    from django.core.management import call_command

    digest = hashlib.sha256()
    for finder in get_finders():
        for name, storage in finder.list([]):
            file = Path(storage.path(name)).stat()
            digest.update(f"{name} {file.st_size} {file.st_mtime_ns}\n".encode())
    stamp = Path(settings.STATIC_ROOT) / "collected"
    if stamp.exists() and stamp.read_text() == digest.hexdigest():
        return
    call_command("collectstatic", interactive=False, clear=True, verbosity=0)
    stamp.write_text(digest.hexdigest())


def staff_password(path: Path) -> str | None:
    """The generated password of the staff account, or None when somebody has chosen another."""
    from django.contrib.auth import get_user_model

    users = get_user_model().objects
    password = kept_secret(path, 12)
    user = users.filter(username=STAFF_NAME).first()
    if user is None:
        users.create_superuser(STAFF_NAME, password=password)
        return password
    return password if user.check_password(password) else None


def web_command(host: str, port: int) -> list[str]:
    """One process: SQLite has one writer anyway, and threads wait for the network side by side."""
    return [
        *(sys.executable, "-m", "gunicorn", "annotator.wsgi"),
        *("--bind", f"{host}:{port}", "--worker-class", "gthread", "--threads", "8"),
        *("--log-level", "warning", "--graceful-timeout", "5"),
    ]


def worker_command(data: Path) -> list[str]:
    return [
        # As root on a fresh machine or in a container Celery would fill the screen with advice.
        *(sys.executable, "-W", "ignore:You're running the worker with superuser"),
        *("-m", "celery", "--quiet", "-A", "annotator", "worker"),
        *("--beat", "--schedule", str(data / "beat-schedule"), "--pidfile", ""),
        *("--concurrency", "1", "--loglevel", "WARNING"),
    ]


@contextmanager
def running(*commands: list[str]) -> Iterator[list[subprocess.Popen[bytes]]]:
    """Run the commands, each in a session of its own, and stop all they started at the end."""
    processes: list[subprocess.Popen[bytes]] = []
    try:
        for command in commands:
            processes.append(subprocess.Popen(command, start_new_session=True))
        yield processes
    finally:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_IGN)  # a second Ctrl-C must not leave a process behind
        print("\nStopping …", flush=True)
        for process in processes:
            send(process, signal.SIGTERM)
        deadline = time.monotonic() + GRACE_SECONDS
        for process in processes:
            with suppress(subprocess.TimeoutExpired):
                process.wait(max(0.1, deadline - time.monotonic()))
            # The leader may be gone while a child of it still runs.
            send(process, signal.SIGKILL)


def send(process: subprocess.Popen[bytes], number: signal.Signals) -> None:
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        return


def wait_until_answering(host: str, port: int, web: subprocess.Popen[bytes], seconds: float = 30) -> bool:
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and web.poll() is None:
        try:
            with socket.create_connection((host, port), timeout=1):
                return True
        except OSError:
            time.sleep(0.1)
    print("The web server did not start; its messages are above.", file=sys.stderr)
    return False


def welcome(host: str, port: int, password: str | None) -> None:
    from django.conf import settings
    from django.core.management import call_command

    base = f"http://{'127.0.0.1' if host == '0.0.0.0' else host}:{port}"
    shown = password or "(as you chose it)"
    print(f"\nGround Truth Marker runs at  {base}/\n")
    print(f"  staff login   name {STAFF_NAME}   password {shown}")
    print("  annotate at once:", flush=True)
    call_command("makelink", settings.TUTORIAL_DATASET, worker="local-annotator", base_url=base)
    print("\nCtrl-C stops everything; data stay in", settings.DATA_DIR, "\n", flush=True)


def wait(processes: list[subprocess.Popen[bytes]]) -> int:
    """Wait for an interruption; a server that dies by itself ends the wait too."""
    while True:
        for process in processes:
            if process.poll() is not None:
                print(f"{process.args!r} ended with {process.returncode}; stopping.", file=sys.stderr)
                return 1
        time.sleep(0.2)


def interrupt(_number: int, _frame: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt


if __name__ == "__main__":
    sys.exit(main())
