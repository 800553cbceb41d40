"""A row is found only below the dataset and the campaign it belongs to, even by who may see both."""

from __future__ import annotations

import pytest

from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.work import links
from tests.access.conftest import Places
from tests.access.scene import Place, somebody
from tests.access.table import TABLE
from tests.access.test_table import LINES, Caller

pytestmark = pytest.mark.django_db

ROWS = (
    *("review/<int:pk>", "reviews/<int:pk>", "comments/<int:comment>", "conflicts/<int:pk>"),
    *("links/<int:pk>", "outbox/<int:pk>", "rows/<int:pk>", "ledger/<int:pk>", "lines/<int:pk>"),
)
CROSSED = [(row, route) for row in ROWS for route in TABLE if f"/{row}" in route]
BODIES = {
    "reviews/<int:pk>/decision/": '{"action": "accept"}',
    "comments/<int:comment>/": '{"resolved": true}',
    "pk>/comments/": '{"text": "Look here."}',
    "conflicts/<int:pk>/decide/": '{"decision": "same"}',
    "outbox/<int:pk>/": '{"action": "withdraw"}',
    "take-back/": '{"note": "wrong"}',
    "links/<int:pk>/": '{"deed": "revoke"}',
}


@pytest.fixture(scope="module")
def caller(places: Places) -> Caller:
    return Caller("a manager of both", somebody("of-both", Role.MANAGER), "manager", everywhere=True)


@pytest.mark.parametrize(("row", "route"), CROSSED)
def test_a_row_of_another_dataset_is_not_there(places: Places, caller: Caller, row: str, route: str) -> None:
    here = places.here
    fills = {**here.fills, row: places.elsewhere.fills[row]}
    crossed = Place(here.dataset, here.assignment, here.layer, here.hidden, fills)
    for method in (method for address, method in LINES if address == route):
        body = next((sent for tail, sent in BODIES.items() if route.endswith(tail)), "")
        if not route.startswith("api/"):
            body = "deed=revoke&action=withdraw&note=wrong"
        kind = "application/json" if route.startswith("api/") else "application/x-www-form-urlencoded"
        answer = caller.client.generic(method, crossed.address(route), body, content_type=kind)
        assert answer.status_code == 404, f"{method} /{route}"


def test_a_batchs_token_answers_no_comment_on_another_ones_work(places: Places, caller: Caller) -> None:
    address = places.elsewhere.address("api/v1/assignment/comments/<int:pk>/")
    headers = {"Authorization": f"Assignment {links.assignment_token(places.here.assignment)}"}
    body = '{"resolved": true}'
    answer = caller.client.generic("POST", address, body, content_type="application/json", headers=headers)
    assert answer.status_code == 404
