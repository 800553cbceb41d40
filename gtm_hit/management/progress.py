"""How far a command is: a bar that redraws itself on a terminal, plain lines of percents elsewhere."""

from __future__ import annotations

import time

from django.core.management.base import OutputWrapper

WIDTH = 30
SECONDS_BETWEEN = 0.1  # a terminal is slower than an import
PERCENTS_BETWEEN = 10


class ProgressLine:
    """Called with the phase in words, steps done and steps in all."""

    def __init__(self, stream: OutputWrapper) -> None:
        self.stream = stream
        self.draws = stream.isatty()
        self.phase = ""
        self.percent = -1
        self.drawn_at = 0.0

    def __call__(self, phase: str, done: int, total: int) -> None:
        percent = 100 * done // total if total else 100
        if phase != self.phase:
            self.finish()
            self.phase, self.percent, self.drawn_at = phase, -1, 0.0
        if self.draws:
            self._draw(done, total, percent)
        else:
            self._write(percent)

    def finish(self) -> None:
        """End the bar's line, so that what is printed next has its own."""
        if self.draws and self.phase:
            self.stream.write("", ending="\n")
        self.phase = ""

    def _draw(self, done: int, total: int, percent: int) -> None:
        now = time.monotonic()
        if done < total and now - self.drawn_at < SECONDS_BETWEEN:
            return
        self.drawn_at = now
        filled = WIDTH * percent // 100
        bar = "█" * filled + "░" * (WIDTH - filled)
        self.stream.write(f"\r{self.phase:24} {bar} {percent:3d} %  {done}/{total}\x1b[K", ending="")
        self.stream.flush()

    def _write(self, percent: int) -> None:
        if percent < 100 and percent // PERCENTS_BETWEEN == self.percent // PERCENTS_BETWEEN:
            return
        if percent == self.percent:
            return
        self.percent = percent
        self.stream.write(f"{self.phase}: {percent} %")
        self.stream.flush()
