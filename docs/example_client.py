"""From a folder of images to a release, with nothing but the REST API: needs Python and httpx.

python docs/example_client.py ADDRESS KEY incoming/MultiviewX mvx truth '{"preset": "multiviewx"}'
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import httpx


class Marker:
    def __init__(self, address: str, key: str) -> None:
        headers = {"Authorization": f"Bearer {key}"}
        self.http = httpx.Client(base_url=f"{address}/api/v1/", headers=headers, timeout=60)

    def get(self, path: str, **query: Any) -> Any:
        return self._checked(self.http.get(path, params=query or None))

    def post(self, path: str, body: dict[str, Any]) -> Any:
        return self._checked(self.http.post(path, json=body))

    def pages(self, path: str, **query: Any) -> Any:
        """Everything of a list, however many pages it has."""
        page = self.get(path, **query)
        yield from page["results"]
        while page["next"]:
            page = self.get(page["next"])
            yield from page["results"]

    def wait(self, job: dict[str, Any]) -> dict[str, Any]:
        """A job's result, once it is done."""
        while job["state"] in {"queued", "running"}:
            print(f"{job['kind']}: {job['done']} of {job['total']}  {job['message']}")
            time.sleep(1)
            job = self.get(f"jobs/{job['id']}/")
        if job["state"] != "done":
            raise SystemExit(f"{job['kind']} {job['state']}: {job['message']}")
        result: dict[str, Any] = job["result"]
        return result

    def download(self, path: str, target: Path) -> None:
        with self.http.stream("GET", path) as answer, target.open("wb") as file:
            answer.raise_for_status()
            for block in answer.iter_bytes():
                file.write(block)

    def _checked(self, answer: httpx.Response) -> Any:
        if answer.is_error:
            error = answer.json()
            raise SystemExit(f"{answer.status_code} {error['code']}: {error['message']} {error['details']}")
        return answer.json()


def main(address: str, key: str, source: str, slug: str, layer: str, scene: str) -> None:
    marker = Marker(address, key)
    wanted = {"source": source, "slug": slug, "layer": layer, **json.loads(scene)}
    print(marker.wait(marker.post("imports/", wanted)))

    made = marker.post(f"datasets/{slug}/batches/", {"size": 10})["made"]
    print(f"{made} batches; {marker.get(f'datasets/{slug}/progress/')}")
    for each in marker.pages(f"datasets/{slug}/assignments/", state="leased"):
        print(f"batch {each['batch']}: {each['frames_done']} of {each['frames']} by {each['worker']}")

    order = {"layer": layer, "licence": "For research only.", "formats": ["wildtrack", "csv"]}
    number = marker.wait(marker.post(f"datasets/{slug}/releases/", order))["release"]
    target = Path(f"{slug}-{number}.zip")
    marker.download(f"datasets/{slug}/releases/{number}/download/", target)
    print(f"release {number} is in {target}")


if __name__ == "__main__":
    main(*sys.argv[1:7])
