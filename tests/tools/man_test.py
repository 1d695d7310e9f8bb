# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""man_test.py THALWEG: the pages of the manual are whole, and neither groff nor man(1) has anything to warn of."""
import os
import pathlib
import re
import subprocess
import tempfile

import spoken

with tempfile.TemporaryDirectory() as folder:
    spoken.say("man", "-o", folder)
    pages = {path.name: path for path in pathlib.Path(folder).glob("man[15]/*")}
    wanted = {"thalweg.1", "thalweg-recipe.5", *(f"thalweg-{command}.1" for command in spoken.commands())}
    assert set(pages) == wanted, set(pages) ^ wanted

    shown = {}
    environment = dict(os.environ, LC_ALL="C.UTF-8", MANWIDTH="80", MAN_KEEP_FORMATTING="", MANPAGER="cat")
    for name, path in pages.items():
        assert path.read_bytes().isascii(), name
        assert not re.search(r"\b20\d\d-\d\d", path.read_text()), f"{name}: a date"
        for program in (["groff", "-man", "-ww", "-Tutf8", "-z"], ["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z"]):
            done = subprocess.run([*program, path], env=environment, text=True, capture_output=True)
            assert done.returncode == 0 and done.stderr == "", f"{program[0]} {name}: {done.stderr}"
        text = subprocess.run(["groff", "-man", "-Tascii", "-P-c", path], check=True, text=True, capture_output=True).stdout
        shown[name] = re.sub(r".\x08", "", text)

for name, text in shown.items():
    headings = re.findall(r"^([A-Z][A-Z ]+)$", text, re.M)
    for heading in ("NAME", "DESCRIPTION", "SEE ALSO"):
        assert heading in headings, (name, headings)
    if name.endswith(".1"):
        for heading in ("SYNOPSIS", "OPTIONS", "EXIT STATUS", "ENVIRONMENT"):
            assert heading in headings, (name, headings)
        assert "NO_COLOR" in text and "TERM" in text and "130" in text, name

for command in spoken.commands():
    assert f"thalweg-{command}(1)" in shown["thalweg.1"], command
    tags = shown[f"thalweg-{command}.1"]
    for option in spoken.options(command):
        assert re.search(rf"^ +(-\w, )?(--[\w-]+, )*{option}\b", tags, re.M), (command, option)
for option in spoken.options():
    assert option in shown["thalweg.1"], option
for key in spoken.keys():
    assert re.search(rf"^ +{key.split('.')[-1]}\b", shown["thalweg-recipe.5"], re.M), key
assert "EXAMPLES" in shown["thalweg-make.1"] and "thalweg make samples/dla.toml" in shown["thalweg-make.1"]

# Every file of a real run is in the page.
with tempfile.TemporaryDirectory() as folder:
    spoken.say("make", "-q", "-o", f"{folder}/out", "--set", "grid.width=64", "--set", "grid.height=48", "--set",
               "network.dla.particles=400", "--set", "network.prune=4")
    for path in pathlib.Path(folder, "out").iterdir():
        known = path.name if path.suffix not in (".shx", ".dbf", ".prj", ".cpg") else path.stem + ".shp"
        assert known in shown["thalweg-make.1"], f"FILES of thalweg-make(1) lacks {path.name}"
assert spoken.say("man", "recipe.5") != spoken.say("man", "recipe")
print(f"{len(shown)} pages")
