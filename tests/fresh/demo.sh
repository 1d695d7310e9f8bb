#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# demo.sh, in a fresh clone: scripts/demo as a newcomer runs it, and what it left.
set -eu
start=$(date +%s)
scripts/demo
echo "demo.sh: $(($(date +%s) - start)) s from the clone to report.html"
for file in map.png network.gpkg network_arcs.shp network_nodes.shp dem.tif network.tif contours.gpkg profile.svg \
    wireframe.svg sections.svg report.html report.json recipe.toml project.qgz; do
    test -s "out/demo/$file" || { echo "demo.sh: out/demo/$file is missing" >&2; exit 1; }
done
test -z "$(git status --porcelain)" || { echo "demo.sh: the demo left files that git sees" >&2; exit 1; }
test ! -e build/release/bin/test_core || { echo "demo.sh: the demo compiled tests" >&2; exit 1; }
