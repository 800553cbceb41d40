from __future__ import annotations

import uuid
from typing import Any

import pytest
from django.apps import apps
from django.contrib import admin
from django.contrib.auth.models import User
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Annotation, Assignment, Dataset, Job, Save
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.work import assignments, batches
from tests.work_scene import do_frames, make_dataset, make_layer, make_worker, row, save

MODELS = sorted(model.__name__.lower() for model in apps.get_app_config("gtm_hit").get_models(False))
LOOK_ONLY = ["annotation", "batch", "camera", "frame", "image", "job", "layerframe", "save"]


@pytest.fixture
def dataset(db: None) -> Dataset:
    return make_dataset(images=True)


@pytest.fixture
def chief(client: Client, db: None) -> Client:
    client.force_login(User.objects.create_superuser("chief"))
    return client


def grow(dataset: Dataset, count: int) -> None:
    """`count` more rows of every kind."""
    for number in range(count):
        name = uuid.uuid4().hex
        other = make_dataset(name, frames=1, images=True)
        batches.make_batches(other)
        do_frames(assignments.claim(make_worker(name), other))
        save(make_layer(other), other.frames.get(), [row(number + 1)])
        queue.create(Job.Kind.EXPORT_LAYER, other, {}, User.objects.create_user(name))


def test_every_model_has_its_place_in_the_admin(db: None) -> None:
    registered = {
        model.__name__.lower() for model in admin.site._registry if model._meta.app_label == "gtm_hit"
    }
    assert registered == set(MODELS)


@pytest.mark.parametrize("model", MODELS)
def test_lists_ask_the_database_the_same_number_of_times_for_many_rows(
    chief: Client, dataset: Dataset, model: str
) -> None:
    grow(dataset, 2)
    few = queries_of(chief, f"/admin/gtm_hit/{model}/")
    grow(dataset, 4)
    assert queries_of(chief, f"/admin/gtm_hit/{model}/") <= few


def queries_of(client: Client, address: str) -> int:
    with CaptureQueriesContext(connection) as queries:
        assert client.get(address).status_code == 200
    return len(queries)


@pytest.mark.parametrize("model", MODELS)
def test_every_list_can_be_searched(chief: Client, dataset: Dataset, model: str) -> None:
    grow(dataset, 1)
    assert chief.get(f"/admin/gtm_hit/{model}/?q=12").status_code == 200


@pytest.mark.parametrize("model", LOOK_ONLY)
def test_what_others_wrote_is_read_and_neither_added_changed_nor_deleted(
    chief: Client, dataset: Dataset, model: str
) -> None:
    grow(dataset, 1)
    found = apps.get_model("gtm_hit", model).objects.first()
    before = list(type(found).objects.values())
    address = f"/admin/gtm_hit/{model}/"
    assert chief.get(f"{address}{found.pk}/change/").status_code == 200
    assert chief.post(f"{address}{found.pk}/change/", {"revision": 9, "state": "done"}).status_code == 403
    assert chief.post(f"{address}{found.pk}/delete/", {"post": "yes"}).status_code == 403
    assert chief.get(f"{address}add/").status_code == 403
    assert list(type(found).objects.values()) == before


def test_a_datasets_name_can_be_corrected_but_not_its_grid(chief: Client, dataset: Dataset) -> None:
    address = f"/admin/gtm_hit/dataset/{dataset.pk}/change/"
    posted = {
        "name": "The square",
        "columns": "7",
        "frame_rate": "10",
        "frame_step": "5",
        "annotation_offset": "0",
        "annotation_digits": "8",
        "instructions": "",
    }
    assert chief.post(address, posted).status_code == 302
    dataset.refresh_from_db()
    assert (dataset.name, dataset.columns) == ("The square", 400)


def test_a_dataset_with_history_cannot_be_deleted(chief: Client, dataset: Dataset) -> None:
    save(make_layer(dataset), dataset.frames.all()[0], [row()])
    chief.post(f"/admin/gtm_hit/dataset/{dataset.pk}/delete/", {"post": "yes"})
    assert Dataset.objects.filter(pk=dataset.pk).exists()
    assert (Save.objects.count(), Annotation.objects.count()) == (1, 1)


def test_a_lease_can_be_lengthened_by_hand_but_not_accepted(chief: Client, dataset: Dataset) -> None:
    batches.make_batches(dataset)
    assignment = assignments.claim(make_worker(), dataset)
    posted: dict[str, Any] = {"expires_at_0": "2099-01-01", "expires_at_1": "12:00:00", "state": "accepted"}
    assert chief.post(f"/admin/gtm_hit/assignment/{assignment.pk}/change/", posted).status_code == 302
    assignment.refresh_from_db()
    assert (assignment.expires_at.year, assignment.state) == (2099, Assignment.State.LEASED)


def test_staff_without_rights_sees_no_rows(client: Client, dataset: Dataset) -> None:
    client.force_login(User.objects.create_user("vera", is_staff=True))
    assert client.get("/admin/gtm_hit/save/").status_code == 403


def test_strangers_are_sent_to_the_login(client: Client, db: None) -> None:
    assert client.get("/admin/gtm_hit/save/").status_code == 302
