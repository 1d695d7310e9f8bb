#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# same_bytes.sh WEB: builds the pages again and compares them with those that are committed.
set -eu
cd "$1"
again=$(mktemp -d)
trap 'rm -rf "$again"' EXIT
npx vite build --outDir "$again" --logLevel warn
npx vite build --mode terrain --outDir "$again" --logLevel warn
for page in report terrain; do
    cmp "$again/$page.html" "dist/$page.html" || {
        echo "web/dist/$page.html is not what web/src makes: run 'npm run build' in web and commit it" >&2
        exit 1
    }
done
