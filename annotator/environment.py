"""Typed reading of environment variables; a wrong value names its variable."""

from __future__ import annotations

import ipaddress
import os
import re
from urllib.parse import unquote, urlsplit

from django.core.exceptions import ImproperlyConfigured


def text(name: str, default: str | None = None) -> str:
    value = os.environ.get(name, "") or default
    if value is None:
        raise ImproperlyConfigured(f"{name} must be set (see .env.example)")
    return value


def boolean(name: str, default: bool) -> bool:
    value = os.environ.get(name, "").strip().lower()
    if not value:
        return default
    if value in {"1", "true", "yes", "on"}:
        return True
    if value in {"0", "false", "no", "off"}:
        return False
    raise ImproperlyConfigured(f"{name} must be one of true, false; got {value!r}")


def integer(name: str, default: int, *, minimum: int, maximum: int) -> int:
    value = os.environ.get(name, "").strip()
    if not value:
        return default
    try:
        number = int(value)
    except ValueError:
        raise ImproperlyConfigured(f"{name} must be a whole number; got {value!r}") from None
    if not minimum <= number <= maximum:
        raise ImproperlyConfigured(f"{name} must lie between {minimum} and {maximum}; got {number}")
    return number


def one_of(name: str, default: str, choices: tuple[str, ...]) -> str:
    value = os.environ.get(name, "") or default
    if value not in choices:
        raise ImproperlyConfigured(f"{name} must be one of {', '.join(choices)}; got {value!r}")
    return value


def starting_with(name: str, default: str, prefixes: tuple[str, ...]) -> str:
    value = os.environ.get(name, "") or default
    if not value.startswith(prefixes):
        raise ImproperlyConfigured(f"{name} must start with one of {', '.join(prefixes)}; got {value!r}")
    return value


def words(name: str, default: str) -> list[str]:
    return [word for word in (os.environ.get(name, "") or default).replace(",", " ").split() if word]


def networks(name: str, default: str) -> list[ipaddress.IPv4Network | ipaddress.IPv6Network]:
    """Addresses and networks, `10.0.0.7 172.16.0.0/12`."""
    try:
        return [ipaddress.ip_network(word) for word in words(name, default)]
    except ValueError as error:
        raise ImproperlyConfigured(f"{name} must be a list of addresses and networks: {error}") from None


def path_prefix(name: str) -> str:
    """`/gtm` or nothing: what stands before every path."""
    value = os.environ.get(name, "").rstrip("/")
    if value and not re.fullmatch(r"(/[A-Za-z0-9._~-]+)+", value):
        raise ImproperlyConfigured(f"{name} must look like /gtm; got {value!r}")
    return value


def database(name: str, default: str, password: str = "") -> dict[str, object]:
    """Django's database entry for `sqlite:///path` or `postgres://user:password@host:port/name`.

    `password` is for an address that has none; it is taken as it is.
    """
    url = text(name, default)
    parts = urlsplit(url)
    if parts.scheme == "sqlite":
        # FULL: what was acknowledged outlives a power cut; the browser forgets it then.
        # IMMEDIATE: a transaction that will write takes the lock at its start and waits for it,
        # instead of failing half-way with "database is locked".
        return {
            "ENGINE": "django.db.backends.sqlite3",
            "NAME": unquote(parts.path.removeprefix("/")) or ":memory:",
            "OPTIONS": {
                "timeout": 20,
                "transaction_mode": "IMMEDIATE",
                "init_command": "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;",
            },
        }
    if parts.scheme in {"postgres", "postgresql"}:
        # A password with one of these ends where it should not, and its rest becomes host or database.
        if (
            parts.netloc.count("@") > 1
            or set(parts.path.lstrip("/")) & set("/@:")
            or parts.query
            or parts.fragment
        ):
            raise ImproperlyConfigured(
                f"{name}: in a password write @ as %40, / as %2F, : as %3A, ? as %3F, # as %23;"
                " or leave it out and set DATABASE_PASSWORD"
            )
        try:
            port = parts.port
        except ValueError:
            raise ImproperlyConfigured(f"{name} has an unreadable port") from None
        return {
            "ENGINE": "django.db.backends.postgresql",
            "NAME": unquote(parts.path.lstrip("/")),
            "USER": unquote(parts.username or ""),
            "PASSWORD": unquote(parts.password or "") or password,
            "HOST": parts.hostname or "",
            "PORT": str(port or ""),
            "CONN_MAX_AGE": 60,
            "CONN_HEALTH_CHECKS": True,
        }
    raise ImproperlyConfigured(f"{name} must start with sqlite:/// or postgres://; got {parts.scheme!r}")
