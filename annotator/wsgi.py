from __future__ import annotations

import os
from pathlib import Path

from django.conf import settings
from django.core.wsgi import get_wsgi_application

from annotator.private_files import keep_private

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
keep_private(settings.DATA_DIR)
Path(settings.FILE_UPLOAD_TEMP_DIR).mkdir(exist_ok=True)
application = get_wsgi_application()
