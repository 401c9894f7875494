"""The factory's own types as plain arrays, and back: a cache whose files need no trust.

A value becomes one JSON text, beside the arrays that it holds. Values are rebuilt by the types'
own constructors, so that a damaged file ends in an error here and not in an asset.
"""

from __future__ import annotations

import dataclasses
import json
import types
from collections.abc import Mapping
from enum import Enum
from functools import cache
from types import MappingProxyType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
import numpy.typing as npt

T = TypeVar("T")
Arrays = dict[str, npt.NDArray[Any]]

TEXT = "text"


def pack(value: object) -> Arrays:
    """Return as arrays: dataclasses, tuples, mappings, sets, arrays, numbers, texts, None."""
    arrays: Arrays = {}
    tree = _flat(value, arrays)
    return {**arrays, TEXT: np.array(json.dumps(tree))}


def contents(value: object) -> list[str | npt.NDArray[Any]]:
    """Return all that a value holds, in a fixed order, for a key; values as for :func:`pack`."""
    arrays = pack(value)
    return [item for name in sorted(arrays) for item in (name, arrays[name])]


def unpack(kind: type[T], arrays: Mapping[str, npt.NDArray[Any]]) -> T:
    """Return the inverse of :func:`pack` for a value of type ``kind``.

    Raises:
        ValueError: no such value was packed here.
    """
    return from_json(kind, json.loads(str(arrays.get(TEXT, ""))), arrays)


def from_json(
    kind: type[T], data: Any, arrays: Mapping[str, npt.NDArray[Any]] = MappingProxyType({})
) -> T:
    """Return a value of that type from its JSON data, and the arrays that this names.

    Raises:
        ValueError: it says something else; names the first field that is missing or too much.
    """
    try:
        value: T = _built(kind, data, arrays)
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"no {kind.__name__}: {type(error).__name__}: {error}") from error
    return value


def _flat(value: Any, arrays: Arrays) -> Any:
    if isinstance(value, np.ndarray):
        name = f"array_{len(arrays)}"
        arrays[name] = value
        return name
    if dataclasses.is_dataclass(value):
        return {
            field.name: _flat(getattr(value, field.name), arrays)
            for field in dataclasses.fields(value)
        }
    if isinstance(value, Mapping):
        return {str(name): _flat(item, arrays) for name, item in value.items()}
    if isinstance(value, frozenset | set):
        return [_flat(item, arrays) for item in sorted(value)]
    if isinstance(value, tuple | list):
        return [_flat(item, arrays) for item in value]
    return value.value if isinstance(value, Enum) else value


def _built(kind: Any, data: Any, arrays: Mapping[str, npt.NDArray[Any]]) -> Any:
    origin = get_origin(kind) or kind
    arguments = get_args(kind)
    if origin is np.ndarray:
        return arrays[data]
    if origin in (Union, types.UnionType):
        (one,) = (option for option in arguments if option is not type(None))
        return None if data is None else _built(one, data, arrays)
    if isinstance(origin, type) and dataclasses.is_dataclass(origin):
        hints = _hints(origin)
        return origin(**{name: _built(hints[name], item, arrays) for name, item in data.items()})
    if origin in (tuple, frozenset):
        kinds = (
            arguments
            if origin is tuple and arguments[-1] is not Ellipsis
            else (arguments[0],) * len(data)
        )
        return origin(
            _built(item_kind, item, arrays) for item_kind, item in zip(kinds, data, strict=True)
        )
    if isinstance(origin, type) and issubclass(origin, Mapping) and arguments:
        return {name: _built(arguments[1], item, arrays) for name, item in data.items()}
    return origin(data) if isinstance(origin, type) and issubclass(origin, Enum) else data


@cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)
