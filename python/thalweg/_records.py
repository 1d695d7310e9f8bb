# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of the library: what pickle needs."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Hashable
from typing import Any, cast


def reduced(record: Any) -> tuple[Any, ...]:
    """Return how pickle makes a record again: from its fields.

    Raises
    ------
    TypeError
        For a record that only the library makes.
    """
    kind: Any = type(record)
    if not set(kind._fields) <= _parameters(cast(Hashable, kind)):
        raise TypeError(f"{kind.__name__} cannot be pickled, as only the library makes one: keep the parts that you need")
    return _restored, (kind, {name: getattr(record, name) for name in kind._fields})


@functools.cache
def _parameters(kind: Hashable) -> set[str]:
    try:
        return set(inspect.signature(cast(type, kind)).parameters)
    except ValueError:
        return set()


def _restored(kind: Any, fields: dict[str, Any]) -> Any:
    return kind(**fields)
