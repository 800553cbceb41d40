"""`ba_problem.txt`: a bundle adjustment as a program published with WILDTRACK reads and writes it.

    cameras points fixed_points observations fixed_observations
    camera point x y            one line an observation of a free point
    camera point x y            … then of the fixed points, whose numbers start at 0 again
    15 numbers a camera         rvec (3) tvec (3) fx fy cx cy k1 k2 k3 p1 p2
    3 numbers a point           the free ones, then the fixed ones

Numbers are separated by any white space. Pixels are those of the picture as taken. The order of the lens is
not OpenCV's, which is k1 k2 p1 p2 k3. Lengths have no unit in the file; WILDTRACK's are centimetres. Neither
the size of the pictures nor the cameras' names are told.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gtm_hit.formats.annotations.delimited_text import real, whole
from gtm_hit.formats.files import read_source, write_bytes
from gtm_hit.formats.problems import FormatError, Problem, ProblemList

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_BYTES = 200_000_000
MOST_COUNTED = 10_000_000
PER_METRE = {"m": 1.0, "cm": 100.0, "mm": 1000.0}
HEADER = ("cameras", "points", "fixed points", "observations", "observations of fixed points")
CAMERA_NUMBERS = 15
FILE_ORDER = (
    0,
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    8,
    9,
    10,
    11,
    14,
    12,
    13,
)  # of OpenCV's order, the file's place by place
FARTHEST = 1e5  # pixels: what lies farther out was not clicked but came out of a broken computation


@dataclass(frozen=True, eq=False)
class Sightings:
    """Which camera saw which point where: N observations."""

    cameras: Ints  # (N,) places in the list of cameras
    points: Ints  # (N,) places in the list of points
    pixels: Floats  # (N, 2)


@dataclass(frozen=True, eq=False)
class BaProblem:
    """What such a file holds, lengths in metres, the lens in OpenCV's order."""

    cameras: Floats  # (C, 15) rvec tvec fx fy cx cy k1 k2 p1 p2 k3
    points: Floats  # (P, 3)
    fixed_points: Floats  # (F, 3)
    seen: Sightings  # of `points`
    fixed_seen: Sightings  # of `fixed_points`


def read_ba_problem(path: Path, unit: str = "cm") -> BaProblem:
    """FormatError with everything that is wrong, each with its line."""
    return parse_ba_problem(read_source(path, MOST_BYTES), str(path), unit)


def parse_ba_problem(data: bytes, path: str, unit: str = "cm") -> BaProblem:
    """As `read_ba_problem`, `path` being what problems are reported under."""
    problems = ProblemList(path)
    words = _Words(data, problems)
    counts = words.header()
    words.check_count(counts)
    cameras, points, fixed, seen, fixed_seen = counts
    free_sightings = words.sightings(seen, cameras, points)
    fixed_sightings = words.sightings(fixed_seen, cameras, fixed)
    camera_numbers = words.reals(cameras * CAMERA_NUMBERS, "a camera's number").reshape(-1, CAMERA_NUMBERS)
    free_points = words.reals(points * 3, "a point's coordinate").reshape(-1, 3)
    fixed_points = words.reals(fixed * 3, "a fixed point's coordinate").reshape(-1, 3)
    problems.raise_if_any()
    metres = _in_opencvs_order(camera_numbers)
    metres[:, 3:6] /= PER_METRE[unit]
    scale = PER_METRE[unit]
    return BaProblem(metres, free_points / scale, fixed_points / scale, free_sightings, fixed_sightings)


def write_ba_problem(path: Path, problem: BaProblem, unit: str = "cm") -> None:
    """Write it so that `read_ba_problem` gives the same numbers back, lengths to 15 digits."""
    write_bytes(path, ba_problem_text(problem, unit).encode())


def ba_problem_text(problem: BaProblem, unit: str = "cm") -> str:
    scale = PER_METRE[unit]
    counts = (
        len(problem.cameras),
        len(problem.points),
        len(problem.fixed_points),
        len(problem.seen.pixels),
        len(problem.fixed_seen.pixels),
    )
    lines = [" ".join(map(str, counts))]
    for seen in (problem.seen, problem.fixed_seen):
        columns = (seen.cameras.tolist(), seen.points.tolist(), seen.pixels.tolist())
        lines += [f"{camera} {point} {x!r} {y!r}" for camera, point, (x, y) in zip(*columns, strict=True)]
    for camera in problem.cameras[:, FILE_ORDER].tolist():
        lines += [repr(value) for value in camera[:3]]
        lines += [_length(value * scale) for value in camera[3:6]]
        lines += [repr(value) for value in camera[6:]]
    for points in (problem.points, problem.fixed_points):
        lines += [_length(value * scale) for value in points.ravel().tolist()]
    return "\n".join(lines) + "\n"


def _length(value: float) -> str:
    """15 digits: 5.58 m are 558 cm, not 558.0000000000001."""
    return repr(float(f"{value:.15g}"))


def _in_opencvs_order(cameras: Floats) -> Floats:
    ordered = np.empty_like(cameras)
    ordered[:, FILE_ORDER] = cameras
    return ordered


class _Words:
    """The file word by word, each with the number of its line."""

    def __init__(self, data: bytes, problems: ProblemList) -> None:
        self.problems = problems
        self.count = len(data.split())
        self.words = _numbered(data)

    def header(self) -> list[int]:
        counts = [self._whole(name, MOST_COUNTED) for name in HEADER]
        if not self.problems and not counts[0]:
            self.problems.add("line 1", "the file has no camera")
        self.problems.raise_if_any()
        return counts

    def check_count(self, counts: list[int]) -> None:
        """Too few or too many numbers shift everything after them: nothing else is worth saying then."""
        cameras, points, fixed, seen, fixed_seen = counts
        wanted = len(HEADER) + 4 * (seen + fixed_seen) + CAMERA_NUMBERS * cameras + 3 * (points + fixed)
        if self.count != wanted:
            reason = (
                f"its first line announces {cameras} cameras, {points} + {fixed} points and "
                f"{seen} + {fixed_seen} observations, which makes {wanted} numbers; there are {self.count}"
            )
            raise FormatError([Problem(self.problems.path, "line 1", reason)])

    def sightings(self, count: int, cameras: int, points: int) -> Sightings:
        numbers: list[tuple[int, int]] = []
        pixels: list[tuple[float, float]] = []
        first: dict[tuple[int, int], int] = {}
        for _ in range(count):
            camera = self._whole("the camera", cameras - 1)
            point = self._whole("the point", points - 1)
            line = self.line
            pixels.append((self._pixel("x"), self._pixel("y")))
            numbers.append((camera, point))
            before = first.setdefault((camera, point), line)
            if before != line and not self.problems:
                reason = f"camera {camera} saw point {point} already in line {before}"
                self.problems.add(f"line {line}", reason)
        pairs = np.array(numbers, dtype=np.int64).reshape(-1, 2)
        return Sightings(pairs[:, 0], pairs[:, 1], np.array(pixels, dtype=np.float64).reshape(-1, 2))

    def reals(self, count: int, name: str) -> Floats:
        return np.array([self._real(name) for _ in range(count)], dtype=np.float64)

    def _pixel(self, name: str) -> float:
        value = self._real(name)
        if abs(value) > FARTHEST:
            self.problems.add(f"line {self.line}", f"{name} is {value:g} pixels, which is in no picture")
        return value

    def _real(self, name: str) -> float:
        self.line, word = next(self.words, (0, ""))
        return real(word, name, self.line, self.problems)

    def _whole(self, name: str, most: int) -> int:
        self.line, word = next(self.words, (1, ""))
        return whole(word, name, 0, self.line, self.problems, most)


def _numbered(data: bytes) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(data.splitlines(), start=1):
        for word in line.split():
            yield number, word.decode("ascii", "backslashreplace")
