# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""make() writes the bytes of `thalweg make`, in every file but report.*, which hold times.
Usage: same_bytes_test.py PROGRAM SAMPLES [NAME ...]: NAME a file of SAMPLES; without one, all recipes and rivers there."""
import pathlib
import subprocess
import sys
import tempfile

import thalweg

program, samples, *names = sys.argv[1:]
chosen = [pathlib.Path(samples) / name for name in names] or [
    *sorted(pathlib.Path(samples).glob("*.toml")), *sorted(pathlib.Path(samples).glob("*nhdplus.gpkg"))]
differ = []
for path in chosen:
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "make", path, "-o", f"{folder}/program", "-q"], check=False)  # 1 where a check fails
        thalweg.make(path, output=f"{folder}/python")
        by_program, by_python = (
            {p.relative_to(f"{folder}/{who}").as_posix(): p.read_bytes() for p in pathlib.Path(folder, who).rglob("*") if p.is_file()}
            for who in ("program", "python"))
        wrong = sorted(name for name in by_program.keys() | by_python.keys()
                       if not name.startswith("report.") and by_program.get(name) != by_python.get(name))
        print(f"{path.name}: {len(by_program)} files, {len(wrong)} differ", flush=True)
        if wrong or len(by_program) < 5:
            differ.append(f"{path.name}: {', '.join(wrong)}")
if differ or not chosen:
    sys.exit("\n".join(differ) or f"no samples in {samples}")
