"""The description of the demo scene, read from its fixture."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gtm_hit.demo.arrays import Flags, Floats
from gtm_hit.geometry.grid import Grid

FIXTURE = Path(__file__).resolve().parent.parent.parent / "fixtures" / "demo_scene.json"


class SceneError(ValueError):
    """A scene description that cannot be drawn; says which entry."""


@dataclass(frozen=True)
class Area:
    """A rectangle on the ground, metres."""

    west: float
    east: float
    south: float
    north: float

    def contains(self, xy: Floats) -> Flags:
        x, y = xy[..., 0], xy[..., 1]
        return (x >= self.west) & (x <= self.east) & (y >= self.south) & (y <= self.north)


@dataclass(frozen=True)
class Crowd:
    walkers: int
    crossing: int  # how many of the walkers enter or leave the grid
    pairs: int
    standing_groups: tuple[int, ...]
    standing_alone: int
    keep_clear: tuple[tuple[float, float, float], ...]  # x, y, radius around the cameras' posts
    core: Area  # where at least three cameras see a person

    @property
    def people(self) -> int:
        return self.walkers + 2 * self.pairs + sum(self.standing_groups) + self.standing_alone


@dataclass(frozen=True)
class Paving:
    field: float  # metres between bands
    band: float  # width of a band
    course: float  # width of a course of slabs
    slab: float  # length of a slab
    joint: float
    rose: tuple[float, float, float]  # x, y, radius of the inlay
    covers: tuple[tuple[float, float], ...]
    light_wells: tuple[tuple[float, float, float, float], ...]  # x0, y0, x1, y1
    drain_x: float
    west: float
    south: float
    north: float


@dataclass(frozen=True)
class Steps:
    x: float  # of the lowest riser
    count: int
    tread: float
    rise: float
    south: float
    north: float

    @property
    def landing(self) -> float:
        return self.count * self.rise


@dataclass(frozen=True)
class Hall:
    """The stone building at the top of the steps; its front faces west."""

    x: float
    south: float
    north: float
    height: float
    bay: float


@dataclass(frozen=True)
class Terrace:
    """A row of houses whose fronts run from (x0, y0) to (x1, y1)."""

    x0: float
    y0: float
    x1: float
    y1: float
    height: float
    bay: float
    tint: tuple[float, float, float]


@dataclass(frozen=True)
class Furniture:
    planters: tuple[tuple[float, float], ...]
    benches: tuple[tuple[float, float, float], ...]  # x, y, degrees
    bins: tuple[tuple[float, float], ...]
    lamps: tuple[tuple[float, float], ...]
    trees: tuple[tuple[float, float], ...]
    parasols: tuple[tuple[float, float, str], ...]  # x, y, colour
    bollards: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Mood:
    """How one camera's picture differs from its neighbours'."""

    exposure: float
    balance: tuple[float, float, float]


@dataclass(frozen=True)
class Scene:
    seed: int
    width: int
    height: int
    frame_count: int
    number_step: int
    numbers_per_second: float
    grid: Grid
    crowd: Crowd
    sun: tuple[float, float, float]  # unit vector towards the sun
    paving: Paving
    steps: Steps
    hall: Hall
    terraces: tuple[Terrace, ...]
    parapet: tuple[float, float]  # x and height
    furniture: Furniture
    moods: tuple[Mood, ...]

    @property
    def frame_numbers(self) -> list[int]:
        return [index * self.number_step for index in range(self.frame_count)]

    def rng(self, *topic: int) -> np.random.Generator:
        """Independent randomness per topic, so that pictures can be made in any order."""
        return np.random.default_rng((self.seed, *topic))


def read_scene(path: Path = FIXTURE) -> Scene:
    """Scene of a description file; SceneError names the entry that is missing or impossible."""
    try:
        return _scene(json.loads(path.read_text(encoding="utf-8")))
    except KeyError as error:
        raise SceneError(f"{path.name}: entry {error} is missing") from error
    except (TypeError, ValueError) as error:
        raise SceneError(f"{path.name}: {error}") from error


def _scene(data: dict[str, Any]) -> Scene:
    frames, moods = data["frames"], data["moods"]
    if frames["count"] < 1:
        raise SceneError(f"frames.count must be at least 1, not {frames['count']}")
    return Scene(
        seed=int(data["seed"]),
        width=data["image"]["width"],
        height=data["image"]["height"],
        frame_count=frames["count"],
        number_step=frames["number_step"],
        numbers_per_second=frames["numbers_per_second"],
        grid=Grid(**data["grid"]),
        crowd=_crowd(data["crowd"]),
        sun=_sun(**data["sun"]),
        paving=_paving(data["paving"]),
        steps=Steps(**data["steps"]),
        hall=Hall(**data["hall"]),
        terraces=tuple(Terrace(**{**row, "tint": tuple(row["tint"])}) for row in data["terraces"]),
        parapet=(data["parapet"]["x"], data["parapet"]["height"]),
        furniture=_furniture(data),
        moods=tuple(Mood(row["exposure"], tuple(row["balance"])) for row in moods),
    )


def _crowd(row: dict[str, Any]) -> Crowd:
    made = {
        "standing_groups": tuple(row["standing_groups"]),
        "keep_clear": _rows(row["keep_clear"]),
        "core": Area(**row["core"]),
    }
    crowd = Crowd(**{**row, **made})
    if crowd.crossing > crowd.walkers:
        raise SceneError(f"crowd.crossing must not exceed crowd.walkers, {crowd.walkers}")
    return crowd


def _sun(towards_x: float, towards_y: float, elevation_degrees: float) -> tuple[float, float, float]:
    if not 5 <= elevation_degrees <= 85:
        raise SceneError(f"sun.elevation_degrees must be within 5…85, not {elevation_degrees}")
    flat = math.cos(math.radians(elevation_degrees)) / math.hypot(towards_x, towards_y)
    return towards_x * flat, towards_y * flat, math.sin(math.radians(elevation_degrees))


def _paving(row: dict[str, Any]) -> Paving:
    rose = row["rose"]
    made = {
        "rose": (rose["x"], rose["y"], rose["radius"]),
        "covers": _rows(row["covers"]),
        "light_wells": _rows(row["light_wells"]),
    }
    return Paving(**{**row, **made})


def _furniture(data: dict[str, Any]) -> Furniture:
    kinds = ("planters", "benches", "bins", "lamps", "trees", "parasols")
    line = data["bollards"]
    xs = np.arange(line["x0"], line["x1"], line["spacing"])
    return Furniture(
        **{kind: _rows(data[kind]) for kind in kinds},
        bollards=tuple((float(x), float(line["y"])) for x in xs),
    )


def _rows(rows: list[list[Any]]) -> tuple[Any, ...]:
    return tuple(tuple(row) for row in rows)
