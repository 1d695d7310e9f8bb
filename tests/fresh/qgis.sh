#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# qgis.sh, on a fresh machine, as root, with the .deb files in the folder `packages` above: installs the QGIS plugin with what it
# depends on, has QGIS make a terrain, and removes both packages without a trace.
set -eu
fail() {
    echo "qgis.sh: $*" >&2
    exit 1
}
clone=$(pwd)
packages=$HOME/packages
place=$(mktemp -d)
start=$(date +%s)
apt="env DEBIAN_FRONTEND=noninteractive apt-get -qq --yes --no-install-recommends -o Dpkg::Use-Pty=0"
$apt update
of_thalweg() { find / -xdev \( -path "$clone" -o -path "$packages" -o -path "$place" \) -prune -o -name '*thalweg*' -print; }
of_thalweg >"$place/names_before"
$apt install "$packages"/thalweg_*.deb "$packages"/qgis-plugin-thalweg_*.deb >"$place/said" 2>&1 || { cat "$place/said" >&2; exit 1; }
echo "qgis.sh: $(($(date +%s) - start)) s to install QGIS"

cd "$place"
mkdir -m 700 home run
export HOME="$place/home" XDG_RUNTIME_DIR="$place/run" QT_QPA_PLATFORM=offscreen
process=$(command -v qgis_process.bin || command -v qgis_process) # Debian 12 has a wrapper that always fails
"$process" plugins enable thalweg_processing >said 2>&1 || { cat said >&2; fail "QGIS does not find the plugin"; }
"$process" list 2>/dev/null | grep -q thalweg:make || fail "QGIS lists no thalweg:make"
"$process" run thalweg:make -- RIVERS="$clone/samples/coastal_nhdplus.gpkg" CELL=150 OUTPUT="$place/coast" >said 2>&1 ||
    { cat said >&2; fail "QGIS cannot make a terrain"; }
thalweg check coast
test -d /usr/share/qgis/python/plugins/thalweg_processing/__pycache__ || fail "the plugin was not compiled"

$apt purge qgis-plugin-thalweg thalweg >/dev/null
! dpkg-query -W '*thalweg*' 2>/dev/null || fail "packages are left"
of_thalweg | diff "$place/names_before" - >&2 || fail "files are left"
echo "qgis.sh: $(($(date +%s) - start)) s"
