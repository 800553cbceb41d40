"""Fields of forms that people fill in."""

from __future__ import annotations

from typing import Any

from django import forms
from django.core.exceptions import ValidationError
from django.core.validators import validate_slug
from django.utils.text import slugify
from django.utils.translation import gettext as _


class AddressNameField(forms.SlugField):
    """A name in addresses. What cannot be one is made into one: “Our plaza, 2” becomes our-plaza-2."""

    def to_python(self, value: Any) -> str:
        wished = str(super().to_python(value))
        try:
            validate_slug(wished)
        except ValidationError:
            made = slugify(wished)
            if wished and not made:
                words = _("Use at least one letter from a to z or a digit, for example plaza-2.")
                raise ValidationError(words) from None
            return made
        return wished
