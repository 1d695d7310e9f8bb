# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every C++ file is as clang-format writes it. Usage: format_test.py CLANG_FORMAT"""
import pathlib
import subprocess
import sys

import rules

root = pathlib.Path(__file__).resolve().parents[2]
sources = [root / name for name in rules.files_of(root) if name.endswith((".cpp", ".hpp"))]
done = subprocess.run([sys.argv[1], "--dry-run", "-Werror", *sources])
if done.returncode != 0:
    sys.exit("mend it with: git ls-files '*.cpp' '*.hpp' | xargs clang-format-16 -i")
print(f"{len(sources)} files are formatted")
