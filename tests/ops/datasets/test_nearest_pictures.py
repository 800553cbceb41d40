"""The choice of pictures, against looking at all of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.ops.datasets.videos.nearest import nearest_pictures

gaps = st.lists(st.integers(1, 3000), max_size=60)


class Pictures:
    """A video of given times; a picture's pixel is its index."""

    def __init__(self, times: list[float], interval: float) -> None:
        self.times = times
        self.interval = interval
        self.index = -1
        self.made = 0
        self.again = 0

    def grab(self) -> float | None:
        self.index += 1
        return self.times[self.index] if self.index < len(self.times) else None

    def pixels(self) -> np.ndarray:
        self.made += 1
        return np.array([self.index])

    def read_again(self, index: int) -> np.ndarray:
        self.again += 1
        return np.array([index])


def chosen(video: Pictures, wanted: list[float]) -> list[int]:
    found = list(nearest_pictures(video, wanted, video.read_again))
    assert [int(taken.pixels[0]) for taken in found] == [taken.index for taken in found]
    return [taken.index for taken in found]


@given(gaps=gaps, wanted=st.lists(st.integers(0, 100_000), max_size=30), interval=st.integers(1, 500))
def test_it_takes_the_nearest_picture_whatever_the_gaps(
    gaps: list[int], wanted: list[int], interval: int
) -> None:
    times = np.cumsum([0, *gaps]) / 1000
    inside = [time / 1000 for time in sorted(wanted) if time / 1000 <= times[-1]]
    video = Pictures(times.tolist(), interval / 1000)
    assert chosen(video, inside) == [int(np.abs(times - time).argmin()) for time in inside]


@given(gaps=gaps, wanted=st.lists(st.integers(0, 100_000), max_size=30))
def test_reading_again_stays_rare(gaps: list[int], wanted: list[int]) -> None:
    video = Pictures((np.cumsum([0, *gaps]) / 1000).tolist(), 0.001)
    chosen(video, [time / 1000 for time in sorted(wanted)])
    assert video.again <= 12  # 3000 ms is 2^11.6 times the interval


def test_pictures_far_from_any_frame_are_never_made_of_pixels() -> None:
    video = Pictures([index / 30 for index in range(30 * 60)], 1 / 30)
    assert len(chosen(video, [index / 2 for index in range(120)])) == 120
    assert video.made <= 3 * 120


def test_a_slow_video_gives_a_picture_twice() -> None:
    assert chosen(Pictures([0.0, 1.0, 2.0], 1.0), [0.0, 0.4, 0.6, 1.0, 1.4]) == [0, 0, 1, 1, 1]


@pytest.mark.parametrize(("time", "count"), [(1.04, 1), (1.06, 0)])
def test_it_ends_half_an_interval_after_the_last_picture(time: float, count: int) -> None:
    video = Pictures([index / 10 for index in range(11)], 0.1)
    assert len(chosen(video, [time])) == count


def test_an_empty_video_has_no_picture() -> None:
    assert chosen(Pictures([], 0.1), [0.0]) == []
