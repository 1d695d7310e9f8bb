#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""notebooks.py [--write] [NOTEBOOK ...]: executes docs/notebooks (or those named) in their folder, and compares the text that
each cell prints with the text that is stored. Exits with 1 when a cell fails or a text differs. --write stores the outputs
anew instead, figures with at most 256 colours; THALWEG_RENEW=1 does so where a text differs."""
import argparse
import base64
import io
import os
import pathlib
import re
import sys
import tempfile
import time

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "docs/notebooks"
COLOUR = re.compile("\x1b\\[[0-9;]*m")  # of a terminal
PLACE = re.compile(r"^/\S*/ipykernel_\d+/\d+\.py:\d+: ", re.M)  # of a warning: a folder and a process of the run


def text_of(cell):
    """What a cell printed and returned, without figures and empty lines: where printed text is cut into pieces is chance."""
    texts = []
    for output in cell.get("outputs", []):
        if output.output_type == "stream":
            texts.append(output.text)
        elif "image/png" not in output.get("data", {}):
            texts.append("\n" + output.get("data", {}).get("text/plain", "") + "\n")
    return "\n".join(line.rstrip() for line in "".join(texts).splitlines() if line.strip())


def small(figure):
    """A PNG with a palette, in base64."""
    from PIL import Image

    out = io.BytesIO()
    picture = Image.open(io.BytesIO(base64.b64decode(figure))).convert("RGB")
    picture.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(out, "png", optimize=True)
    return base64.b64encode(out.getvalue()).decode()


def stored_form(notebook):
    """Drops what differs from run to run, and shrinks figures."""
    notebook.metadata = {"kernelspec": notebook.metadata.kernelspec, "language_info": {"name": "python"}}
    for cell in notebook.cells:
        cell.metadata = {}
        for output in cell.get("outputs", []):
            if "image/png" in output.get("data", {}):
                output.data = {"image/png": small(output.data["image/png"])}
    return notebook


def run(path, write):
    """Executes a notebook; returns its faults."""
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    stored = [text_of(cell) for cell in notebook.cells]
    start = time.monotonic()
    try:
        nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", record_timing=False,
                                resources={"metadata": {"path": str(path.parent)}}).execute()
    except nbclient.exceptions.CellExecutionError as fault:
        return [f"{path.name}: {COLOUR.sub('', str(fault))}"]
    for output in (output for cell in notebook.cells for output in cell.get("outputs", []) if output.output_type == "stream"):
        output.text = PLACE.sub("", output.text)
    print(f"{path.name:24} {time.monotonic() - start:5.1f} s", flush=True)
    faults = [f"{path.name}, cell {number}: stored\n{before}\nnow\n{after}" for number, (before, after)
              in enumerate(zip(stored, map(text_of, notebook.cells)), 1) if before != after]
    if write or (faults and os.environ.get("THALWEG_RENEW") == "1"):
        nbformat.write(stored_form(notebook), path)
        return []
    return faults


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("notebooks", nargs="*", type=pathlib.Path)
    words.add_argument("--write", action="store_true", help="store the outputs anew")
    given = words.parse_args()
    with tempfile.TemporaryDirectory(prefix="thalweg-notebooks-") as place:
        # What Jupyter, IPython, Matplotlib and the notebooks write stays here.
        os.environ |= {name: place for name in ("TMPDIR", "IPYTHONDIR", "JUPYTER_RUNTIME_DIR", "MPLCONFIGDIR")}
        os.environ |= {"PYDEVD_DISABLE_FILE_VALIDATION": "1", "PYTHONDONTWRITEBYTECODE": "1"}
        tempfile.tempdir = None
        start = time.monotonic()
        faults = [fault for path in given.notebooks or sorted(FOLDER.glob("*.ipynb")) for fault in run(path.resolve(), given.write)]
        print(f"{'together':24} {time.monotonic() - start:5.1f} s")
    print(*faults, sep="\n\n", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
