#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# deb.sh, on a fresh machine with a .deb in the folder above: installs it, makes a terrain, finds its manual.
set -eu
start=$(date +%s)
apt-get -qq update
DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 install --yes --no-install-recommends "$(ls "$HOME"/thalweg_*.deb)" >/dev/null
cd "$HOME"
thalweg make -o made
echo "deb.sh: $(($(date +%s) - start)) s to install the package and make a terrain"
for file in report.html map.png dem.tif network.gpkg; do
    test -s "made/$file" || { echo "deb.sh: made/$file is missing" >&2; exit 1; }
done
thalweg check made
dpkg-query -L thalweg | grep -q '/man1/thalweg.1.gz$' || { echo "deb.sh: no manual page" >&2; exit 1; }
! command -v g++ >/dev/null || { echo "deb.sh: the package brings a compiler" >&2; exit 1; }
