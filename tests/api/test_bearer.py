from __future__ import annotations

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import Layer, Save
from gtm_hit.ops import api_tokens
from tests.api.conftest import Caller, bearer, body
from tests.work_scene import row


def test_a_token_with_the_scope_reads(layer: Layer) -> None:
    assert bearer("read").get(f"/api/v1/layers/{layer.pk}/scene/").status_code == 200


def test_saving_takes_another_scope_and_bears_the_owners_name(layer: Layer) -> None:
    path = f"/api/v1/layers/{layer.pk}/frames/5/"
    refused = bearer("read").put(path, body(people=[row()]))
    assert (refused.status_code, refused.json()["code"]) == (403, "forbidden")
    assert "work" in refused.json()["message"]
    assert not Save.objects.exists()
    saved = bearer("work").put(path, body(people=[row()]))
    assert (saved.status_code, saved.json()["author"]) == (200, "script")


def test_a_scope_to_write_does_not_read(layer: Layer) -> None:
    assert bearer("work").get(f"/api/v1/layers/{layer.pk}/scene/").status_code == 403


@pytest.mark.parametrize("authorization", ["Bearer", "Bearer ", "Bearer gtm_wrong", "bearer x y"])
def test_a_wrong_key_is_nobody_even_beside_a_session(layer: Layer, authorization: str) -> None:
    manager = User.objects.create_user("manager", is_superuser=True)
    response = Caller(authorization, manager).get(f"/api/v1/layers/{layer.pk}/scene/")
    assert (response.status_code, response.json()["code"]) == (401, "not_signed_in")


def test_a_revoked_token_stops_at_once(layer: Layer) -> None:
    script = bearer("read")
    api_tokens.revoke(api_tokens.valid().get())
    assert script.get(f"/api/v1/layers/{layer.pk}/scene/").status_code == 401


def test_pictures_need_the_scope_to_read(layer: Layer) -> None:
    path = f"/api/v1/images/{'0' * 64}.jpg"
    assert bearer("read").get(path).status_code == 404
    assert bearer("work").get(path).status_code == 403
