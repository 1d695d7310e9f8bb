#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# GDAL 3.6.2 (Debian 12): cells without data become 1.18e-38 in HF2 files, which declare something else or nothing.
#
# Input: a GeoTIFF of -9999 everywhere, declared as no-data, converted by `gdal_translate -of HF2`.
# Guess: the cells come back as no-data, or the format refuses them.
# Seen: each cell is 1.17549435e-38, the smallest normal float. Beside the file NAME.hf2.aux.xml declares -9999, which no cell
#   has; without that file nothing is declared. Statistics take holes for land at height 0.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=gdal-bin=3.6.2+dfsg-1+b2 bookworm "$place/root" "${MIRROR:-http://deb.debian.org/debian}" || exit 77
seen=$(chroot "$place/root" sh -euc '
    cd "$(mktemp -d)"
    gdal_create -q -of GTiff -outsize 20 20 -bands 1 -burn -9999 -ot Float32 -a_nodata -9999 -a_srs EPSG:32613 \
        -a_ullr 500000 4400000 500600 4399400 none.tif
    gdal_translate -q -of HF2 none.tif none.hf2
    gdallocationinfo -valonly none.hf2 3 3
    gdalinfo -mm none.hf2 | grep -E "NoData|Min/Max" | tr -s " "
    rm none.hf2.aux.xml
    echo "alone:"
    gdalinfo -mm none.hf2 | grep -E "NoData|Min/Max" | tr -s " "') || exit 1
echo "$seen"
[ "$seen" = "1.17549435082229e-38
 Computed Min/Max=0.000,0.000
 NoData Value=-9999
alone:
 Computed Min/Max=0.000,0.000" ]
