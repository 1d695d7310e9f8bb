# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""QGIS plugin that runs the program thalweg from the Processing toolbox."""
from __future__ import annotations

from typing import Any


def classFactory(iface: Any) -> Any:
    """Return the plugin; QGIS calls this with its interface, or with None where it has no window."""
    from .plugin import Plugin

    return Plugin()
