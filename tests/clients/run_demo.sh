#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# run_demo.sh SOURCE_DIR: scripts/demo in a fresh clone in an empty folder, as a newcomer runs it.
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
git clone --quiet "$1" "$place/thalweg"
cd /
"$place/thalweg/scripts/demo"
for file in map.png network.gpkg network_arcs.shp network_nodes.shp dem.tif network.tif contours.gpkg profile.svg \
    curve.svg wireframe.svg sections.svg report.html report.json recipe.toml; do
    test -s "$place/thalweg/out/demo/$file" || { echo "run_demo.sh: out/demo/$file is missing" >&2; exit 1; }
done
test -z "$(git -C "$place/thalweg" status --porcelain)" || { echo "run_demo.sh: the demo left files git sees" >&2; exit 1; }
