#!/usr/bin/env bash
# Create or refresh the virtual environment build/venv from python/requirements-test.txt, with the python3 that is first
# on PATH (or $PYTHON). Does nothing when it is up to date.
set -euo pipefail
cd "$(dirname "$0")/.."
python=$(command -v "${PYTHON:-python3}")
wanted="$("$python" -VV) $("$python" -c 'import sys; print(sys.executable)')
$(cat python/requirements-test.txt)"
stamp=build/venv/.made-from
[ -f "$stamp" ] && [ "$(cat "$stamp")" = "$wanted" ] && exit 0
echo "setup: Python environment build/venv for $python" >&2
rm -rf build/venv
mkdir -p build
"$python" -m venv build/venv
build/venv/bin/python -m pip install --quiet --disable-pip-version-check -r python/requirements-test.txt
printf '%s\n' "$wanted" >"$stamp"
