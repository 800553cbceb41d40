from __future__ import annotations

from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Batch
from tests.work_scene import make_dataset


def run(*arguments: str) -> str:
    output = StringIO()
    call_command("makebatches", *arguments, stdout=output)
    return output.getvalue()


def test_it_tells_how_many_batches_it_added(db: None) -> None:
    make_dataset(frames=25)
    assert run("square") == "square: 3 batches added, 3 in all\n"
    assert run("square", "--copies", "2") == "square: 3 batches added, 6 in all\n"


def test_the_size_can_be_chosen(db: None) -> None:
    make_dataset(frames=25)
    assert run("square", "--size", "5").startswith("square: 5 batches added")


def test_an_unknown_dataset_is_named(db: None) -> None:
    with pytest.raises(CommandError, match="no dataset nowhere; there are: none"):
        run("nowhere")


def test_an_impossible_size_makes_nothing(db: None) -> None:
    make_dataset()
    with pytest.raises(CommandError, match="1 to 500"):
        run("square", "--size", "0")
    assert not Batch.objects.exists()
