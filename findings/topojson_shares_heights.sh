#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# topojson-server 3.0.1 and topojson-client 3.1.0 (npm): a line takes the heights of another line with the same x and y.
#
# Input: a river's bed (30, 20, 10 m) and its water surface (35, 25, 15 m) as two lines along the same centre line.
# Guess: positions are shared where they are equal, heights included; failing that, all heights are dropped.
# Seen: there and back again, the water surface has the heights of the bed: one arc is kept for both. With quantization all
#   heights are gone. Nothing is said.
# Misleads whoever ships profiles, bridges over rivers or two surveys of one river as TopoJSON.
# Needs node, npm and its registry. Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
cd "$place"
npm install --prefix "$place" --silent --no-audit --no-fund --ignore-scripts \
    topojson-server@3.0.1 topojson-client@3.1.0 || exit 77
seen=$(node -e '
    const { topology } = require("topojson-server"), { feature } = require("topojson-client");
    const line = heights => ({ type: "LineString", coordinates: heights.map((z, i) => [i, 0, z]) });
    for (const quantization of [0, 1e6]) {
        const there = topology({ bed: line([30, 20, 10]), water: line([35, 25, 15]) }, quantization);
        const back = feature(there, there.objects.water).geometry.coordinates;
        console.log(`${there.arcs.length} arc, heights of the water surface: ${back.map(position => position[2])}`);
    }') || exit 1
echo "$seen"
[ "$seen" = '1 arc, heights of the water surface: 30,20,10
1 arc, heights of the water surface: ,,' ]
