"""What each decision needs, does and leaves on record."""

from __future__ import annotations

import pytest

from gtm_hit.models import Appeal, AppendOnlyError, Assignment, Dataset, Transition
from gtm_hit.ops.frames.saving import read_frame
from gtm_hit.ops.review import comments, mending
from gtm_hit.ops.review.comments import Pin
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.refusals import Incomplete, NotAllowed, OwnWork, WrongState
from gtm_hit.ops.review.transitions import transition
from gtm_hit.ops.work.assignments import claim, current, submit
from tests.ops.review.scene import PLACES, REASON, make_reviewer, make_work, state, submitted
from tests.work_scene import make_worker, row, save

pytestmark = pytest.mark.django_db


@pytest.fixture
def dataset() -> Dataset:
    return make_work()


@pytest.fixture
def work(dataset: Dataset) -> Assignment:
    return submitted("alice", dataset)


def reject(work: Assignment, by: str = "rita") -> Assignment:
    return transition(work, Action.REJECT, make_reviewer(by), category="low_effort", reason=REASON)


def test_the_record_says_who_when_and_why(work: Assignment) -> None:
    rita = make_reviewer()
    transition(work, Action.ACCEPT, rita, reason=" well done ")
    steps = [(one.action, one.from_state, one.to_state) for one in work.transitions.all()]
    assert steps == [("submit", "leased", "submitted"), ("accept", "submitted", "accepted")]
    last = work.transitions.last()
    assert last and (last.user, last.reason) == (rita, "well done")


def test_the_record_is_never_changed(work: Assignment) -> None:
    step = Transition.objects.get()
    with pytest.raises(AppendOnlyError):
        step.save()
    with pytest.raises(AppendOnlyError):
        step.delete()


@pytest.mark.parametrize("name", ["alice", "ALICE", "alice@lab.example"])
def test_nobody_reviews_his_own_work(dataset: Dataset, name: str) -> None:
    work = submitted(make_worker(name, "own_team"), dataset)
    with pytest.raises(OwnWork):
        transition(work, Action.ACCEPT, make_reviewer("alice"))
    assert state(work) == "submitted"


def test_an_account_s_number_is_its_owner_too(dataset: Dataset) -> None:
    rita = make_reviewer()
    work = submitted(make_worker(str(rita.pk), "own_team"), dataset)
    with pytest.raises(OwnWork):
        transition(work, Action.ACCEPT, rita)


def test_the_number_of_a_stranger_on_a_panel_is_nobody_s_account(dataset: Dataset) -> None:
    rita = make_reviewer()
    work = submitted(make_worker(str(rita.pk), "link"), dataset)
    assert transition(work, Action.ACCEPT, rita).state == "accepted"


def test_workers_decide_nothing(work: Assignment) -> None:
    for by in (work.worker, make_worker("bob"), None):
        with pytest.raises(NotAllowed):
            transition(work, Action.ACCEPT, by)
    assert state(work) == "submitted"


@pytest.mark.parametrize(
    ("category", "reason"), [("", REASON), ("nonsense", REASON), ("low_effort", ""), ("low_effort", "bad")]
)
def test_a_rejection_needs_a_category_and_a_reason(work: Assignment, category: str, reason: str) -> None:
    with pytest.raises(Incomplete):
        transition(work, Action.REJECT, make_reviewer(), category=category, reason=reason)
    assert state(work) == "submitted" and Transition.objects.count() == 1


def test_a_rejected_batch_is_free_for_somebody_else(work: Assignment, dataset: Dataset) -> None:
    reject(work)
    assert claim(make_worker("bob"), dataset).batch == work.batch


def test_work_goes_back_with_a_comment_or_a_reason_only(work: Assignment) -> None:
    rita = make_reviewer()
    with pytest.raises(Incomplete):
        transition(work, Action.RETURN, rita)
    comments.remark(work, rita, "Too far left", Pin(0, 1))
    assert transition(work, Action.RETURN, rita).state == "returned"


def test_returned_work_is_changed_and_submitted_again(work: Assignment, dataset: Dataset) -> None:
    transition(work, Action.RETURN, make_reviewer(), reason="Person 1 is too far left.")
    assert current(work.worker, dataset) == work
    save(work.layer, dataset.frames.get(number=0), [row(1, 9)], 1, author=work.worker, done=True)
    assert submit(work).state == "submitted"


def test_of_two_reviewers_the_second_is_told(work: Assignment) -> None:
    transition(work, Action.ACCEPT, make_reviewer())
    with pytest.raises(WrongState, match="accepted"):
        reject(work, by="sven")
    assert state(work) == "accepted"


def test_one_may_appeal_once(work: Assignment) -> None:
    reject(work)
    transition(work, Action.APPEAL, work.worker, reason="They left the square.")
    with pytest.raises(WrongState):
        transition(work, Action.APPEAL, work.worker, reason="Really.")
    assert Appeal.objects.get().text == "They left the square."


def test_only_the_worker_himself_appeals(work: Assignment) -> None:
    reject(work)
    with pytest.raises(NotAllowed):
        transition(work, Action.APPEAL, make_worker("bob"), reason="They left.")


def test_somebody_else_decides_the_appeal(work: Assignment) -> None:
    rita, sven = make_reviewer(), make_reviewer("sven")
    transition(work, Action.REJECT, rita, category="low_effort", reason=REASON)
    transition(work, Action.APPEAL, work.worker, reason="They left the square.")
    with pytest.raises(OwnWork):
        transition(work, Action.UPHOLD, rita, reason="No.")
    assert transition(work, Action.OVERTURN, sven, reason="Right.").state == "accepted"
    assert Appeal.objects.get().decided_by == sven


def test_work_accepted_after_all_becomes_a_copy_where_its_batch_is_taken(
    work: Assignment, dataset: Dataset
) -> None:
    reject(work)
    other = claim(make_worker("bob"), dataset)
    transition(work, Action.APPEAL, work.worker, reason="They left the square.")
    found = transition(work, Action.OVERTURN, make_reviewer("sven"), reason="Right.")
    assert (found.batch.number, found.batch.copy) == (other.batch.number, 2)
    assert list(found.batch.frames.all()) == list(other.batch.frames.all())


def test_returned_work_nobody_comes_for_is_taken_back(work: Assignment, dataset: Dataset) -> None:
    rita = make_reviewer()
    transition(work, Action.RETURN, rita, reason="Look again.")
    assert transition(work, Action.TAKE_BACK, rita, reason="No answer for a week.").state == "expired"
    assert claim(make_worker("bob"), dataset).batch == work.batch


def test_a_reviewer_puts_work_right_himself(work: Assignment, dataset: Dataset) -> None:
    rita, frame = make_reviewer(), dataset.frames.get(number=0)
    made = mending.mend(work, rita)
    assert mending.mend(work, rita) == made
    assert [one.position for one in read_frame(made.layer, frame).annotations] == PLACES
    save(made.layer, frame, [row(1, 9)], 1, author=rita, done=True)
    transition(work, Action.ACCEPT_MENDED, rita)
    accepted = Assignment.objects.select_related("mend").get(pk=work.pk)
    assert mending.layer_that_counts(accepted) == made.layer_id
    assert len(read_frame(work.layer, frame).annotations) == len(PLACES)


def test_what_a_colleague_puts_right_is_not_accepted_by_another(work: Assignment) -> None:
    mending.mend(work, make_reviewer())
    sven = make_reviewer("sven")
    with pytest.raises(WrongState, match="rita"):
        mending.mend(work, sven)
    with pytest.raises(Incomplete):
        transition(work, Action.ACCEPT_MENDED, sven)
