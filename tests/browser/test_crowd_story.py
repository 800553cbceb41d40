"""From a link to trusted, paid, merged ground truth: web server, worker, PostgreSQL, Redis and Chromium."""

from __future__ import annotations

import re
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import psycopg
import pytest
from playwright.sync_api import Browser, Page, expect
from redis import Redis

from gtm_hit.metrics import detection, tracking
from gtm_hit.metrics.annotations import Annotations
from tests.browser import story
from tests.browser.story import DATASET, TRUTH, Batch, Story, Worker
from tests.browser.street import GRID
from tests.ops.site import Site
from tests.prolific_server import TOKEN, Prolific, prolific_server
from tests.services import postgres_url, redis_url  # noqa: F401

pytestmark = [pytest.mark.browser, pytest.mark.services, pytest.mark.flaky(reruns=1)]

RULES: dict[str, Any] = {
    "batch_size": 4,
    "overlap": 1,
    "copies": 2,
    "currency": "EUR",
    "pay_per_batch": "2.00",
    "hourly_floor": "8.00",
    "review_share": 1.0,
}
CODES = {"code_completed": "DONE1", "code_no_work": "NONE1", "code_not_admitted": "OUT1"}
WHY = "Nobody in these frames was touched: everybody stands where he was put, also where that is wrong. Look."


@pytest.fixture
def prolific() -> Iterator[Prolific]:
    with prolific_server() as server:
        yield server


@pytest.fixture
def site(
    tmp_path: Path,
    prolific: Prolific,
    postgres_url: str,  # noqa: F811
    redis_url: str,  # noqa: F811
) -> Site:
    site = Site(tmp_path, own_database(postgres_url), own_queue(redis_url))
    site.environment["PROLIFIC_ADDRESSES"] = prolific.base
    site.python("manage.py", "migrate", "--verbosity", "0")
    site.python("-m", "tests.browser.story_scene")
    site.python("-c", story.COLLECT)
    return site


def own_database(postgres_url: str) -> str:  # noqa: F811
    """An empty one beside that of the other tests."""
    name = f"story_{uuid.uuid4().hex[:8]}"
    with psycopg.connect(postgres_url, autocommit=True) as connection:
        connection.execute(f"CREATE DATABASE {name}")
    return f"{postgres_url.rpartition('/')[0]}/{name}"


def own_queue(redis_url: str) -> str:  # noqa: F811
    """An empty one beside that of the other tests."""
    own = f"{redis_url.removesuffix('/0')}/7"
    Redis.from_url(own).flushdb()
    return own


@pytest.fixture
def tale(site: Site, prolific: Prolific, browser: Browser) -> Iterator[Story]:
    expect.set_options(timeout=30_000)
    with story.web_server(site) as address:
        tale = Story(site, prolific, browser, address)
        yield tale
        for context in browser.contexts:
            context.close()
    expect.set_options(timeout=5_000)


def open_campaigns(tale: Story) -> None:
    """Three, one for each kind of link; the panel's has two copies, gold frames and planted faults."""
    for name, platform, more in (
        ("panel", "prolific", {"platform_settings": CODES}),
        ("survey", "link", {}),
        ("team", "own_team", {"copies": 1}),
    ):
        tale.maria.post("campaigns/", name=name, platform=platform, **{**RULES, **more})
        if name != "team":
            tale.maria.post(f"campaigns/{name}/gold/", layer="truth", share=0.5)
            faults = {"starting_layer": "tracker", "share": 1.0, "faults": 3}
            tale.maria.post(f"campaigns/{name}/planted-faults/", **faults)
    account = {"address": tale.prolific.base, "study": "st1", "token": TOKEN}
    tale.maria.post("campaigns/panel/platform/", **account)
    page = tale.staff("maria")
    for name in ("panel", "survey", "team"):
        tale.at(page, f"campaigns/{name}/").get_by_role("button", name="Open", exact=True).click()
        expect(page.get_by_role("button", name="Pause")).to_be_visible()


def somebody_goes_away(tale: Story) -> None:
    """Invited to the own team, he begins in the workbench and closes the browser; his batch is free again."""
    page = story.somebody(tale.browser, tale.errors)
    page.goto(tale.link("team", "invitation"))
    page.get_by_label("Name to log in with").fill("tom")
    page.get_by_label("Password").fill("another-long-word")
    page.get_by_role("button", name="Make my account").click()
    page.get_by_role("button", name="Open").click()
    page.get_by_role("button", name=re.compile("start", re.I)).first.click()
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    page.locator('[data-view="camera-0"]').click()
    expect(page.locator(".people li .number")).to_have_count(1)
    expect(page.locator(".save-words")).to_have_text(re.compile("All saved"))
    page.context.close()
    tale.site.sql("UPDATE gtm_hit_assignment SET expires_at = now() - interval '1 minute'")
    tale.site.python("-c", EXPIRE)
    tale.site.wait_until(lambda: states(tale, "team") == ["expired"])


EXPIRE = "from annotator.celery import app; app.send_task('gtm_hit.tasks.expire_leases')"


def states(tale: Story, campaign: str) -> list[str]:
    found = tale.site.sql(
        "SELECT a.state FROM gtm_hit_assignment a JOIN gtm_hit_batch b ON a.batch_id = b.id"
        " JOIN gtm_hit_campaign c ON b.campaign_id = c.id WHERE c.name = ? ORDER BY b.number, b.copy",
        campaign,
    )
    return [state for (state,) in found]


def three_work(tale: Story) -> dict[str, Batch]:
    """Ada is careful and Sam is sloppy, both by Prolific; Nina presses “next”, by the general link."""
    link, held = tale.link("panel"), {}
    for person, how in (("ada", story.careful), ("sam", story.sloppy)):
        for number in (1, 2, 3):
            submission = f"{person}-{number}"
            tale.prolific.add(submission, person)
            held[submission] = story.came_by_prolific(tale.address, link, person, submission)
            tale.works(held[submission], how, 600)
            assert "cc=DONE1" in held[submission].home()
    for number, batch in enumerate(by_general_link(tale), start=1):
        held[f"nina-{number}"] = batch
    return held


def by_general_link(tale: Story) -> list[Batch]:
    page = story.somebody(tale.browser, tale.errors)
    page.goto(tale.link("survey"))
    page.get_by_label("Your worker ID").fill("nina")
    page.get_by_role("button", name="Start").click()
    page.wait_for_url(re.compile("/work/"))
    home, held = page.url, []
    for press in (re.compile("start", re.I), "Annotate another batch", "Annotate another batch"):
        page.get_by_role("button", name=press).first.click()
        page.wait_for_url(re.compile("/annotate/"))
        held.append(Batch(tale.address, story.token_in(page.url)))
        code = tale.works(held[-1], story.pressing_next, 1)
        page.goto(home)
        expect(page.get_by_label("Your completion code")).to_have_value(code)
    page.context.close()
    return held


def scores(tale: Story) -> dict[str, tuple[float, float, float]]:
    """By worker, once the worker process has measured everything: the score and its interval."""
    found: dict[str, tuple[float, float, float]] = {}

    def measured() -> bool:
        rows = tale.site.sql(
            "SELECT w.external_id, s.score, s.low, s.high, s.assignments FROM gtm_hit_workerscore s"
            " JOIN gtm_hit_worker w ON s.worker_id = w.id"
        )
        found.update({row[0]: row[1:4] for row in rows})
        return {row[0]: row[4] for row in rows} == {"ada": 3, "sam": 3, "nina": 3}

    tale.site.wait_until(measured)
    for name, (score, low, high) in sorted(found.items(), key=lambda one: -one[1][0]):
        tale.told.append(f"{name:<28}{score:6.1f}  ({low:.0f} to {high:.0f})")
    return found


def desk(tale: Story, page: Page, pk: int) -> Page:
    tale.at(page, f"review/{pk}/")
    expect(page.locator("#viewer")).to_have_attribute("data-ready", "true")
    return page


def accept(tale: Story, page: Page, pk: int) -> None:
    desk(tale, page, pk).keyboard.press("a")
    asked = page.get_by_role("dialog").get_by_role("button", name="Accept")
    tale.site.wait_until(lambda: asked.is_visible() or not at_desk(page.url, pk))
    if asked.is_visible():
        asked.click()
    decided(tale, page, pk, "accepted")


def at_desk(url: str, pk: int) -> bool:
    return f"/review/{pk}/" in url


def decided(tale: Story, page: Page, pk: int, state: str) -> None:
    page.wait_for_url(lambda url: not at_desk(url, pk))  # the next one, or the queue
    tale.site.wait_until(
        lambda: tale.site.sql("SELECT state FROM gtm_hit_assignment WHERE id = ?", pk) == [(state,)]
    )


def returned_and_mended(tale: Story, rita: Page, batch: Batch) -> None:
    """Rita pins a comment; Sam puts his batch right, finds the comment and answers; then it is accepted."""
    pk = tale.review_of("panel", 2, 2)
    desk(tale, rita, pk)
    rita.keyboard.press("n")
    rita.keyboard.press("c")
    expect(rita.get_by_role("dialog")).to_contain_text("Frame ")
    rita.keyboard.type("Somebody is missing here, and others stand beside their feet.")
    rita.keyboard.press("Control+Enter")
    expect(rita.locator(".comments li")).to_contain_text("Somebody is missing")
    rita.keyboard.press("r")
    rita.get_by_role("dialog").get_by_role("button", name="Return").click()
    decided(tale, rita, pk, "returned")

    sam = story.somebody(tale.browser, tale.errors)
    tale.hour_passes()
    batch.annotate(story.careful, 60)
    sam.goto(f"{tale.address}/annotate/{batch.token}/")
    expect(sam.locator("#workbench")).to_have_attribute("data-ready", "true")
    comment = sam.locator(".comments li")
    expect(comment).to_contain_text("Somebody is missing")
    comment.get_by_label("Answer").fill("All of them are there now.")
    comment.get_by_label("Answer").press("Enter")
    expect(comment).to_contain_text("You: All of them are there now.")
    comment.get_by_role("button", name="Done").click()
    expect(sam.locator(".comments h2")).to_contain_text("All comments are done")
    sam.context.close()
    batch.submit()
    accept(tale, rita, pk)


def rejected_and_appealed(tale: Story, rita: Page, batch: Batch) -> None:
    """Nina objects; Otto, who did not reject it, decides."""
    pk = tale.review_of("survey", 1, 1)
    desk(tale, rita, pk).keyboard.press("x")
    dialog = rita.get_by_role("dialog")
    dialog.get_by_label("Category").last.select_option("failed_check")
    dialog.get_by_label("Reason").last.fill(WHY)
    dialog.get_by_role("button", name="Reject").click()
    decided(tale, rita, pk, "rejected")
    nina = story.somebody(tale.browser, tale.errors)
    nina.goto(f"{tale.address}/annotate/{batch.token}/decision/")
    expect(nina.locator("main")).to_contain_text(WHY)
    nina.get_by_role("textbox").fill("I looked at every frame, they were right.")
    nina.get_by_role("button", name="Appeal").click()
    expect(nina.get_by_role("button", name="Appeal")).to_have_count(0)
    otto = tale.at(tale.staff("otto"), f"review/{pk}/appeal/")
    otto.get_by_role("textbox").fill("Three planted faults are still there.")
    otto.get_by_role("button", name="The rejection stands").click()
    tale.site.wait_until(lambda: tale.site.sql("SELECT outcome FROM gtm_hit_appeal") == [("upheld",)])
    nina.reload()
    expect(nina.locator("main")).to_contain_text("Three planted faults are still there.")


def paid_once(tale: Story, worker: Any) -> None:
    """Bonuses are proposed, approved and sent; the worker is killed before Prolific answers."""
    page = tale.at(tale.staff("maria"), "campaigns/panel/pay/")
    page.get_by_role("button", name=re.compile(r"Approve 2 bonuses")).click()
    expect(page.locator("main")).to_contain_text("2 bonuses were approved")
    tale.at(page, "campaigns/panel/pay/payout/").get_by_role("button", name="Plan these payments").click()
    tale.prolific.go_wrong("/pay/", "hold")
    page.get_by_role("button", name=re.compile(r"Send \d+ rows")).click()
    page.wait_for_url(re.compile(r"/jobs/\d+/"))
    tale.site.wait_until(tale.prolific.holding.is_set)
    worker.kill()
    tale.prolific.let_go.set()
    tale.site.half_a_minute_passes()
    worker.start()
    tale.site.wait_until(lambda: unconfirmed(tale) == [])
    asked = [one for one in tale.prolific.asked if one.endswith("/pay/")]
    # 8.00 an hour at least: Ada did three batches of 40 minutes for 6.00, Sam one of 44 minutes for 2.00.
    assert len(asked) == len(tale.prolific.payments) == 2
    assert sorted(cents for _to, cents in tale.prolific.payments) == [387, 1000]
    # Only what was accepted is approved; two of Sam's batches wait for their review.
    told = {name: one["status"] for name, one in tale.prolific.submissions.items()}
    assert {name for name, status in told.items() if status == "APPROVED"} == {
        *("ada-1", "ada-2", "ada-3"),
        "sam-2",
    }
    money = tale.maria.get("campaigns/panel/pay/")
    sums = [[one[kind] for kind in ("earned", "bonus_approved", "paid")] for one in money["workers"]]
    assert sorted(sums) == [["2.00", "3.87", "5.87"], ["6.00", "10.00", "16.00"]]
    for earned, bonus, paid in sums:
        tale.told.append(f"earned {earned} + bonus {bonus} = paid {paid} {money['currency']}")


def unconfirmed(tale: Story) -> list[Any]:
    return tale.site.sql("SELECT kind, state, error FROM gtm_hit_outboxrow WHERE state <> 'confirmed'")


def stitched_and_released(tale: Story) -> tuple[float, float]:
    """MODA and IDF1 of the release against the truth."""
    page = tale.at(tale.staff("maria"), "campaigns/panel/stitching/")
    page.get_by_role("button", name="Make the ground truth").click()
    job_done(tale, "stitch")
    order = {"layer": "ground-truth-panel", "licence": "CC BY 4.0", "formats": ["wildtrack"]}
    tale.lena.post("releases/", **order)
    job_done(tale, "make_release")
    folder = tale.site.folder / "releases" / "street" / "1"
    found = annotations(story.released(folder))
    truth = annotations(
        [(frame, person, place) for frame, places in TRUTH.items() for person, place in enumerate(places)]
    )
    moda = detection.evaluate(truth, found).moda
    idf1 = tracking.evaluate(truth, found).score.idf1
    tale.told.append(f"MODA {moda:.3f}   IDF1 {idf1:.3f}")
    return moda, idf1


TABS = ("", "rules/", "links/", "workers/", "gold/", "scores/", "suspicion/", "review/", "pay/", "platform/")


def every_page_answers(tale: Story) -> None:
    """Of all three campaigns, with everything that has happened in them."""
    page = tale.staff("maria")
    answers = {
        path: page.request.get(f"{tale.address}/{DATASET}{path}").status
        for path in [
            *(f"campaigns/{name}/{tab}" for name in ("panel", "survey", "team") for tab in TABS),
            *("campaigns/panel/stitching/", "stitching/conflicts/", "review/", "releases/1/", "statistics/"),
        ]
    }
    assert {path: status for path, status in answers.items() if status != 200} == {}


def job_done(tale: Story, kind: str) -> None:
    def over() -> bool:
        rows = tale.site.sql("SELECT state, message FROM gtm_hit_job WHERE kind = ?", kind)
        assert not rows or rows[0][0] != "failed", rows
        return [state for state, _message in rows] == ["done"]

    tale.site.wait_until(over)


def annotations(rows: list[tuple[int, int, int]]) -> Annotations:
    frames, persons, places = np.array(rows, np.int64).T
    return Annotations(frames, GRID.metres(places), persons)


@pytest.fixture
def worker(site: Site) -> Iterator[Worker]:
    worker = Worker(site)
    worker.start()
    yield worker
    worker.kill()


def test_from_a_link_to_trusted_paid_and_merged_ground_truth(tale: Story, worker: Worker) -> None:
    open_campaigns(tale)
    somebody_goes_away(tale)
    held = three_work(tale)
    found = scores(tale)
    assert found["ada"][0] > 80, found
    assert found["sam"][0] < 65 and found["nina"][0] < 65, found

    rita = tale.staff("rita")
    returned_and_mended(tale, rita, held["sam-2"])
    for number in (1, 2, 3):
        accept(tale, rita, tale.review_of("panel", number, 1))
    rejected_and_appealed(tale, rita, held["nina-1"])
    paid_once(tale, worker)
    moda, idf1 = stitched_and_released(tale)
    print("\n" + "\n".join(tale.told))
    every_page_answers(tale)
    assert moda >= 0.99
    assert idf1 >= 0.99
    assert tale.errors == []
