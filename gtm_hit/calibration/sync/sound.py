"""What a WAV file sounds like: where it becomes louder, hundreds of times a second."""

from __future__ import annotations

import wave
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.sync.series import Series, SyncError

STEP = 0.005  # seconds
BLOCK = 200  # steps read at once
LONGEST = 1200.0  # seconds that are listened to
QUIET = 1e-4  # of full scale; what is below is silence


def read_sound(path: Path, longest: float = LONGEST) -> Series:
    """Raises SyncError for what is no PCM sound that Python's own reader knows, or for silence."""
    try:
        with wave.open(str(path), "rb") as file:
            loud = _loudness(file, longest)
    except (wave.Error, EOFError, OSError) as error:
        raise SyncError(f"{path.name} is no WAV file that can be read: {error}") from error
    if len(loud) < 2 or loud.max() <= np.log(QUIET):
        raise SyncError(f"{path.name} is silent")
    rises = np.maximum(np.diff(loud), 0).astype(np.float32)
    # A rise lies between its two steps; a step's loudness is that of its middle.
    return Series(STEP, STEP, rises[:, None], np.ones(1, bool))


def _loudness(file: wave.Wave_read, longest: float) -> NDArray[np.float64]:
    """Logarithm of the mean level of every step."""
    rate, wanted = file.getframerate(), int(min(file.getnframes() / file.getframerate(), longest) / STEP)
    levels: list[float] = []
    read, samples = 0, np.zeros(0, np.float64)
    while len(levels) < wanted:
        stop = round((len(levels) + BLOCK) * STEP * rate)
        fresh = _samples(file, stop - read)
        if not len(fresh):
            break
        samples, first = np.concatenate((samples, fresh)), read - len(samples)
        read += len(fresh)
        count = min(BLOCK, int(read / (STEP * rate)) - len(levels))
        edges = np.round((len(levels) + np.arange(count + 1)) * STEP * rate).astype(int) - first
        levels += [float(np.sqrt(np.mean(np.square(samples[a:b])))) for a, b in pairwise(edges)]
        samples = samples[edges[-1] :]
    return np.log(np.maximum(levels[:wanted], QUIET))


def _samples(file: wave.Wave_read, count: int) -> NDArray[np.float64]:
    """The next samples of all channels' mean, -1 … 1."""
    data, width = file.readframes(count), file.getsampwidth()
    if width == 1:
        values = (np.frombuffer(data, np.uint8).astype(np.float64) - 128) / 128
    elif width == 3:
        parts = np.frombuffer(data, np.uint8).reshape(-1, 3).astype(np.int32)
        whole = (parts[:, 0] << 8) | (parts[:, 1] << 16) | (parts[:, 2] << 24)
        values = whole / 2**31
    else:
        values = np.frombuffer(data, f"<i{width}").astype(np.float64) / 2 ** (8 * width - 1)
    return np.asarray(values.reshape(-1, file.getnchannels()).mean(axis=1))
