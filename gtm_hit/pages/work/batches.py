from __future__ import annotations

from django import forms
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path, reverse
from django.utils.translation import gettext_lazy, ngettext
from django.views.decorators.http import require_http_methods, require_POST

from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.work import batches, entry_links, links
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.datasets.listing import dataset_or_404

ROWS_PER_PAGE = 100


class MakeBatchesForm(forms.Form):
    size = forms.IntegerField(
        label=gettext_lazy("Frames per batch"), min_value=1, max_value=batches.MAX_SIZE, initial=10
    )
    copies = forms.IntegerField(
        label=gettext_lazy("Opinions per frame"), min_value=1, max_value=batches.MAX_COPIES, initial=1
    )


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def dataset_batches(request: HttpRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    form = MakeBatchesForm(request.POST or None)
    if request.method == "POST" and form.is_valid():
        added = batches.make_batches(dataset, **form.cleaned_data)
        text = ngettext("%(count)d batch was added.", "%(count)d batches were added.", added)
        messages.success(request, text % {"count": added})
        return redirect("dataset-batches", slug=slug)
    page = Paginator(overview.batches(dataset), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    context = {
        "section": "datasets",
        "tab": "batches",
        "dataset": dataset,
        "counts": overview.batch_counts(dataset),
        "page": page,
        "rows": overview.with_assignments(page.object_list),
        "form": form,
        "closed": entry_links.state(dataset, "link").closed_at is not None,
        "entry_link": request.build_absolute_uri(reverse("join", args=[links.entry_token(dataset)])),
    }
    return render(request, "staff/batches.html", context)


@require_POST
@needs(Role.MANAGER)
def switch_link(request: HttpRequest, slug: str) -> HttpResponse:
    switch = {"close": entry_links.close, "open": entry_links.reopen}.get(request.POST.get("switch", ""))
    if switch is not None:
        switch(dataset_or_404(slug), "link")
    return redirect("dataset-batches", slug=slug)


urlpatterns = [
    path("datasets/<slug:slug>/batches/", dataset_batches, name="dataset-batches"),
    path("datasets/<slug:slug>/batches/link/", switch_link, name="dataset-link"),
]
