#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# deb.sh, on a fresh machine, as root, with the .deb files in the folder `packages` above: installs them, uses each, and
# removes them without a trace.
set -eu
fail() {
    echo "deb.sh: $*" >&2
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

$apt install "$packages"/thalweg_*.deb >/dev/null
! command -v g++ >/dev/null || fail "the program's package brings a compiler"
! command -v python3 >/dev/null || fail "the program's package brings Python"
cd "$place"
thalweg make -o made
echo "deb.sh: $(($(date +%s) - start)) s to install the program and make a terrain"
for file in report.html map.png dem.tif network.gpkg; do
    test -s "made/$file" || fail "made/$file is missing"
done
thalweg check made
dpkg-query -L thalweg | grep -q '/man1/thalweg.1.gz$' || fail "no manual page"

# The library, by CMake and by pkg-config; apt takes what libthalweg-dev itself does not depend on.
$apt install "$packages"/libthalweg-dev_*.deb $("$clone/scripts/packages" --list compiler) >/dev/null
cmake -G Ninja -S "$clone/tests/house/consumer" -B built -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build built >/dev/null
g++ -std=c++20 -O1 "$clone/tests/house/consumer/main.cpp" -o linked $(pkg-config --cflags --libs thalweg)
g++ -std=c++20 -O1 "$clone/tests/house/consumer/main.cpp" -o linked_static $(pkg-config --static --cflags --libs thalweg)
for program in built/consumer ./linked ./linked_static; do
    test "$($program)" = 1.2 || fail "$program says something else than 1.2"
done

$apt install "$packages"/python3-thalweg_*.deb >/dev/null
shape=$(cd / && python3 -c "import thalweg; print(thalweg.make({'grid': {'width': 256, 'height': 256}}).dem.shape)")
test "$shape" = "(256, 256)" || fail "the module made $shape"

$apt install "$packages"/thalweg-doc_*.deb >/dev/null
doc=/usr/share/doc/thalweg-doc
thalweg make "$doc/samples/lines.toml" -o lines
# Links of a page to another, to a picture or to a sample.
find "$doc" -name '*.md' | while read -r page; do
    grep -o '][(][^)#: ][^)#: ]*[)#]' "$page" | sed 's/^..//; s/.$//' | while read -r link; do
        test -e "$(dirname "$page")/$link" || echo "$page: $link"
    done
done >broken
test ! -s broken || fail "links without a target: $(cat broken)"

$apt purge thalweg libthalweg-dev python3-thalweg thalweg-doc >/dev/null
! dpkg-query -W '*thalweg*' 2>/dev/null || fail "packages are left"
of_thalweg | diff "$place/names_before" - >&2 || fail "files are left"
echo "deb.sh: $(($(date +%s) - start)) s"
