# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the QGIS plugin for "Install from ZIP", for scripts/package. The same sources and SOURCE_DATE_EPOCH give the same
bytes. Usage: pack.py OUTPUT_DIR; prints the name of the file."""
import calendar
import os
import pathlib
import re
import sys
import time
import zipfile

import manual

ROOT = pathlib.Path(__file__).resolve().parents[1]
NAME = "thalweg_processing"

version = re.search(r"^project\(thalweg VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text("utf-8"), re.MULTILINE)[1]
files = {path.relative_to(ROOT / "qgis").as_posix(): path.read_bytes() for path in (ROOT / "qgis" / NAME).rglob("*")
         if path.is_file() and path.suffix in (".py", ".svg", ".txt")}
files[f"{NAME}/metadata.txt"] = files[f"{NAME}/metadata.txt"].replace(b"@PROJECT_VERSION@", version.encode())
files[f"{NAME}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
files.update({f"{NAME}/help/{name}": content for name, content in manual.files().items()})
first = calendar.timegm((1980, 1, 1, 0, 0, 0))  # a ZIP knows no earlier time
when = time.gmtime(max(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), first))[:6]
output = pathlib.Path(sys.argv[1]).resolve() / f"thalweg-qgis-{version}.zip"
with zipfile.ZipFile(output, "w") as packed:
    for name in sorted(files):
        entry = zipfile.ZipInfo(name, when)
        entry.create_system = 3  # UNIX, whose modes these are
        entry.external_attr = 0o100644 << 16
        packed.writestr(entry, files[name], zipfile.ZIP_DEFLATED, 9)
print(output)
