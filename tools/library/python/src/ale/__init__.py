"""ALE-SLAM for Python: lines and corners of 2D laser scans, pose and map of a drive.

    import ale
    features = ale.Extractor(ale.scanner("urg-04lx")).extract(ranges)

Metres, radians, seconds; x ahead, y to the left, angles counter-clockwise. ale.bags reads ROS bags, ale.plot draws.
"""
import importlib
import pkgutil
from typing import Any

from ._core import DESCRIPTION as _DESCRIPTION
from ._errors import AleError
from .config import blind_from, settings_from
from .extractor import Extractor
from .features import CornerKind, EndKind, Features
from .scanner import SCANNERS, Scanner, scanner
from .tracker import ESTIMATE, Map, State, Tracker, WheelFault

__version__: str = _DESCRIPTION["version"]
__all__ = ["AleError", "CornerKind", "ESTIMATE", "EndKind", "Extractor", "Features", "Map", "SCANNERS", "Scanner", "State",
           "Tracker", "WheelFault", "blind_from", "scanner", "settings_from"]

# LCM's types for Python are a package of this name, too: where it lies behind this one in sys.path, its types are here.
__path__ = pkgutil.extend_path(__path__, __name__)


def __getattr__(name: str) -> Any:
    if name.endswith("_t") and not name.startswith("_"):
        try:
            kind = getattr(importlib.import_module(f"{__name__}.{name}"), name)
        except ModuleNotFoundError:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}: no LCM types are in sys.path") from None
        globals()[name] = kind
        return kind
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
