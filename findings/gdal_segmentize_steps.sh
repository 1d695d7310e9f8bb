#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# GDAL 3.6.2 (Debian 12): ogr2ogr -segmentize gives each new vertex the height of the segment's eastern end.
#
# Input: two rivers with heights and measures, each of one segment 90 m long that falls from 100 m to 10 m: one flows east,
#   one west.
# Guess: heights and measures of the new vertices are interpolated along the segment, as x and y are; or they are dropped.
# Seen: new vertices have the height and the measure of the segment's eastern end (northern, if it runs due north or south).
#   The first river falls 90 m to its first new vertex and is level below it, the second is level and falls at its end.
# Misleads whoever makes vertices denser before computing slopes or draping, and whoever locates events by measure.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=gdal-bin=3.6.2+dfsg-1+b2 bookworm "$place/root" "${MIRROR:-http://deb.debian.org/debian}" || exit 77
seen=$(chroot "$place/root" sh -euc '
    cd "$(mktemp -d)"
    cat > river.csv <<END
id,WKT
1,"LINESTRING ZM (0 0 100 0, 90 0 10 90)"
2,"LINESTRING ZM (90 0 100 0, 0 0 10 90)"
END
    ogr2ogr -q -f CSV -lco GEOMETRY=AS_WKT -select id -segmentize 30 /vsistdout/ river.csv | grep -o "LINE[^)]*"') || exit 1
echo "$seen"
[ "$seen" = 'LINESTRING ZM (0 0 100 0,30 0 10 90,60 0 10 90,90 0 10 90
LINESTRING ZM (90 0 100 0,60 0 100 0,30 0 100 0,0 0 10 90' ]
