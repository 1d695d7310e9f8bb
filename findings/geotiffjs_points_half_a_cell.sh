#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# geotiff.js 3.0.5 (npm): the bounding box of a DEM whose samples are points lies half a cell to the south-east.
#
# Input: one DEM of 20 x 20 cells of 10 m, first sample at (500005, 4399995), as GeoTIFF in both ways of the standard: samples
#   are areas (tie point: their corner, 500000 4400000) and samples are points (tie point: the sample).
# Guess: getBoundingBox() is the same for both (as in GDAL), or spans the samples of the second: 500005 to 500195.
# Seen: 500005 to 500205 and 4399795 to 4399995 for the second: half a cell beside its samples. pixelIsArea() is false, but
#   neither getOrigin() nor getBoundingBox() heeds it.
# Misleads web maps that place a DEM by its bounding box: rivers from elsewhere lie beside their valleys.
# Needs node, npm and its registry. Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
cd "$place"
npm install --prefix "$place" --silent --no-audit --no-fund --ignore-scripts geotiff@3.0.5 || exit 77
seen=$(node --input-type=module -e '
    import { fromArrayBuffer, writeArrayBuffer } from "geotiff";
    for (const [type, x, y] of [[1, 500000, 4400000], [2, 500005, 4399995]]) {
        const file = await writeArrayBuffer(new Float32Array(400), {
            width: 20, height: 20, ModelTiepoint: [0, 0, 0, x, y, 0], ModelPixelScale: [10, 10, 0],
            GTModelTypeGeoKey: 1, GTRasterTypeGeoKey: type, ProjectedCSTypeGeoKey: 32613 });
        const image = await (await fromArrayBuffer(file)).getImage();
        console.log(`${image.pixelIsArea() ? "areas" : "points"}: ${image.getBoundingBox().join(" ")}`);
    }') || exit 1
echo "$seen"
[ "$seen" = 'areas: 500000 4399800 500200 4400000
points: 500005 4399795 500205 4399995' ]
