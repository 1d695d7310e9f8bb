#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# install.sh WEB: the npm packages of the lock file, once.
set -eu
cd "$1"
[ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --no-audit --no-fund
