from __future__ import annotations

import io

from django.core.management.base import OutputWrapper

from gtm_hit.management.progress import ProgressLine


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def written(stream: io.StringIO, total: int = 200) -> str:
    progress = ProgressLine(OutputWrapper(stream))
    for phase in ("reading", "writing"):
        for done in range(1, total + 1):
            progress(phase, done, total)
    progress.finish()
    return stream.getvalue()


def test_a_file_gets_a_line_per_ten_percent() -> None:
    lines = written(io.StringIO()).splitlines()
    assert lines[:2] == ["reading: 0 %", "reading: 10 %"]
    assert lines[-1] == "writing: 100 %"
    assert len(lines) == 22


def test_a_terminal_gets_one_line_per_phase_that_ends_full() -> None:
    lines = written(Terminal()).split("\n")
    assert len(lines) == 3
    assert lines[0].split("\r")[-1].startswith("reading")
    assert all("100 %  200/200" in line.split("\r")[-1] for line in lines[:2])


def test_nothing_to_do_is_all_done() -> None:
    stream = io.StringIO()
    ProgressLine(OutputWrapper(stream))("reading", 0, 0)
    assert stream.getvalue() == "reading: 100 %\n"
