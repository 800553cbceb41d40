from __future__ import annotations

from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Dataset, Worker
from gtm_hit.ops.work import links
from tests.work_scene import make_dataset


@pytest.fixture
def dataset(db: None) -> Dataset:
    return make_dataset()


def run(*arguments: str) -> str:
    output = StringIO()
    call_command("makelink", *arguments, stdout=output)
    return output.getvalue().strip()


def entry(link: str) -> links.Entry:
    return links.read_entry(link.split("/")[-2])


def test_it_prints_the_whole_link(dataset: Dataset) -> None:
    link = run("square", "--base-url", "https://marker.example/", "--platform", "panel")
    assert link.startswith("https://marker.example/join/")
    assert entry(link) == links.Entry(dataset, "panel", None)


def test_a_personal_link_names_its_worker_and_creates_nothing(dataset: Dataset) -> None:
    assert entry(run("square", "--worker", "Ä 1")).external_id == "Ä 1"
    assert not Worker.objects.exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nowhere"], "no dataset nowhere; there are: square"),
        (["square", "--platform", "my panel"], "'my panel'"),
        (["square", "--platform", "p" * 41], "at most 40"),
        (["square", "--worker", "x" * 256], "255 characters"),
    ],
)
def test_what_makes_no_link_is_explained(dataset: Dataset, arguments: list[str], said: str) -> None:
    with pytest.raises(CommandError, match=said):
        run(*arguments)


def test_a_link_is_closed_and_a_new_one_made(dataset: Dataset) -> None:
    first = run("square")
    assert "closed" in run("square", "--close")
    assert entry(first).closed
    with pytest.raises(CommandError, match="--open"):
        run("square")
    again = run("square", "--open")
    assert not entry(again).closed and entry(first).closed


def test_a_personal_link_is_made_while_the_general_one_is_closed(dataset: Dataset) -> None:
    run("square", "--close")
    assert not entry(run("square", "--worker", "ada")).closed


def test_a_personal_link_has_no_switch(dataset: Dataset) -> None:
    with pytest.raises(CommandError, match="personal"):
        run("square", "--worker", "ada", "--close")
