"""How far two series are apart, told from numbers alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gtm_hit.calibration.sync.align import align
from gtm_hit.calibration.sync.lag import lag_between
from gtm_hit.calibration.sync.series import Series, SyncError, steady

EVENTS = np.random.default_rng(3).uniform(0, 60, (40, 12))  # seconds, of twelve channels


def seen(start: float, rate: float, seconds: float = 30.0, noise: float = 0.0) -> Series:
    """What a video that begins at this instant and runs at this rate has of the events."""
    times = np.arange(0, seconds, 1 / rate)
    apart = (times + start)[:, None, None] - EVENTS
    values = np.exp(-((apart / 0.15) ** 2)).sum(axis=1)
    values += noise * np.random.default_rng(int(1000 * start)).uniform(0, 2, values.shape)
    return steady(times.tolist(), values, 0.04)


@pytest.mark.parametrize("rates", [(25.0, 30.0), (30000 / 1001, 60000 / 1001), (24.0, 50.0)])
def test_the_lag_of_two_rates_is_found_to_a_fraction_of_a_picture(rates: tuple[float, float]) -> None:
    lag = lag_between(seen(3.217, rates[0]), seen(1.004, rates[1]))
    assert lag.sure
    assert lag.seconds == pytest.approx(2.213, abs=0.005)


def test_an_event_that_is_later_in_the_second_video_gives_a_positive_lag() -> None:
    assert lag_between(seen(5.0, 25), seen(4.0, 25)).seconds > 0


def test_series_that_show_different_things_are_not_sure() -> None:
    other = seen(0, 25)
    scrambled = Series(0, other.step, other.values[:, ::-1].copy(), other.known)
    assert not lag_between(seen(3, 25), scrambled).sure


def test_channels_that_one_of_them_cannot_see_have_no_say() -> None:
    first, second = seen(3, 25), seen(1, 25)
    blind = np.arange(12) < 6
    second.values[:, ~blind] = np.random.default_rng(1).uniform(0, 9, (len(second.values), 6))
    lag = lag_between(first, Series(0, second.step, second.values, blind))
    assert lag.seconds == pytest.approx(2, abs=0.005)


def test_two_that_share_no_channel_are_refused() -> None:
    one, low = seen(0, 25), np.arange(12) < 6
    with pytest.raises(SyncError, match="share no ground"):
        lag_between(replace(one, known=low), replace(one, known=~low))


def test_many_are_put_together_though_every_one_is_noisy() -> None:
    starts = [0.0, 2.5, 7.031, 11.3]
    found = align([seen(start, 25 + index, noise=0.3) for index, start in enumerate(starts)])
    places = np.array([each.offset for each in found if each])
    assert len(places) == 4
    errors = places + starts
    assert np.abs(errors - errors.mean()).max() < 0.02


def test_the_one_that_has_nothing_in_common_is_left_out() -> None:
    strange = seen(0, 25)
    strange.values[:] = np.random.default_rng(2).uniform(0, 1, strange.values.shape)
    found = align([seen(3, 25), strange, seen(1, 30)])
    assert [each is None for each in found] == [False, True, False]


def test_where_no_two_have_anything_in_common_nothing_is_guessed() -> None:
    noise = [np.random.default_rng(seed).uniform(0, 1, (700, 12)).astype(np.float32) for seed in range(3)]
    with pytest.raises(SyncError, match="these videos show no common motion"):
        align([Series(0, 0.04, values, np.ones(12, bool)) for values in noise])
