#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# wheel.sh, on a fresh machine, as root, with the wheel in the folder `packages` above: installs it into a virtual environment
# without an index of packages, and what its METADATA names by apt; makes a terrain; removes it without a trace.
set -eu
fail() {
    echo "wheel.sh: $*" >&2
    exit 1
}
start=$(date +%s)
scripts/packages venv
cd "$HOME"
python3 -m venv --system-site-packages venv
find venv | grep -v __pycache__ | sort >before
venv/bin/pip install --no-index --quiet packages/thalweg-*.whl
DEBIAN_FRONTEND=noninteractive apt-get -qq --yes --no-install-recommends -o Dpkg::Use-Pty=0 install \
    $(venv/bin/python3 -c 'import importlib.metadata as m
print(*m.metadata("thalweg").get_all("Requires-External"))') >/dev/null
shape=$(venv/bin/python3 -c "import thalweg; print(thalweg.make({'grid': {'width': 256, 'height': 256}}).dem.shape)")
test "$shape" = "(256, 256)" || fail "the module made $shape"
! command -v g++ >/dev/null || fail "the wheel needs a compiler"
venv/bin/pip uninstall --quiet --yes thalweg
find venv | grep -v __pycache__ | sort | diff before - >&2 || fail "files are left"
echo "wheel.sh: $(($(date +%s) - start)) s"
