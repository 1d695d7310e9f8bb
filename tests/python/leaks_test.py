# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A thousand makes, views of their rasters, and as many refused calls leave neither memory nor open files."""
import gc
import os
import pathlib
import resource
import subprocess
import sys
import unittest

import numpy as np

import thalweg


def resident_bytes():
    return int(pathlib.Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * resource.getpagesize()


def use(seed):
    made = thalweg.make({"grid": {"width": 64, "height": 64}}, seed=seed, threads=1, log=lambda line: None)
    dem = np.asarray(made.dem)
    routed = thalweg.flow.route(dem)
    assert routed.area_cells.values.max() > 0
    try:
        thalweg.surface.diffuse(dem, sigma_cells=-1)
    except thalweg.BadParameter:
        pass


class Leaks(unittest.TestCase):
    def test_a_thousand_makes_leave_nothing(self):
        for seed in range(50):
            use(seed)
        gc.collect()
        memory, files = resident_bytes(), len(os.listdir("/proc/self/fd"))
        for seed in range(1000):
            use(seed)
        gc.collect()
        grown = resident_bytes() - memory
        print(f"{grown / 2**20:.1f} MiB more after 1000 makes")
        self.assertLess(grown, 8 << 20)
        self.assertEqual(len(os.listdir("/proc/self/fd")), files)


class Ending(unittest.TestCase):
    def test_the_interpreter_may_end_while_a_thread_works(self):
        for seconds in (0.1, 0.3, 0.5):
            ended = subprocess.run([sys.executable, "-c", f"""
import threading, time, thalweg
def work():
    try:
        thalweg.make({{"grid": {{"width": 512, "height": 512}}}}, log=lambda line: None)
    except thalweg.Cancelled:
        pass
threading.Thread(target=work, daemon=True).start()
time.sleep({seconds})
"""], capture_output=True, text=True, timeout=300)
            self.assertEqual(ended.returncode, 0, ended.stderr)


if __name__ == "__main__":
    unittest.main()
