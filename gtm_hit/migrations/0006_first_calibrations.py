import hashlib
import json
from typing import Any

from django.db import migrations

NUMBERS = ("matrix", "rvec", "tvec", "distortion")
SOURCE = "in place before versions were kept"


def keep_what_is_in_place(apps: Any, _schema: Any) -> None:
    """Every dataset with cameras gets them as its first calibration.

    Saves and releases made before stay without one: nobody knows how often it was replaced meanwhile.
    """
    Dataset, Calibration = (apps.get_model("gtm_hit", name) for name in ("Dataset", "Calibration"))
    for dataset in Dataset.objects.filter(calibration=None, cameras__isnull=False).distinct():
        cameras = [facts(camera) for camera in dataset.cameras.order_by("index")]
        dataset.calibration = Calibration.objects.create(
            dataset=dataset,
            number=1,
            cameras={"format": "gtm-cameras", "version": 1, "cameras": cameras},
            digest=digest(cameras),
            source=SOURCE,
        )
        dataset.save(update_fields=["calibration"])


def facts(camera: Any) -> dict[str, Any]:
    return {
        "name": camera.name,
        "width": camera.width,
        "height": camera.height,
        "matrix": [[float(value) for value in row] for row in camera.matrix],
        "rvec": [float(value) for value in camera.rvec],
        "tvec": [float(value) for value in camera.tvec],
        "distortion": [float(value) for value in camera.distortion or [0.0] * 5],
    }


def digest(cameras: list[dict[str, Any]]) -> str:
    """As `content_digest` of the program at that time."""
    told = []
    for camera in cameras:
        numbers = {name: camera[name] for name in NUMBERS}
        numbers["matrix"] = [value for row in camera["matrix"] for value in row]
        flat = [[value + 0.0 for value in numbers[name]] for name in NUMBERS]
        told.append([camera["name"], camera["width"], camera["height"], *flat])
    return hashlib.sha256(json.dumps(told).encode()).hexdigest()


class Migration(migrations.Migration):
    dependencies = [("gtm_hit", "0005_calibrations")]

    operations = [migrations.RunPython(keep_what_is_in_place, migrations.RunPython.noop)]
