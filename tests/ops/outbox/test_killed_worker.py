"""A worker process that is killed between a request and its answer: everybody is paid, and nobody twice."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.ops.site import Site
from tests.prolific_server import Prolific, prolific_server
from tests.services import postgres_url, redis_url  # noqa: F401


def built(site: Site, prolific: Prolific) -> Site:
    site.environment["PROLIFIC_ADDRESSES"] = prolific.base
    for number in (1, 2, 3):
        prolific.add(f"s{number}", f"p{number}")
    site.python("manage.py", "migrate", "--verbosity", "0")
    site.python("-m", "tests.ops.outbox.paid_scene", "build")
    return site


def states(site: Site) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for kind, state in site.sql("SELECT kind, state FROM gtm_hit_outboxrow ORDER BY id"):
        found.setdefault(kind, []).append(state)
    return found


def check_killed_between_request_and_answer(site: Site, prolific: Prolific) -> None:
    prolific.go_wrong("/pay/", "hold")
    job = int(site.python("-m", "tests.ops.outbox.paid_scene", "start"))
    with site.worker():
        site.wait_until(prolific.holding.is_set)
    assert states(site)["bonus_pay"] == ["sent", "planned", "planned"]
    assert len(prolific.payments) == 1

    prolific.let_go.set()
    site.half_a_minute_passes()
    with site.worker():
        site.wait_until(lambda: site.job(job)["state"] in {"done", "failed"})

    assert site.job(job) == {"state": "done", "attempts": 2, "message": ""}
    assert {state for each in states(site).values() for state in each} == {"confirmed"}
    assert [prolific.paid(f"s{number}") for number in (1, 2, 3)] == [2, 2, 2]
    assert len([asked for asked in prolific.asked if asked.endswith("/pay/")]) == 3
    paid = site.sql(
        "SELECT worker_id, SUM(amount) FROM gtm_hit_moneyentry WHERE kind = 'paid' GROUP BY worker_id"
    )
    assert sorted(float(total) for _worker, total in paid) == [4, 4, 4]


def test_a_worker_killed_between_paying_and_the_answer_pays_once(tmp_path: Path) -> None:
    with prolific_server() as prolific:
        check_killed_between_request_and_answer(built(Site(tmp_path), prolific), prolific)


@pytest.mark.services
def test_the_same_on_postgresql_and_redis(
    tmp_path: Path,
    postgres_url: str,  # noqa: F811
    redis_url: str,  # noqa: F811
) -> None:
    with prolific_server() as prolific:
        site = built(Site(tmp_path, postgres_url, redis_url), prolific)
        check_killed_between_request_and_answer(site, prolific)
