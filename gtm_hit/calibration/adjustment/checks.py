"""What cannot be adjusted, by name, and what is left out or worth saying."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.parameters import packed
from gtm_hit.calibration.adjustment.problem import PARAMETERS, Problem, Sightings, View
from gtm_hit.calibration.adjustment.residuals import Seen, depths
from gtm_hit.calibration.adjustment.settling import NARROW, meeting, rays, widest_angles
from gtm_hit.geometry.camera import CalibrationError

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

OUTSIDE = 1.0  # pictures: a click farther off the picture than this is none
NAMED = 8  # points listed in a sentence


def check(problem: Problem) -> None:
    """AdjustmentError for what no solver should be given."""
    if not problem.views:
        raise AdjustmentError("There is no camera.")
    for name in sorted({name for name in problem.names if problem.names.count(name) > 1}):
        raise AdjustmentError(f"Two cameras are named {name}.")
    for view in problem.views:
        _check_view(view)
        _check_start(view)
    _check_seen(problem, problem.seen, len(problem.points), "point")
    _check_seen(problem, problem.measured_seen, len(problem.measured), "measured point")
    if not np.isfinite(problem.measured).all():
        raise AdjustmentError("A measured point has a coordinate that is no number.")
    if np.isinf(problem.points).any():
        raise AdjustmentError("A point starts at an infinite coordinate.")
    _check_same_places(problem)
    if not len(problem.seen.pixels) + len(problem.measured_seen.pixels):
        raise AdjustmentError("Nothing was clicked.")


def check_result(views: Sequence[View], rows: Floats, points: Floats, seen: Seen) -> None:
    """AdjustmentError for a result that fits the clicks and yet cannot be."""
    for view in views:
        _check_start(view, "came to stand", "The clicks or the first poses are mirrored or mixed up.")
    behind = depths(rows, points, seen) <= 0
    for number, view in enumerate(views):
        part = behind[seen.of(number)]
        if part.size and part.mean() > 0.5:
            raise AdjustmentError(
                f"{view.name} came to look away from {part.sum()} of the {part.size} points it saw: "
                "its first pose is too far off."
            )


def usable(problem: Problem, seen: Seen) -> tuple[Seen, tuple[str, ...]]:
    """The observations that can be used, and sentences on what was left out.

    AdjustmentError names the cameras that hang on nothing.
    """
    single = _single(problem, seen)
    unmet = _unmet(problem, seen) & ~single
    notices = []
    if single.any():
        notices.append(_told(single, "seen in one view only and left out", problem.labels))
    if unmet.any():
        left = "seen along parallel rays, placed by nobody, and left out"
        notices.append(_told(unmet, left, problem.labels))
    kept = seen.where(~(single | unmet)[seen.points])
    _check_connected(problem, kept)
    return kept, tuple(notices)


def doubts(
    rows: Floats, points: Floats, seen: Seen, free: int, labels: Sequence[str] = ()
) -> tuple[str, ...]:
    """Sentences on points of a result that should not be trusted."""
    narrow = np.zeros(len(points), dtype=bool)
    narrow[np.unique(seen.points)] = True
    narrow &= widest_angles(rows, seen, len(points)) < NARROW
    narrow[free:] = False
    behind = np.zeros(len(points), dtype=bool)
    behind[seen.points[depths(rows, points, seen) <= 0]] = True
    sentences = []
    if narrow.any():
        what = f"seen along rays less than {NARROW:g}° apart, at no sure distance"
        sentences.append(_told(narrow, what, labels))
    if behind.any():
        sentences.append(_told(behind, "clicked in a view whose camera has them behind it", labels))
    return tuple(sentences)


def shared_points(seen: Seen, views: int, free: int) -> NDArray[np.int64]:
    """(C, C) how many free points each two cameras both saw; on the diagonal, how many each saw."""
    saw = np.zeros((views, free), dtype=np.int64)
    of_free = seen.points < free
    saw[seen.cameras[of_free], seen.points[of_free]] = 1
    return saw @ saw.T


def _check_view(view: View) -> None:
    try:
        view.camera()
    except CalibrationError as error:
        raise AdjustmentError(str(error)) from error
    if view.lens.distortion.size not in (5, 8):
        raise AdjustmentError(
            f"{view.name}: a lens of {view.lens.distortion.size} coefficients cannot be adjusted, "
            "only one of 5 or 8."
        )
    known = {*PARAMETERS, "pose", "lens"}
    for name in sorted(set(view.stays) - known | set(view.sigmas) - set(PARAMETERS[6:])):
        raise AdjustmentError(
            f"{view.name}: there is no parameter {name}; there are {', '.join(PARAMETERS)}."
        )
    if any(not sigma > 0 for sigma in view.sigmas.values()):
        raise AdjustmentError(f"{view.name}: a σ must be above 0.")


def _check_start(view: View, stands: str = "stands", advice: str = "Solve its pose anew.") -> None:
    camera = view.camera()
    if camera.facing < 0:
        raise AdjustmentError(
            f"{view.name} sees the world upside down or mirrored: its pose is left-handed. {advice}"
        )
    if not camera.centre[2] > 0:
        raise AdjustmentError(f"{view.name} {stands} {-camera.centre[2]:.2f} m under the ground. {advice}")


def _check_seen(problem: Problem, seen: Sightings, count: int, noun: str) -> None:
    if not (_within(seen.cameras, len(problem.views)) and _within(seen.points, count)):
        raise AdjustmentError(f"A click names a camera or a {noun} that there is not.")
    sizes = np.array([(view.lens.width, view.lens.height) for view in problem.views], dtype=np.float64)
    size = sizes[seen.cameras]
    with np.errstate(invalid="ignore"):
        fine = ((seen.pixels > -OUTSIDE * size) & (seen.pixels < (1 + OUTSIDE) * size)).all(axis=1)
    for row in np.flatnonzero(~fine)[:1]:
        view = problem.views[seen.cameras[row]]
        x, y = seen.pixels[row]
        raise AdjustmentError(
            f"{view.name}: the click on {noun} {seen.points[row]} is at ({x:g}, {y:g}), far outside its "
            f"picture of {view.lens.width}×{view.lens.height}."
        )
    pairs, counts = np.unique(np.column_stack((seen.cameras, seen.points)), axis=0, return_counts=True)
    for camera, point in pairs[counts > 1][:1]:
        raise AdjustmentError(f"{problem.views[camera].name}: {noun} {point} was clicked twice.")


def _check_same_places(problem: Problem) -> None:
    places, counts = np.unique(problem.measured, axis=0, return_counts=True)
    for x, y, z in places[counts > 1][:1]:
        raise AdjustmentError(f"Two measured points have the same coordinates ({x:g}, {y:g}, {z:g}) m.")


def _check_connected(problem: Problem, seen: Seen) -> None:
    """Every camera must see measured points, or what cameras see that hang together with the others."""
    free = len(problem.points)
    measured = np.array([(seen.points[seen.of(each)] >= free).sum() for each in range(len(problem.views))])
    saw = np.zeros((len(problem.views), free), dtype=bool)
    of_free = seen.points < free
    saw[seen.cameras[of_free], seen.points[of_free]] = True
    joined = [each for each, view in enumerate(problem.views) if "pose" in view.stays or measured[each] >= 3]
    joined = joined or [int(saw.sum(axis=1).argmax())]
    others = [each for each in range(len(problem.views)) if each not in joined]
    while others:
        # A shared point tells one number of a pose, a measured one two; a pose has six.
        told = [(saw[each] & saw[joined].any(axis=0)).sum() + 2 * measured[each] for each in others]
        best = int(np.argmax(told))
        if told[best] < 6:
            raise AdjustmentError(_unconnected(problem, others, saw, joined, measured.tolist()))
        joined.append(others.pop(best))


def _unconnected(
    problem: Problem, others: Iterable[int], saw: Flags, joined: list[int], measured: list[int]
) -> str:
    sentences = []
    for each in others:
        shared = (saw[each] & saw[joined].any(axis=0)).sum()
        sentences.append(
            f"{problem.views[each].name} is not connected: it shares {shared} points with the other cameras "
            f"and sees {measured[each]} measured ones."
        )
    return " ".join([*sentences, "Click in each at least 6 points that others see, or 3 measured ones."])


def _single(problem: Problem, seen: Seen) -> Flags:
    """(P,) free points in one view of which not enough else is known."""
    total = len(problem.points) + len(problem.measured)
    told = 2 * np.bincount(seen.points, minlength=total)
    told[len(problem.points) :] += 3
    if problem.point_sigmas is not None:
        told[: len(problem.points)] += np.isfinite(problem.point_sigmas).sum(axis=1)
    return (told > 0) & (told < 3) & (np.bincount(seen.points, minlength=total) > 0)


def _unmet(problem: Problem, seen: Seen) -> Flags:
    """(P,) points that nobody gave a place, and whose rays do not meet."""
    total = len(problem.points) + len(problem.measured)
    unknown = np.zeros(total, dtype=bool)
    unknown[: len(problem.points)] = np.isnan(problem.points).any(axis=1)
    if not unknown.any():
        return unknown
    directions, centres = rays(packed(problem.views), seen)
    _, met = meeting(directions, centres[seen.cameras], seen, total)
    seen_at_all = np.bincount(seen.points, minlength=total) > 0
    return unknown & ~met & seen_at_all


def _told(which: Flags, what: str, labels: Sequence[str]) -> str:
    numbers = np.flatnonzero(which)
    names = [labels[number] if labels else str(number) for number in numbers[:NAMED]]
    shown = ", ".join(names) + (" …" if numbers.size > NAMED else "")
    noun = "point was" if numbers.size == 1 else "points were"
    return f"{numbers.size} {noun} {what}: {shown}."


def _within(places: NDArray[np.int64], count: int) -> bool:
    return places.size == 0 or bool(places.min() >= 0 and places.max() < count)
