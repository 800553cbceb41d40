"""Stitching from the command line."""

from __future__ import annotations

import json
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Layer
from tests.stitch_scene import doubtful, two_batches
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


def printed(*words: str) -> str:
    out = StringIO()
    call_command("stitch", *words, stdout=out, stderr=StringIO())
    return out.getvalue()


def test_it_prints_one_object_with_what_came_out() -> None:
    doubtful()
    found = json.loads(printed("square", "--json"))
    assert (found["layer"], found["people"], found["open_conflicts"]) == ("ground-truth", 3, 1)


def test_again_it_says_that_nothing_changed() -> None:
    two_batches()
    assert "20 frames changed, 0 stayed" in printed("square")
    assert "0 frames changed, 20 stayed" in printed("square", "--gap", "4")


@pytest.mark.parametrize(
    ("words", "reason"),
    [(["--campaign", "autumn"], "no campaign autumn"), (["--gate", "0"], "gate"), ([], "accepted")],
)
def test_what_cannot_be_stitched_is_refused_with_the_reason(words: list[str], reason: str) -> None:
    make_dataset()
    with pytest.raises(CommandError, match=reason):
        printed("square", *words)
    assert not Layer.objects.exists()
