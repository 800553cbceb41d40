from __future__ import annotations

import json
import math
from typing import Any

from gtm_hit.formats.problems import FormatError, Problem, shown


def parse_json(data: bytes, path: str) -> Any:
    """The value of a JSON text without NaN, infinities and numbers too large to be finite.

    Raises FormatError for these and for what is not JSON.
    """
    try:
        return json.loads(data, parse_constant=_refuse_constant, parse_float=_finite)
    except (ValueError, RecursionError) as error:
        raise FormatError([Problem(path, "", f"not JSON that can be read: {shown(str(error))}")]) from error


def json_text(data: bytes, path: str) -> str:
    """The text of a JSON file in any of the encodings JSON knows. Raises FormatError."""
    try:
        return data.decode(json.detect_encoding(data))
    except ValueError as error:
        raise FormatError([Problem(path, "", f"not JSON that can be read: {shown(str(error))}")]) from error


def _refuse_constant(word: str) -> None:
    raise ValueError(f"{word} is not a number")


def _finite(word: str) -> float:
    value = float(word)
    if not math.isfinite(value):
        raise ValueError(f"{word[:40]} is too large")
    return value


DECODER = json.JSONDecoder(parse_constant=_refuse_constant, parse_float=_finite)
