"""Everything on one machine: `python -m annotator.local` prepares and runs web server and worker.

`make run` calls it. The first start makes a secret key, the database, a staff account and the demo
scene below DATA_DIR; later starts find them there. Ctrl-C stops everything it started.
"""

from __future__ import annotations

import argparse
import errno
import hashlib
import os
import secrets
import signal
import socket
import sys
import time
from pathlib import Path
from types import FrameType
from typing import NoReturn

from annotator.private_files import keep_private
from annotator.processes import AlreadyRunning, Claim, Part, claim, keep_alive, run_once, running

STAFF_NAME = "staff"
ROOT = Path(__file__).resolve().parent.parent


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=8000)
    options = parser.parse_args()
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    data = Path(os.environ.setdefault("DATA_DIR", str(ROOT / "var")))
    keep_private(data)
    # A closed terminal or a service manager ends it as Ctrl-C does; a shell's background job starts
    # with SIGINT ignored.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    try:
        return start(options.host, options.port, data, claim(data))
    except AlreadyRunning as other:
        print(f"Ground Truth Marker runs on {data} already (process {other.pid}).", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0


def start(host: str, port: int, data: Path, claimed: Claim) -> int:
    if problem := port_problem(host, port):
        print(problem, file=sys.stderr)
        return 1
    for folder in (data / "broker" / "queue", data / "broker" / "control"):
        folder.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("SECRET_KEY", kept_secret(data / "secret-key", 64))
    if not prepare(claimed):
        return 1
    password = staff_password(data / "staff-password")
    web = Part("web server", web_command(host, port))
    worker = Part("worker", worker_command(data))
    with running(claimed, web, worker):
        if not wait_until_answering(host, port, web):
            return 1
        welcome(host, port, password)
        return keep_alive(claimed, [web, worker])


def port_problem(host: str, port: int) -> str | None:
    try:
        family, _kind, _protocol, _name, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        return f"{host} is no address of this machine ({error.strerror})."
    with socket.socket(family) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(address)
        except OSError as error:
            hint = (
                f" Try: make run PORT={port + 1}" if error.errno in {errno.EADDRINUSE, errno.EACCES} else ""
            )
            return f"Port {port} on {host} cannot be used ({error.strerror}).{hint}"
    return None


def kept_secret(path: Path, length: int) -> str:
    """The secret in the file; made on the first call, readable by its owner only."""
    if not path.exists():
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
            file.write(secrets.token_urlsafe(length))
    return path.read_text().strip()


def prepare(claimed: Claim) -> bool:
    import django
    from django.conf import settings
    from django.core.management import call_command

    django.setup()
    from gtm_hit.models import Dataset

    print("Preparing database and static files …", flush=True)
    call_command("migrate", verbosity=0)
    collect_static()
    if Dataset.objects.filter(slug=settings.TUTORIAL_DATASET).exists():
        return True
    print("Making the demo scene (once) …", flush=True)
    # A process of its own: it starts others, and all of them can be ended at once.
    command = [sys.executable, str(ROOT / "manage.py"), "makedemo", "--campaign"]
    command += ["--slug", settings.TUTORIAL_DATASET]
    return run_once(claimed, command) == 0


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
    return [sys.executable, "-m", "annotator.web_server", "--host", host, "--port", str(port)]


def worker_command(data: Path) -> list[str]:
    return [
        # As root on a fresh machine or in a container Celery would fill the screen with advice.
        *(sys.executable, "-W", "ignore:You're running the worker with superuser"),
        *("-m", "celery", "--quiet", "-A", "annotator", "worker"),
        *("--beat", "--schedule", str(data / "beat-schedule"), "--pidfile", ""),
        *("--concurrency", "1", "--loglevel", "WARNING"),
    ]


def wait_until_answering(host: str, port: int, web: Part, seconds: float = 30) -> bool:
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and web.alive():
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

    server = f"http://{shown_host(host)}:{port}"
    shown = password or "(as you chose it)"
    print(f"\nGround Truth Marker runs at  {server}{settings.SCRIPT_NAME}/\n")
    print(f"  staff login   name {STAFF_NAME}   password {shown}")
    print("  annotate at once:", flush=True)
    call_command("makelink", settings.TUTORIAL_DATASET, worker="local-annotator", base_url=server)
    print(f"  or, logged in, under “My work”:\n{server}{settings.SCRIPT_NAME}/my-work/")
    print("\nCtrl-C stops everything; data stay in", settings.DATA_DIR, "\n", flush=True)


def shown_host(host: str) -> str:
    """As it stands in addresses; what listens everywhere is reached here too."""
    host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    return f"[{host}]" if ":" in host else host


def interrupt(_number: int, _frame: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt


if __name__ == "__main__":
    sys.exit(main())
