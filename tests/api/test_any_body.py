"""Whatever is sent, the answer is one of those described, and only a described save is written."""

from __future__ import annotations

import json
import uuid
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.django import TestCase

from gtm_hit.models import Save
from gtm_hit.ops.work import assignments, batches, links
from tests.api.conftest import Caller
from tests.work_scene import make_dataset, make_worker, row

json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda children: st.lists(children, max_size=4) | st.dictionaries(st.text(), children, max_size=4),
    max_leaves=8,
)
nearly_rows = st.fixed_dictionaries(
    {"person": st.integers(0, 5) | json_values, "position": st.integers(0, 200_000) | json_values},
    optional={
        "state": st.sampled_from(["validated", "carried"]) | json_values,
        "origin": st.just("clicked") | json_values,
        "height": st.floats(0, 4) | json_values,
        "radius": st.floats(0, 3) | json_values,
    },
)
bodies = st.fixed_dictionaries(
    {},
    optional={
        "save_id": st.uuids().map(str) | json_values,
        "revision": st.integers(0, 3) | json_values,
        "annotations": st.lists(nearly_rows, max_size=4) | json_values,
        "done": st.booleans() | json_values,
        "nobody": st.booleans() | json_values,
        "seconds": st.floats(0, 100) | json_values,
    },
)
few = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])


class AnyBodyTest(TestCase):
    def setup_example(self) -> None:
        super().setup_example()
        dataset = make_dataset(frames=2)
        batches.make_batches(dataset)
        assignment = assignments.claim(make_worker(), dataset)
        self.alice = Caller(f"Assignment {links.assignment_token(assignment)}")
        self.learner = Caller(f"Worker {links.worker_token(assignment.worker, dataset)}")

    def send(self, caller: Caller, method: str, path: str, content: Any) -> Any:
        # json.dumps writes lone surrogates as escapes, as a hostile sender would.
        return getattr(caller.client, method)(
            path, json.dumps(content), content_type="application/json", headers=caller.headers
        )

    @few
    @given(bodies | json_values)
    def test_any_save_is_written_or_refused(self, sent: Any) -> None:
        response = self.send(self.alice, "put", "/api/v1/assignment/frames/5/", sent)
        assert response.status_code in {200, 400, 412}, response.content
        assert Save.objects.exists() == (response.status_code == 200)

    @few
    @given(st.lists(nearly_rows, max_size=3), st.booleans(), st.booleans())
    def test_what_was_accepted_is_what_is_read(self, rows: list[Any], done: bool, nobody: bool) -> None:
        sent = {
            "save_id": str(uuid.uuid4()),
            "revision": 0,
            "annotations": rows,
            "done": done,
            "nobody": nobody,
        }
        path = "/api/v1/assignment/frames/5/"
        response = self.send(self.alice, "put", path, sent)
        if response.status_code == 200:
            wanted = sorted(({**row(), **one} for one in rows), key=lambda one: one["person"])
            assert self.alice.get(path).json() == response.json()
            assert response.json()["annotations"] == wanted

    @few
    @given(json_values)
    def test_any_submission_is_answered(self, sent: Any) -> None:
        response = self.send(self.alice, "post", "/api/v1/assignment/submit/", sent)
        assert response.status_code == 409, response.content

    @few
    @given(st.fixed_dictionaries({}, optional={"step": json_values, "frame": json_values}) | json_values)
    def test_any_check_is_answered(self, sent: Any) -> None:
        response = self.send(self.learner, "post", "/api/v1/tutorial/check/", sent)
        assert response.status_code in {400, 404}, response.content

    @few
    @given(st.text("abc.-_:=/ \x00é漢", max_size=40))
    def test_any_token_is_answered(self, token: str) -> None:
        header = f"Assignment {token}".encode().decode("latin-1")
        assert Caller(header).get("/api/v1/assignment/scene/").status_code == 401
