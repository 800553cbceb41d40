"""Detectors at an address: what they are asked, what is believed, and how broken ones fail."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gtm_hit.vision.boxes import Box
from gtm_hit.vision.detectors import DetectorError
from gtm_hit.vision.detectors.exchange import Limits
from gtm_hit.vision.detectors.http_plug import HttpDetector, HttpLocator, at_address
from tests.detector_server import PERSON, DetectorServer, serving
from tests.vision.plaza import CAMERAS, GRID

PICTURE = np.full((54, 96, 3), 90, np.uint8)
LIMITS = Limits(seconds=0.6, health=2.0, most=100_000)


def test_a_detector_of_cvats_serves_unchanged() -> None:
    with serving(DetectorServer()) as server:
        detector = at_address(server.address)
        assert isinstance(detector, HttpDetector)
        (box,) = detector.detect(PICTURE)
    assert box == pytest.approx((43.2, 16.2, 52.8, 37.8, 0.91))
    assert set(server.asked[0]) == {"image", "threshold"}


def test_a_model_of_all_views_gets_them_with_their_calibration() -> None:
    with serving(DetectorServer(multi_view=True)) as server:
        locator = at_address(server.address)
        assert isinstance(locator, HttpLocator) and locator.version == f"{server.address} 3"
        found = locator.locate({"C1": PICTURE, "C3": PICTURE}, CAMERAS, GRID, 35)
    assert found == [(0.5, -1.0, 0.8)]
    (body,) = server.asked
    assert body["frame"] == 35 and set(body["images"]) == {"C1", "C3"}
    assert [each["name"] for each in body["cameras"]] == ["C1", "C3"]
    assert np.allclose(body["cameras"][1]["tvec"], CAMERAS["C3"].tvec)
    assert body["grid"]["step"] == GRID.step


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ("status", "503: out of memory"),
        ("html", "no JSON"),
        ("huge", "more than 100000 bytes"),
        ("slow", "within 0.6 seconds"),
        ("drops", "does not answer"),
        ("redirect", "307"),
    ],
)
def test_a_broken_one_fails_with_words(wrong: str, words: str) -> None:
    with serving(DetectorServer(wrong=wrong)) as server:
        with pytest.raises(DetectorError, match=words):
            at_address(server.address, LIMITS).detect(PICTURE)
        assert len(server.asked) == 1


@pytest.mark.parametrize(
    "answer",
    [
        {"boxes": []},
        [7],
        [PERSON],
        [{**PERSON, "points": [1, 2, 3]}],
        [{**PERSON, "points": [1, 2, float("nan"), 4]}],
        [{**PERSON, "points": [30, 2, 10, 40]}],
        [{**PERSON, "points": [0, 0, 1920, 1080]}],
        [{**PERSON, "points": [1, 2, 3, 4], "confidence": 91}],
        [{**PERSON, "points": [1, 2, 3, 4], "confidence": None}],
        [{**PERSON, "type": "polygon", "points": [1, 2, 3, 4]}],
        [{**PERSON, "points": [1, 2, 3, 4]}] * 2001,
    ],
)
def test_nonsense_is_no_box(answer: Any) -> None:
    with serving(DetectorServer(answer=answer)) as server, pytest.raises(DetectorError):
        at_address(server.address).detect(PICTURE)


@pytest.mark.parametrize(
    "answer",
    [
        [],
        {"ground": 3},
        {"ground": [{"x": 1}]},
        {"ground": [{"x": 1, "y": "far", "score": 0.5}]},
        {"ground": [{"x": 1e9, "y": 0, "score": 0.5}]},
    ],
)
def test_nonsense_is_nobody_on_the_ground(answer: Any) -> None:
    with serving(DetectorServer(multi_view=True, answer=answer)) as server:
        locator = at_address(server.address)
        assert isinstance(locator, HttpLocator)
        with pytest.raises(DetectorError):
            locator.locate({"C1": PICTURE}, CAMERAS, GRID, 0)


def test_a_box_that_reaches_a_little_out_of_the_picture_is_cut() -> None:
    answer = [{**PERSON, "points": [-3, 10, 20, 56]}]
    with serving(DetectorServer(answer=answer)) as server:
        assert at_address(server.address).detect(PICTURE) == [Box(0, 10, 20, 54, 0.91)]


@pytest.mark.parametrize("address", ["http://127.0.0.1:9", "file:///etc/passwd", "http://[", "nowhere"])
def test_nobody_there_is_said(address: str) -> None:
    with pytest.raises(DetectorError):
        at_address(address, LIMITS)
