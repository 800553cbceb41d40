"""Who is let in by a link: the browser counts, not what is known about somebody."""

from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from gtm_hit.crowd.entry import WORKER_PARAMETERS
from gtm_hit.models import Assignment, Dataset, Worker
from gtm_hit.ops.work import assignments, batches, entry_links, links
from gtm_hit.pages.work import workplace
from tests.work_scene import finish, make_dataset, make_worker


@pytest.fixture
def dataset(db: None) -> Dataset:
    dataset = make_dataset()
    batches.make_batches(dataset)
    return dataset


@pytest.fixture
def entry(dataset: Dataset) -> str:
    return f"/join/{links.entry_token(dataset, 'prolific')}/"


@pytest.fixture
def alice(client: Client, entry: str) -> Worker:
    """She entered in `client`."""
    client.post(entry, {"worker_id": "alice"})
    return Worker.objects.get(external_id="alice")


def personal(dataset: Dataset, external_id: str = "alice") -> str:
    return f"/join/{links.entry_token(dataset, 'prolific', external_id)}/"


def text(response: Any) -> str:
    return response.content.decode()


def without_form_secret(page: str) -> str:
    start = page.index('name="csrfmiddlewaretoken"')
    return page[:start] + page[page.index(">", start) :]


@pytest.mark.parametrize("name", WORKER_PARAMETERS)
def test_another_browser_with_her_id_is_not_her(
    alice: Worker, dataset: Dataset, entry: str, name: str
) -> None:
    code = finish(assignments.claim(alice, dataset)).code
    for response in (
        Client().get(f"{entry}?{name}=alice", follow=True),
        Client().post(entry, {name: "alice"}, follow=True),
    ):
        assert not response.redirect_chain
        assert str(code) not in text(response)


def test_another_browser_is_told_what_to_do(alice: Worker, entry: str) -> None:
    response = Client().post(entry, {"worker_id": "alice"})
    assert response.status_code == 403
    assert "ask the people who gave you the link for your personal link" in text(response)


def test_opening_the_link_does_not_tell_which_ids_exist(alice: Worker, entry: str) -> None:
    pages, queries = [], []
    for external_id in ("alice", "clara"):
        with CaptureQueriesContext(connection) as counted:
            page = without_form_secret(text(Client().get(f"{entry}?worker_id={external_id}")))
        pages.append(page.replace(external_id, "…"))
        queries.append(len(counted))
    assert pages[0] == pages[1]
    assert queries[0] == queries[1]


def test_who_tries_out_ids_is_stopped(alice: Worker, client: Client, entry: str) -> None:
    for _number in range(workplace.NOT_PROVEN.most):
        assert Client().post(entry, {"worker_id": "alice"}).status_code == 403
    for external_id in ("alice", "somebody new"):
        assert Client().post(entry, {"worker_id": external_id}).status_code == 429
    assert client.post(entry, {"worker_id": "alice"}).status_code == 302


def test_a_personal_link_opens_in_every_browser(alice: Worker, dataset: Dataset) -> None:
    response = Client().get(personal(dataset))
    assert response["Location"] == f"/work/{links.worker_token(alice, dataset)}/"


def test_a_personal_link_leaves_the_first_browser_its_own(
    client: Client, alice: Worker, dataset: Dataset, entry: str
) -> None:
    Client().get(personal(dataset))
    assert client.get(entry + "?worker_id=alice").status_code == 302


def test_who_came_by_a_personal_link_cannot_be_taken_over(
    client: Client, dataset: Dataset, entry: str
) -> None:
    client.post(personal(dataset))
    assert Client().post(entry, {"worker_id": "alice"}).status_code == 403
    assert client.get(entry + "?worker_id=alice").status_code == 302


def test_a_worker_without_work_from_before_is_bound_at_the_next_entry(
    client: Client, dataset: Dataset, entry: str
) -> None:
    make_worker("old", "prolific")
    assert client.post(entry, {"worker_id": "old"}).status_code == 302
    assert Client().post(entry, {"worker_id": "old"}).status_code == 403


def test_a_worker_with_work_from_before_needs_the_personal_link(dataset: Dataset, entry: str) -> None:
    old = make_worker("old", "prolific")
    assignments.claim(old, dataset)
    assert Client().get(entry + "?worker_id=old").status_code == 200
    assert Client().post(entry, {"worker_id": "old"}).status_code == 403
    assert Client().get(personal(dataset, "old")).status_code == 302


def test_no_script_reads_the_secret_and_the_database_does_not_hold_it(client: Client, alice: Worker) -> None:
    cookie = client.cookies["browser"]
    assert cookie["httponly"] and cookie["samesite"] == "Lax"
    assert len(alice.browser) == 64
    assert alice.browser not in cookie.value and cookie.value.split(":")[0] != alice.browser


def test_a_changed_cookie_is_no_proof(client: Client, alice: Worker, entry: str) -> None:
    client.cookies["browser"] = "x" + client.cookies["browser"].value
    assert client.post(entry, {"worker_id": "alice"}).status_code == 403


def test_a_closed_link_lets_nobody_new_in(dataset: Dataset, entry: str) -> None:
    entry_links.close(dataset, "prolific")
    for response in (Client().get(entry + "?worker_id=new"), Client().post(entry, {"worker_id": "new"})):
        assert response.status_code == 410
        assert "This link is closed" in text(response)
    assert not Worker.objects.exists()


def test_whoever_began_goes_on_after_the_link_is_closed(
    client: Client, alice: Worker, dataset: Dataset, entry: str
) -> None:
    entry_links.close(dataset, "prolific")
    assert client.get(entry + "?worker_id=alice").status_code == 302
    assert Client().get(personal(dataset)).status_code == 302


def test_opening_again_makes_a_new_link_and_the_old_one_stays_closed(dataset: Dataset, entry: str) -> None:
    entry_links.close(dataset, "prolific")
    entry_links.reopen(dataset, "prolific")
    fresh = f"/join/{links.entry_token(dataset, 'prolific')}/"
    assert fresh != entry
    assert Client().get(entry).status_code == 410
    assert Client().post(fresh, {"worker_id": "new"}).status_code == 302


def test_links_of_other_platforms_stay_open(dataset: Dataset, entry: str) -> None:
    entry_links.close(dataset, "link")
    assert Client().get(entry).status_code == 200


def test_invented_ids_take_few_batches(dataset: Dataset, entry: str, settings: Any) -> None:
    settings.UNSAVED_PER_ADDRESS = 1
    answers = []
    for number in range(2):
        visitor = Client()
        home = visitor.post(entry, {"worker_id": f"invented {number}"})["Location"]
        answers.append(visitor.post(home + "start/"))
    assert [response.status_code for response in answers] == [302, 429]
    assert "Please wait a few minutes" in text(answers[1])
    assert Assignment.objects.count() == 1


def test_the_workers_page_says_how_to_make_a_personal_link(
    client: Client, alice: Worker, dataset: Dataset
) -> None:
    assignments.claim(alice, dataset)
    client.force_login(User.objects.create_superuser("chief"))
    page = text(client.get(f"/admin/gtm_hit/worker/{alice.pk}/change/"))
    assert "manage.py makelink square --platform prolific --worker alice" in page
    assert alice.browser not in page
