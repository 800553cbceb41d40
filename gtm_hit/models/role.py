"""Who is what: roles for all datasets are Django's groups, roles for one dataset are rows here."""

from __future__ import annotations

from django.conf import settings
from django.db import models

from gtm_hit.models.dataset import Dataset


class Role(models.TextChoices):
    """Managers may review, administrators everything; otherwise nobody may do another one's work.

    A member of the group of this name has the role for all datasets.
    """

    ANNOTATOR = "annotator", "annotator"
    REVIEWER = "reviewer", "reviewer"
    MANAGER = "manager", "manager"
    MAINTAINER = "maintainer", "maintainer"
    ADMINISTRATOR = "administrator", "administrator"


class Membership(models.Model):
    """A role somebody has for one dataset."""

    user = models.ForeignKey(settings.AUTH_USER_MODEL, on_delete=models.CASCADE, related_name="memberships")
    role = models.CharField(max_length=16, choices=Role.choices)
    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="memberships")

    class Meta:
        ordering = ["dataset", "user__username", "role"]
        constraints = [
            models.UniqueConstraint(fields=["user", "role", "dataset"], name="membership_once"),
        ]

    def __str__(self) -> str:
        return f"{self.user} {self.role} of {self.dataset}"


class RoleChange(models.Model):
    """Who gave or took which role when; in words, so that it outlives accounts and datasets."""

    at = models.DateTimeField(auto_now_add=True)
    by = models.CharField(max_length=150, blank=True, help_text="empty: whoever runs the server")
    username = models.CharField(max_length=150)
    role = models.CharField(max_length=16, choices=Role.choices)
    dataset = models.CharField(max_length=80, blank=True, help_text="its name in addresses; empty: all")
    granted = models.BooleanField(help_text="false: taken")

    class Meta:
        ordering = ["-at", "-pk"]
        indexes = [models.Index(fields=["dataset", "at"], name="role_changes_of_a_dataset")]

    def __str__(self) -> str:
        return f"{self.username} {'+' if self.granted else '-'}{self.role} {self.dataset or 'everywhere'}"
