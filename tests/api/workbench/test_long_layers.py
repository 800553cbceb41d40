from __future__ import annotations

import pytest

from gtm_hit.models import Assignment, Frame, Layer, LayerFrame
from gtm_hit.ops.frames import parts
from tests.api.conftest import Caller, body
from tests.work_scene import row


@pytest.fixture(autouse=True)
def short_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """The dataset has frames 0, 5 … 95."""
    monkeypatch.setattr(parts, "FRAMES_PER_PART", 8)


def numbers(caller: Caller, address: str) -> list[int]:
    return [frame["number"] for frame in caller.get(address).json()["frames"]]


def test_a_long_layer_opens_in_the_part_with_the_first_frame_that_is_not_done(
    staff: Caller, layer: Layer
) -> None:
    address = f"/api/v1/layers/{layer.pk}/scene/"
    assert numbers(staff, address) == list(range(0, 40, 5))
    for frame in Frame.objects.filter(dataset=layer.dataset, number__lt=40):
        LayerFrame.objects.update_or_create(layer=layer, frame=frame, defaults={"revision": 1, "done": True})
    assert numbers(staff, address) == list(range(40, 80, 5))
    assert staff.get(address).json()["layer"]["first"] == 40


@pytest.mark.parametrize(
    ("asked", "first", "end"), [(0, 0, 40), (39, 40, 80), (40, 40, 80), (80, 80, 100), (999, 80, 100)]
)
def test_a_part_is_found_by_any_frame_number(
    staff: Caller, layer: Layer, asked: int, first: int, end: int
) -> None:
    address = f"/api/v1/layers/{layer.pk}/from/{asked}/scene/"
    assert numbers(staff, address) == list(range(first, end, 5))


def test_nothing_beyond_a_part_is_read_or_written_under_its_address(staff: Caller, layer: Layer) -> None:
    base = f"/api/v1/layers/{layer.pk}/from/40/"
    assert numbers(staff, base + "frames/?from=60&count=20") == [60, 65, 70, 75]
    assert staff.put(base + "frames/40/", body(people=[row()])).status_code == 200
    assert staff.put(base + "frames/80/", body(people=[row()])).status_code == 404
    assert staff.get(base + "frames/35/").status_code == 404


def test_a_part_is_for_staff_only(alice: Caller, stranger: Caller, layer: Layer) -> None:
    for caller in (alice, stranger):
        assert caller.get(f"/api/v1/layers/{layer.pk}/from/40/scene/").status_code == 401


def test_an_assignment_is_opened_whole(staff: Caller, assignment: Assignment) -> None:
    scene = staff.get(f"/api/v1/layers/{assignment.layer_id}/scene/").json()
    assert (len(scene["frames"]), scene["layer"]["first"]) == (10, None)


def test_the_page_of_a_layer_leads_to_the_part_that_was_asked_for(staff: Caller, layer: Layer) -> None:
    page = f"/datasets/{layer.dataset.slug}/layers/{layer.name}/"
    base = f'data-api="/api/v1/layers/{layer.pk}/from/'
    for query, first in {"?from=55": 40, "": 0, "?from=x": 0}.items():
        assert f'{base}{first}/"' in staff.client.get(page + query).content.decode()
    assert 'name="from"' in staff.client.get(f"/datasets/{layer.dataset.slug}/layers/").content.decode()
