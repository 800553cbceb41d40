from __future__ import annotations

from datetime import timedelta
from typing import Any

from django.contrib.auth.models import User
from django.core.management.base import BaseCommand, CommandError, CommandParser
from django.utils import timezone

from gtm_hit.models import ApiToken
from gtm_hit.ops import api_tokens

MOST_DAYS = 3650


class Command(BaseCommand):
    help = "Print a new key for scripts that use the REST API. It is shown this once."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("username", help="whose name the script acts under; must be staff")
        parser.add_argument("--name", default="script", help="what the key is used for")
        parser.add_argument(
            "--scope",
            action="append",
            choices=ApiToken.Scope.values,
            help="what the key may do; again for more (default: read)",
        )
        parser.add_argument("--days", type=int, help="how long it is valid (default: until it is revoked)")

    def handle(
        self,
        *args: Any,
        username: str,
        name: str,
        scope: list[str] | None,
        days: int | None,
        **options: Any,
    ) -> None:
        user = User.objects.filter(username=username).first()
        if user is None:
            raise CommandError(f"There is no user {username!r}.")
        if days is not None and not 1 <= days <= MOST_DAYS:
            raise CommandError(f"--days must be 1 to {MOST_DAYS}, not {days}")
        expires_at = timezone.now() + timedelta(days=days) if days else None
        try:
            _token, key = api_tokens.make(user, name, scope or [ApiToken.Scope.READ], expires_at)
        except api_tokens.TokenError as error:
            raise CommandError(str(error)) from error
        self.stdout.write(key)
