"""Runs with detectors of others: from a command's file, and at an address that the operator listed."""

from __future__ import annotations

import io
import json
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from gtm_hit import tasks
from gtm_hit.models import Dataset, Job, PictureBoxes, ProposalFrame
from gtm_hit.ops.proposals import detectors, job, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.job import Order
from gtm_hit.ops.work import batches
from tests.detector_server import DetectorServer, serving
from tests.vision.test_python_detectors import CVAT_STYLE


def propose(*options: Any) -> dict[str, Any]:
    stream = io.StringIO()
    call_command("propose", "square", "--json", *map(str, options), stdout=stream, stderr=io.StringIO())
    found: dict[str, Any] = json.loads(stream.getvalue())
    return found


def test_a_command_may_name_a_file_and_its_parameters(dataset: Dataset) -> None:
    told = propose("--detector-file", CVAT_STYLE, "-p", "below=int:90")
    assert told["frames"] == 8
    run = runs.runs(dataset)[0]
    assert run.model.startswith("cvat_style-") and run.parameters["params"] == {"below": 90}
    assert PictureBoxes.objects.filter(model=run.model).count() == 16
    assert propose("--detector-module", "tests.vision.cvat_style")["run"] != run.pk


@pytest.mark.parametrize("wrong", ["below", "below=90", "below=int:many", "below=list:1"])
def test_parameters_that_cannot_be_read_are_refused(dataset: Dataset, wrong: str) -> None:
    with pytest.raises(CommandError, match="NAME=TYPE:VALUE"):
        propose("--detector-file", CVAT_STYLE, "-p", wrong)


def test_new_frames_do_not_start_what_only_a_command_may_name(dataset: Dataset, settings: Any) -> None:
    propose("--detector-file", CVAT_STYLE)
    ProposalFrame.objects.all()[0].delete()
    settings.PROPOSE_AUTOMATICALLY = True
    batches.make_batches(dataset, size=4)
    assert not Job.objects.exists()


@pytest.mark.parametrize("detector", [f"file:{CVAT_STYLE}", "module:tests.vision.cvat_style"])
def test_nobody_else_can_name_files_and_modules(dataset: Dataset, detector: str) -> None:
    with pytest.raises(ProposalError):
        job.start(dataset, Order(detector=detector))
    smuggled = Job.objects.create(
        kind=Job.Kind.PROPOSE, dataset=dataset, parameters={"method": "cover", "detector": detector}
    )
    tasks.run_job(smuggled.pk)
    smuggled.refresh_from_db()
    assert smuggled.state == Job.State.FAILED and "no longer offered" in smuggled.message


def test_a_listed_address_is_asked_picture_by_picture(dataset: Dataset, settings: Any) -> None:
    with serving(DetectorServer()) as server:
        settings.DETECTOR_ADDRESSES = [server.address]
        started = job.start(dataset, Order("projected", server.address))
        tasks.run_job(started.pk)
    started.refresh_from_db()
    assert started.state == Job.State.DONE, started.message
    assert len(server.asked) == 16
    assert runs.runs(dataset)[0].model == server.address


def test_a_model_of_all_views_at_an_address_proposes_its_places(dataset: Dataset, settings: Any) -> None:
    with serving(DetectorServer(multi_view=True)) as server:
        settings.DETECTOR_ADDRESSES = [server.address]
        run, proposed = job.do(dataset, Order(detector=server.address))
        assert (run.method, proposed.people, len(server.asked)) == ("located", 8, 8)
        with pytest.raises(ProposalError, match="needs boxes"):
            job.do(dataset, Order("projected", server.address))


def test_an_address_nobody_listed_gets_no_picture(dataset: Dataset) -> None:
    with serving(DetectorServer()) as server:
        assert server.address not in detectors.choices()
        with pytest.raises(ProposalError):
            job.do(dataset, Order(detector=server.address))
    assert server.asked == []


def test_a_broken_one_fails_the_job_and_names_frame_and_camera(dataset: Dataset, settings: Any) -> None:
    with serving(DetectorServer()) as server:
        settings.DETECTOR_ADDRESSES = [server.address]
        server.wrong = "status"
        started = job.start(dataset, Order(detector=server.address))
        tasks.run_job(started.pk)
        started.refresh_from_db()
        assert started.state == Job.State.FAILED
        assert started.message == "Frame 0: C1: the detector answers 503: out of memory"
        server.wrong = ""
        tasks.run_job(job.start(dataset, Order(detector=server.address)).pk)  # repaired, it goes on
    assert ProposalFrame.objects.count() == 8
