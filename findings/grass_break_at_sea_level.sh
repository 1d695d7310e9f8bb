#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# GRASS 8.2.1 (Debian 12): v.clean tool=break puts confluences of 3-D rivers at height 0.
#
# Input: a river from 100 m to 20 m without a vertex in between, and a tributary that falls from 70 m to 60 m and ends on the
#   river where its height is 60 m too.
# Guess: the river is broken there, and the new vertex has its interpolated height, 60 m.
# Seen: both halves of the river have height 0 at the confluence; the tributary keeps 60. The map stays 3-D and nothing is said.
# Misleads whoever makes a network's nodes in GRASS and then takes slopes or profiles from its lines.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=grass-core=8.2.1-1 bookworm "$place/root" "${MIRROR:-http://deb.debian.org/debian}" || exit 77
cat > "$place/root/break.sh" <<'RIVERS'
v.in.ascii --quiet -z -n input=- output=rivers format=standard <<END
L 2 1
 0 100 100
 200 100 20
 1 1
L 2 1
 100 200 70
 100 100 60
 1 2
END
v.clean --quiet input=rivers output=broken tool=break type=line
v.info -t broken | grep map3d
v.out.ascii --quiet broken format=standard | sed 1,/VERTI/d | tr -s " " | sed "s/ $//"
RIVERS
seen=$(chroot "$place/root" grass --tmp-location XY --exec sh -eu /break.sh 2> "$place/said") || { cat "$place/said"; exit 1; }
echo "$seen"
[ "$seen" = 'map3d=1
L 2 1
 100 200 70
 100 100 60
 1 2
L 2 1
 0 100 100
 100 100 0
 1 1
L 2 1
 100 100 0
 200 100 20
 1 1' ]
