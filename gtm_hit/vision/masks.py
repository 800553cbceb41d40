"""What is not the background in a frame's views, as it is kept: a few steps of grey, some kilobytes.

Learning a background takes seconds and many pictures; whoever looks at a frame again later, to put one person
right, has what was seen there at hand.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from gtm_hit.vision.background import Background, Backgrounds
from gtm_hit.vision.boxes import Picture

Mask = NDArray[np.float32]  # (h, w) 0…1: how surely a pixel is not the background; 0.5: unknown
Masks = Mapping[str, Mask]  # by camera

STEPS = 8  # of grey between 0 and 1; even, so that 0.5 stays what it is


class Noted(Background):
    """A background that remembers the foreground it was asked for last."""

    last: Mask | None = None

    @classmethod
    def of(cls, background: Background) -> Noted:
        return cls(**vars(background))

    def foreground(self, picture: Picture) -> Mask:
        mask = super().foreground(picture)
        self.last = mask
        return mask


class Notes:
    """The foregrounds that were seen while a frame was looked at."""

    def __init__(self, backgrounds: Backgrounds) -> None:
        self._noted = {name: Noted.of(each) for name, each in backgrounds.cameras.items()}
        self.backgrounds = Backgrounds(dict(self._noted))

    def take(self) -> dict[str, Mask]:
        """By camera, since this was called before."""
        taken = {name: each.last for name, each in self._noted.items() if each.last is not None}
        for each in self._noted.values():
            each.last = None
        return taken


def packed(masks: Masks) -> bytes:
    """An archive of arrays: the cameras' names first, then a mask for each."""
    stream = io.BytesIO()
    np.savez_compressed(stream, np.array(list(masks), dtype=np.str_), *map(_steps, masks.values()))
    return stream.getvalue()


def unpacked(data: bytes) -> dict[str, Mask]:
    """Raises ValueError for what `packed` did not write."""
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as kept:
            names, *steps = (kept[f"arr_{place}"] for place in range(len(kept.files)))
            masks = (each.astype(np.float32) / STEPS for each in steps)
            return dict(zip(names.tolist(), masks, strict=True))
    except (ValueError, KeyError, EOFError, OSError, zipfile.BadZipFile) as error:
        raise ValueError("these are no masks") from error


def _steps(mask: Mask) -> NDArray[np.uint8]:
    return np.rint(mask * STEPS).astype(np.uint8)
