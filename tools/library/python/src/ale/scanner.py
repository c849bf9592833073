"""Scanners: how their beams lie, how they are swept, and how rough their ranges are."""
from __future__ import annotations

import configparser
import dataclasses
import math
import pathlib
from collections.abc import Mapping

from . import _checks, _core

FARTHEST_M: float = _core.DESCRIPTION["max_range"]


@dataclasses.dataclass(frozen=True)
class Scanner:
    """Beam k looks along first_bearing + k * step (radians, counter-clockwise) and is taken at the scan's stamp
    + (k - stamp_beam) * beam_time (seconds; 0: the whole scan at its stamp). Ranges in metres."""

    first_bearing: float
    step: float
    range_min: float = 0.02
    range_max: float = 30.0
    beam_time: float = 0.0
    stamp_beam: int = 0
    beams: int | None = None  # None: whatever comes
    noise: Mapping[str, float] = dataclasses.field(default_factory=dict)  # settings noise.*, without that word

    def __post_init__(self) -> None:
        _checks.finite("first_bearing", self.first_bearing, -2 * math.pi, 2 * math.pi)
        _checks.finite("step", self.step, -math.pi, math.pi)
        _checks.finite("range_max", self.range_max, 1e-6, FARTHEST_M)
        _checks.finite("range_min", self.range_min, 0, self.range_max)
        _checks.finite("beam_time", self.beam_time, -1, 1)
        _checks.finite("stamp_beam", self.stamp_beam, -(2**20), 2**20)
        if self.step == 0:
            raise ValueError("step is 0: all beams would look the same way")
        sweep = abs(self.beam_time) * ((self.beams or _checks.MAX_BEAMS) + abs(self.stamp_beam))
        if sweep > 2:
            raise ValueError(f"a scan lasts {sweep:g} s by its beam_time: at most 2 s")
        _checks.settings_of(self.settings())

    def settings(self) -> dict[str, float]:
        return {f"noise.{name}": value for name, value in self.noise.items()}

    def record(self) -> _core.Records:
        """As the core reads it."""
        one = _core.records("scanner", 1)
        for name in _core.DTYPES["scanner"].names or ():
            one[name] = getattr(self, name)
        return one

    def upside_down(self) -> Scanner:
        """The same, mounted upside down: its beams run the other way."""
        return dataclasses.replace(self, first_bearing=-self.first_bearing, step=-self.step)


def _presets_file() -> pathlib.Path:
    """The firmware's own: laid beside the package, or where it lies in the tree."""
    here = pathlib.Path(__file__).resolve().parent
    beside = here / "scanners.ini"
    return beside if beside.exists() else here.parents[4] / "firmware/config/scanners.ini"


def _read_presets() -> dict[str, Scanner]:
    file = configparser.ConfigParser(inline_comment_prefixes=("#",))
    file.read_string(_presets_file().read_text(encoding="utf-8"))
    return {name: _preset(file[name]) for name in file.sections()}


def _every(beams: int) -> int:
    """Of more beams than fit as many are left out, evenly over the turn: ranges[::every]."""
    every = -(-beams // _checks.MAX_BEAMS)
    while beams % every:
        every += 1
    return every


def _preset(section: configparser.SectionProxy) -> Scanner:
    numbers = {key: float(text) for key, text in section.items() if key != "identity"}
    every = _every(int(numbers["beams"]))
    beams_a_turn = numbers["beams_a_turn"] / every
    settings = {name for name, *_ in _core.DESCRIPTION["settings"]}
    noise = {key: value for key, value in numbers.items() if f"noise.{key}" in settings}
    return Scanner(first_bearing=math.radians(numbers["first_degrees"]), step=2 * math.pi / beams_a_turn,
                   range_min=numbers["range_min"], range_max=numbers["range_max"], beam_time=numbers["turn_s"] / beams_a_turn,
                   stamp_beam=int(numbers.get("stamp_beam", 0)) // every, beams=int(numbers["beams"]) // every, noise=noise)


SCANNERS: dict[str, Scanner] = _read_presets()


def scanner(name: str) -> Scanner:
    """A preset by its name."""
    try:
        return SCANNERS[name]
    except KeyError:
        raise ValueError(f"no preset is called {name}; there are: {', '.join(SCANNERS)}") from None
