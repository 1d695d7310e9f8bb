#!/bin/sh
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# QGIS 3.40.6 (Debian 13): a mesh style without the names of its dataset groups is loaded "with success" and without its colours.
#
# Input: a mesh of two triangles in a .2dm file and a .qml with three colours for dataset group 0, as QGIS 3.22 reads it: its
#   scalar-settings name the group by its number.
# Guess: loadNamedStyle returns success and the layer has the three colours, as in QGIS 3.22.
# Seen: success, the width of the edges of the .qml, and the default ramp of 52 colours. With one more element, which names
#   the group as the driver does (name-to-global-index, "Bed Elevation"), the three colours are there, also where QGIS finds
#   the .qml by itself.
# Misleads whoever ships styles for meshes, made by hand or saved by an older QGIS: neither a message nor the return value
#   tells that they are not applied.
# Needs root, mmdebstrap and a Debian mirror ($MIRROR). Exit status: 0 seen again, 1 changed, 77 not to be had.
set -eu
place=$(mktemp -d)
trap 'rm -rf --one-file-system "$place"' EXIT
mmdebstrap --quiet --variant=apt --include=python3-qgis=3.40.6+dfsg-1 trixie "$place/root" \
    "${MIRROR:-http://deb.debian.org/debian}" || exit 77
cat >"$place/root/style.py" <<'PY'
import os
import pathlib
os.environ["QT_QPA_PLATFORM"] = "offscreen"
from qgis.core import QgsApplication, QgsMeshLayer
application = QgsApplication([], False)
application.initQgis()
here = pathlib.Path("/here")
here.mkdir()
(here / "mesh.2dm").write_text("MESH2D\nE3T 1 1 2 3 1\nE3T 2 2 4 3 1\nND 1 0 0 10\nND 2 9 0 20\nND 3 0 9 30\nND 4 9 9 40\n")
ramp = "".join(f'<item value="{z}" color="#00{z:02}00" alpha="255" label="{z}"/>' for z in (10, 25, 40))
style = ('<qgis version="3.22.0" styleCategories="AllStyleCategories"><mesh-renderer-settings>'
         '<active-dataset-group scalar="0" vector="-1"/><scalar-settings group="0" min-val="10" max-val="40" opacity="1" '
         f'interpolation-method="none"><colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" '
         f'minimumValue="10" maximumValue="40">{ramp}</colorrampshader></scalar-settings>'
         '<mesh-settings-native enabled="1" color="1,2,3,255" line-width="0.7" line-width-unit="MM"/>'
         '</mesh-renderer-settings>NAMES</qgis>')
for case, names in (("unnamed", ""), ("named", '<name-to-global-index name="Bed Elevation" global-index="0"/>')):
    file = here / f"{case}.qml"
    file.write_text(style.replace("NAMES", names))
    layer = QgsMeshLayer(str(here / "mesh.2dm"), case, "mdal")
    _, loaded = layer.loadNamedStyle(str(file))
    settings = layer.rendererSettings()
    print(case, loaded, settings.nativeMeshSettings().lineWidth(), len(settings.scalarSettings(0).colorRampShader().colorRampItemList()))
PY
seen=$(chroot "$place/root" python3 /style.py 2>/dev/null) || exit 1
echo "$seen"
[ "$seen" = 'unnamed True 0.7 52
named True 0.7 3' ]
