# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What thalweg says of itself: its commands and their options, read from --help, and the keys of a recipe."""
import re
import subprocess
import sys

thalweg = sys.argv[1]


def say(*words):
    return subprocess.run([thalweg, *words], check=True, capture_output=True, text=True).stdout


def part(text, name):
    """The lines below a heading of --help."""
    found = re.search(rf"^{name}:\n((?:  .*\n)*)", text, re.M)
    return found[1] if found else ""


def commands():
    names = re.findall(r"^  (\S+)", re.sub(r"^   .*\n", "", part(say("--help"), "Commands"), flags=re.M), re.M)
    assert len(names) >= 8, names
    return names


def options(*command):
    """-o, --output, ... of a command, or of thalweg itself."""
    names = re.findall(r"(?:^  (?:    )?|(?<=\w), )(--?[\w-]+)", part(say(*command, "--help"), "Options"), re.M)
    assert "--help" in names, names
    return names


def keys():
    section, found = "", []
    for line in say("recipe").splitlines():
        if head := re.match(r"\[+([^]]*)\]+$", line):
            section = head[1] + "."
        elif key := re.match(r"(\w+)", line):
            found.append(section + key[1])
    assert "network.dla.sticking" in found and len(found) > 25, found
    return found
