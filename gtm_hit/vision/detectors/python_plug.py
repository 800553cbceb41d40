"""Detectors written in Python, in the form that CVAT's auto-annotation functions have.

`create(**params)` makes one, or the module is one itself: `spec`, and `detect(context, image)` for one
picture or `locate(context, images, cameras, grid)` for all views of a frame. Pictures are PIL's. Whoever
names a file or a module runs its code, so only whoever may run commands on the server can.
"""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import cv2
from PIL import Image

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.boxes import Box, Picture
from gtm_hit.vision.detectors.checking import as_list, checked_box, checked_place
from gtm_hit.vision.detectors.errors import DetectorError
from gtm_hit.vision.detectors.labels import is_person
from gtm_hit.vision.located import Located

GROUP = "gtm.detectors"
Params = Mapping[str, str | int | float | bool]


@dataclass(frozen=True)
class Context:
    """What CVAT tells its functions, too."""

    frame_name: str = ""
    conf_threshold: float | None = None
    conv_mask_to_poly: bool = False


@dataclass(frozen=True)
class PythonDetector:
    """Looks at one picture at a time."""

    version: str
    call: Callable[[Context, Image.Image], Any]
    labels: Mapping[int, str] = field(default_factory=dict)  # empty: everything it finds is a person

    def detect(self, image: Picture) -> list[Box]:
        answer = _answered(self.call, "boxes", Context(), _as_pil(image))
        size = (image.shape[1], image.shape[0])
        return [box for each in answer if (box := self._box(each, size)) is not None]

    def _box(self, each: Any, size: tuple[int, int]) -> Box | None:
        if isinstance(each, (tuple, list)):
            if len(each) != 5:
                raise DetectorError(f"a box is x1, y1, x2, y2, score; not {len(each)} values")
            return checked_box(each[:4], each[4], size)
        if self.labels and not is_person(self.labels.get(_of(each, "label_id"), "")):
            return None
        kind = _of(each, "type")
        if str(getattr(kind, "value", kind)) != "rectangle":
            raise DetectorError("the detector answers something other than rectangles")
        score = _of(each, "score", None)
        return checked_box(_of(each, "points"), 1.0 if score is None else score, size)


@dataclass(frozen=True)
class PythonLocator:
    """Looks at all views of a frame at once."""

    version: str
    call: Callable[[Context, dict[str, Image.Image], dict[str, Camera], Grid], Any]

    def locate(
        self, pictures: Mapping[str, Picture], cameras: Mapping[str, Camera], grid: Grid, frame: int
    ) -> list[Located]:
        images = {name: _as_pil(picture) for name, picture in pictures.items()}
        told = (Context(str(frame)), images, dict(cameras), grid)
        found = []
        for each in _answered(self.call, "people", *told):
            if not isinstance(each, (tuple, list)) or len(each) not in (3, 4):
                raise DetectorError("somebody on the ground is (x, y, score) or (x, y, score, person)")
            found.append(checked_place(*each[:3]))
        return found


def from_file(path: Path, params: Params) -> PythonDetector | PythonLocator:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise DetectorError(f"{path}: {error.strerror}") from error
    digest = hashlib.sha256(content).hexdigest()[:12]
    name = f"gtm_detector_{digest}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise DetectorError(f"{path.name} is no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses and pickles in it look for their module there
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[name]
        raise DetectorError(f"{path.name}: {_said(error)}") from error
    return _plugged(module, f"{path.stem}-{digest}", params)


def from_module(name: str, params: Params) -> PythonDetector | PythonLocator:
    try:
        module = importlib.import_module(name)
    except Exception as error:
        raise DetectorError(f"{name}: {_said(error)}") from error
    return _plugged(module, f"{name}-{_state(module)}", params)


def installed() -> list[str]:
    """Names of detectors that packages on this server offer."""
    return sorted(each.name for each in entry_points(group=GROUP))


def from_entry_point(name: str, params: Params) -> PythonDetector | PythonLocator:
    """What it points to is a module as described above, or its `create`."""
    found = next(iter(entry_points(group=GROUP, name=name)), None)
    if found is None:
        raise DetectorError(f"no package on this server offers a detector {name}")
    try:
        target = found.load()
    except Exception as error:
        raise DetectorError(f"{name}: {_said(error)}") from error
    version = found.dist.version if found.dist else _state(target)
    return _plugged(target, f"{name}-{version}", params)


def _plugged(source: Any, version: str, params: Params) -> PythonDetector | PythonLocator:
    function = _made(source, version, params)
    if params:
        told = json.dumps(dict(params), sort_keys=True)
        version += f"-{hashlib.sha256(told.encode()).hexdigest()[:8]}"
    locate, detect = getattr(function, "locate", None), getattr(function, "detect", None)
    if callable(locate):
        return PythonLocator(version, locate)
    if callable(detect):
        return PythonDetector(version, detect, _labels(function))
    raise DetectorError(f"{version} has neither detect(context, image) nor locate(context, images, …)")


def _made(source: Any, version: str, params: Params) -> Any:
    create = getattr(source, "create", None) or (source if callable(source) else None)
    if create is None:
        if params:
            raise DetectorError(f"{version} has no create(), so it takes no parameters")
        return source
    try:
        return create(**params)
    except Exception as error:
        raise DetectorError(f"create() of {version}: {_said(error)}") from error


def _labels(function: Any) -> dict[int, str]:
    """By id. With one label only, whatever it is called, that is what was asked for."""
    labels = getattr(getattr(function, "spec", None), "labels", None) or ()
    try:
        known = {int(_of(each, "id")): str(_of(each, "name")) for each in labels}
    except (TypeError, ValueError) as error:
        raise DetectorError(f"labels of spec: {error}") from error
    if len(known) > 1 and not any(map(is_person, known.values())):
        raise DetectorError(f"none of its labels is a person: {', '.join(sorted(known.values()))[:200]}")
    return known if len(known) > 1 else {}


def _answered(call: Callable[..., Any], several: str, *told: Any) -> list[Any]:
    try:
        return as_list(call(*told), several)
    except DetectorError:
        raise
    except Exception as error:  # whatever the code of others raises
        raise DetectorError(f"the detector raised {_said(error)}") from error


_NOTHING = object()


def _of(each: Any, name: str, default: Any = _NOTHING) -> Any:
    """A value of CVAT's objects, or of dictionaries that stand for them."""
    try:
        return each[name] if isinstance(each, Mapping) else getattr(each, name)
    except (KeyError, AttributeError) as error:
        if default is not _NOTHING:
            return default
        raise DetectorError(f"{type(each).__name__} has no {name}") from error


def _state(target: Any) -> str:
    """What changes when the code does: the package's version, else the file."""
    version = getattr(target, "__version__", None)
    if version:
        return str(version)
    file = getattr(target, "__file__", None)
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()[:12] if file else "unknown"


def _as_pil(picture: Picture) -> Image.Image:
    return Image.fromarray(cv2.cvtColor(picture, cv2.COLOR_BGR2RGB))


def _said(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
