"""Which annotations of which layers every person of a stitched layer was made of."""

from __future__ import annotations

import csv
import io

from gtm_hit.ops.exports.formats.target import Target
from gtm_hit.ops.exports.frames import Chunk
from gtm_hit.ops.stitching import provenance

SOURCES = "sources.csv"
COLUMNS = ("frame", "person", "source_layer", "source_person", "worker", "batch", "copy")


class SourcesWriter:
    """A line per annotation that went in; frames people changed by hand afterwards have none."""

    def __init__(self, target: Target) -> None:
        self.layer = target.layer
        self.stream = target.open_files.enter_context(target.files.stream(SOURCES))
        self.stream.write(f"{','.join(COLUMNS)}\n".encode())

    def add(self, chunk: Chunk) -> None:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(
            (line.frame, line.person, line.layer, line.source_person, line.worker, line.batch, line.copy)
            for line in provenance.lines(self.layer, chunk.numbers)
        )
        self.stream.write(text.getvalue().encode())

    def finish(self) -> None:
        pass
