from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.models import Worker
from gtm_hit.ops.work.workers import InvalidWorkerId, clean_external_id, enter, find


@pytest.mark.parametrize(
    "external_id", ["A1B2", "5f3cdead", "ä漢🙂", "with blank inside", "x" * 255, "a/b?c=d&e", "../../etc"]
)
def test_ids_of_any_alphabet_and_case_are_kept_as_they_are(db: None, external_id: str) -> None:
    assert enter("panel", external_id).external_id == external_id
    assert Worker.objects.get() == enter("panel", external_id)


def test_case_makes_a_difference(db: None) -> None:
    assert enter("panel", "abc") != enter("panel", "ABC")


def test_one_id_on_two_platforms_is_two_workers(db: None) -> None:
    assert enter("panel", "abc") != enter("prolific", "abc")


def test_blanks_around_a_copied_id_do_not_count(db: None) -> None:
    assert enter("panel", " abc\n") == enter("panel", "abc")


@pytest.mark.parametrize(
    "external_id", ["", " \t", "a\x00b", "a\nb", "\x7f", "\ud800", "a\u2028b", "x" * 256]
)
def test_what_no_platform_gives_out_is_refused(db: None, external_id: str) -> None:
    with pytest.raises(InvalidWorkerId):
        enter("panel", external_id)
    assert not Worker.objects.exists()


def test_looking_for_a_worker_creates_none(db: None) -> None:
    assert find("panel", "abc") is None
    assert not Worker.objects.exists()


def test_the_pseudonym_tells_nothing_of_the_id(db: None) -> None:
    assert "5f3c" not in enter("panel", "5f3c").pseudonym


@given(st.text(max_size=300))
def test_any_text_is_cleaned_once_and_for_all_or_refused(text: str) -> None:
    try:
        cleaned = clean_external_id(text)
    except InvalidWorkerId:
        return
    assert clean_external_id(cleaned) == cleaned
    assert 1 <= len(cleaned) <= 255
    cleaned.encode()
