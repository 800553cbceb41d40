"""A campaign's page of gold frames, planted faults and required qualifications."""

from __future__ import annotations

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Campaign, GoldFrame, Layer, Planting
from gtm_hit.ops.qualifications import managing
from tests.gold_scene import make_scene

pytestmark = pytest.mark.django_db
PAGE = "/datasets/square/campaigns/street/gold/"


@pytest.fixture
def scene() -> tuple[Campaign, Layer]:
    return make_scene()


@pytest.fixture
def manager(client: Client) -> Client:
    client.force_login(User.objects.create_user("manager", password="x", is_superuser=True))
    return client


def faults(**values: object) -> dict[str, object]:
    return {
        "form": "faults",
        "faults-layer": "truth",
        "faults-percent": 50,
        "faults-faults": 2,
        "faults-kinds": ["shifted", "removed"],
        "faults-seed": 1,
        **values,
    }


def test_strangers_are_sent_to_the_login(client: Client, scene: tuple[Campaign, Layer]) -> None:
    for address in (PAGE, PAGE.replace("gold", "scores"), PAGE.replace("gold", "suspicion")):
        assert client.get(address).status_code == 302
    assert client.post(PAGE, faults()).status_code == 302
    assert not Planting.objects.exists()


def test_somebody_who_is_not_staff_may_not(client: Client, scene: tuple[Campaign, Layer]) -> None:
    client.force_login(User.objects.create_user("visitor", password="x"))
    assert client.get(PAGE).status_code == 403
    assert client.post(PAGE, faults()).status_code == 403
    assert not Planting.objects.exists()


def test_a_share_of_the_frames_is_made_gold(manager: Client, scene: tuple[Campaign, Layer]) -> None:
    given = {"form": "gold", "gold-layer": "truth", "gold-percent": 20, "gold-seed": 1}
    answer = manager.post(PAGE, given, follow=True)
    assert "4 frames are gold now." in answer.content.decode()
    assert GoldFrame.objects.count() == 4


def test_faults_are_settled_and_stopped(manager: Client, scene: tuple[Campaign, Layer]) -> None:
    assert manager.post(PAGE, faults()).status_code == 302
    planting = Planting.objects.get()
    assert (planting.share, planting.kinds, planting.starting_layer) == (
        0.5,
        ["shifted", "removed"],
        scene[1],
    )
    assert manager.post(PAGE, {"form": "stop"}).status_code == 302
    assert not Planting.objects.exists()


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"faults-percent": 120}, "less than or equal to 100"),
        ({"faults-kinds": []}, "Choose the kinds"),
        ({"faults-layer": "nowhere"}, "not one of the available choices"),
    ],
)
def test_bad_settings_are_said_on_the_page_and_change_nothing(
    manager: Client, scene: tuple[Campaign, Layer], values: dict[str, object], words: str
) -> None:
    answer = manager.post(PAGE, faults(**values))
    assert answer.status_code == 400
    assert words in answer.content.decode()
    assert not Planting.objects.exists()


def test_qualifications_are_asked_for(manager: Client, scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    managing.create(campaign.dataset, managing.Order("basics", truth))
    assert manager.post(PAGE, {"form": "required", "required-names": ["basics"]}).status_code == 302
    assert [one.qualification.name for one in campaign.required_qualifications.all()] == ["basics"]


def test_a_campaign_that_is_not_there_is_404(manager: Client, scene: tuple[Campaign, Layer]) -> None:
    assert manager.get(PAGE.replace("street", "road")).status_code == 404
