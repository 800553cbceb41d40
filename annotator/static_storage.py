from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePosixPath
from typing import Any

from django.core.files.base import ContentFile
from rcssmin import cssmin
from rjsmin import jsmin
from whitenoise.storage import CompressedManifestStaticFilesStorage

OURS = {"base", "compare", "geometry", "review", "saving", "site", "tables", "truth", "views", "workbench"}
# As Django writes its patterns of imports; it has none for modules that are resolved now and imported later.
RESOLVED = (
    "*.js",
    (
        (
            r"""(?P<matched>import\.meta\.resolve\(["'](?P<url>[./].*?)["']\))""",
            """import.meta.resolve("%(url)s")""",
        ),
    ),
)
MINIFIERS = {".css": cssmin, ".js": jsmin}


class ModuleManifestStaticFilesStorage(CompressedManifestStaticFilesStorage):
    """Hashed names inside `import … from "./x.js";` and `import.meta.resolve("./x.js")` too, so that no
    browser mixes old and new modules.

    Our own modules travel without their comments, which are a quarter of them.
    """

    support_js_module_import_aggregation = True
    patterns = (*CompressedManifestStaticFilesStorage.patterns, RESOLVED)

    def post_process(self, paths: dict[str, Any], dry_run: bool = False, **options: Any) -> Iterator[Any]:
        """Names are looked for in what was collected: without comments, where types import in circles."""
        yield from super().post_process({name: (self, name) for name in paths}, dry_run, **options)

    def _save(self, name: str, content: Any) -> str:
        path = PurePosixPath(name)
        if path.parts[0] in OURS and path.suffix in MINIFIERS:
            text = b"".join(content.chunks()).decode()
            content.seek(0)  # hashing has read it already
            content = ContentFile(MINIFIERS[path.suffix](text).encode())
        return super()._save(name, content)
