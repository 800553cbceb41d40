"""What reviewers and workers share about the comments of an assignment."""

from __future__ import annotations

from django.shortcuts import get_object_or_404
from rest_framework.response import Response

from gtm_hit.models import Assignment, Comment
from gtm_hit.ops.review import facts


def comment_or_404(assignment: Assignment, pk: int) -> Comment:
    rows = Comment.objects.select_related("assignment__batch__dataset", "assignment__worker", "answers")
    return get_object_or_404(rows, assignment=assignment, pk=pk)


def listed(assignment: Assignment, status: int = 200) -> Response:
    return Response({"comments": facts.comments_of(assignment)}, status=status)
