#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# GDAL 3.6.2 (Debian 12): looking at an INSPIRE GML once, read-only, hides the directions of its rivers from then on.
#
# Input: one WatercourseLink whose flowDirection is a reference (xlink:href), as INSPIRE's schema has it.
# Guess: `ogrinfo -ro` leaves nothing behind, and the open option GML_ATTRIBUTES_TO_OGR_FIELDS=YES shows references whenever
#   it is given.
# Seen: `ogrinfo -ro` writes a .gfs beside the file. With it the option does nothing and says nothing: flowDirection_href is
#   a field before, and none after.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=gdal-bin=3.6.2+dfsg-1+b2 bookworm "$place/root" "${MIRROR:-http://deb.debian.org/debian}" || exit 77
seen=$(chroot "$place/root" sh -euc '
    cd "$(mktemp -d)"
    cat > links.gml <<END
<?xml version="1.0" encoding="UTF-8"?>
<wfs:FeatureCollection xmlns:wfs="http://www.opengis.net/wfs/2.0" xmlns:gml="http://www.opengis.net/gml/3.2"
    xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:hy="http://inspire.ec.europa.eu/schemas/hy-n/4.0">
  <wfs:member><hy:WatercourseLink gml:id="a1">
    <hy:centrelineGeometry><gml:LineString srsName="EPSG:25832" gml:id="g1">
      <gml:posList>500000 5200000 500100 5200000</gml:posList></gml:LineString></hy:centrelineGeometry>
    <hy:flowDirection xlink:href="http://inspire.ec.europa.eu/codelist/LinkDirectionValue/inOppositeDirection"/>
  </hy:WatercourseLink></wfs:member>
</wfs:FeatureCollection>
END
    fields() { ogrinfo -ro -al -q -oo GML_ATTRIBUTES_TO_OGR_FIELDS=YES links.gml | grep -c flowDirection_href || true; }
    echo "before: $(fields)"
    rm links.gfs
    ogrinfo -ro -q links.gml > /dev/null
    ls
    echo "after: $(fields)"') || exit 1
echo "$seen"
[ "$seen" = "before: 1
links.gfs
links.gml
after: 0" ]
