"""Adjusting a desk over REST, from the job to the cameras that stand by its result."""

from __future__ import annotations

import pytest

from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.access.scene import somebody
from tests.adjust_scene import noisy_desk
from tests.api.conftest import Caller

pytestmark = pytest.mark.django_db

AT = "/api/v1/calibration-desks/plaza/"


@pytest.fixture
def maintainer() -> Caller:
    noisy_desk()
    return Caller(user=somebody("mia", Role.MAINTAINER))


def test_a_job_gives_a_result_that_is_used_and_left_again(maintainer: Caller) -> None:
    job = maintainer.post(f"{AT}adjust/", {"variant": "fixed"})
    assert job.status_code == 202, job.json()
    queue.run(job.json()["id"], OPERATIONS)
    worst = maintainer.get(f"{AT}adjust/results/1/").json()["worst"][0]
    click = {name: worst[name] for name in ("source", "point", "camera")}
    dropped = maintainer.post(f"{AT}adjust/decisions/", {**click, "decision": "drop"}).json()
    assert [each["point"] for each in dropped["dropped"]] == [worst["point"]]
    assert maintainer.get(f"{AT}adjust/results/1/").json()["since"]
    assert maintainer.post(f"{AT}adjust/results/1/use/", {}).json()["in_use"] == 1
    assert maintainer.post(f"{AT}adjust/leave/", {}).json()["in_use"] is None


def test_what_cannot_be_is_refused_with_a_sentence(maintainer: Caller) -> None:
    for wrong, word in (({"hold": ["C9:pose"]}, "C9"), ({"turn": 0}, "above 0"), ({"variant": "x"}, "x")):
        answer = maintainer.post(f"{AT}adjust/", wrong)
        assert answer.status_code == 400 and word in answer.content.decode()
    assert maintainer.post(f"{AT}adjust/results/7/use/", {}).status_code == 404
    nothing = {"source": "kept", "point": "P999", "camera": "C1", "decision": "drop"}
    assert maintainer.post(f"{AT}adjust/decisions/", nothing).status_code == 404
