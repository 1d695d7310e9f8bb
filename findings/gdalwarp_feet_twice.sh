#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# GDAL 3.6.2 (Debian 12): gdalwarp converts heights and leaves the old unit beside the new numbers.
#
# Input: a DEM of 1000 US survey feet everywhere, whose compound CRS says so (EPSG:26913+6360).
# Guess: `gdalwarp -t_srs EPSG:26913`, a target without heights, leaves the numbers alone; or, if it converts them to metres,
#   writes metres as the band's unit.
# Seen: 304.801 everywhere, and "Unit Type: US survey foot". Whoever trusts the unit converts a second time: 92.9 m for 304.8 m.
#   With -novshift the numbers stay 1000, under the same unit.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=gdal-bin=3.6.2+dfsg-1+b2 bookworm "$place/root" "${MIRROR:-http://deb.debian.org/debian}" || exit 77
seen=$(chroot "$place/root" sh -euc '
    cd "$(mktemp -d)"
    gdal_create -q -of GTiff -outsize 20 20 -bands 1 -burn 1000 -ot Float32 -a_srs EPSG:26913+6360 \
        -a_ullr 500000 4400000 500600 4399400 feet.tif
    gdalwarp -q -t_srs EPSG:26913 feet.tif warped.tif
    gdalwarp -q -novshift -t_srs EPSG:26913 feet.tif kept.tif
    for file in feet warped kept; do
        echo "$file:$(gdalinfo -mm $file.tif | grep -E "Min/Max|Unit Type" | tr -d "\n" | tr -s " ")"
    done') || exit 1
echo "$seen"
[ "$seen" = "feet: Computed Min/Max=1000.000,1000.000 Unit Type: US survey foot
warped: Computed Min/Max=304.801,304.801 Unit Type: US survey foot
kept: Computed Min/Max=1000.000,1000.000 Unit Type: US survey foot" ]
