"""The native core: the only import of `rgp_core`, and where its Embree library lies."""

import importlib
import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType

from .report import UserError

CORE_VERSION = "0.1.0"
"""Version of `rgp_core` this package talks to."""

# Where the wheels of Linux, Windows and macOS keep Embree, seen from the folder of the package embreex.
_EMBREE_PATTERNS = (
    "../embreex.libs/libembree4*.so*",
    "../embreex.libs/embree4*.dll",
    ".dylibs/libembree4*.dylib",
)


class NativeError(UserError):
    """The native core cannot be used; the message says what to install."""


def core() -> ModuleType:
    """The module `rgp_core`. Raises NativeError when it is missing, broken or of another version."""
    try:
        module = importlib.import_module("rgp_core")
    except ImportError as error:
        raise NativeError(
            "The native core of RGP Engine (the wheel rgp_core) cannot be loaded. "
            f"Install the extension built for this platform. ({error})"
        ) from error
    found = str(getattr(module, "__version__", "unknown"))
    if found.partition("+")[0] != CORE_VERSION:
        raise NativeError(
            f"RGP Engine needs rgp_core {CORE_VERSION} but {found} is installed. "
            "Remove the older extension, restart Blender and install again."
        )
    return module


def is_render_error(error: Exception) -> bool:
    """True when the core raised it with a message for the artist."""
    module = sys.modules.get("rgp_core")
    return module is not None and isinstance(error, module.RenderError)


def versions() -> dict[str, str]:
    """Versions of the native parts."""
    module = core()
    return {"rgp_core": module.__version__, "embree": module.embree_version(str(embree_library()))}


def memory_allowed() -> int:
    """Memory (MiB) a render may take when the user sets no limit: 90 % of the machine's; 0 where that is unknown."""
    try:
        total = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return 0  # Windows has no sysconf
    return max(0, int(0.9 * total) >> 20)


def embree_library() -> Path:
    """Path of the Embree library in the embreex wheel. Raises NativeError when there is none."""
    spec = importlib.util.find_spec("embreex")
    for folder in (spec and spec.submodule_search_locations) or ():
        for pattern in _EMBREE_PATTERNS:
            parent, _, name = pattern.rpartition("/")
            for path in sorted((Path(folder) / parent).glob(name)):
                return path.resolve()
    raise NativeError(
        "Embree is missing: the wheel embreex is not installed or holds no Embree library for "
        "this platform. Install the extension built for this platform."
    )
