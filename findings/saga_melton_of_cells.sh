#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# SAGA 8.5.0 (Debian 12): the Melton ruggedness number depends on the size of the cells, since its area is no area.
#
# Input: one plane that falls to the south by one in one, 10 x 10 cells, once with cells of 30 m and once the same scaled to
#   cells of 90 m.
# Guess: ta_hydrology 23 (Melton Ruggedness Number) divides the height above a cell by the root of its catchment area in m2.
#   Melton's number has no unit: both planes have the same at the same cell, 210 / sqrt(8 x 30 x 30) = 2.47.
# Seen: 13.56 and 23.48. The output "Catchment Area" is the number of cells times their side (240 and 720 at this cell, of 8
#   cells), and the number too large by the root of the side, 5.5 and 9.5 times.
# Misleads whoever compares catchments with published thresholds of Melton's number (debris flows above 0.3 to 0.6), or DEMs of
#   two resolutions.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=saga=8.5.0+dfsg-2,gdal-bin=3.6.2+dfsg-1+b2 bookworm "$place/root" \
    "${MIRROR:-http://deb.debian.org/debian}" || exit 77
seen=$(chroot "$place/root" sh -euc '
    cd "$(mktemp -d)"
    for side in 30 90; do
        for row in $(seq 9 -1 0); do
            for column in $(seq 0 9); do
                echo "$((column * side + side / 2)) $((row * side + side / 2)) $((row * side))"
            done
        done > plane.xyz
        gdal_translate -q -of SAGA plane.xyz plane.sdat
        saga_cmd -f=s ta_hydrology 23 -DEM plane.sgrd -AREA area.sgrd -ZMAX highest.sgrd -MRN melton.sgrd > log 2>&1
        for what in plane highest area melton; do
            echo "$side $what $(gdallocationinfo -valonly $what.sdat 5 8)"
        done
    done') || exit 1
echo "$seen"
[ "$seen" = '30 plane 30
30 highest 240
30 area 240
30 melton 13.5554418563843
90 plane 90
90 highest 720
90 area 720
90 melton 23.4787139892578' ]
