"""Commands that are told where a grid begins."""

from __future__ import annotations

from django.core.management.base import BaseCommand


class SceneCommand(BaseCommand):
    def run_from_argv(self, argv: list[str]) -> None:
        # argparse takes "-3,-9" for an option unless it is joined to the one it belongs to.
        joined: list[str] = []
        for word in argv:
            if joined and joined[-1] == "--origin":
                joined[-1] += f"={word}"
            else:
                joined.append(word)
        super().run_from_argv(joined)
