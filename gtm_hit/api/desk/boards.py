"""Pictures of boards, and the lens that is solved from them."""

from __future__ import annotations

from typing import Any

from django.http import Http404, HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.parsing import BoundedJSONParser, BoundedMultiPartParser
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import ASKS, READS, WRITES, answers, asked, caller
from gtm_hit.api.datasets.importing import FiniteField
from gtm_hit.api.desk.common import DeskView, desk_or_404, told
from gtm_hit.api.desk.lenses import DeskLensShape, lens_answer
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.models import BoardPicture, Desk
from gtm_hit.ops.desk import board_choices, boards, lens_job, preview
from gtm_hit.ops.files import sources


class BoardQuery(serializers.Serializer[Any]):
    kind = serializers.ChoiceField(choices=board_choices.KINDS)
    columns = serializers.IntegerField(min_value=1, max_value=LARGEST, help_text="inner corners or circles")
    rows = serializers.IntegerField(min_value=1, max_value=LARGEST, help_text="ChArUco: squares")
    spacing = FiniteField(help_text="metres: side of a square, or between two circles of a row")
    marker = FiniteField(required=False, help_text="ChArUco: share of a square's side")
    dictionary = serializers.ChoiceField(choices=board_choices.DICTIONARIES, required=False)
    inverted = serializers.BooleanField(required=False, help_text="white printed on black")
    legacy = serializers.BooleanField(required=False, help_text="ChArUco as OpenCV before 4.6 laid it out")


class LensModelSerializer(serializers.Serializer[Any]):
    coefficients = serializers.ChoiceField(choices=board_choices.COEFFICIENTS, default="five")
    fixed_centre = serializers.BooleanField(default=False, help_text="stays in the middle of the picture")
    fixed_aspect = serializers.BooleanField(default=False, help_text="fx = fy")


class SearchSerializer(BoardQuery, LensModelSerializer):
    """The board that is looked for, and the model that is solved."""


class SendBoardsSerializer(SearchSerializer):
    file = serializers.ListField(
        child=serializers.FileField(), max_length=lens_job.MOST_FILES, help_text="pictures, a zip, or a video"
    )


class PictureSwitchSerializer(serializers.Serializer[Any]):
    used = StrictBooleanField()


class BoardPictureShape(serializers.ModelSerializer[BoardPicture]):
    found = serializers.SerializerMethodField()

    class Meta:
        model = BoardPicture
        fields = ["id", "name", "found", "reason", "used", "light_digest", "full_digest", "width", "height"]

    def get_found(self, row: BoardPicture) -> int:
        """Points of the board that were found."""
        return len(row.found["pixels"]) if row.found else 0


class BoardPicturesShape(serializers.Serializer[Any]):
    pictures = BoardPictureShape(many=True)
    board = serializers.DictField(allow_null=True, help_text="board and model asked for last")


class BoardsParser(BoundedMultiPartParser):
    def most_bytes(self) -> int:
        return sources.most_bytes()


class Boards(DeskView):
    parser_classes = [BoardsParser]

    @extend_schema(
        operation_id="board_pictures",
        summary="A camera's pictures of boards: found or not, and why",
        responses=answers(200, BoardPicturesShape, READS),
    )
    def get(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        with told():
            rows = boards.pictures_of(found, camera)
            board = boards.camera_of(found, camera).board
        return Response({"pictures": BoardPictureShape(rows, many=True).data, "board": board})

    @extend_schema(
        operation_id="send_board_pictures",
        summary="Send pictures of a board, and solve the lens from them",
        request={"multipart/form-data": SendBoardsSerializer},
        responses=answers(202, JobShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(SearchSerializer(data=request.data))
        with told("file"):
            board = boards.board_of(wanted)
            boards.camera_of(found, camera)
            sent = lens_job.keep_upload(request.FILES.getlist("file"))
            model = board_choices.model_of(wanted)
            return started(lens_job.start(found, camera, board, model, sent, caller(request)))

    @extend_schema(
        operation_id="remove_board_pictures",
        summary="Remove all pictures of boards of a camera",
        description="The lens stays.",
        responses={204: None, **READS},
    )
    def delete(self, request: Request, desk: str, camera: str) -> Response:
        with told():
            boards.remove_all(desk_or_404(request, desk), camera)
        return Response(status=204)


class SearchBoards(DeskView):
    parser_classes = [BoundedJSONParser]

    @extend_schema(
        operation_id="search_boards",
        summary="Look for a board in the pictures that are there, and solve",
        request=SearchSerializer,
        responses=answers(202, JobShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(SearchSerializer(data=request.data))
        with told("kind"):
            board, model = boards.board_of(wanted), board_choices.model_of(wanted)
            return started(lens_job.start(found, camera, board, model, "", caller(request)))


class OneBoardPicture(DeskView):
    @extend_schema(
        operation_id="switch_board_picture",
        summary="Let a picture take part in the solve, or not; solves again at once",
        request=PictureSwitchSerializer,
        responses=answers(200, DeskLensShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str, picture: int) -> Response:
        found = desk_or_404(request, desk)
        name = _picture(found, camera, picture).name
        used = valid(PictureSwitchSerializer(data=request.data))["used"]
        with told("used"):
            boards.switch(found, camera, name, used, caller(request))
            return Response(lens_answer(found, camera))


class SolveModel(DeskView):
    @extend_schema(
        operation_id="solve_lens_model",
        summary="Solve the pictures in use with another model",
        request=LensModelSerializer,
        responses=answers(200, DeskLensShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(LensModelSerializer(data=request.data))
        with told("coefficients"):
            boards.use_model(found, camera, board_choices.model_of(wanted), caller(request))
            return Response(lens_answer(found, camera))


class ChooseViews(DeskView):
    @extend_schema(
        operation_id="choose_lens_views",
        summary="Let the program choose the views again, and solve",
        request=None,
        responses=answers(200, DeskLensShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        with told():
            boards.use_chosen(found, camera, caller(request))
            return Response(lens_answer(found, camera))


class UndistortedPicture(DeskView):
    @extend_schema(
        operation_id="undistorted_desk_picture",
        summary="The picture of the ground with the lens taken out",
        responses={(200, "image/jpeg"): OpenApiTypes.BINARY, **ASKS},
    )
    def get(self, request: Request, desk: str, camera: str) -> HttpResponse:
        with told():
            data = preview.undistorted(desk_or_404(request, desk), camera)
        return HttpResponse(data, content_type="image/jpeg")


class BoardSheet(DeskView):
    @extend_schema(
        operation_id="board_sheet",
        summary="A board on paper, in its true size",
        parameters=[BoardQuery],
        responses={(200, "image/svg+xml"): OpenApiTypes.BINARY, **ASKS},
    )
    def get(self, request: Request, kind: str) -> HttpResponse:
        if kind not in preview.SHEETS:
            raise Http404
        with told("kind"):
            board = boards.board_of(asked(request, BoardQuery))
        return HttpResponse(preview.sheet(board, kind), content_type=preview.SHEETS[kind])


def _picture(desk: Desk, camera: str, pk: int) -> BoardPicture:
    found = BoardPicture.objects.filter(camera__desk=desk, camera__name=camera, pk=pk).first()
    if found is None:
        raise Http404
    return found
