"""What the people of the demo scene look like: dealt out so that neighbours differ."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.light import linear
from gtm_hit.demo.pose import Arms
from gtm_hit.demo.walks import Walks

SKINS = ("d9ad8a", "cc9872", "b57d54", "8a5838", "60402c", "deb896", "c48f69")
HAIRS = ("1c1613", "2b1d14", "4a2f1b", "7a5230", "b58a4e", "8d8a86", "140f0d", "5b2f1d")
TOPS = (
    "9c2a30", "28456f", "dedad2", "2c2d31", "3f6f4c", "c79a36", "6c87a8", "7b2f4a", "c05a38", "1f6d72",
    "8d8f92", "c9b497", "5a4a7f", "1b2a44", "d98ba0", "5c6b3a", "e6e2da", "35383d",
)  # fmt: skip
COATS = ("1f2226", "b08d57", "3b4a3c", "6d2430", "27364f", "8a8378", "c7bca6", "4c4038")
TROUSERS = (
    "2a3a55", "1d1f24", "3e4c63", "a89673", "4b4f57", "5c718f", "20242c", "6a5a45", "c3b393", "33402f",
    "6f7f96",
)  # fmt: skip
SKIRTS = ("24252b", "7a2c38", "35507a", "c49a3a", "5d6b52")
SHOES = ("17171a", "e8e6e2", "5a3a24", "2e3036", "b9b5ad", "8b2a2a", "3a2b22")
BAGS = ("22252b", "7a3b23", "2f4a63", "5b5f3a", "b3452f", "141518")


class Top(StrEnum):
    TSHIRT = "t-shirt"
    SHIRT = "shirt"
    JACKET = "jacket"
    COAT = "coat"


class Bottom(StrEnum):
    TROUSERS = "trousers"
    SHORTS = "shorts"
    SKIRT = "skirt"
    DRESS = "dress"


class Hair(StrEnum):
    SHORT = "short"
    CROPPED = "cropped"
    LONG = "long"
    PONYTAIL = "ponytail"
    CAP = "cap"
    BEANIE = "beanie"


class Pattern(StrEnum):
    PLAIN = "plain"
    STRIPES = "stripes"
    CHECK = "check"
    PRINT = "print"


class Bag(StrEnum):
    NONE = "none"
    BACKPACK = "backpack"
    TOTE = "tote"
    SUITCASE = "suitcase"


@dataclass(frozen=True, eq=False)
class Look:
    """One person's clothes; colours are linear light (3,)."""

    womanly: bool
    skin: Floats
    hair: Hair
    hair_colour: Floats
    hat_colour: Floats
    top: Top
    top_colour: Floats
    under_colour: Floats
    pattern: Pattern
    open_front: bool
    bottom: Bottom
    bottom_colour: Floats
    shoe_colour: Floats
    pale_soles: bool
    bag: Bag
    bag_colour: Floats
    arms: Arms
    beard: bool
    glasses: bool
    seed: int  # of the folds


def dress_everybody(walks: Walks, rng: np.random.Generator) -> list[Look]:
    decks = {
        name: _deck(colours, walks.people, rng)
        for name, colours in {
            "skin": SKINS, "hair": HAIRS, "top": TOPS, "coat": COATS, "trousers": TROUSERS,
            "skirt": SKIRTS, "shoe": SHOES, "bag": BAGS, "under": TOPS, "hat": COATS + TOPS[:6],
        }.items()
    }  # fmt: skip
    womanly = rng.permutation(np.arange(walks.people) % 2 == 0)
    looks = []
    for person in range(walks.people):
        dealt = {name: linear(deck[person]) for name, deck in decks.items()}
        looks.append(_look(bool(womanly[person]), walks.speed[person] > 0, dealt, rng))
    return looks


def _deck(cards: tuple[str, ...], people: int, rng: np.random.Generator) -> list[str]:
    """A card for everybody; none comes again before all others were dealt."""
    rounds = -(-people // len(cards))
    return [str(card) for _ in range(rounds) for card in rng.permutation(cards)][:people]


def _look(womanly: bool, walks: bool, dealt: dict[str, Floats], rng: np.random.Generator) -> Look:
    tops, weights = list(Top), (0.3, 0.26, 0.28, 0.16)
    top = Top(rng.choice(tops, p=weights))
    bottom = _bottom(womanly, top, rng)
    pattern = Pattern(rng.choice(list(Pattern), p=(0.52, 0.2, 0.12, 0.16)))
    return Look(
        womanly=womanly,
        skin=dealt["skin"],
        hair=_hair(womanly, rng),
        hair_colour=dealt["hair"],
        hat_colour=dealt["hat"],
        top=top,
        top_colour=dealt["coat"] if top is Top.COAT else dealt["top"],
        under_colour=dealt["under"],
        pattern=pattern if top in (Top.TSHIRT, Top.SHIRT) else Pattern.PLAIN,
        open_front=top in (Top.JACKET, Top.COAT) and rng.random() < 0.6,
        bottom=bottom,
        bottom_colour=dealt["skirt"] if bottom in (Bottom.SKIRT, Bottom.DRESS) else dealt["trousers"],
        shoe_colour=dealt["shoe"],
        pale_soles=rng.random() < 0.55,
        bag=Bag(rng.choice(list(Bag), p=(0.5, 0.27, 0.18, 0.05))) if walks else _idle_bag(rng),
        bag_colour=dealt["bag"],
        arms=_arms(walks, rng),
        beard=not womanly and rng.random() < 0.35,
        glasses=rng.random() < 0.22,
        seed=int(rng.integers(2**31)),
    )


def _bottom(womanly: bool, top: Top, rng: np.random.Generator) -> Bottom:
    draw = rng.random()
    if womanly and draw < 0.38:
        return Bottom.DRESS if top in (Top.TSHIRT, Top.SHIRT) and draw < 0.14 else Bottom.SKIRT
    return Bottom.SHORTS if draw > 0.9 and top is Top.TSHIRT else Bottom.TROUSERS


def _hair(womanly: bool, rng: np.random.Generator) -> Hair:
    weights = (0.14, 0.0, 0.48, 0.26, 0.06, 0.06) if womanly else (0.52, 0.2, 0.03, 0.0, 0.14, 0.11)
    return Hair(rng.choice(list(Hair), p=weights))


def _idle_bag(rng: np.random.Generator) -> Bag:
    return Bag(rng.choice([Bag.NONE, Bag.BACKPACK, Bag.TOTE], p=(0.5, 0.3, 0.2)))


def _arms(walks: bool, rng: np.random.Generator) -> Arms:
    weights = (0.72, 0.1, 0.08, 0.0, 0.1, 0.0) if walks else (0.1, 0.25, 0.2, 0.17, 0.08, 0.2)
    return Arms(rng.choice(list(Arms), p=weights))
