"""The form of a campaign's rules, in groups, with what each field may still be changed to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

from django import forms
from django.utils.functional import Promise
from django.utils.translation import gettext_lazy

from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns import changes, editing, platform_settings

GROUPS: tuple[tuple[str | Promise, tuple[str, ...]], ...] = (
    (gettext_lazy("What workers read"), ("name", "title", "instructions")),
    (gettext_lazy("Batches"), ("batch_size", "overlap", "copies")),
    (
        gettext_lazy("Who, and how much"),
        ("entry", "batches_per_worker", "batches_at_once", "lease_minutes"),
    ),
    (gettext_lazy("Pay"), ("pay_per_batch", "currency", "expected_minutes", "hourly_floor")),
    (gettext_lazy("Review"), ("review_share", "newcomer_batches")),
)
HELP: dict[str, str | Promise] = {
    "name": gettext_lazy("Letters, digits, dots, dashes and underscores."),
    "title": gettext_lazy("Empty: the dataset's name."),
    "instructions": gettext_lazy("Shown before the dataset's own."),
    "overlap": gettext_lazy("By these frames the batches are joined to one ground truth; 1 is enough."),
    "copies": gettext_lazy("Opinions of different workers on the same frames."),
    "batches_per_worker": gettext_lazy("Empty: no limit."),
    "lease_minutes": gettext_lazy("Every save makes it longer again."),
    "expected_minutes": "",
    "newcomer_batches": "",
    "hourly_floor": gettext_lazy("Who falls below it is proposed a bonus."),
    "review_share": gettext_lazy("0.1: every tenth batch; work under suspicion comes on top."),
}


def setting_name(platform: str, name: str) -> str:
    return f"{platform}.{name}"


class CampaignForm(forms.ModelForm):
    class Meta:
        model = Campaign
        fields = [name for name in changes.FIELDS if name != "platform_settings"]
        labels = changes.LABELS
        help_texts = HELP
        widgets = {"instructions": forms.Textarea(attrs={"rows": 4})}

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.fields["name"].widget.attrs["maxlength"] = editing.MAX_NAME
        for platform, kind in platform_settings.KINDS.items():
            stored = platform_settings.made(platform, self.stored(platform))
            for field in fields(kind):
                value = getattr(stored, field.name)
                self.fields[setting_name(platform, field.name)] = forms.CharField(
                    required=False,
                    label=str(SETTING_LABELS[field.name]),
                    initial="\n".join(value) if isinstance(value, tuple) else value,
                    widget=forms.Textarea(attrs={"rows": 2}) if isinstance(value, tuple) else None,
                )
        for name in self.fields:
            if name in changes.WHILE_OPEN and changes.rule_of(self.instance, name).fixed:
                self.fields[name].disabled = True

    def stored(self, platform: str) -> dict[str, Any]:
        return self.instance.platform_settings if self.instance.platform == platform else {}

    def _post_clean(self) -> None:
        """The operation looks at the row; the form only reads what was typed."""

    def values(self) -> dict[str, Any]:
        """For `editing`."""
        values = {name: self.cleaned_data[name] for name in self.Meta.fields}
        values["platform_settings"] = self.settings(values["platform"])
        return values

    def settings(self, platform: str) -> dict[str, Any]:
        usual = platform_settings.made(platform, {})
        found: dict[str, Any] = {}
        for name in platform_settings.names(platform):
            typed = self.cleaned_data[setting_name(platform, name)]
            before = getattr(usual, name)
            found[name] = typed.split() if isinstance(before, tuple) else typed.strip()
            # An emptied name of a parameter means the usual one.
            if not found[name] and name.endswith("_parameter"):
                found[name] = before
        return found

    def groups(self) -> Iterator[Group]:
        for title, names in GROUPS:
            yield Group(title, [Row(self, name) for name in names])

    def platform_row(self) -> Row:
        return Row(self, "platform")

    def platforms(self) -> Iterator[Group]:
        for platform in platform_settings.KINDS:
            names = [setting_name(platform, name) for name in platform_settings.names(platform)]
            if names:
                label = Campaign.Platform(platform).label
                yield Group(label, [Row(self, name) for name in names], platform)


@dataclass(frozen=True)
class Row:
    form: CampaignForm
    name: str

    @property
    def field(self) -> forms.BoundField:
        return self.form[self.name]

    @property
    def rule(self) -> str | Promise:
        """What still may be changed, once the campaign was opened."""
        if self.form.instance.state == Campaign.State.DRAFT or self.name not in changes.WHILE_OPEN:
            return ""
        return changes.rule_of(self.form.instance, self.name).text


@dataclass(frozen=True)
class Group:
    title: str | Promise
    rows: list[Row]
    platform: str = ""


SETTING_LABELS: dict[str, str | Promise] = {
    "worker_parameter": gettext_lazy("parameter that names the worker"),
    "study_parameter": gettext_lazy("parameter that names the study"),
    "submission_parameter": gettext_lazy("parameter that names the submission"),
    "fixed_code": gettext_lazy("the panel's own code, the same for everybody (empty: one per batch)"),
    "return_address": gettext_lazy("address back to the panel"),
    "completion_address": gettext_lazy("address of completed submissions"),
    "code_completed": gettext_lazy("code: batch submitted"),
    "code_no_work": gettext_lazy("code: no batch left"),
    "code_not_admitted": gettext_lazy("code: not admitted"),
    "frame_ancestors": gettext_lazy("origins that show the page in a frame, one a line"),
    "submit_to": gettext_lazy("origins that take the form at the end, one a line"),
}
