"""Where the whole story plays: `-m tests.browser.story_scene` in a site of its own, before anybody comes."""

from __future__ import annotations

import os

import numpy as np

PEOPLE, FRAMES, VIEWS = 5, 10, 3
PASSWORD = "a-long-word-for-tests"
STAFF = {"maria": "manager", "rita": "reviewer", "otto": "reviewer", "lena": "maintainer"}
TRACKER = "tracker"


def build() -> None:
    from django.contrib.auth.models import User

    from gtm_hit.models import Batch, Layer
    from gtm_hit.ops.access import granting
    from gtm_hit.ops.access.roles import Role
    from tests.browser.street import GRID, make_street
    from tests.gold_scene import put
    from tests.work_scene import make_layer

    street = make_street(PEOPLE, FRAMES, views=VIEWS)
    Batch.objects.all().delete()  # only campaigns hand out work here
    known = {
        frame.number: {person + 1: int(place) for person, place in enumerate(street.truth[index])}
        for index, frame in enumerate(street.frames)
    }
    put(make_layer(street.dataset, "truth", Layer.Kind.GROUND_TRUTH, hidden=True), known)
    near = np.random.default_rng(5).normal(0.0, 0.12, (FRAMES, PEOPLE, 2))
    guessed = {
        frame.number: {
            person + 1: int(GRID.nearest([GRID.metres([place])[0] + near[index, person]])[0])
            for person, place in enumerate(street.truth[index])
        }
        for index, frame in enumerate(street.frames)
    }
    put(make_layer(street.dataset, TRACKER, Layer.Kind.PROPOSAL), guessed)
    for name, role in STAFF.items():
        granting.grant(User.objects.create_user(name, password=PASSWORD), Role(role), street.dataset)


if __name__ == "__main__":
    import django

    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    django.setup()
    build()
