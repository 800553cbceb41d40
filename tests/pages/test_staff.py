from __future__ import annotations

from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.template.loader import render_to_string
from django.test import Client
from django.test.utils import CaptureQueriesContext
from django.utils import timezone

from gtm_hit.models import Assignment, Batch, Dataset, Job, Layer, LayerFrame
from gtm_hit.ops.exports import expiry, exporting
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.work import assignments, batches
from tests.work_scene import add_frames, make_dataset, make_layer, make_worker

PAGES = [
    "/datasets/",
    "/datasets/square/",
    "/datasets/square/batches/",
    "/datasets/square/layers/",
    "/exports/",
    "/jobs/{job}/",
    "/jobs/{job}/download/",
]
FORMS = [
    "/datasets/square/batches/",
    "/datasets/square/batches/link/",
    "/datasets/square/layers/own/export/",
    "/jobs/{job}/cancel/",
    "/jobs/{job}/retry/",
    "/jobs/{job}/delete-files/",
]


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, settings: Any) -> None:
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def dataset(db: None) -> Dataset:
    return make_dataset(images=True)


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    layer = make_layer(dataset)
    LayerFrame.objects.create(layer=layer, frame=dataset.frames.all()[0], revision=1, done=True)
    return layer


@pytest.fixture
def job(layer: Layer) -> Job:
    return exporting.start(layer)


@pytest.fixture
def staff(client: Client, db: None) -> Client:
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    return client


def text(response: Any) -> str:
    return response.content.decode()


def everything() -> list[Any]:
    rows = [*Job.objects.order_by("pk").values(), *Layer.objects.values()]
    return [*rows, Batch.objects.count()]


@pytest.mark.parametrize("page", PAGES)
def test_strangers_are_sent_to_the_login_and_back(client: Client, job: Job, page: str) -> None:
    address = page.format(job=job.pk)
    response = client.get(address)
    assert (response.status_code, response["Location"]) == (302, f"/login/?next={address}")


@pytest.mark.parametrize("address", [*PAGES, *FORMS])
def test_an_account_without_a_role_sees_and_changes_nothing(client: Client, job: Job, address: str) -> None:
    client.force_login(User.objects.create_user("curious"))
    before = everything()
    for response in (
        client.get(address.format(job=job.pk)),
        client.post(address.format(job=job.pk), {"size": 10, "copies": 1}),
    ):
        assert response.status_code in {403, 405}
    assert everything() == before


@pytest.mark.parametrize("page", PAGES[:-1])
def test_staff_sees_the_page(staff: Client, job: Job, page: str) -> None:
    assert staff.get(page.format(job=job.pk)).status_code == 200


def test_an_account_that_was_switched_off_sees_nothing(client: Client, dataset: Dataset) -> None:
    client.force_login(User.objects.create_user("gone", is_superuser=True))
    User.objects.update(is_active=False)
    assert client.get("/datasets/").status_code == 302


def test_home_leads_staff_to_the_datasets_and_tells_others_what_this_is(client: Client, db: None) -> None:
    assert "Open the link you were given" in text(client.get("/"))
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    assert client.get("/")["Location"] == "/datasets/"


def test_logging_in_leads_to_the_page_asked_for(client: Client, dataset: Dataset) -> None:
    User.objects.create_user("vera", password="long enough", is_superuser=True)
    refused = client.post("/login/?next=/datasets/square/", {"username": "vera", "password": "wrong"})
    assert "do not match" in text(refused)
    address = "/login/?next=/datasets/square/"
    assert 'name="next" value="/datasets/square/"' in text(client.get(address))
    right = {"username": "vera", "password": "long enough", "next": "/datasets/square/"}
    assert client.post(address, right)["Location"] == "/datasets/square/"


def test_a_server_without_datasets_says_how_to_get_one(staff: Client) -> None:
    page = text(staff.get("/datasets/"))
    assert "manage.py makedemo" in page and "manage.py importdataset" in page


def test_the_list_shows_first_pictures_and_counts(staff: Client, layer: Layer) -> None:
    page = text(staff.get("/datasets/"))
    first = layer.dataset.frames.all()[0]
    assert [f"/api/v1/images/{image.light_digest}.jpg" in page for image in first.images.all()] == [
        True,
        True,
    ]
    assert '<dd>1<span class="muted"> / 20</span></dd>' in page


def test_hidden_truth_does_not_count_as_annotated(staff: Client, layer: Layer) -> None:
    Layer.objects.update(hidden=True)
    assert '<dd>0<span class="muted"> / 20</span></dd>' in text(staff.get("/datasets/"))


def test_names_are_text_and_never_markup(staff: Client, dataset: Dataset) -> None:
    Dataset.objects.update(name="<script>alert(1)</script>")
    for address in ("/datasets/", "/datasets/square/", "/datasets/square/layers/"):
        assert "<script>alert" not in text(staff.get(address))


def test_the_dataset_page_draws_the_ground_and_its_cameras(staff: Client, dataset: Dataset) -> None:
    page = text(staff.get("/datasets/square/"))
    picture = page.split('<image href="')[1].split('"')[0]
    assert page.count('<g class="camera">') == 2
    assert "160,000" in page
    response = staff.get(picture)
    assert response["Content-Type"] == "image/png"
    assert "immutable" in response["Cache-Control"] and "private" in response["Cache-Control"]


def test_the_ground_is_drawn_in_plain_numbers_in_every_language(staff: Client, dataset: Dataset) -> None:
    page = text(staff.get("/datasets/square/", headers={"accept-language": "de"}))
    drawing = page.split("<svg class=")[1].split("</svg>")[0]
    assert "," not in drawing.split('viewBox="')[1].split('"')[0]
    assert 'x="0,' not in drawing


def test_a_dataset_without_cameras_or_frames_still_has_a_page(staff: Client, db: None) -> None:
    Dataset.objects.create(slug="bare", name="Bare")
    for address in ("/datasets/bare/", "/datasets/bare/batches/", "/datasets/bare/layers/"):
        assert staff.get(address).status_code == 200
    assert "no cameras" in text(staff.get("/datasets/bare/"))


def test_an_unknown_dataset_is_told_in_plain_words(staff: Client, db: None, settings: Any) -> None:
    response = staff.get("/datasets/nowhere/")
    assert response.status_code == 404
    assert "There is nothing here" in text(response)


def test_batches_are_made_with_the_form(staff: Client, dataset: Dataset) -> None:
    response = staff.post("/datasets/square/batches/", {"size": 8, "copies": 2}, follow=True)
    assert "6 batches were added." in text(response)
    assert dataset.batches.count() == 6


@pytest.mark.parametrize("size", ["0", "-1", "", "many", "100000"])
def test_an_impossible_size_makes_no_batches(staff: Client, dataset: Dataset, size: str) -> None:
    response = staff.post("/datasets/square/batches/", {"size": size, "copies": 1})
    assert "errorlist" in text(response)
    assert not dataset.batches.exists()


def test_the_batches_page_tells_who_has_what_and_until_when(staff: Client, dataset: Dataset) -> None:
    batches.make_batches(dataset)
    assignment = assignments.claim(make_worker(), dataset)
    for frame in assignment.batch.frames.all()[:4]:
        LayerFrame.objects.update_or_create(
            layer=assignment.layer, frame=frame, defaults={"revision": 1, "done": True}
        )
    page = text(staff.get("/datasets/square/batches/"))
    assert assignment.worker.pseudonym in page and "worker-one" not in page
    assert "being annotated" in page and "4/10" in page
    assert f"{assignment.expires_at:%Y-%m-%d %H:%M}" in page
    Assignment.objects.update(expires_at=timezone.now() - timedelta(minutes=1))
    assert "lease ran out" in text(staff.get("/datasets/square/batches/"))


def test_the_entry_link_on_the_batches_page_works(staff: Client, dataset: Dataset) -> None:
    page = text(staff.get("/datasets/square/batches/"))
    link = page.split('value="http://testserver')[1].split('"')[0]
    assert link.startswith("/join/")
    assert Client().get(link).status_code == 200


def test_the_entry_link_is_closed_and_made_anew_by_buttons(staff: Client, dataset: Dataset) -> None:
    first = text(staff.get("/datasets/square/batches/")).split('value="http://testserver')[1].split('"')[0]
    page = text(staff.post("/datasets/square/batches/link/", {"switch": "close"}, follow=True))
    assert "The link for workers is closed" in page and first not in page
    assert Client().get(first).status_code == 410
    page = text(staff.post("/datasets/square/batches/link/", {"switch": "open"}, follow=True))
    again = page.split('value="http://testserver')[1].split('"')[0]
    assert again != first and Client().get(again).status_code == 200


def test_the_batches_page_says_how_to_make_a_personal_link(staff: Client, dataset: Dataset) -> None:
    assert "manage.py makelink square --worker ID" in text(staff.get("/datasets/square/batches/"))


def test_export_starts_one_job_however_often_it_is_pressed(staff: Client, layer: Layer) -> None:
    first = staff.post("/datasets/square/layers/own/export/")
    second = staff.post("/datasets/square/layers/own/export/")
    job = Job.objects.get()
    assert first["Location"] == second["Location"] == f"/jobs/{job.pk}/"
    assert job.created_by is not None and job.created_by.username == "vera"


def test_opening_the_address_of_a_form_changes_nothing(staff: Client, job: Job) -> None:
    before = everything()
    for address in FORMS[1:]:
        assert staff.get(address.format(job=job.pk)).status_code == 405
    assert everything() == before


def test_a_form_from_elsewhere_is_refused(layer: Layer) -> None:
    strict = Client(enforce_csrf_checks=True)
    strict.force_login(User.objects.create_user("vera", is_superuser=True))
    response = strict.post("/datasets/square/layers/own/export/")
    assert response.status_code == 403
    assert "This form is too old" in text(response)
    assert not Job.objects.exists()


def test_the_job_page_follows_the_job(staff: Client, job: Job) -> None:
    address = f"/jobs/{job.pk}/"
    assert "waiting" in text(staff.get(address)) and "Cancel" in text(staff.get(address))
    run = queue.claim(job.pk)
    assert run is not None
    run.report(40, 100, "writing frames: 4 of 10")
    page = text(staff.get(address))
    assert "running" in page and 'value="40" max="100"' in page and "writing frames: 4 of 10" in page
    asked = page.split('data-job="')[1].split('"')[0]
    state = staff.get(asked).json()
    assert (state["state"], state["done"], state["total"]) == ("running", 40, 100)
    assert state["finished_at"] is None
    run.fail("The disk is full.")
    page = text(staff.get(address))
    assert "The disk is full." in page and "Try again" in page and "http-equiv" not in page


def test_an_expired_export_says_so_and_is_made_again(staff: Client, job: Job) -> None:
    queue.run(job.pk, {job.kind: exporting.run})
    assert "Files kept until" in text(staff.get(f"/jobs/{job.pk}/"))
    expiry.expire(timezone.now() + timedelta(days=31))
    page = text(staff.get(f"/jobs/{job.pk}/download/", follow=True))
    assert "kept for 30 days" in page and "Make it again" in page
    assert staff.post(f"/jobs/{job.pk}/retry/").url != f"/jobs/{job.pk}/"


def test_the_files_of_an_export_can_be_deleted(staff: Client, job: Job) -> None:
    queue.run(job.pk, {job.kind: exporting.run})
    assert "Delete files" in text(staff.get(f"/jobs/{job.pk}/"))
    page = text(staff.post(f"/jobs/{job.pk}/delete-files/", follow=True))
    assert "were deleted" in page and "Delete files" not in page


def test_a_job_without_files_says_that_there_are_none(staff: Client, job: Job) -> None:
    assert "no files to delete" in text(staff.post(f"/jobs/{job.pk}/delete-files/", follow=True))


def test_a_finished_export_can_be_downloaded(staff: Client, job: Job) -> None:
    queue.run(job.pk, {job.kind: exporting.run})
    page = text(staff.get(f"/jobs/{job.pk}/"))
    assert "Download zip" in page and "annotations_positions/00000000.json" in page
    response = staff.get(f"/jobs/{job.pk}/download/")
    assert response["Content-Disposition"] == 'attachment; filename="square-own.zip"'
    assert b"".join(response.streaming_content).startswith(b"PK")
    assert f'href="/jobs/{job.pk}/download/"' in text(staff.get("/exports/"))


def test_a_job_that_is_not_done_has_nothing_to_download(staff: Client, job: Job) -> None:
    assert staff.get(f"/jobs/{job.pk}/download/").status_code == 404


def test_a_waiting_job_is_cancelled_and_started_again(staff: Client, job: Job) -> None:
    staff.post(f"/jobs/{job.pk}/cancel/")
    job.refresh_from_db()
    assert job.state == Job.State.CANCELLED
    again = staff.post(f"/jobs/{job.pk}/retry/")
    assert again["Location"] != f"/jobs/{job.pk}/"
    assert Job.objects.filter(state=Job.State.QUEUED).count() == 1


def test_a_job_under_way_is_not_started_twice(staff: Client, job: Job) -> None:
    assert "still under way" in text(staff.post(f"/jobs/{job.pk}/retry/", follow=True))
    assert Job.objects.count() == 1


@pytest.mark.parametrize(
    "address", ["/datasets/", "/datasets/square/batches/", "/datasets/square/layers/", "/exports/"]
)
def test_pages_ask_the_database_the_same_number_of_times_for_many_rows(
    staff: Client, layer: Layer, address: str
) -> None:
    batches.make_batches(layer.dataset, size=5)
    grow(layer.dataset, 1)
    few = queries_of(staff, address)
    for number in range(2, 6):
        grow(layer.dataset, number)
    assert queries_of(staff, address) == few


def grow(dataset: Dataset, number: int) -> None:
    """One more of everything a page lists."""
    assignment = assignments.claim(make_worker(f"worker-{number}"), dataset)
    Assignment.objects.filter(pk=assignment.pk).update(
        state=Assignment.State.SUBMITTED, submitted_at=timezone.now()
    )
    other = make_dataset(f"square-{number}", frames=2, images=True)
    exporting.start(make_layer(other))
    exporting.start(make_layer(dataset, f"layer-{number}"))
    add_frames(dataset, 5)
    batches.make_batches(dataset, size=5)


def queries_of(client: Client, address: str) -> int:
    with CaptureQueriesContext(connection) as queries:
        assert client.get(address).status_code == 200
    return len(queries)


def test_long_lists_are_cut_into_pages(staff: Client, dataset: Dataset) -> None:
    Layer.objects.bulk_create(
        Layer(dataset=dataset, name=f"layer-{number:03d}", kind=Layer.Kind.IMPORTED) for number in range(150)
    )
    first, second = (text(staff.get(f"/datasets/square/layers/?page={page}")) for page in (1, 2))
    assert "layer-099" in first and "layer-100" not in first
    assert "layer-100" in second and "101 to 150 of 150" in second
    assert staff.get("/datasets/square/layers/?page=nonsense").status_code == 200


def test_layers_of_workers_come_last(staff: Client, dataset: Dataset) -> None:
    make_layer(dataset, "batch-0001", Layer.Kind.ASSIGNMENT)
    make_layer(dataset, "truth", Layer.Kind.GROUND_TRUTH)
    page = text(staff.get("/datasets/square/layers/"))
    assert page.index("truth") < page.index("batch-0001")


@pytest.mark.parametrize("name", ["403.html", "404.html", "500.html", "403_csrf.html"])
def test_error_pages_need_no_context(name: str) -> None:
    assert 'href="/"' in render_to_string(name)


def test_a_job_without_a_dataset_has_a_page_too(staff: Client, db: None) -> None:
    job = queue.create(Job.Kind.IMPORT_DATASET, None, {})
    assert "Import of a dataset" in text(staff.get(f"/jobs/{job.pk}/"))
