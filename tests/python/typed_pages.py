# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""typed_pages.py MYPY-ARGUMENT...: mypy, with these arguments, finds nothing in the Python of README.md and in the first two cells
of every notebook, whose own functions need no types."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def programs():
    """By name: the Python of a page."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    yield "readme", "\n".join(re.findall(r"^```python\n(.*?)^```", readme, re.S | re.M))
    for path in sorted((ROOT / "docs/notebooks").glob("*.ipynb")):
        cells = [c for c in json.loads(path.read_text(encoding="utf-8"))["cells"] if c["cell_type"] == "code"]
        yield f"notebook_{path.stem}", "\n".join("".join(cell["source"]) for cell in cells[:2])


with tempfile.TemporaryDirectory() as place:
    names = []
    for name, text in programs():
        assert "thalweg" in text, name
        names.append(f"{place}/{name}.py")
        pathlib.Path(names[-1]).write_text(text + "\n", encoding="utf-8")
    assert len(names) > 5
    sys.exit(subprocess.run([sys.executable, "-m", "mypy", "--allow-untyped-defs", "--allow-untyped-calls", *sys.argv[1:], *names], check=False).returncode)
