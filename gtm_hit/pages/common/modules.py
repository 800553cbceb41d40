"""Which modules of the browser's program a page will need, so that it can name them all at once."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from posixpath import dirname, join, normpath

from django.conf import settings
from django.contrib.staticfiles import finders

IMPORTED = re.compile(r"""^(?:import|export)\b[^;]*?\bfrom\s*"(\.[^"]+)";""", re.MULTILINE)


def imported_by(module: str) -> list[str]:
    """Static names of a module's imports, of their imports, and so on; the nearest first, itself left out.

    Without them in the page, a browser finds out about each layer of modules only from the one before it.
    """
    return _read(module) if settings.DEBUG else _remembered(module)


def _read(module: str) -> list[str]:
    found = [module]
    for name in found:  # grows on the way
        found += [one for one in _imports(name) if one not in found]
    return found[1:]


_remembered = cache(_read)


def _imports(module: str) -> list[str]:
    path = finders.find(module)
    if path is None:
        return []  # the browser will say what is missing
    named = IMPORTED.findall(Path(str(path)).read_text(encoding="utf-8"))
    return list(dict.fromkeys(normpath(join(dirname(module), name)) for name in named))
