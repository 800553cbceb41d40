"""What a worker lacks before he may come into a campaign."""

from __future__ import annotations

from django.db.models import OuterRef, Q, QuerySet, Subquery

from gtm_hit.models import Campaign, Dataset, Qualification, QualificationGrant, Worker


def missing_qualifications(campaign: Campaign, worker: Worker) -> list[str]:
    """Names of the qualifications the campaign asks for and the worker does not have now; one query."""
    required = Qualification.objects.filter(required_by__campaign=campaign)
    return list(lacking(required, worker).order_by("name").values_list("name", flat=True))


def lacking(qualifications: QuerySet[Qualification], worker: Worker) -> QuerySet[Qualification]:
    rows = QualificationGrant.objects.filter(qualification=OuterRef("pk"), worker=worker).order_by("-pk")
    marked = qualifications.annotate(held=Subquery(rows.values("granted")[:1]))
    return marked.filter(Q(held=False) | Q(held=None))


def offered(dataset: Dataset) -> QuerySet[Qualification]:
    """What workers of the dataset can try."""
    return Qualification.objects.filter(dataset=dataset, closed_at=None).order_by("name")
