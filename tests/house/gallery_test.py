#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/gallery --check names a picture of another terrain. Usage: gallery_test.py THALWEG"""
import contextlib
import importlib.machinery
import io
import pathlib
import re
import sys
import tempfile
import types
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]


def gallery():
    """scripts/gallery as a module."""
    loader = importlib.machinery.SourceFileLoader("gallery", str(ROOT / "scripts/gallery"))
    module = types.ModuleType("gallery")
    module.__file__ = loader.path
    loader.exec_module(module)
    return module


class Gallery(unittest.TestCase):
    program = None

    def test_a_picture_of_another_terrain_is_named(self):
        module = gallery()
        with tempfile.TemporaryDirectory() as place, contextlib.redirect_stdout(io.StringIO()) as said:
            module.TERRAIN = pathlib.Path(place) / "terrain.txt"
            of_all = (ROOT / "docs/gallery/README.md").read_text(encoding="utf-8")  # it quotes the terrains of presets
            words = ["gallery", "--check", "wireframe", "--program", self.program]
            with mock.patch.object(module, "readme", return_value=of_all), mock.patch("sys.argv", words):
                self.assertEqual(module.main(), 1)  # it has no line
                made = re.search(r"not recorded\n  (\w{16}  \d+ arcs to order \d+, \d+ to \d+ m)\n", said.getvalue())[1]
                module.write_terrains({"wireframe": made})
                self.assertEqual(module.main(), 0)
                module.write_terrains({"wireframe": ("1" if made[0] == "0" else "0") + made[1:]})
                self.assertEqual(module.main(), 1)
        self.assertEqual(said.getvalue().count("scripts/gallery wireframe\n"), 2)

    def test_terrains_are_kept_in_the_order_of_the_pictures(self):
        module = gallery()
        self.assertEqual(module.stale({"a": "1", "c": "3"}, {"a": "1", "b": "2", "c": "4"}), ["b", "c"])
        with tempfile.TemporaryDirectory() as place:
            module.TERRAIN = pathlib.Path(place) / "terrain.txt"
            module.write_terrains({"qgis": "b  2", "gone": "c", "island": "a  1"})
            self.assertEqual(list(module.read_terrains().items()), [("island", "a  1"), ("qgis", "b  2")])


if __name__ == "__main__":
    Gallery.program = sys.argv.pop(1)
    unittest.main()
