"""Settings of a robot from the file that its ale-slamd reads."""
from __future__ import annotations

import configparser
import math
import os

from . import _core
from .scanner import scanner


def settings_from(path: str | os.PathLike[str]) -> dict[str, float]:
    """Those settings of ale-slamd's configuration that tracker and extractor have, for their `settings`; the noise that the
    file does not say is the preset's that sensor.model names. What else the file says (ports, keys, LCM) is the robot's own
    and left out; so are blind sectors (blind_from) and sensor.reversed."""
    known = [name for name, *_ in _core.DESCRIPTION["settings"]]
    file = _read(path)
    found = {f"{section}.{key}": text for section in file.sections() for key, text in file[section].items()}
    model = found.get("sensor.model", "")
    preset = scanner(model).settings() if model else {}
    return {**preset, **{name: _number(path, name, found[name]) for name in known if name in found}}


def blind_from(path: str | os.PathLike[str]) -> list[tuple[float, float]]:
    """Blind sectors of the configuration, in radians."""
    text = _read(path).get("sensor", "blind", fallback="")
    sectors = []
    for sector in filter(None, (word.strip() for word in text.split(","))):
        first, colon, last = sector.partition(":")
        try:
            sectors.append((math.radians(float(first)), math.radians(float(last))))
        except ValueError:
            raise ValueError(f"{os.fspath(path)}: sensor.blind: {sector!r} is not from:to in degrees") from None
    return sectors


def _read(path: str | os.PathLike[str]) -> configparser.ConfigParser:
    file = configparser.ConfigParser(inline_comment_prefixes=("#", ";"), interpolation=None, strict=False)  # a section may go on later
    with open(path, encoding="utf-8") as text:
        try:
            file.read_file(text)
        except configparser.Error as error:
            raise ValueError(f"{os.fspath(path)}: {' '.join(str(error).split())}") from None
    return file


def _number(path: str | os.PathLike[str], name: str, text: str) -> float:
    words = {"yes": 1.0, "true": 1.0, "on": 1.0, "no": 0.0, "false": 0.0, "off": 0.0}
    try:
        return words[text.lower()] if text.lower() in words else float(text)
    except ValueError:
        raise ValueError(f"{os.fspath(path)}: {name}: {text!r} is not a number") from None
