#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# GDAL 3.6.2 (Debian 12): a BAG file made of heights comes back with a vertical axis that points down.
#
# Input: a DEM of 400 m everywhere in EPSG:32613, without a vertical CRS, converted by `gdal_translate -of BAG`.
# Guess: the file comes back with EPSG:32613, or with a vertical CRS of heights that grow upwards.
# Seen: a compound CRS whose vertical axis is "depth", down, and 400 in the band "elevation". Whoever honours the axis turns
#   the land into a sea 400 m deep.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=gdal-bin=3.6.2+dfsg-1+b2 bookworm "$place/root" "${MIRROR:-http://deb.debian.org/debian}" || exit 77
seen=$(chroot "$place/root" sh -euc '
    cd "$(mktemp -d)"
    gdal_create -q -of GTiff -outsize 20 20 -bands 1 -burn 400 -ot Float32 -a_srs EPSG:32613 \
        -a_ullr 500000 4400000 500600 4399400 land.tif
    gdal_translate -q -of BAG land.tif land.bag
    gdalinfo land.bag | grep -oE "AXIS\[.depth.,down|Description = elevation|Min=[0-9.]+ Max=[0-9.]+" | head -n 3') || exit 1
echo "$seen"
[ "$seen" = 'AXIS["depth",down
Description = elevation
Min=400.000 Max=400.000' ]
