from __future__ import annotations

import pytest

from gtm_hit.models import Campaign, GoldFrame, Layer
from gtm_hit.ops.gold import frames
from gtm_hit.ops.gold.errors import GoldError
from gtm_hit.ops.qualifications import managing
from tests.gold_scene import make_scene, put, take, truth_of_square
from tests.work_scene import make_dataset, make_layer

pytestmark = pytest.mark.django_db


@pytest.fixture
def scene() -> tuple[Campaign, Layer]:
    return make_scene()


def gold(campaign: Campaign) -> list[int]:
    return list(frames.gold_frames(campaign).values_list("frame__number", flat=True))


def test_the_share_of_frames_is_chosen_and_the_same_seed_chooses_the_same(
    scene: tuple[Campaign, Layer],
) -> None:
    campaign, truth = scene
    assert frames.choose(campaign, truth, 0.2) == 4
    first = gold(campaign)
    assert frames.choose(campaign, truth, 0.2) == 4
    assert gold(campaign) == first


def test_a_larger_share_keeps_those_there_were(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    frames.choose(campaign, truth, 0.2)
    few = set(gold(campaign))
    frames.choose(campaign, truth, 0.5)
    assert few < set(gold(campaign))


def test_frames_of_a_qualification_are_never_gold(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    managing.create(campaign.dataset, managing.Order("basics", truth, frames_per_try=5, tries=2))
    assert frames.choose(campaign, truth, 1.0) == 10
    assert min(gold(campaign)) == 50


def test_only_frames_that_are_handed_out_are_chosen(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    campaign.batches.get(number=2).delete()
    assert frames.choose(campaign, truth, 1.0) == 10
    assert max(gold(campaign)) == 45


def test_two_truths_add_up_and_go_one_by_one(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    other = make_layer(campaign.dataset, "second", Layer.Kind.STAFF)
    put(other, truth_of_square(3))
    frames.choose(campaign, other, 1.0)
    assert frames.choose(campaign, truth, 0.1) >= 3
    frames.remove(campaign, truth)
    assert set(GoldFrame.objects.values_list("truth", flat=True)) <= {other.pk}
    assert frames.remove(campaign) == 3


@pytest.mark.parametrize("share", [-0.1, 1.1])
def test_an_impossible_share_is_refused(scene: tuple[Campaign, Layer], share: float) -> None:
    with pytest.raises(GoldError, match="between 0 and 1"):
        frames.choose(*scene, share)
    assert not GoldFrame.objects.exists()


def test_work_nobody_accepted_is_no_truth(scene: tuple[Campaign, Layer]) -> None:
    campaign, _truth = scene
    with pytest.raises(GoldError, match="no known truth"):
        frames.choose(campaign, take(campaign).layer, 0.5)


def test_proposals_and_other_datasets_are_no_truth(scene: tuple[Campaign, Layer]) -> None:
    campaign, _truth = scene
    proposed = make_layer(campaign.dataset, "proposed", Layer.Kind.PROPOSAL)
    for layer in (proposed, make_layer(make_dataset("other"), "theirs")):
        with pytest.raises(GoldError, match="no known truth"):
            frames.choose(campaign, layer, 0.5)


def test_a_truth_that_knows_none_of_the_frames_is_refused(scene: tuple[Campaign, Layer]) -> None:
    campaign, _truth = scene
    with pytest.raises(GoldError, match="no frame of this campaign"):
        frames.choose(campaign, make_layer(campaign.dataset, "empty"), 0.5)
