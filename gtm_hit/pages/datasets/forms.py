from __future__ import annotations

from pathlib import Path
from typing import Any

from django import forms
from django.contrib.auth.models import User
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy

from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.models import Dataset
from gtm_hit.ops.access.desks import desks_of
from gtm_hit.ops.access.jobs import NOT_YOURS, may_import
from gtm_hit.ops.calibration.cameras import UNITS
from gtm_hit.ops.datasets import job
from gtm_hit.ops.datasets.options import PRESETS, REQUIRED, ImportOptions, SceneValues, scene
from gtm_hit.ops.datasets.videos.options import SourceError, VideoSource, parse_source
from gtm_hit.ops.datasets.videos.plan import USUAL
from gtm_hit.ops.desk import placing
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.files import sources
from gtm_hit.pages.common.fields import AddressNameField

PRESET_NAMES = {"wildtrack": "WILDTRACK", "multiviewx": "MultiviewX"}


class SceneForm(forms.Form):
    """What an import is told besides its files."""

    slug = AddressNameField(
        label=gettext_lazy("Name in addresses"),
        max_length=80,
        help_text=gettext_lazy(
            "Blanks become hyphens. An existing dataset gets the frames it does not have yet."
        ),
    )
    name = forms.CharField(label=gettext_lazy("Display name"), max_length=200, required=False)
    preset = forms.ChoiceField(
        label=gettext_lazy("As published with"),
        required=False,
        choices=[("", gettext_lazy("none: all values below"))]
        + [(name, PRESET_NAMES.get(name, name)) for name in sorted(PRESETS, reverse=True)],
    )
    columns = forms.IntegerField(label=gettext_lazy("Grid columns, along X"), required=False, min_value=1)
    rows = forms.IntegerField(label=gettext_lazy("Grid rows, along Y"), required=False, min_value=1)
    step = forms.FloatField(label=gettext_lazy("Grid step, metres"), required=False, min_value=0)
    origin_x = forms.FloatField(label=gettext_lazy("Origin X, metres"), required=False)
    origin_y = forms.FloatField(label=gettext_lazy("Origin Y, metres"), required=False)
    cylinder_radius = forms.FloatField(label=gettext_lazy("Cylinder radius, metres"), required=False)
    cylinder_height = forms.FloatField(label=gettext_lazy("Cylinder height, metres"), required=False)
    foot_rule = forms.ChoiceField(
        label=gettext_lazy("Foot rule"),
        required=False,
        choices=[("", "–"), *((rule.value, rule.value) for rule in FootRule)],
    )
    frame_rate = forms.FloatField(label=gettext_lazy("Frame numbers per second"), required=False)
    frame_step = forms.IntegerField(
        label=gettext_lazy("Every n-th frame number"), required=False, min_value=1
    )
    tvec_unit = forms.ChoiceField(
        label=gettext_lazy("Unit of tvec in XML and YAML"),
        required=False,
        choices=[("", gettext_lazy("the preset's, or metres")), *UNITS.items()],
    )
    alpha = forms.FloatField(
        label=gettext_lazy("Kept without lens, 0 to 1"),
        required=False,
        min_value=0,
        max_value=1,
        help_text=gettext_lazy("0: no black rim; 1: nothing seen is lost. Empty: the files' camera matrix."),
    )

    usual_values = SceneValues()  # where neither form nor preset nor dataset says anything

    def clean(self) -> dict[str, Any]:
        cleaned = super().clean() or {}
        if self.errors:
            return cleaned
        existing = Dataset.objects.filter(slug=cleaned["slug"]).first()
        if existing is None and not cleaned["preset"]:
            self._require(self.usual_values)
        if not self.errors:
            problems = ProblemList("")
            try:
                scene(ImportOptions(folder=Path(), **self.options()), existing, problems)
                problems.raise_if_any()
            except FormatError as error:
                for problem in error.problems:
                    self.add_error(None, problem.reason)
        return cleaned

    def values(self) -> SceneValues:
        """Only what was filled in."""
        found = {name: self.cleaned_data.get(name) for name in SceneValues.__annotations__}
        return SceneValues(**{name: value for name, value in found.items() if value not in (None, "")})  # type: ignore[typeddict-item]

    def options(self) -> dict[str, Any]:
        """Fields of ImportOptions, but for the folder; JSON values."""
        cleaned = self.cleaned_data
        return {
            "slug": cleaned["slug"],
            "name": cleaned["name"],
            "preset": cleaned["preset"] or None,
            "tvec_unit": cleaned["tvec_unit"] or None,
            "values": self.values(),
            "alpha": cleaned.get("alpha"),
        }

    def scene_fields(self) -> list[forms.BoundField]:
        """What the page shows folded away when a preset says it."""
        return [
            self[name] for name in self.fields if name in SceneValues.__annotations__ or name == "tvec_unit"
        ]

    def _require(self, usual: SceneValues) -> None:
        for name in (*REQUIRED, "rows", "origin_y"):
            if self.cleaned_data.get(name) is None and name not in usual:
                self.add_error(name, _("Needed where no published dataset is chosen."))


class DatasetForm(SceneForm):
    archive = forms.FileField(label=gettext_lazy("Zip archive on this computer"), required=False)
    source = forms.ChoiceField(label=gettext_lazy("Or on the server"), required=False)
    layer = forms.CharField(
        label=gettext_lazy("Layer the annotations go into"), max_length=80, initial="imported"
    )
    hidden_layer = forms.BooleanField(label=gettext_lazy("Never show this layer to workers"), required=False)
    undistort = forms.BooleanField(
        label=gettext_lazy("Take the lens out of the images, by intrinsic_original"), required=False
    )
    keep_all_frames = forms.BooleanField(
        label=gettext_lazy("Import the frame numbers between the steps too"), required=False
    )
    desk = forms.SlugField(required=False, widget=forms.HiddenInput)

    def __init__(self, user: User, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.user = user
        self.kept: sources.Source | None = None
        sent = sources.source_of(str(self.data.get("source", "")), user)
        self._offer([sent] if sent else [])

    def _offer(self, more: list[sources.Source]) -> None:
        offered = sources.offered(self.user)
        choose(self.fields["source"], offered + [each for each in more if each not in offered])

    def archive_source(self) -> sources.Source | None:
        """The archive just sent, put among the sources; None with the form's errors."""
        try:
            return sources.keep(self.cleaned_data["archive"])
        except FormatError as error:
            for problem in error.problems:
                self.add_error("archive", ": ".join(part for part in (problem.place, problem.reason) if part))
            return None

    def keep_archive(self) -> None:
        """Of a form refused for something else: what took an hour to send need not be sent again."""
        if not self.is_bound or "archive" in self.errors or not self.cleaned_data.get("archive"):
            return
        self.kept = self.archive_source()
        if self.kept:
            self._offer([self.kept])
            self.data = {**dict(self.data.items()), "source": self.kept.key}

    def clean_slug(self) -> str:
        slug: str = self.cleaned_data["slug"]
        if not may_import(self.user, slug):
            raise forms.ValidationError(NOT_YOURS % {"slug": slug})
        return slug

    def clean(self) -> dict[str, Any]:
        cleaned = super().clean()
        if bool(cleaned.get("archive")) == bool(cleaned.get("source")) and "archive" not in self.errors:
            self.add_error("archive", _("Choose an archive here, or a folder or archive on the server."))
        return cleaned

    def clean_desk(self) -> str:
        """The file of the desk's cameras; empty without a desk."""
        slug: str = self.cleaned_data["desk"]
        if not slug:
            return ""
        desk = desks_of(self.user).filter(slug=slug).first()
        if desk is None:
            raise forms.ValidationError(_("There is no desk %(slug)s.") % {"slug": slug})
        try:
            return str(placing.cameras_file(desk))
        except DeskError as error:
            raise forms.ValidationError(str(error)) from error

    def options(self) -> dict[str, Any]:
        names = ("layer", "hidden_layer", "undistort", "keep_all_frames")
        found = {**super().options(), **{name: self.cleaned_data.get(name) for name in names}}
        return (
            {**found, "calibrations": self.cleaned_data["desk"]} if self.cleaned_data.get("desk") else found
        )


class VideosForm(SceneForm):
    source = forms.ChoiceField(label=gettext_lazy("Folder on the server"))
    videos = forms.CharField(
        label=gettext_lazy("Videos: CAMERA = FILE @ SECONDS, one a line"),
        widget=forms.Textarea(attrs={"rows": 8, "spellcheck": "false", "class": "mono"}),
    )
    start = forms.FloatField(label=gettext_lazy("From, seconds"), required=False, min_value=0)
    until = forms.FloatField(label=gettext_lazy("Until, seconds"), required=False, min_value=0)
    as_taken = forms.BooleanField(label=gettext_lazy("Leave the lens in the pictures"), required=False)

    usual_values = USUAL

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        choose(self.fields["source"], [each for each in sources.sources() if not each.is_archive])

    def clean_videos(self) -> list[VideoSource]:
        found, reasons = [], []
        for line in self.cleaned_data["videos"].splitlines():
            if line.strip():
                try:
                    found.append(parse_source(line))
                except SourceError as error:
                    reasons.append(str(error))
        if reasons:
            raise forms.ValidationError(reasons)
        return found

    def clean(self) -> dict[str, Any]:
        cleaned = super().clean()
        folder = sources.source(cleaned.get("source", ""))
        if folder is not None:
            for video in cleaned.get("videos", []):
                if not sources.holds(folder, video.path):
                    self.add_error(
                        "videos", _("%(path)s does not lie in this folder.") % {"path": video.path}
                    )
        return cleaned

    def values(self) -> SceneValues:
        cleaned = self.cleaned_data
        return job.video_values(cleaned["slug"], cleaned["preset"], super().values())

    def options(self) -> dict[str, Any]:
        return {**super().options(), "undistort": not self.cleaned_data.get("as_taken")}


def choose(field: forms.Field, found: list[sources.Source]) -> None:
    assert isinstance(field, forms.ChoiceField)
    field.choices = [("", "–"), *((each.key, each.key) for each in found)]
