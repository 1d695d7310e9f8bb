# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/bench reads from benchmarks and counts, and what it says of them.
Usage: bench_test.py"""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("bench", str(ROOT / "scripts/bench"))
bench = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench", loader))
loader.exec_module(bench)


def benchmark(name, *runs, **more):
    return json.dumps({"benchmarks": [{"name": name, "run_type": kind, "cpu_time": time, "time_unit": unit, **more}
                                      for kind, time, unit in runs]})


class Reading(unittest.TestCase):
    def test_the_least_run_in_nanoseconds(self):
        text = benchmark("BM_x/1", ("iteration", 3.0, "ms"), ("iteration", 2.0, "ms"), ("aggregate", 1.0, "ms"), rounds=6.0)
        self.assertEqual(bench.parsed(text, "BM_x/1").ns, 2e6)
        self.assertEqual(bench.parsed(text, "BM_x/1").counters["rounds"], 6.0)

    def test_no_such_benchmark_or_an_error(self):
        with self.assertRaisesRegex(SystemExit, "BM_y: no such benchmark"):
            bench.parsed(benchmark("BM_x", ("iteration", 1.0, "ns")), "BM_y")
        with self.assertRaisesRegex(SystemExit, "BM_x: broken"):
            bench.parsed(benchmark("BM_x", ("iteration", 1.0, "ns"), error_occurred=True, error_message="broken"), "BM_x")

    def test_lines_of_other_programs(self):
        self.assertEqual({name: found.ns for name, found in bench.parsed_lines("a_fill/512 1500000\na_d8/512 20\n").items()},
                         {"a_fill/512": 1.5e6, "a_d8/512": 20.0})


class Table(unittest.TestCase):
    def test_slope(self):
        self.assertAlmostEqual(bench.slope([(10, 3 * 10**1.2), (100, 3 * 100**1.2), (1000, 3 * 1000**1.2)]), 1.2)

    def test_numbers(self):
        self.assertEqual([bench.number(x) for x in (0.0123, 0.98, 1.26, 34.4, 1234.0, 0.0)], ["0.012", "0.98", "1.3", "34", "1234", "0"])

    def test_a_row_for_each_yardstick(self):
        kernel = bench.Kernel("filling", "BM_fill/{}", (512, 1024), (("memcpy", "BM_memcpy/{}", (1024,)),))
        cells = 1024 * 1024
        by_size = {512: bench.Measured(10.0 * cells / 4), 1024: bench.Measured(10.0 * cells, 8 * cells, {"rounds": 5.0})}
        self.assertEqual(list(bench.rows(kernel, by_size, [("memcpy", 1024, bench.Measured(0.25 * cells))])),
                         ["| filling | 1024² | memcpy | 40 | 10.0, 2.00 a round | 8.00 | 1.00 |"])
        self.assertEqual(list(bench.rows(kernel, {512: by_size[512]}, [])), ["| filling | 512² |  |  | 10.0 | 0 |  |"])

    def test_every_benchmark_is_registered(self):
        """By its function: the sizes are found where scripts/test --full bench runs."""
        sources = "".join(file.read_text() for file in (ROOT / "bench").glob("*.cpp"))
        peers = "".join(file.read_text() for file in (ROOT / "bench/peers").glob("*.cpp"))
        for kernel in bench.KERNELS:
            for name in (kernel.benchmark, *(benchmark for _, benchmark, _ in kernel.yardsticks)):
                function = name.split("/")[0]
                wanted = rf"BENCHMARK(_CAPTURE)?\({function}\b" if name.startswith("BM_") else f'"{function}"'
                self.assertTrue(re.search(wanted, sources if name.startswith("BM_") else peers), name)


class Instructions(unittest.TestCase):
    golden = "# words\ntarget g++ 12 avx2\nfill 1000\ncarve 2000\n"

    def held(self, target="g++ 12 avx2", **counts):
        return bench.held(self.golden, target, counts)

    def test_within_five_percent(self):
        self.assertEqual(self.held(fill=1050, carve=1901), ([], True))

    def test_more_and_fewer(self):
        faults, compared = self.held(fill=1051, carve=1899)
        self.assertTrue(compared)
        self.assertEqual(len(faults), 2)
        self.assertRegex(faults[0], "^carve: 1899 instructions, 5.0 % fewer.*scripts/bench --instructions --renew")
        self.assertRegex(faults[1], "^fill: 1051 instructions, 5.1 % more.*scripts/bench --instructions --renew")

    def test_kernels_that_only_one_knows(self):
        faults, _ = self.held(fill=1000, thin=3)
        self.assertRegex(faults[0], "^carve: only in instructions.txt")
        self.assertRegex(faults[1], "^thin: only in bench/instructions.cpp")

    def test_another_compiler_or_processor(self):
        faults, compared = self.held("g++ 14 avx2", fill=9)
        self.assertFalse(compared)
        self.assertRegex(faults[0], "counted for g\\+\\+ 12 avx2, and this is g\\+\\+ 14 avx2")
        self.assertFalse(self.held("g++ 12 plain", fill=9)[1])

    def test_the_file_has_every_kernel(self):
        found, compared = bench.held(bench.COUNTS.read_text(), "g++ 12 avx2", {
            name: 1 for name in re.findall(r'(?m)^    \{"(\w+)",', (ROOT / "bench/instructions.cpp").read_text())})
        self.assertTrue(compared)
        self.assertEqual([fault for fault in found if "only in" in fault], [])


if __name__ == "__main__":
    unittest.main()
