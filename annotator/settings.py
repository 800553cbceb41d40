"""Settings come from the environment only; `.env.example` and the README list every variable."""

from __future__ import annotations

from pathlib import Path

from django.core.exceptions import ImproperlyConfigured

from annotator import environment

BASE_DIR = Path(__file__).resolve().parent.parent
DATA_DIR = Path(environment.text("DATA_DIR", str(BASE_DIR / "var"))).resolve()

DEBUG = environment.boolean("DEBUG", False)
SECRET_KEY = environment.text("SECRET_KEY", "only-for-debugging-on-this-machine" if DEBUG else None)
if len(SECRET_KEY) < 32:
    raise ImproperlyConfigured("SECRET_KEY must have at least 32 characters")
# Keys of before: what they signed still counts, what is signed now has the new one.
SECRET_KEY_FALLBACKS = environment.words("SECRET_KEY_FALLBACKS", "")
ALLOWED_HOSTS = environment.words("ALLOWED_HOSTS", "localhost 127.0.0.1 [::1]")
CSRF_TRUSTED_ORIGINS = environment.words("CSRF_TRUSTED_ORIGINS", "")

INSTALLED_APPS = [
    "django.contrib.admin",
    "django.contrib.auth",
    "django.contrib.contenttypes",
    "django.contrib.sessions",
    "django.contrib.messages",
    "whitenoise.runserver_nostatic",
    "annotator.apps.StaticFiles",
    "rest_framework",
    "drf_spectacular",
    "drf_spectacular_sidecar",
    "gtm_hit",
]

# The path below which a proxy shows this server, for example /gtm; the proxy passes it on.
SCRIPT_NAME = environment.path_prefix("SCRIPT_NAME")
FORCE_SCRIPT_NAME = SCRIPT_NAME or None
SESSION_COOKIE_PATH = CSRF_COOKIE_PATH = LANGUAGE_COOKIE_PATH = SCRIPT_NAME or "/"

MIDDLEWARE = [
    "annotator.content_policy.ContentPolicyMiddleware",
    "django.middleware.security.SecurityMiddleware",
    "whitenoise.middleware.WhiteNoiseMiddleware",
    "django.contrib.sessions.middleware.SessionMiddleware",
    "django.middleware.locale.LocaleMiddleware",
    "django.middleware.common.CommonMiddleware",
    "django.middleware.csrf.CsrfViewMiddleware",
    "django.contrib.auth.middleware.AuthenticationMiddleware",
    "django.contrib.messages.middleware.MessageMiddleware",
    "django.middleware.clickjacking.XFrameOptionsMiddleware",
]

ROOT_URLCONF = "annotator.urls"
WSGI_APPLICATION = "annotator.wsgi.application"
ASGI_APPLICATION = "annotator.asgi.application"

TEMPLATES = [
    {
        "BACKEND": "django.template.backends.django.DjangoTemplates",
        "DIRS": [BASE_DIR / "templates"],
        "APP_DIRS": True,
        "OPTIONS": {
            "context_processors": [
                "django.template.context_processors.request",
                "django.contrib.auth.context_processors.auth",
                "django.contrib.messages.context_processors.messages",
            ],
        },
    },
]

DATABASES = {
    "default": environment.database(
        "DATABASE_URL", f"sqlite:///{DATA_DIR}/gtm.sqlite3", environment.text("DATABASE_PASSWORD", "")
    )
}
DEFAULT_AUTO_FIELD = "django.db.models.BigAutoField"

AUTH_PASSWORD_VALIDATORS = [
    {"NAME": "django.contrib.auth.password_validation.MinimumLengthValidator"},
    {"NAME": "django.contrib.auth.password_validation.CommonPasswordValidator"},
]
LOGIN_URL = "login"
LOGIN_REDIRECT_URL = "home"
LOGOUT_REDIRECT_URL = "home"

LANGUAGE_CODE = "en"
TIME_ZONE = "UTC"
USE_I18N = True
USE_TZ = True
LOCALE_PATHS = [BASE_DIR / "locale"]

STATIC_URL = f"{SCRIPT_NAME}/static/"
STATICFILES_DIRS = [BASE_DIR / "static"]
STATIC_ROOT = DATA_DIR / "static"
WHITENOISE_KEEP_ONLY_HASHED_FILES = True
MEDIA_ROOT = DATA_DIR / "media"  # image derivatives, by digest
TABLES_ROOT = DATA_DIR / "tables"  # rectangle tables, by digest; memory-mapped, so always a local folder
EXPORTS_ROOT = DATA_DIR / "exports"
RELEASES_ROOT = DATA_DIR / "releases"
INCOMING_ROOT = DATA_DIR / "incoming"  # folders and videos put on the server for import
# Days until the files of an export are removed; 0: never. Releases are never removed.
EXPORT_KEEP_DAYS = environment.integer("EXPORT_KEEP_DAYS", 30, minimum=0, maximum=36_500)
UPLOADS_ROOT = DATA_DIR / "uploads"  # archives that came through the browser
# Where they arrive: on the same disk, so that keeping one needs no second copy.
FILE_UPLOAD_TEMP_DIR = str(DATA_DIR / "arriving")
FILE_UPLOAD_PERMISSIONS = 0o600
FILE_UPLOAD_DIRECTORY_PERMISSIONS = 0o700
MAX_UPLOAD_MB = environment.integer("MAX_UPLOAD_MB", 2048, minimum=1, maximum=1_000_000)
STORAGES = {
    "default": {"BACKEND": "django.core.files.storage.FileSystemStorage"},
    "staticfiles": {"BACKEND": "annotator.static_storage.ModuleManifestStaticFilesStorage"},
}

# Celery: a folder is broker enough for one machine; production names a Redis.
CELERY_BROKER_URL = environment.starting_with(
    "CELERY_BROKER_URL", "filesystem://", ("filesystem://", "redis://", "rediss://")
)
if CELERY_BROKER_URL.startswith("filesystem://"):
    CELERY_BROKER_TRANSPORT_OPTIONS = {
        "data_folder_in": str(DATA_DIR / "broker" / "queue"),
        "data_folder_out": str(DATA_DIR / "broker" / "queue"),
        "control_folder": str(DATA_DIR / "broker" / "control"),
        "store_processed": False,
    }
CELERY_TASK_IGNORE_RESULT = True
CELERY_BEAT_SCHEDULE_FILENAME = str(DATA_DIR / "beat-schedule")
CELERY_TASK_ACKS_LATE = True
CELERY_WORKER_PREFETCH_MULTIPLIER = 1
CELERY_WORKER_HIJACK_ROOT_LOGGER = False
CELERY_BROKER_CONNECTION_RETRY_ON_STARTUP = True

REST_FRAMEWORK = {
    "DEFAULT_AUTHENTICATION_CLASSES": ["rest_framework.authentication.SessionAuthentication"],
    "DEFAULT_PERMISSION_CLASSES": ["rest_framework.permissions.IsAdminUser"],
    "DEFAULT_RENDERER_CLASSES": ["rest_framework.renderers.JSONRenderer"],
    "DEFAULT_PARSER_CLASSES": ["rest_framework.parsers.JSONParser"],
    "DEFAULT_SCHEMA_CLASS": "drf_spectacular.openapi.AutoSchema",
    "EXCEPTION_HANDLER": "gtm_hit.api.common.errors.handle",
}
SPECTACULAR_SETTINGS = {
    "TITLE": "Ground Truth Marker",
    "VERSION": "1",
    "SWAGGER_UI_DIST": "SIDECAR",
    "SWAGGER_UI_FAVICON_HREF": "SIDECAR",
    "SERVE_PERMISSIONS": ["rest_framework.permissions.IsAdminUser"],
    "ENUM_NAME_OVERRIDES": {
        "AnnotationState": "gtm_hit.models.annotation.Annotation.State",
        "AssignmentState": "gtm_hit.models.work.Assignment.State",
        "JobState": "gtm_hit.models.job.Job.State",
        "CampaignState": "gtm_hit.models.campaign.Campaign.State",
        "CampaignLinkKind": "gtm_hit.models.campaign_link.CampaignLink.Kind",
        "StitchConflictKind": "gtm_hit.models.stitching.StitchConflict.Kind",
        "StitchConflictState": "gtm_hit.models.stitching.StitchConflict.State",
        "StitchConflictDecision": "gtm_hit.models.stitching.StitchConflict.Decision",
        "OutboxState": "gtm_hit.models.outbox.OutboxRow.State",
        "OutboxKind": "gtm_hit.models.outbox.OutboxRow.Kind",
        "BoardKind": "gtm_hit.ops.desk.board_choices.KINDS",
        "LengthUnit": ["m", "cm", "mm"],
        "AdjustVariant": "gtm_hit.ops.desk.adjust_choices.VARIANTS",
        "ClickDecisionKind": "gtm_hit.models.desk.ClickDecision.Decision",
    },
}

# Behind TLS (SECURE=true) cookies and redirects insist on it.
SECURE = environment.boolean("SECURE", False)
SECURE_SSL_REDIRECT = SESSION_COOKIE_SECURE = CSRF_COOKIE_SECURE = SECURE
SECURE_PROXY_SSL_HEADER = ("HTTP_X_FORWARDED_PROTO", "https") if SECURE else None
SECURE_HSTS_SECONDS = 365 * 24 * 3600 if SECURE else 0
# Names below and above ours belong to others; browsers' lists are for whoever owns the whole domain.
SILENCED_SYSTEM_CHECKS = ["security.W005", "security.W021"]
SECURE_REFERRER_POLICY = "same-origin"  # assignment tokens are in addresses
X_FRAME_OPTIONS = "DENY"
DATA_UPLOAD_MAX_MEMORY_SIZE = 5 * 1024 * 1024

LEASE_MINUTES = environment.integer("LEASE_MINUTES", 120, minimum=1, maximum=60 * 24 * 30)
# Until its first save a lease is short, and only so many of them run at once: whoever invents workers holds
# little, not for long. Whoever saves makes room for others at the same address.
FIRST_SAVE_MINUTES = environment.integer("FIRST_SAVE_MINUTES", 15, minimum=1, maximum=60 * 24 * 30)
UNSAVED_PER_ADDRESS = environment.integer("UNSAVED_PER_ADDRESS", 30, minimum=1, maximum=1_000_000)
UNSAVED_PER_LINK = environment.integer("UNSAVED_PER_LINK", 300, minimum=1, maximum=1_000_000)
# Whose X-Forwarded-For is believed; from anybody else it is a claim.
TRUSTED_PROXIES = environment.networks("TRUSTED_PROXIES", "")
# Days until an address that lets somebody in, or leads to his own work, is worth nothing; 0: never.
ENTRY_LINK_DAYS = environment.integer("ENTRY_LINK_DAYS", 180, minimum=0, maximum=36_500)
WORKER_LINK_DAYS = environment.integer("WORKER_LINK_DAYS", 90, minimum=0, maximum=36_500)
# Panels whose pages may show ours in a frame and take its form; campaigns choose among them.
EMBEDDING_ORIGINS = environment.words("EMBEDDING_ORIGINS", "")
# Where Prolific's interface may be: a campaign chooses among these and can name no other.
PROLIFIC_ADDRESSES = environment.words("PROLIFIC_ADDRESSES", "https://api.prolific.com")
PROLIFIC_TOKEN = environment.text("PROLIFIC_TOKEN", "")  # for campaigns without a key of their own
TUTORIAL_DATASET = environment.text("TUTORIAL_DATASET", "demo")

LOG_LEVEL = environment.one_of("LOG_LEVEL", "INFO", ("DEBUG", "INFO", "WARNING", "ERROR"))
LOGGING = {
    "version": 1,
    "disable_existing_loggers": False,
    "formatters": {
        "plain": {
            "()": "annotator.masked_log.MaskingFormatter",
            "format": "{asctime} {levelname} {name}: {message}",
            "style": "{",
        }
    },
    "handlers": {"console": {"class": "logging.StreamHandler", "formatter": "plain"}},
    "root": {
        "handlers": ["console"],
        "level": environment.one_of("LOG_LEVEL", "INFO", ("DEBUG", "INFO", "WARNING", "ERROR")),
    },
    # A folder as broker has no host name, which Kombu finds remarkable.
    "loggers": {"kombu.connection": {"level": "ERROR"}},
}
# Detectors of people that pictures may be sent to; empty: nothing leaves the server.
DETECTOR_ADDRESSES = environment.words("DETECTOR_ADDRESSES", "")
# People are proposed when frames arrive and batches are cut, not only when somebody asks for it.
PROPOSE_AUTOMATICALLY = environment.boolean("PROPOSE_AUTOMATICALLY", True)
