"""People who are proposed before the annotator comes: accepted, refused, looked at."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import expect

from gtm_hit.models import PictureBoxes, ProposalRun, Refusal
from gtm_hit.ops.proposals import runs
from gtm_hit.ops.proposals.pictures import pictures_of
from gtm_hit.ops.proposals.proposing import keep
from gtm_hit.ops.proposals.tracks import link_run
from gtm_hit.vision.bodies import body_boxes
from gtm_hit.vision.people import Evidence, FrameProposals, Proposal
from tests.browser.bench import Bench, best_view, metres_apart
from tests.browser.street import GRID, Street

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

PEOPLE, FRAMES = 8, 4


def proposal(position: int, score: float, rng: np.random.Generator) -> Proposal:
    """A few centimetres off, seen by all views but one."""
    x, y = GRID.metres([position])[0] + rng.normal(0, 0.03, 2)
    evidence = tuple(Evidence(f"C{view}", (0.0, 0.0, 9.0, 9.0), 0.9, False) for view in range(1, 7))
    evidence = (*evidence, Evidence("C7", None, float("nan"), True))
    return Proposal(float(x), float(y), 1.8, 0.16, score, evidence, "cover")


def propose(street: Street, false: int = 1) -> ProposalRun:
    """Everybody of the truth, the first one doubtful; and in every frame somebody who is not there."""
    rng = np.random.default_rng(3)
    run = runs.find_or_make(street.dataset, "cover", "test", {"detector": "none"})
    for index, frame in enumerate(street.frames):
        found = [
            proposal(int(position), 0.4 if person == 0 else 0.92, rng)
            for person, position in enumerate(street.truth[index])
        ]
        empty = [proposal(int(GRID.position([(7.5, 15.0 + 2 * index)])[0]), 0.3, rng)] if false else []
        keep(run, frame, "pictures", FrameProposals((*found, *empty)), 1.0)
    link_run(run)
    runs.use(run)
    return run


@pytest.fixture
def proposed(bench: Callable[..., Bench]) -> Bench:
    made = bench(people=PEOPLE, frames=FRAMES, marked=False)
    propose(made.street)
    return ready(made)


def ready(made: Bench) -> Bench:
    made.open()
    expect(made.page.locator(".proposals .details").first).not_to_have_text("")
    return made


def count(made: Bench) -> str:
    made.painted()
    return made.page.locator(".proposals .details").first.inner_text()


def test_one_key_accepts_all_right_ones_and_undo_takes_them_back(proposed: Bench) -> None:
    assert count(proposed) == "Proposed: 7 to accept, 2 doubtful"
    assert proposed.rows() == []
    proposed.press("o")
    assert len(proposed.rows()) == PEOPLE - 1
    assert {row.origin for row in proposed.stored()} == {"proposed"}
    proposed.press("Control+z")
    assert proposed.rows() == []
    assert count(proposed) == "Proposed: 7 to accept, 2 doubtful"


def test_the_slider_says_who_is_taken_for_real(proposed: Bench) -> None:
    slider = proposed.page.locator(".proposals input[type=range]")
    slider.fill("0.35")
    assert count(proposed) == "Proposed: 8 to accept, 1 doubtful"
    proposed.open()
    expect(proposed.page.locator(".proposals output")).to_have_text("35 %")


def test_the_most_doubtful_is_gone_to_and_refused_for_good(proposed: Bench) -> None:
    proposed.press("Shift+f", "Shift+r")
    assert count(proposed) == "Proposed: 7 to accept, 1 doubtful"
    expect(
        proposed.page.locator(".notices, [role=status]").filter(has_text="Nobody there").first
    ).to_be_visible()
    ready(proposed)
    assert count(proposed) == "Proposed: 7 to accept, 1 doubtful"
    assert Refusal.objects.count() == 1
    proposed.press("Control+z")
    assert count(proposed) == "Proposed: 7 to accept, 2 doubtful"


def test_the_pointer_shows_the_evidence_and_a_click_on_the_feet_accepts(proposed: Bench) -> None:
    position = int(proposed.street.truth[0][3])
    view = best_view(position)
    proposed.page.mouse.move(*proposed.place_of(view, position))
    proposed.click(view, position)
    (row,) = proposed.stored()
    assert row.origin == "proposed"
    assert metres_apart(row.position, position) < 0.15


def test_doubtful_ones_come_close_up_the_most_doubtful_first(proposed: Bench) -> None:
    proposed.press("o", "Shift+a")
    expect(proposed.page.locator(".left")).to_contain_text("2 yellow")
    proposed.press("Delete")  # nobody is there
    proposed.press("Enter")  # somebody is
    assert len(proposed.rows()) == PEOPLE
    assert count(proposed) == "Proposed: nobody is left"
    proposed.saved()
    assert {row.state for row in proposed.stored()} == {"validated"}
    assert Refusal.objects.count() == 1


def boxed(made: Bench, person: int) -> int:
    """Their position in the first frame, where every view has a box of them and nobody else is proposed."""
    run, frame = runs.in_use(made.street.dataset), made.street.frames[0]
    assert run is not None
    run.frames.get(frame=frame).people.all().delete()
    position = int(made.street.truth[0][person])
    digests = pictures_of([frame])[frame.pk].digests
    for camera in made.street.dataset.calibrated_cameras():
        seen = body_boxes(camera, GRID.metres([position]), 0.2, 1.72)
        boxes = [[*seen.boxes[0].tolist(), 0.9]] if seen.share[0] > 0.5 else []
        PictureBoxes.objects.create(picture=digests[camera.name], model=run.model, boxes=boxes)
    return position


def test_a_click_snaps_to_the_feet_and_not_with_shift_until_the_key_says_so(proposed: Bench) -> None:
    position = boxed(proposed, 3)
    x, y = GRID.metres([position])[0]
    beside = int(GRID.position([(x + 0.25, y)])[0])
    ready(proposed)

    def answered(act: Callable[[], None]) -> float:
        """Metres between the person and the place of the boxes, once the server has said where they are."""
        with proposed.page.expect_response(lambda answer: answer.url.endswith("/snap/")):
            act()
        proposed.painted()
        return away()

    def away() -> float:
        return metres_apart(proposed.stored()[0].position, position)

    assert answered(lambda: proposed.click(best_view(position), beside)) < 0.06
    proposed.press("Control+z")
    assert 0.2 < away() < 0.3
    assert answered(lambda: proposed.press("Shift+d")) < 0.06
    proposed.press("Delete")
    proposed.page.keyboard.down("Shift")
    proposed.click(best_view(position), beside)
    proposed.page.keyboard.up("Shift")
    assert away() > 0.2


def test_a_frame_nobody_is_proposed_in_works_as_ever(bench: Callable[..., Bench]) -> None:
    made = bench(people=3).open()
    assert made.page.locator(".proposals").count() == 0
    made.press("o")
    assert made.rows() == ["1", "2", "3"] or len(made.rows()) == 3


class Annotator:
    """Sees only what the page shows; counts what it does."""

    def __init__(self, made: Bench) -> None:
        self.made = made
        self.actions = 0

    def press(self, key: str) -> None:
        self.made.press(key)
        self.made.painted()
        self.actions += 1

    def text(self, selector: str) -> str:
        self.made.painted()
        return self.made.page.locator(selector).first.inner_text()

    def check_batch(self) -> None:
        """Accept, look at the doubtful ones (here: the lower of two scores is nobody), go on."""
        for index in range(FRAMES):
            expect(self.made.page.locator(".place")).to_have_text(f"Frame {index + 1} of {FRAMES}")
            if not self.text(".proposals .details").startswith(("Proposed: 0", "Proposed: nobody")):
                self.press("o")
            if "0 doubtful" not in self.text(".proposals .details"):
                self.press("Shift+a")
                self.press("Delete")
                self.press("Enter")
                self.press("a")
            if index < FRAMES - 1:
                self.press("n")


def right(made: Bench) -> float:
    """Share of all people of the truth with an annotation within 15 cm, and nobody else."""
    matched = extra = 0
    for index in range(FRAMES):
        truth = GRID.metres(made.street.truth[index])
        found = GRID.metres([row.position for row in made.stored(index)])
        near = np.hypot(*(truth[:, None] - found[None]).transpose(2, 0, 1)) < 0.15
        matched += int(near.any(axis=1).sum())
        extra += int((~near.any(axis=0)).sum())
    assert extra == 0
    return matched / (PEOPLE * FRAMES)


def test_a_batch_is_checked_to_the_end_with_few_actions(proposed: Bench, record_property: Any) -> None:
    annotator = Annotator(proposed)
    annotator.check_batch()
    assert right(proposed) == 1.0
    persons = {frame: {row.person for row in proposed.stored(frame)} for frame in range(FRAMES)}
    assert len(set().union(*persons.values())) == PEOPLE
    each = annotator.actions / (PEOPLE * FRAMES)
    record_property("actions per person and frame", each)
    assert each <= 0.75  # by hand it is at least one click a person
