"""People whom somebody else's program found, read from the formats that annotations come in."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from pathlib import Path

from django.contrib.auth.models import User

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Dataset, Frame, ProposalRun
from gtm_hit.ops.jobs.progress import Progress, no_progress
from gtm_hit.ops.layers.findings import Findings, Kind
from gtm_hit.ops.layers.importing import AnnotationSource, read_people
from gtm_hit.ops.layers.tables import People
from gtm_hit.ops.proposals import runs, tracks
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.proposing import Proposed, keep
from gtm_hit.vision.people import FrameProposals
from gtm_hit.vision.people import Proposal as Found

METHOD = ProposalRun.Method.FILE.value
SCORE = 1.0  # files of these formats say who is there, not how sure they are


def take_in(
    dataset: Dataset, path: Path, kind: str, progress: Progress = no_progress, user: User | None = None
) -> tuple[ProposalRun, Proposed]:
    """A run out of a file; raises ProposalError with everything that is wrong with it."""
    findings = Findings(frozenset({Kind.OUTSIDE, Kind.DUPLICATES}))
    try:
        found = read_people(dataset, AnnotationSource(path, kind), progress, findings)
        findings.standing.raise_if_any()
    except FormatError as error:
        raise ProposalError(str(error)) from error
    told = {"file": path.name, "content": _digest(path), "format": kind}
    run = runs.find_or_make(dataset, METHOD, "", told, user)
    by_frame = _by_frame(dataset, found)
    frames = Frame.objects.filter(dataset=dataset, number__in=[*by_frame, *found.empty]).order_by("number")
    for frame in frames:
        keep(run, frame, told["content"], FrameProposals(tuple(by_frame.get(frame.number, ()))), 0.0)
    return run, Proposed(len(frames), 0, len(found), tracks.link_run(run))


def _by_frame(dataset: Dataset, found: People) -> dict[int, list[Found]]:
    people: dict[int, list[Found]] = defaultdict(list)
    cylinder, metres = dataset.cylinder, dataset.grid.metres(found.positions).tolist()
    columns = (found.frames.tolist(), metres, found.heights.tolist(), found.radii.tolist())
    for number, (x, y), height, radius in zip(*columns, strict=True):
        tall = cylinder.height if height != height else height
        wide = cylinder.radius if radius != radius else radius
        people[number].append(Found(x, y, tall, wide, SCORE, (), METHOD))
    return people


def _digest(path: Path) -> str:
    files = sorted(each for each in path.rglob("*") if each.is_file()) if path.is_dir() else [path]
    whole = hashlib.sha256()
    for file in files:
        with file.open("rb") as stream:
            whole.update(hashlib.file_digest(stream, "sha256").digest())
    return whole.hexdigest()
