"""Colours of clothes, skin and hair as small pictures that are stretched over the body's surfaces.

Rows run from the first ring of a surface to its last, columns around it: back, right, front, left, back.
Pictures of a look are made once and shared, so whoever takes one must not change it.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from gtm_hit.demo.arrays import Floats, Indices
from gtm_hit.demo.noise import cloudy
from gtm_hit.demo.wardrobe import Look, Pattern

ROWS, COLUMNS = 96, 96
FRONT = COLUMNS // 2


@lru_cache(maxsize=1)
def _folds() -> tuple[Floats, Floats]:
    rng = np.random.default_rng(20)
    return cloudy(rng, (256, 256), 1.55, 0.45), cloudy(rng, (256, 256), 0.4)


def plain(colour: Floats, seed: int, folds: float = 0.16, weave: float = 0.03) -> Floats:
    """A cloth with soft folds, drawn out along the surface."""
    return (_tone(seed, folds, weave) * colour).astype(np.float32)


@lru_cache(maxsize=1024)
def _tone(seed: int, folds: float, weave: float) -> Floats:
    rng = np.random.default_rng(seed)
    down, across = rng.integers(0, 160, 2)
    wrinkles, threads = (texture[down : down + ROWS, across : across + COLUMNS] for texture in _folds())
    # The back column and its copy meet: fade the folds out there, or a seam shows.
    fade = np.maximum(np.sin(np.linspace(0, np.pi, COLUMNS)), 0) ** 0.35
    return np.exp(folds * wrinkles * fade + weave * threads).astype(np.float32)[..., None]


@lru_cache(maxsize=256)
def trousers(look: Look, bare_from: float) -> Floats:
    """Legs from the hip down; skin from the share `bare_from` of the length on."""
    cloth = plain(look.bottom_colour, look.seed + 1, 0.19)
    rows = np.arange(ROWS)
    cloth[:, [COLUMNS // 4, COLUMNS // 4 + 1]] *= 0.82  # seams
    cloth[:, [3 * COLUMNS // 4, 3 * COLUMNS // 4 + 1]] *= 0.82
    cloth[int(ROWS * 0.46) : int(ROWS * 0.52)] *= 0.9  # creases behind and above the knee
    bare = rows >= bare_from * ROWS
    cloth[bare] = plain(look.skin, look.seed + 2, 0.03, 0.01)[bare]
    edge = int(bare_from * ROWS)
    if 2 < edge < ROWS:
        cloth[edge - 2 : edge] *= 0.7
    return cloth


@lru_cache(maxsize=256)
def sleeve(look: Look, bare_from: float) -> Floats:
    """Arms from the shoulder down."""
    cloth = _patterned(look, plain(look.top_colour, look.seed + 3, 0.18), 5.0)
    edge = int(bare_from * ROWS)
    cloth[edge:] = plain(look.skin, look.seed + 4, 0.03, 0.01)[edge:]
    cloth[edge - 2 : edge] *= 0.75
    return cloth


@lru_cache(maxsize=256)
def upper_body(look: Look, straps: bool) -> Floats:
    """From the hem (row 0) up to the neck."""
    cloth = _patterned(look, plain(look.top_colour, look.seed + 5), 9.0)
    rows, columns = np.mgrid[0:ROWS, 0:COLUMNS]
    off = np.abs(columns - FRONT)
    if look.open_front:
        gap = 4.0 + 7.0 * (rows / ROWS) ** 1.5
        cloth[off < gap] = plain(look.under_colour, look.seed + 6)[off < gap]
        cloth[(off >= gap) & (off < gap + 1.6)] *= 0.5
    elif look.top.value in ("shirt", "jacket", "coat"):
        cloth[(off < 1) & (rows < ROWS - 8)] *= 0.55
    _collar(look, cloth, rows, off)
    if look.pattern is Pattern.PRINT:
        badge = (np.abs(rows - 56) < 12) & (off < 9)
        cloth[badge] = 0.25 * cloth[badge] + 0.75 * look.under_colour
    if straps:
        strap = (np.abs(off - 15) < 3) & (rows > 38)
        cloth[strap] = look.bag_colour * 0.9
    cloth[:3] *= 0.72
    return cloth


def _collar(look: Look, cloth: Floats, rows: Indices, off: Indices) -> None:
    depth = {"t-shirt": 5, "shirt": 12, "jacket": 10, "coat": 16}[look.top.value]
    neckline = (rows - (ROWS - depth)) * (11 / depth)
    opening = (rows > ROWS - depth) & (off < np.maximum(neckline, 0))
    cloth[opening] = look.skin * 0.92 if look.top.value in ("t-shirt", "shirt") else look.under_colour
    edge = (rows > ROWS - depth - 3) & ~opening & (off < np.maximum(neckline, 0) + 4)
    cloth[edge] *= 0.78


def _patterned(look: Look, cloth: Floats, repeats: float) -> Floats:
    rows, columns = np.mgrid[0:ROWS, 0:COLUMNS]
    if look.pattern is Pattern.STRIPES:
        cloth[np.sin(rows / ROWS * 2 * np.pi * repeats) > 0.25] *= _contrast(look.top_colour)
    if look.pattern is Pattern.CHECK:
        for wave in (rows / ROWS * repeats, columns / COLUMNS * 16):
            cloth[np.sin(wave * 2 * np.pi) > 0.5] *= 0.62
    return cloth


def _contrast(colour: Floats) -> Floats:
    """Factor that turns a dark cloth's stripes light and a light one's dark."""
    stripe = np.array([0.62, 0.60, 0.56]) if colour.mean() < 0.25 else np.array([0.03, 0.05, 0.12])
    return (stripe / np.maximum(colour, 0.01)).astype(np.float32)


@lru_cache(maxsize=256)
def face(look: Look) -> Floats:
    """The head from the chin (row 0) to the crown; rows are 2.5 mm, columns 3.75 degrees."""
    picture = np.broadcast_to(look.skin, (ROWS, COLUMNS, 3)).astype(np.float32).copy()
    rows, columns = np.mgrid[0:ROWS, 0:COLUMNS].astype(np.float32)
    off = np.abs(columns - FRONT)

    def spot(row: float, column: float, height: float, width: float) -> Floats:
        bump = np.exp(-(((rows - row) / height) ** 2) - (((off - column) / width) ** 2))
        return bump[..., None].astype(np.float32)

    warm = np.array([1.0, 0.72, 0.66], dtype=np.float32)
    picture *= 1 - (1 - warm) * 0.35 * (spot(38, 8, 7, 4) + spot(42, 0, 4, 2))
    if look.beard:
        jaw = np.clip((34 - rows + 0.25 * off) / 5, 0, 1) * np.clip((27 - off) / 4, 0, 1)
        jaw *= 1 - np.exp(-(((rows - 27) / 2.2) ** 2) - ((off / 3.5) ** 2))
        picture += (look.hair_colour - picture) * (0.8 * jaw[..., None]).astype(np.float32)
    picture *= 1 - 0.45 * spot(53, 6, 4, 3.4)  # sockets
    picture *= 1 - 0.8 * spot(53, 6, 1.5, 1.7)  # eyes
    picture += (look.hair_colour - picture) * 0.75 * np.minimum(spot(59.5, 6.3, 1.4, 3.2), 1)  # brows
    lips = np.array([0.62, 0.36, 0.34], dtype=np.float32)
    picture *= 1 - (1 - lips) * spot(27, 0, 1.8, 4)
    picture *= 1 - 0.35 * spot(36, 2, 1.5, 1.6)  # under the nose
    if look.glasses:
        rim = np.maximum(spot(53, 6, 3.4, 3.6) - 0.25, 0) * 1.2
        picture *= 1 - 0.85 * np.minimum(rim, 1)
    return np.maximum(picture, 0.004)


def hair(colour: Floats, seed: int) -> Floats:
    strands = plain(colour, seed, 0.22, 0.12)
    return strands


@lru_cache(maxsize=256)
def shoe(look: Look) -> Floats:
    """From heel to toe; the sole is where the columns meet."""
    picture = plain(look.shoe_colour, look.seed + 8, 0.06)
    around = np.abs(np.arange(COLUMNS) - FRONT)
    sole = np.array([0.72, 0.71, 0.68]) if look.pale_soles else np.array([0.03, 0.03, 0.03])
    picture[:, around > COLUMNS * 0.31] = sole
    picture[30:62, around < 3] *= 1.6  # laces
    return picture


def bag(colour: Floats, seed: int) -> Floats:
    picture = plain(colour, seed, 0.08)
    rows, columns = np.mgrid[0:ROWS, 0:COLUMNS]
    behind = np.minimum(columns, COLUMNS - columns)
    pocket = (rows > 18) & (rows < 50) & (behind < 14)
    picture[pocket] *= 0.8
    picture[np.abs(rows - 52) < 2] *= 0.6
    return picture
