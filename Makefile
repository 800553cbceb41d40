# `make run` and `make test` do everything on a fresh Debian machine; `make help` lists the rest.
PORT ?= 8000
HOST ?= 127.0.0.1
PYTHON ?= python3
BIN := .venv/bin
ENVIRONMENT := .venv/.runtime
DEV_ENVIRONMENT := .venv/.development
NODE_ENVIRONMENT := node_modules/.development
NODE := node_modules/.bin
DETECTOR := $(or $(DATA_DIR),$(CURDIR)/var)/detector
# Fetched once; where it cannot be had, proposals rest on the background alone and its tests are skipped.
HAVE_DETECTOR = test -f "$(DETECTOR)/nanodet_g_416.onnx" || $(MAKE) --no-print-directory detector || true
# Commands that only look at the code need settings, but no secrets and no data.
CHECK := SECRET_KEY=checks-only-0123456789-0123456789-0123456789 DATA_DIR=$(CURDIR)/var/check

.DEFAULT_GOAL := help
.PHONY: help run detector test test-fast test-js lint format types migrations-check static-check check benchmarks clean

help: ## list what make can do
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1\t\2/' | expand -t 26

run: $(ENVIRONMENT) ## start everything on this machine: demo scene, web server, worker (PORT=8123 for another port)
	@$(HAVE_DETECTOR)
	@exec $(BIN)/python -m annotator.local --host $(HOST) --port $(PORT)

detector: $(ENVIRONMENT) ## fetch and convert the person detector that proposals are made with (needs npm and the network once)
	@mkdir -p -m 700 "$(dir $(DETECTOR))"
	@command -v npm >/dev/null || scripts/install-debian-packages nodejs npm || true
	@$(BIN)/python -m gtm_hit.vision.detectors.make "$(DETECTOR)"

test: $(DEV_ENVIRONMENT) ## run all tests; installs the Debian packages they need (chromium, postgresql, redis-server, nginx)
	@scripts/install-debian-packages chromium postgresql redis-server nginx fonts-dejavu-core
	$(MAKE) test-js
	@$(HAVE_DETECTOR)
	$(BIN)/pytest -n 2 --dist loadgroup

test-fast: test-js $(DEV_ENVIRONMENT) ## the tests that need neither a browser nor services
	$(BIN)/pytest -n 2 -m "not browser and not services"

test-js: $(NODE_ENVIRONMENT) ## the browser's modules that need no browser
	node --test tests/js/*.test.js

lint: $(DEV_ENVIRONMENT) $(NODE_ENVIRONMENT) ## ruff and biome: rules and format
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(NODE)/biome check

format: $(DEV_ENVIRONMENT) $(NODE_ENVIRONMENT) ## let ruff and biome repair and format
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(NODE)/biome check --write

types: $(DEV_ENVIRONMENT) $(NODE_ENVIRONMENT) ## mypy, and tsc over the browser's half
	$(BIN)/mypy annotator gtm_hit
	$(NODE)/tsc -p tsconfig.json
	$(NODE)/tsc -p tsconfig.pure.json

migrations-check: $(DEV_ENVIRONMENT) ## models and migrations tell the same story
	$(CHECK) $(BIN)/python manage.py makemigrations --check --dry-run

static-check: $(DEV_ENVIRONMENT) ## every module import and asset resolves under its hashed name
	$(CHECK) $(BIN)/python manage.py collectstatic --noinput --verbosity 0

check: lint types migrations-check static-check ## everything .ci/run does before the tests

benchmarks: $(DEV_ENVIRONMENT) ## print the figures of the README's performance table
	@for file in benchmarks/[a-z]*.py; do echo "== $$file"; $(BIN)/python -m benchmarks.$$(basename $$file .py) || exit 1; done

clean: ## remove the environments and caches; data in var/ stay
	rm -rf .venv node_modules .mypy_cache .ruff_cache .pytest_cache .hypothesis

$(ENVIRONMENT): requirements.txt
	@scripts/make-environment $(PYTHON) requirements.txt
	@touch $@

$(DEV_ENVIRONMENT): requirements.txt requirements-dev.txt requirements-alone.txt
	@scripts/make-environment $(PYTHON) requirements-dev.txt
	@$(BIN)/pip install --quiet --disable-pip-version-check --no-deps -r requirements-alone.txt
	@touch $(ENVIRONMENT) $@

$(NODE_ENVIRONMENT): package.json package-lock.json
	@command -v npm >/dev/null && command -v node >/dev/null || scripts/install-debian-packages nodejs npm
	@npm ci --silent --no-progress
	@touch $@
