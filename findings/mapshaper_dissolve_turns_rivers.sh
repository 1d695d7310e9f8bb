#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# mapshaper 0.7.70 (npm): -dissolve turns rivers round.
#
# Input: two tributaries and the river below their confluence, three lines, each drawn downstream.
# Guess: -dissolve makes one feature of the three lines; where lines are joined, they are joined end to start.
# Seen: one line goes down the first tributary and up the second, and the river below runs from its mouth up to the confluence.
#   Nothing is said.
# Misleads whoever dissolves reaches by river name and reads directions of flow from the order of the vertices.
# Needs node, npm and its registry. Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
cd "$place"
npm install --prefix "$place" --silent --no-audit --no-fund --ignore-scripts mapshaper@0.7.70 || exit 77
cat > rivers.json <<END
{"type": "GeometryCollection", "geometries": [
  {"type": "LineString", "coordinates": [[0, 10], [1, 6], [5, 5]]},
  {"type": "LineString", "coordinates": [[10, 0], [8, 1], [5, 5]]},
  {"type": "LineString", "coordinates": [[5, 5], [4, 3], [5, -10]]}]}
END
node_modules/.bin/mapshaper rivers.json -dissolve -o dissolved.json format=geojson || exit 1
seen=$(grep -o '"coordinates".*]' dissolved.json) || exit 1
echo "$seen"
[ "$seen" = '"coordinates":[[[0,10],[1,6],[5,5],[8,1],[10,0]],[[5,-10],[4,3],[5,5]]]' ]
