# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names for the keys of a recipe: each belongs to a group, after which its parameter is labelled."""
from __future__ import annotations

import re

# Groups, as the parameters follow one another: those for rivers of a layer come first.
GROUPS = (
    ("Rivers of a layer", r"network\.lines\."),
    ("Rivers", r"network\.[a-z_]+$"),
    ("Terrain", r"surface\.(method|source|relief|mask|mean_slope|hillslope|debris_area|floor_width|roughness|longest_wave|grain|"
                r"strike|edge|region|uplift|uplift_[a-z]+|erodibility|lakes|lake_share|like|drain|max_cut)$"),
    ("Ridges and points", r"skeleton\."),
    ("Detail", r"detail\."),
    ("Patch", r"patch\."),
    ("Grid", r"grid\."),
    ("Output", r"output\."),
    ("Grown rivers, DLA", r"network\.dla\."),
    ("Grown rivers, Tokunaga", r"network\.tokunaga\."),
    ("Grown rivers, forest", r"network\.forest\."),
    ("Dilated terrain", r"surface\.(base|increment|metric|allow_negative)$"),
    ("Diffused terrain", r"surface\.(tolerance|diffusion|sweeps|start|alpha|smoothing|noise)$"),
    ("Terrain of points", r"surface\.(interpolation|frequency_[xy]|slope_mode|eighth_term)$"),
    ("Terrain of statistics", r"statistics\."),
)
LABELS = {"seed": "Random seed", "grid.cell": "Cell size", "grid.crs": "CRS of the terrain", "output.units": "Unit of heights",
          "output.title": "Title"}  # of keys outside the groups


def group_of(key: str) -> int:
    """Return the number of a key's group; that after the last one where it has none."""
    return next((number for number, (_, pattern) in enumerate(GROUPS) if re.match(pattern, key)), len(GROUPS))


def label_of(key: str) -> str:
    """Return the label of a key's parameter, without its unit."""
    if key in LABELS:
        return LABELS[key]
    section, _, last = key.rpartition(".")
    group = group_of(key)
    return f"{GROUPS[group][0] if group < len(GROUPS) else section}: {last.replace('_', ' ')}"
