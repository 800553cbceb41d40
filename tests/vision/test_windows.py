"""Long sequences are linked in windows, and nobody notices."""

from __future__ import annotations

import numpy as np

from gtm_hit.vision.link import FILLED, LinkSettings
from gtm_hit.vision.windows import OVERLAP, WINDOW, linked_in_windows


def there_and_back(frames: int) -> np.ndarray:
    at = np.arange(frames)
    return np.column_stack((5 * np.sin(at / 12), 5 * np.cos(at / 12)))


def test_tracks_go_on_over_the_borders_of_windows() -> None:
    count = 2 * WINDOW + 30
    frames = np.concatenate((np.arange(count), np.arange(count)))
    xy = np.concatenate((there_and_back(count), there_and_back(count) + np.array([20.0, 0.0])))
    linked = linked_in_windows(frames, xy, LinkSettings())
    assert len(linked.rows) == 2 * count
    west = linked.xy[:, 0] < 8
    assert len(set(linked.tracks[west].tolist())) == len(set(linked.tracks[~west].tolist())) == 1


def test_a_hole_at_the_border_of_windows_is_filled_once() -> None:
    count = WINDOW + 20
    for hole in (WINDOW - OVERLAP, WINDOW - 2, WINDOW - 1, WINDOW, WINDOW + 1):
        frames = np.delete(np.arange(count), hole)
        linked = linked_in_windows(frames, there_and_back(count)[frames], LinkSettings())
        assert linked.frames[linked.rows == FILLED].tolist() == [hole]
        assert len(set(linked.tracks.tolist())) == 1


def test_two_frames_of_a_hole_at_the_border_are_filled_once() -> None:
    count = WINDOW + 20
    for hole in range(WINDOW - OVERLAP - 1, WINDOW + 2):
        frames = np.delete(np.arange(count), [hole, hole + 1])
        linked = linked_in_windows(frames, there_and_back(count)[frames], LinkSettings())
        assert sorted(linked.frames[linked.rows == FILLED].tolist()) == [hole, hole + 1]


def test_somebody_new_in_a_later_window_gets_a_number_of_their_own() -> None:
    late = np.arange(WINDOW + 5, WINDOW + 25)
    frames = np.concatenate((np.arange(WINDOW + 25), late))
    xy = np.concatenate((there_and_back(WINDOW + 25), np.column_stack((30 + 0.1 * late, 0.0 * late))))
    linked = linked_in_windows(frames, xy, LinkSettings())
    assert len(set(linked.tracks.tolist())) == 2


def test_nobody_is_no_track() -> None:
    assert len(linked_in_windows(np.zeros(0, np.int64), np.zeros((0, 2)), LinkSettings()).tracks) == 0
