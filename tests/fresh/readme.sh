#!/bin/bash
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# readme.sh, after scripts/demo: the other commands of README.md, with what the demo installed and nothing else.
# As run_docs.py, but without Python: a command is a line that begins with "$ " in a block marked sh, and exits with 0 or
# with N where its line ends in "# exit N". What builds and installs runs here, with a home of its own to install into.
set -u
source=$(pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir "$place/.bin"
ln -s "$source/build/release/bin/thalweg" "$place/.bin/thalweg"
cp -R samples "$place"
export PATH="$place/.bin:$PATH"
run=0 failed=0
while IFS= read -r line; do
    line=${line#build/release/bin/}
    folder=$place home=${HOME-}
    case $line in
    thalweg\ studio*) line="timeout --foreground --preserve-status -s INT 5 $line --no-browser" ;; # it serves until it is interrupted
    scripts/packages\ * | cmake\ --preset\ * | cmake\ --build\ *) folder=$source ;;
    cmake\ --install\ *) folder=$source home=$place ;;
    scripts/* | ./* | cmake\ * | git\ * | cd\ * | ctest\ * | build/*) continue ;;
    esac
    wanted=$(sed -n 's/.*# exit \([0-9]*\) *$/\1/p' <<<"$line")
    code=0
    said=$(cd "$folder" && HOME=$home bash -c "$line" 2>&1 </dev/null) || code=$?
    run=$((run + 1))
    if [ "$code" -ne "${wanted:-0}" ]; then
        failed=$((failed + 1))
        printf 'README.md: %s\nexit %s, wanted %s\n%s\n' "$line" "$code" "${wanted:-0}" "$said"
    fi
done < <(sed -n '/^```sh$/,/^```$/s/^\$ //p' README.md)
# What README.md installs works.
"$place/.local/bin/thalweg" --version || failed=$((failed + 1))
echo "readme.sh: $run commands run, $failed failed"
[ "$run" -gt 0 ] && [ "$failed" -eq 0 ]
