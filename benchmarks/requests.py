"""What a request costs: queries, and time on the clock and of the processor."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

Timed = tuple[int, float, float]  # queries, milliseconds, milliseconds of the processor; both are medians


def queries_of(call: Callable[[], Any]) -> int:
    """How often a request that succeeds asks the database."""
    from django.db import connection

    count = 0

    def counted(execute: Any, *arguments: Any) -> Any:
        nonlocal count
        count += 1
        return execute(*arguments)

    with connection.execute_wrapper(counted):
        answer = call()
    assert answer.status_code == 200, answer
    return count


def timed(client: Any, path: str, times: int) -> Timed:
    """The first request warms up, and is the one whose queries are counted."""
    count = queries_of(lambda: client.get(path))
    waited, worked = [], []
    for _again in range(times):
        began, at_work = time.perf_counter(), time.process_time()
        client.get(path)
        waited.append(1000 * (time.perf_counter() - began))
        worked.append(1000 * (time.process_time() - at_work))
    return count, statistics.median(waited), statistics.median(worked)
