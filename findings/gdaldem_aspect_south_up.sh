#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# GDAL 3.6.2 (Debian 12): gdaldem turns the aspect of a DEM stored from south to north; its slope and hillshade are right.
#
# Input: one plane that falls to the south by 45 degrees, as two XYZ files with the same points: rows from north to south, and
#   rows from south to north, which GDAL reads as a raster whose y grows (as it does many netCDF grids).
# Guess: aspect, slope and hillshade are the same for both, or the second is refused.
# Seen: aspect is 180 (south) for the first and 0 (north) for the second, without a word. Slope and hillshade are the same.
# Misleads whoever takes sunny slopes or directions of flow from aspect and checks them by the hillshade of the same file.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=gdal-bin=3.6.2+dfsg-1+b2 bookworm "$place/root" "${MIRROR:-http://deb.debian.org/debian}" || exit 77
seen=$(chroot "$place/root" sh -euc '
    cd "$(mktemp -d)"
    for y in $(seq 95 -10 5); do for x in $(seq 5 10 95); do echo "$x $y $y"; done; done > north_first.xyz
    for y in $(seq 5 10 95); do for x in $(seq 5 10 95); do echo "$x $y $y"; done; done > south_first.xyz
    for file in north_first south_first; do
        for mode in aspect slope hillshade; do
            gdaldem $mode -q $file.xyz $mode.tif
            echo "$file $mode:$(gdalinfo -mm $mode.tif | grep -o "Min/Max=.*")"
        done
    done') || exit 1
echo "$seen"
[ "$seen" = 'north_first aspect:Min/Max=180.000,180.000
north_first slope:Min/Max=45.000,45.000
north_first hillshade:Min/Max=38.000,38.000
south_first aspect:Min/Max=0.000,0.000
south_first slope:Min/Max=45.000,45.000
south_first hillshade:Min/Max=38.000,38.000' ]
