"""How a draft of clocks is told and changed."""

from __future__ import annotations

from typing import Any

from rest_framework import serializers

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.datasets.importing import FiniteField
from gtm_hit.models import VideoSync


class OpenSyncSerializer(serializers.Serializer[Any]):
    source = serializers.CharField(  # type: ignore[assignment]
        max_length=300, help_text="a folder on the server, as in `sources/`"
    )


class VideoClockSerializer(serializers.Serializer[Any]):
    file = serializers.CharField(max_length=300)
    camera = serializers.CharField(max_length=80)
    offset = FiniteField(help_text="the second in this video at which the time all videos share is 0")
    drift = FiniteField(default=0.0, help_text="parts per million by which its clock is fast")
    used = StrictBooleanField(default=True, help_text="whether it will be imported")


class VideoEventSerializer(serializers.Serializer[Any]):
    name = serializers.CharField(max_length=80)
    marks = serializers.DictField(
        child=FiniteField(), help_text="by file the second in the video at which it happens"
    )


class SyncRevisionSerializer(serializers.Serializer[Any]):
    revision = serializers.IntegerField(min_value=0, max_value=LARGEST, help_text="the one changed from")


class SaveSyncSerializer(SyncRevisionSerializer):
    clocks = VideoClockSerializer(many=True)
    events = VideoEventSerializer(many=True, default=list)
    reference = serializers.CharField(
        max_length=300, allow_blank=True, default="", help_text="file the others are laid beside"
    )


class SyncVideoShape(serializers.Serializer[Any]):
    file = serializers.CharField()
    width = serializers.IntegerField()
    height = serializers.IntegerField()
    start = serializers.FloatField(help_text="of its first picture, seconds")
    interval = serializers.FloatField(help_text="seconds from picture to picture")
    duration = serializers.FloatField(help_text="seconds, by its header")
    version = serializers.CharField(help_text="changes with the file")


class SyncJobShape(serializers.Serializer[Any]):
    id = serializers.IntegerField()
    done = serializers.IntegerField()
    total = serializers.IntegerField()
    message = serializers.CharField()


class SyncShape(serializers.Serializer[Any]):
    id = serializers.IntegerField()
    source = serializers.CharField()  # type: ignore[assignment]
    revision = serializers.IntegerField(help_text="a change names the one it was made from")
    undo = serializers.BooleanField(help_text="whether there is something to undo")
    redo = serializers.BooleanField()
    videos = SyncVideoShape(many=True)
    clocks = VideoClockSerializer(many=True)
    events = VideoEventSerializer(many=True)
    reference = serializers.CharField()
    guess = serializers.DictField(help_text="basis, told, places; empty before there is one")
    job = SyncJobShape(allow_null=True, help_text="the guess under way")
    lines = serializers.ListField(child=serializers.CharField(), help_text="as an import is told")
    problem = serializers.CharField(help_text="why no picture can be shown; empty: none")


class SyncRowShape(serializers.ModelSerializer[VideoSync]):
    class Meta:
        model = VideoSync
        fields = ["id", "source", "revision", "created_at", "changed_at"]
