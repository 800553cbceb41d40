from __future__ import annotations

from whitenoise.storage import CompressedManifestStaticFilesStorage


class ModuleManifestStaticFilesStorage(CompressedManifestStaticFilesStorage):
    """Hashed names inside `import … from "./x.js";` too, so that no browser mixes old and new modules."""

    support_js_module_import_aggregation = True
