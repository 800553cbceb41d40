"""How good proposals are: `python -m benchmarks.proposals [--data FOLDER] [--json] [--quick]`.

Scores the methods against annotated pictures, per frame: MODA, MODP, precision within 0.5 m. FOLDER holds
`multiviewx` and `wildtrack` as in the published samples; without it only the demo scene, which the project
renders itself, is scored. Without a detector (`make detector`) only what works on the background is.

What was tuned on what: the constants in `gtm_hit/vision` were chosen on MultiviewX's frames 0-4 and the demo
scene's frames 0-4, looking at about 80 settings in all; the rows of the other frames were never tuned on. The
alarm about a camera and the pass for people who sit were made looking at WILDTRACK's one real frame.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import cv2
import numpy as np

from gtm_hit.demo.render import render_scene, truth
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.formats.calibration.wildtrack_xml import read_extrinsic, read_intrinsic
from gtm_hit.geometry.camera import Camera, undistort_maps
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.metrics.detection import DetectionScore, evaluate
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.vision import detectors
from gtm_hit.vision.background import Backgrounds, Pictures
from gtm_hit.vision.boxes import Box, Detector, Picture
from gtm_hit.vision.people import FrameProposals
from gtm_hit.vision.proposing import Method, Proposer, Scene, Settings

ROOT = Path(__file__).resolve().parent.parent
CAMERAS = ROOT / "fixtures" / "wildtrack_cameras.json"
FRAMES = 10
# People beyond this line are in MultiviewX's pictures but not in its annotations.
MULTIVIEWX_ANNOTATED = 15.0  # metres along Y

Found = list[FrameProposals]


@dataclass(frozen=True)
class Example:
    """Frames with the truth about some of them."""

    name: str
    scene: Scene
    frames: Sequence[Pictures]
    truth: Mapping[int, np.ndarray]  # frame → (N, 2) metres
    ends: float = float("inf")  # metres along Y to which people are annotated


@dataclass(frozen=True)
class Row:
    """A line of the table; what does not apply is None."""

    name: str
    moda: float | None = None
    modp: float | None = None
    precision: float | None = None
    recall: float | None = None
    people: int | None = None
    seconds: float | None = None  # of one processor, per frame
    note: str = ""


class Folder(Sequence[Pictures]):
    """Pictures of frames, read when asked for and changed on the way."""

    def __init__(self, paths: Sequence[Mapping[str, Path]], change: Callable[[Picture], Picture]) -> None:
        self.paths, self.change = paths, change

    def __len__(self) -> int:
        return len(self.paths)

    def __getitem__(self, place):
        if isinstance(place, slice):
            return Folder(self.paths[place], self.change)
        return {name: self.change(cv2.imread(str(path))) for name, path in self.paths[place].items()}


def unchanged(picture: Picture) -> Picture:
    return picture


def noisy(picture: Picture) -> Picture:
    """Sensor noise of 6 levels, a gain of 3 %, strong compression."""
    rng = np.random.default_rng(int(picture[::50, ::50].sum()))
    spoilt = picture * rng.normal(1.0, 0.03) + rng.normal(0.0, 6.0, picture.shape)
    data = cv2.imencode(".jpg", np.clip(spoilt, 0, 255).astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, 70])[1]
    return cv2.imdecode(data, cv2.IMREAD_COLOR)


def halved(picture: Picture) -> Picture:
    return cv2.resize(picture, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)


def multiviewx(folder: Path, change: Callable[[Picture], Picture] = unchanged) -> Example:
    cameras = {}
    for index in range(6):
        lens = read_intrinsic(folder / f"calibrations/intrinsic/intr_Camera{index + 1}.xml")
        pose = read_extrinsic(folder / f"calibrations/extrinsic/extr_Camera{index + 1}.xml")
        name = f"C{index + 1}"
        cameras[name] = Camera(index, name, 1920, 1080, lens.matrix, pose.rvec, pose.tvec, lens.distortion)
    numbers = sorted(int(path.stem) for path in (folder / "Image_subsets/C1").glob("*.jpg"))[:FRAMES]
    paths = [{name: folder / f"Image_subsets/{name}/{n:04d}.jpg" for name in cameras} for n in numbers]
    grid = Grid(1000, 640, 0.025, 0.0, 0.0)
    known = {}
    for place, number in enumerate(numbers):  # annotation 00001 belongs to picture 0000
        file = folder / f"annotations_positions/{number + 1:05d}.json"
        if file.exists():
            known[place] = grid.metres([row["positionID"] for row in json.loads(file.read_text())])
    scene = Scene(cameras, grid, rule=FootRule.CENTRE)
    return Example("MultiviewX", scene, Folder(paths, change), known, MULTIVIEWX_ANNOTATED)


def demo(folder: Path) -> Example:
    """The demo scene's first frames, rendered into the folder unless they are there."""
    scene = replace(read_scene(), frame_count=FRAMES)
    cameras = {camera.name: camera for camera in load_cameras(CAMERAS)}
    if not (folder / "Image_subsets").exists():
        render_scene(scene, list(cameras.values()), folder)
    paths = [
        {name: folder / f"Image_subsets/C{camera.index + 1}/{n:08d}.jpg" for name, camera in cameras.items()}
        for n in scene.frame_numbers
    ]
    rows = truth(scene)
    known = {
        place: np.array([(row.x, row.y) for row in rows if row.number == number])
        for place, number in enumerate(scene.frame_numbers)
    }
    return Example("demo scene", Scene(cameras, scene.grid), Folder(paths, unchanged), known)


def wildtrack(folder: Path) -> Example:
    """The one real frame, its lenses taken out."""
    cameras = {camera.name: camera for camera in load_cameras(CAMERAS)}
    pictures = {}
    for taken in load_cameras(CAMERAS, original=True):
        picture = cv2.imread(str(folder / f"original_frames/C{taken.index + 1}/00000000.jpg"))
        maps = undistort_maps(taken, cameras[taken.name].matrix)
        pictures[taken.name] = cv2.remap(picture, *maps, cv2.INTER_LINEAR)
    return Example("WILDTRACK", Scene(cameras, Grid(480, 1440, 0.025, -3.0, -9.0)), [pictures], {})


class Kept:
    """A detector's boxes of an example, found once for all methods; tells the time it took."""

    def __init__(self, example: Example, detector: Detector) -> None:
        start = time.process_time()
        proposer = Proposer(example.scene, Method.PROJECTED, detector, Settings())
        self.boxes: list[dict[str, list[Box]]] = [proposer.boxes(frame) for frame in example.frames]
        self.seconds = (time.process_time() - start) / len(self.boxes)


def run(
    example: Example, method: Method, kept: Kept | None, settings: Settings, learn_from: int | None = FRAMES
) -> tuple[Found, float]:
    """Proposals of all frames, and processor seconds per frame with reading, without the detector's."""
    start = time.process_time()
    cameras = example.scene.cameras
    backgrounds = Backgrounds.learn(example.frames[:learn_from], cameras) if learn_from else None
    detector = Silent() if kept else None
    proposer = Proposer(example.scene, method, detector, settings, backgrounds)
    found = [
        proposer.frame(frame, kept.boxes[place] if kept else None)
        for place, frame in enumerate(example.frames)
    ]
    return found, (time.process_time() - start) / len(found)


class Silent:
    """Stands for the detector whose boxes were kept."""

    version = "kept"

    def detect(self, image: Picture) -> list[Box]:
        raise AssertionError("the boxes are known")


def scored(example: Example, found: Found, frames: Sequence[int] | None = None) -> DetectionScore:
    chosen = [place for place in (frames if frames is not None else example.truth) if place in example.truth]
    true_frames, true_xy, found_frames, found_xy = [], [], [], []
    for place in chosen:
        known = example.truth[place]
        xy = np.array([(each.x, each.y) for each in found[place].people]).reshape(-1, 2)
        xy = xy[is_annotated(example, xy, known)]
        true_frames += [place] * len(known)
        found_frames += [place] * len(xy)
        true_xy.append(known)
        found_xy.append(xy)
    return evaluate(
        Annotations(np.array(true_frames, int), np.concatenate(true_xy)),
        Annotations(np.array(found_frames, int), np.concatenate(found_xy)),
    )


def is_annotated(example: Example, xy: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Whom the annotations could know: inside, or so near the line that somebody annotated may be meant."""
    if not np.isfinite(example.ends) or not len(xy):
        return np.ones(len(xy), bool)
    at_line = known[known[:, 1] > example.ends - RADIUS]
    near = np.hypot(*(xy[:, None] - at_line[None]).transpose(2, 0, 1)) < RADIUS
    inside = xy[:, 1] < example.ends
    # Somebody annotated just inside whose proposal lies inside needs none from beyond.
    alone = ~(near & inside[:, None]).any(axis=0) if len(at_line) else np.zeros(0, bool)
    return inside | (near & alone[None]).any(axis=1)


def row(
    name: str, example: Example, found: Found, frames: Sequence[int] | None = None, **more: float | str | None
) -> Row:
    if not example.truth:
        return Row(name, note="no annotations")
    score = scored(example, found, frames)
    return Row(name, score.moda, score.modp, score.precision, score.recall, score.truth, **more)


def rows_of(example: Example, detector: Detector | None) -> Iterator[Row]:
    """Every method on one example."""
    kept = Kept(example, detector) if detector else None
    settings = Settings()
    if kept:
        found, seconds = run(example, Method.COVER, kept, settings)
        yield row(f"{example.name}, per frame", example, found, seconds=kept.seconds + seconds)
        for name, half in (("first", range(5)), ("second", range(5, FRAMES))):
            if any(place in example.truth for place in half):
                yield row(f"{example.name}, {name} half", example, found, half)
        yield from linked(example, found)
        plain, seconds = run(example, Method.COVER, kept, replace(settings, refine=False), None)
        yield row(f"{example.name}, boxes only", example, plain, seconds=kept.seconds + seconds)
        few, _ = run(example, Method.COVER, kept, settings, 3)
        yield row(f"{example.name}, background of 3 frames", example, few)
    alone, seconds = run(example, Method.BACKGROUND, None, settings)
    yield row(f"{example.name}, background alone", example, alone, seconds=seconds)
    pom, seconds = run(example, Method.POM, None, settings)
    yield row(f"{example.name}, POM", example, pom, seconds=seconds)
    if kept:
        loose = replace(settings, least=0.0)
        clustered, _ = run(example, Method.PROJECTED, kept, loose, None)
        yield row(f"{example.name}, projected + clustered", example, clustered)
        two = replace(loose, projected=replace(loose.projected, views=2))
        clustered, _ = run(example, Method.PROJECTED, kept, two, None)
        yield row(f"{example.name}, projected + clustered, 2 views", example, clustered)


def linked(example: Example, found: Found) -> Iterator[Row]:
    """Rows of the linking, where it is there."""
    try:
        from benchmarks.proposals_linked import linked_row  # type: ignore[import-not-found]
    except ImportError:
        return
    yield Row(**linked_row(example, found))


def real_frame(folder: Path, detector: Detector) -> Row:
    example = wildtrack(folder)
    found = Proposer(example.scene, Method.COVER, detector, Settings()).frame(example.frames[0])
    standing = sum(not each.seated for each in found.people)
    places = ", ".join(
        f"({each.x:.2f}, {each.y:.2f}){' sitting' if each.seated else ''}" for each in found.people
    )
    flagged = " ".join(each.why for each in found.suspicious) or "No camera is suspected."
    note = f"{standing} standing, {len(found.people) - standing} sitting: {places}. {flagged}"
    return Row("WILDTRACK's real frame", people=len(found.people), note=note)


def table(data: Path | None, detector: Detector | None, quick: bool) -> Iterator[Row]:
    if data and (data / "multiviewx").is_dir():
        yield from rows_of(multiviewx(data / "multiviewx"), detector)
        if detector and not quick:
            for name, change in (("noise σ 6", noisy), ("half size", halved)):
                example = multiviewx(data / "multiviewx", change)
                found, _ = run(example, Method.COVER, Kept(example, detector), Settings())
                yield row(f"MultiviewX, {name}", example, found)
    if data and (data / "wildtrack").is_dir() and detector:
        yield real_frame(data / "wildtrack", detector)
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as made:
        yield from rows_of(demo(Path(os.environ.get("DEMO_FOLDER", made))), detector)


def shown(line: Row) -> str:
    numbers = [line.moda, line.modp, line.precision, line.recall]
    percent = "".join("      -" if value is None else f"{100 * value:7.1f}" for value in numbers)
    seconds = "" if line.seconds is None else f"{line.seconds:7.2f}"
    return f"{line.name:<46}{percent}  {line.people or '':>6}{seconds}  {line.note}".rstrip()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder with multiviewx and wildtrack")
    parser.add_argument("--detector", type=Path, help="the detector's file, else DATA_DIR's")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--quick", action="store_true", help="without noise and half size")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    detector = detectors.built_in(Path(os.environ.get("DATA_DIR", ROOT / "var")), options.detector)
    if not options.json:
        if detector is None:
            print("No detector (make detector): only the background's methods are scored.")
        print(f"{'':<46}   MODA   MODP  prec.   rec.  people  s/frame")
    rows = []
    for line in table(options.data, detector, options.quick):
        rows.append(asdict(line))
        if not options.json:
            print(shown(line), flush=True)
    if options.json:
        print(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
