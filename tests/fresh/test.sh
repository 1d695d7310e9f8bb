#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# test.sh, in a fresh clone: scripts/test as a newcomer runs it; then the package of what it compiled.
set -eu
start=$(date +%s)
scripts/test
echo "test.sh: $(($(date +%s) - start)) s for scripts/test"
scripts/package deb
lintian --fail-on error --allow-root build/packages/thalweg_*.deb
