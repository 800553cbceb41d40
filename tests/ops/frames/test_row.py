"""Rows: the six facts of an annotation have one order, wherever they are written."""

from __future__ import annotations

from gtm_hit.api.workbench.frames import AnnotationSerializer
from gtm_hit.ops.frames.row import FIELDS, Row

ROW = Row(7, 1200, "carried", "copied", 1.5, 0.2)


def test_a_row_is_written_in_the_order_in_which_answers_have_always_shown_it() -> None:
    assert list(ROW.as_dict()) == ["person", "position", "state", "origin", "height", "radius"]


def test_a_row_comes_back_from_a_database_that_sorts_its_keys() -> None:
    assert Row.from_dict(dict(sorted(ROW.as_dict().items()))) == ROW


def test_what_is_done_to_the_written_row_does_not_reach_the_row() -> None:
    ROW.as_dict()["position"] = 3
    assert ROW.position == 1200


def test_somebody_carried_over_is_to_be_looked_at() -> None:
    assert Row.carried(7, 1200).as_dict() == {
        "person": 7,
        "position": 1200,
        "state": "carried",
        "origin": "carried",
        "height": None,
        "radius": None,
    }


def test_the_interface_describes_every_field_of_a_row() -> None:
    assert set(AnnotationSerializer().get_fields()) == set(FIELDS)
