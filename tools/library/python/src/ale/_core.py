"""The shared library by ctypes. Records, capacities and settings are as it describes them itself: nothing is said twice."""
from __future__ import annotations

import ctypes
import json
import os
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import AleError

Records = NDArray[np.record]  # one-dimensional, fields as described


def _load() -> ctypes.CDLL:
    folder = pathlib.Path(os.environ.get("ALE_CORE", pathlib.Path(__file__).parent))
    path = folder / "ale_core.so"
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise ImportError(f"{error}; `pip install` this package, or name the folder of ale_core.so in ALE_CORE") from error


library = _load()
library.ale_binding_describe.restype = ctypes.c_char_p
library.ale_binding_error.restype = ctypes.c_char_p
library.ale_binding_extractor_new.restype = ctypes.c_void_p
library.ale_binding_tracker_new.restype = ctypes.c_void_p
library.ale_binding_trajectory.restype = ctypes.c_uint32

DESCRIPTION: dict[str, Any] = json.loads(library.ale_binding_describe())


def _dtype(record: dict[str, Any]) -> np.dtype[Any]:
    names, formats, offsets = [], [], []
    for name, element, offset, size in record["fields"]:
        count = size // np.dtype(element).itemsize
        shape = () if count == 1 else (3, 3) if count == 9 else (count,)
        names.append(name)
        formats.append((element, shape))
        offsets.append(offset)
    layout = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": record["size"]}, align=False)
    return np.dtype((np.record, layout))


DTYPES: dict[str, np.dtype[Any]] = {name: _dtype(record) for name, record in DESCRIPTION["records"].items()}


def records(name: str, count: int) -> Records:
    """Room for so many."""
    return np.zeros(count, DTYPES[name])


class Config(ctypes.Structure):
    _fields_ = [("settings", ctypes.c_void_p), ("blind_rad", ctypes.c_void_p), ("blind_count", ctypes.c_uint32),
                ("close_loops", ctypes.c_uint32), ("rebuilds_map", ctypes.c_uint32)]


class Scan(ctypes.Structure):
    _fields_ = [("scanner", ctypes.c_void_p), ("ranges", ctypes.c_void_p), ("beams", ctypes.c_uint32),
                ("is_float32", ctypes.c_uint32), ("stamp_s", ctypes.c_double)]


class Features(ctypes.Structure):
    _fields_ = [("lines", ctypes.c_void_p), ("corners", ctypes.c_void_p), ("curves", ctypes.c_void_p),
                ("counts", ctypes.c_void_p)]


def address(array: NDArray[Any]) -> ctypes.c_void_p:
    """Of the first element; the array must be held by whoever asks."""
    return ctypes.c_void_p(array.ctypes.data)


def reason() -> str:
    text: bytes = library.ale_binding_error()
    return text.decode(errors="replace")


def check(status: int) -> None:
    if status < 0:
        raise AleError(reason())
