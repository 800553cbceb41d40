"""A job's page follows the job by itself."""

from __future__ import annotations

import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Job
from gtm_hit.ops.jobs import queue

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def job(page: Page, live_server: LiveServer) -> Job:
    """A waiting job, shown to staff."""
    client = Client()
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    job = queue.create(Job.Kind.IMPORT_DATASET, None, {})
    page.goto(f"{live_server.url}/jobs/{job.pk}/")
    return job


def test_the_page_shows_how_far_the_job_is_and_how_it_ends(page: Page, job: Job) -> None:
    expect(page.locator("[data-job-state]")).to_have_text("waiting")
    run = queue.claim(job.pk)
    assert run is not None
    run.report(40, 100, "reading pictures")
    expect(page.locator("[data-job-state]")).to_have_text("running")
    expect(page.locator("[data-job-count]")).to_have_text("40 %")
    expect(page.locator("[data-job-message]")).to_have_text("reading pictures")
    run.fail("The disk is full.")
    expect(page.get_by_role("alert")).to_have_text("The disk is full.")


def test_a_session_that_ended_leads_to_the_login(page: Page, job: Job) -> None:
    page.context.clear_cookies()
    page.wait_for_url("**/login/?next=/jobs/**")
