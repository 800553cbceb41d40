from __future__ import annotations

import pytest
from django.db.models import F
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.models import Assignment, Dataset
from gtm_hit.ops.work import links
from gtm_hit.ops.work.assignments import claim
from tests.work_scene import make_dataset, make_worker


@pytest.fixture
def assignment(dataset: Dataset) -> Assignment:
    return claim(make_worker("secret-id"), dataset)


def test_every_token_reads_back(dataset: Dataset, assignment: Assignment) -> None:
    worker = assignment.worker
    entry = links.read_entry(links.entry_token(dataset, "panel"))
    assert (entry.dataset, entry.platform, entry.external_id) == (dataset, "panel", None)
    assert links.read_entry(links.entry_token(dataset, "panel", "ä漢")).external_id == "ä漢"
    assert links.read_worker(links.worker_token(worker, dataset)) == links.Seat(worker, dataset)
    assert links.read_assignment(links.assignment_token(assignment)) == assignment


def test_a_token_of_one_kind_is_none_of_another(dataset: Dataset, assignment: Assignment) -> None:
    with pytest.raises(links.BadToken):
        links.read_assignment(links.worker_token(assignment.worker, dataset))
    with pytest.raises(links.BadToken):
        links.read_worker(links.entry_token(dataset))


def test_a_changed_letter_makes_a_token_worthless(assignment: Assignment) -> None:
    token = links.assignment_token(assignment)
    for index in range(len(token)):
        other = "A" if token[index] != "A" else "B"
        # The last letter of base64 has spare bits, so only what is signed counts.
        if index == len(token) - 1:
            continue
        with pytest.raises(links.BadToken):
            links.read_assignment(token[:index] + other + token[index + 1 :])


def test_tokens_fit_into_an_address(dataset: Dataset, assignment: Assignment) -> None:
    token = links.entry_token(dataset, "panel", "ä/漢?" * 60)
    assert set(token) <= set("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.")


def test_changing_the_nonce_revokes_the_link(assignment: Assignment) -> None:
    token = links.assignment_token(assignment)
    Assignment.objects.update(nonce=F("id"))
    with pytest.raises(links.BadToken):
        links.read_assignment(token)


def test_a_token_of_a_dataset_that_is_gone_is_bad(db: None) -> None:
    dataset = make_dataset()
    token = links.entry_token(dataset)
    dataset.delete()
    with pytest.raises(links.BadToken):
        links.read_entry(token)


@given(st.text() | st.text("abc.-_:=", max_size=20))
def test_any_text_is_a_bad_token(text: str) -> None:
    with pytest.raises(links.BadToken):
        links.unsign("assignment", text)
