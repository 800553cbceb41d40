"""A campaign's gold frames, planted faults and the qualifications it asks for."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy, ngettext
from django.views.decorators.http import require_http_methods

from gtm_hit.models import Campaign, PlantedFault, Planting
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.gold import frames, planting, results
from gtm_hit.ops.gold.truths import truths
from gtm_hit.ops.qualifications import managing
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.common.campaign_choice import campaign_or_404


class GoldForm(forms.Form):
    layer = forms.ChoiceField(label=gettext_lazy("Layer with the truth"))
    percent = forms.FloatField(
        label=gettext_lazy("Share of its frames, %"), min_value=0, max_value=100, initial=10
    )
    seed = forms.IntegerField(label=gettext_lazy("Seed"), min_value=0, max_value=2**31 - 1, initial=1)

    def __init__(self, campaign: Campaign, data: Any = None) -> None:
        super().__init__(data, prefix="gold")
        names = truths(campaign.dataset).values_list("name", flat=True)[:200]
        self.fields["layer"].choices = [(name, name) for name in names]  # type: ignore[attr-defined]


class PlantingForm(forms.Form):
    layer = forms.ChoiceField(label=gettext_lazy("Batches start with the people of"), required=False)
    percent = forms.FloatField(
        label=gettext_lazy("Batches with faults, %"), min_value=0, max_value=100, initial=30
    )
    faults = forms.IntegerField(
        label=gettext_lazy("Faults in each of them"),
        min_value=1,
        max_value=planting.MOST_FAULTS,
        initial=2,
    )
    kinds = forms.MultipleChoiceField(
        label=gettext_lazy("Kinds"),
        choices=PlantedFault.Kind.choices,
        widget=forms.CheckboxSelectMultiple,
        initial=PlantedFault.Kind.values,
        required=False,
    )
    seed = forms.IntegerField(label=gettext_lazy("Seed"), min_value=0, max_value=2**31 - 1, initial=1)

    def __init__(self, campaign: Campaign, now: Planting | None, data: Any = None) -> None:
        super().__init__(data, prefix="faults", initial=self.settled(now))
        names = planting.starting_layers(campaign).values_list("name", flat=True)[:200]
        neighbours = ("", _("accepted work in frames shared with a neighbouring batch"))
        self.fields["layer"].choices = [neighbours, *((name, name) for name in names)]  # type: ignore[attr-defined]

    @staticmethod
    def settled(now: Planting | None) -> dict[str, Any]:
        if now is None:
            return {}
        layer = now.starting_layer.name if now.starting_layer else ""
        shown = {"layer": layer, "percent": round(100 * now.share, 1)}
        return {**shown, "faults": now.faults, "kinds": now.kinds, "seed": now.seed}


class RequiredForm(forms.Form):
    names = forms.MultipleChoiceField(
        label=gettext_lazy("Qualifications"), widget=forms.CheckboxSelectMultiple, required=False
    )

    def __init__(self, campaign: Campaign, data: Any = None) -> None:
        asked = campaign.required_qualifications.values_list("qualification__name", flat=True)
        super().__init__(data, prefix="required", initial={"names": list(asked)})
        found = campaign.dataset.qualifications.order_by("name")
        self.fields["names"].choices = [(one.name, one.shown_name) for one in found]  # type: ignore[attr-defined]


def save_gold(campaign: Campaign, values: dict[str, Any]) -> str:
    truth = truths(campaign.dataset).get(name=values["layer"])
    number = frames.choose(campaign, truth, values["percent"] / 100, values["seed"])
    text = ngettext("%(count)d frame is gold now.", "%(count)d frames are gold now.", number)
    return text % {"count": number}


def save_faults(campaign: Campaign, values: dict[str, Any]) -> str:
    layer = planting.starting_layers(campaign).filter(name=values["layer"]).first()
    share, faults = values["percent"] / 100, values["faults"]
    planting.settle(campaign, layer, share, faults, values["kinds"], values["seed"])
    return _("Batches taken from now on start with these people and faults.")


def save_required(campaign: Campaign, values: dict[str, Any]) -> str:
    managing.require(campaign, values["names"])
    return _("The campaign asks for these qualifications from now on.")


SAVING = {"gold": save_gold, "faults": save_faults, "required": save_required}


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def campaign_gold(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    asked = request.POST.get("form", "")
    if asked == "stop":
        planting.stop(campaign)
        messages.success(request, _("Batches taken from now on start empty, without faults."))
        return redirect("campaign-gold", slug, name)
    now = Planting.objects.filter(campaign=campaign).select_related("starting_layer").first()
    given = {form: request.POST if form == asked else None for form in SAVING}
    bound = {
        "gold": GoldForm(campaign, given["gold"]),
        "faults": PlantingForm(campaign, now, given["faults"]),
        "required": RequiredForm(campaign, given["required"]),
    }
    if asked in bound and (form := bound[asked]).is_valid():
        try:
            messages.success(request, SAVING[asked](campaign, form.cleaned_data))
            return redirect("campaign-gold", slug, name)
        except OperationError as error:
            form.add_error(None, str(error))
    context = {**frame_of(campaign), "forms": bound, "planting": now, "here_quality": "campaign-gold"}
    context |= {"gold": results.gold_result(campaign), "faults": results.fault_results(campaign)}
    context["frames"] = list(frames.gold_frames(campaign)[:500])
    return render(request, "campaigns/gold.html", context, status=400 if asked else 200)


def frame_of(campaign: Campaign) -> dict[str, Any]:
    return {"section": "datasets", "tab": "campaigns", "dataset": campaign.dataset, "campaign": campaign}


urlpatterns = [
    path("datasets/<slug:slug>/campaigns/<str:name>/gold/", campaign_gold, name="campaign-gold"),
]
