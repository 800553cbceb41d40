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
EXPOSE 8000
CMD ["gunicorn", "annotator.wsgi", "--bind", "0.0.0.0:8000", "--worker-class", "gthread", "--workers", "2", "--threads", "8", "--keep-alive", "75", "--no-control-socket"]
