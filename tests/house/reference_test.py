# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the library's reference in a folder of its own. Fails on any warning of Doxygen, and on a function with a
comment that does not say what each parameter is and what is returned: Doxygen 1.9 overlooks functions without any tag.
Usage: reference_test.py DOXYGEN DOXYFILE"""
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml


def faults_of(member):
    """What a function's comment leaves out."""
    about = member.find("detaileddescription")
    if not any("".join(member.find(part).itertext()).strip() for part in ("briefdescription", "detaileddescription")):
        return
    told = {"".join(name.itertext()) for name in about.iter("parametername")}
    for param in member.findall("param"):
        name = param.findtext("declname")
        if name and name not in told:
            yield f"\\param {name} is missing"
    result = "".join(member.find("type").itertext())
    words = [w for w in result.split() if w not in ("inline", "constexpr", "static", "virtual", "explicit")]
    if words not in ([], ["void"]) and about.find(".//simplesect[@kind='return']") is None:
        yield "\\return is missing"


def faults(folder):
    functions = 0
    for path in sorted(pathlib.Path(folder, "xml").glob("*.xml")):
        for member in xml.parse(path).getroot().iter("memberdef"):
            if member.get("kind") != "function" or member.get("prot") == "private":
                continue
            functions += 1
            where = member.find("location")
            for words in faults_of(member):
                yield f"{where.get('file')}:{where.get('line')}: {member.findtext('name')}: {words}"
    if functions < 300:
        yield f"only {functions} functions were found"


doxygen, doxyfile = sys.argv[1:3]
with tempfile.TemporaryDirectory() as folder:
    config = (pathlib.Path(doxyfile).read_text(encoding="utf-8")
              + f"OUTPUT_DIRECTORY = {folder}\nGENERATE_XML = YES\nXML_PROGRAMLISTING = NO\nWARN_AS_ERROR = NO\n")
    ran = subprocess.run([doxygen, "-"], input=config, text=True, capture_output=True, cwd=folder,
                         env={**os.environ, "BIBINPUTS": ".", "BSTINPUTS": "."})
    found = (ran.stdout + ran.stderr).splitlines() + sorted(set(faults(folder)))
print("\n".join(found) if found else "every function says what it takes and gives")
sys.exit(1 if found or ran.returncode else 0)
