"""A looker that needs no network: it finds whom the test tells it to, in the order of the frames."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from gtm_hit.models import Dataset, Frame, ProposalRun
from gtm_hit.ops.proposals import runs
from gtm_hit.ops.proposals.pictures import StoredPictures, pictures_of
from gtm_hit.ops.proposals.proposing import propose
from gtm_hit.vision.people import CameraAlarm, Evidence, FrameProposals, Proposal

XY = tuple[float, float]


def person(x: float, y: float, score: float = 0.9) -> Proposal:
    boxed = Evidence("C1", (10.0, 20.0, 30.0, 80.0), 0.8, False)
    hidden = Evidence("C2", None, float("nan"), True)
    return Proposal(x, y, 1.8, 0.16, score, (boxed, hidden), "cover")


class Watcher:
    """`people` by frame number; what it looked at is in `looked`."""

    method = "cover"
    model = "watcher-1"
    settings: dict[str, Any] = {}

    def __init__(
        self, dataset: Dataset, people: dict[int, list[Proposal]], alarms: Sequence[str] = ()
    ) -> None:
        frames = Frame.objects.filter(dataset=dataset)
        found = pictures_of(frames)
        self.numbers = {found[frame.pk].digest: frame.number for frame in frames}
        self.people = people
        self.alarms = tuple(CameraAlarm(name, 3.0, "it stands elsewhere") for name in alarms)
        self.looked: list[int] = []
        self.masks: dict[str, Any] = {}
        self.before: Callable[[int], None] = lambda number: None

    def prepare(self, group: Sequence[StoredPictures]) -> None:
        pass

    def look(self, pictures: StoredPictures) -> FrameProposals:
        number = self.numbers[pictures.digest]
        self.before(number)
        self.looked.append(number)
        return FrameProposals(tuple(self.people.get(number, ())), self.alarms)

    def foregrounds(self) -> dict[str, Any]:
        return self.masks


def walk(numbers: Sequence[int], start: XY = (0.0, 0.0), step: XY = (0.3, 0.0)) -> dict[int, list[Proposal]]:
    """Somebody who walks by, one step a frame."""
    (x, y), (dx, dy) = start, step
    return {number: [person(x + dx * at, y + dy * at)] for at, number in enumerate(numbers)}


def make_run(dataset: Dataset, method: str = "cover", **told: Any) -> ProposalRun:
    return runs.find_or_make(dataset, method, Watcher.model, {"detector": "built-in", **told})


def two_walkers(numbers: Sequence[int]) -> dict[int, list[Proposal]]:
    """Two who walk by, each in a direction of their own."""
    people = walk(numbers)
    for number, found in walk(numbers, (-2.0, 2.0), (0.0, -0.2)).items():
        people[number] += found
    return people


def shown_run(dataset: Dataset, people: dict[int, list[Proposal]], alarms: Sequence[str] = ()) -> ProposalRun:
    """These people, proposed and shown to annotators."""
    run = make_run(dataset)
    propose(run, Watcher(dataset, people, alarms))
    runs.use(run)
    return run
