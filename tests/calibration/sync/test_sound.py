"""WAV files as series of what became louder."""

from __future__ import annotations

import wave
from pathlib import Path

import numpy as np
import pytest

from gtm_hit.calibration.sync.align import align
from gtm_hit.calibration.sync.series import SyncError
from gtm_hit.calibration.sync.sound import read_sound

CLAPS = np.random.default_rng(5).uniform(0, 40, 25)  # seconds


def make_sound(
    path: Path, start: float, rate: int = 16000, width: int = 2, channels: int = 1, seconds: float = 20
) -> Path:
    """Claps over a murmur, recorded from this instant on."""
    times = np.arange(int(seconds * rate)) / rate + start
    rng = np.random.default_rng(int(1000 * start) + rate)
    values = 0.01 * rng.standard_normal(len(times))
    fading = 0.6 * np.exp(-np.arange(rate // 4) / (0.05 * rate))
    for clap in CLAPS[(start < CLAPS) & (start + seconds - 0.5 > CLAPS)]:
        first = round((clap - start) * rate)
        values[first : first + len(fading)] += fading * rng.standard_normal(len(fading))
    write_sound(path, np.clip(values, -1, 1), rate, width, channels)
    return path


def write_sound(path: Path, values: np.ndarray, rate: int, width: int, channels: int) -> None:
    whole = np.repeat((values * (2 ** (8 * width - 1) - 1)).astype("<i4"), channels)
    data = whole.view(np.uint8).reshape(-1, 4)[:, :width].tobytes()
    if width == 1:
        data = (whole + 128).astype(np.uint8).tobytes()
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(width)
        file.setframerate(rate)
        file.writeframes(data)


def test_recordings_of_all_kinds_are_put_together_within_five_milliseconds(tmp_path: Path) -> None:
    kinds = [(0.0, 16000, 2, 1), (3.1234, 44100, 3, 2), (7.5, 8000, 1, 1), (1.75, 48000, 4, 2)]
    paths = [make_sound(tmp_path / f"{index}.wav", *kind) for index, kind in enumerate(kinds)]
    found = align([read_sound(path) for path in paths])
    errors = np.array([each.offset for each in found if each]) + [kind[0] for kind in kinds]
    assert np.abs(errors - errors.mean()).max() < 0.005


def test_silence_is_refused(tmp_path: Path) -> None:
    write_sound(tmp_path / "quiet.wav", np.zeros(16000), 16000, 2, 1)
    with pytest.raises(SyncError, match=r"quiet\.wav is silent"):
        read_sound(tmp_path / "quiet.wav")


def test_what_is_no_sound_is_refused(tmp_path: Path) -> None:
    (tmp_path / "odd.wav").write_bytes(b"RIFF, or so it says")
    with pytest.raises(SyncError, match=r"odd\.wav is no WAV file"):
        read_sound(tmp_path / "odd.wav")
