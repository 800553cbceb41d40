"""Signed addresses: what a link entitles its holder to. Nothing in them is secret, nothing can be altered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django.core.signing import BadSignature, Signer

from gtm_hit.models import Assignment, Dataset, Worker
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.work import entry_links


class BadToken(OperationError):
    """Not signed here, cut off in copying, or revoked."""


@dataclass(frozen=True)
class Entry:
    """The way into a dataset's work; a personal link names the worker too."""

    dataset: Dataset
    platform: str
    external_id: str | None
    closed: bool = False  # to new people


@dataclass(frozen=True)
class Seat:
    """A worker at one dataset."""

    worker: Worker
    dataset: Dataset


def entry_token(dataset: Dataset, platform: str = "link", external_id: str | None = None) -> str:
    if external_id:
        return sign("entry", [dataset.pk, platform, external_id])
    nonce = entry_links.state(dataset, platform).nonce
    return sign("entry", [dataset.pk, platform, *(["", nonce] if nonce else [])])


def read_entry(token: str) -> Entry:
    dataset_id, platform, *more = unsign("entry", token)
    dataset = Dataset.objects.filter(pk=dataset_id).first()
    if dataset is None:
        raise BadToken("the dataset is gone")
    external_id, nonce = [*more, "", ""][:2]
    if external_id:
        return Entry(dataset, platform, external_id)
    link = entry_links.state(dataset, platform)
    return Entry(dataset, platform, None, closed=link.closed_at is not None or link.nonce != nonce)


def worker_token(worker: Worker, dataset: Dataset) -> str:
    return sign("worker", [worker.pk, dataset.pk])


def read_worker(token: str) -> Seat:
    worker_id, dataset_id = unsign("worker", token)
    worker = Worker.objects.filter(pk=worker_id).first()
    dataset = Dataset.objects.filter(pk=dataset_id).first()
    if worker is None or dataset is None:
        raise BadToken("the worker or the dataset is gone")
    return Seat(worker, dataset)


def assignment_token(assignment: Assignment) -> str:
    return sign("assignment", [assignment.pk, assignment.nonce])


def read_assignment(token: str) -> Assignment:
    assignment_id, nonce = unsign("assignment", token)
    rows = Assignment.objects.select_related("batch__dataset", "worker", "layer__dataset")
    assignment = rows.filter(pk=assignment_id, nonce=nonce).first()
    if assignment is None:
        raise BadToken("the assignment is gone or its link was revoked")
    return assignment


def sign(kind: str, content: list[Any]) -> str:
    return signer(kind).sign_object(content)


def unsign(kind: str, token: str) -> list[Any]:
    try:
        return signer(kind).unsign_object(token)
    except (BadSignature, ValueError) as error:
        raise BadToken("not signed here") from error


def signer(kind: str) -> Signer:
    # One salt per kind: a token of one kind is never taken for another.
    return Signer(salt=f"gtm_hit.{kind}", sep=".")
