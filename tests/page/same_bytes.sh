#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# same_bytes.sh WEB: builds the page again and compares it with the one that is committed.
set -eu
cd "$1"
again=$(mktemp -d)
trap 'rm -rf "$again"' EXIT
npx vite build --outDir "$again" --logLevel warn
cmp "$again/report.html" dist/report.html || {
    echo "web/dist/report.html is not what web/src makes: run 'npm run build' in web and commit it" >&2
    exit 1
}
