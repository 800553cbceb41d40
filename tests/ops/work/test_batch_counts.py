from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment
from gtm_hit.ops import overview
from gtm_hit.ops.work import assignments
from gtm_hit.ops.work.batches import make_batches
from tests.work_scene import make_dataset, make_worker

pytestmark = pytest.mark.django_db


def test_a_lease_that_ran_out_is_free_before_the_clock_comes_by() -> None:
    dataset = make_dataset()
    count = make_batches(dataset)
    assignments.claim(make_worker(), dataset)
    assert (overview.batch_counts(dataset).free, overview.batch_counts(dataset).leased) == (count - 1, 1)
    Assignment.objects.update(expires_at=timezone.now() - timedelta(seconds=1))
    assert (overview.batch_counts(dataset).free, overview.batch_counts(dataset).leased) == (count, 0)
