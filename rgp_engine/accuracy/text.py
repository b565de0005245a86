"""A sweep in words and figures, for the terminal and for the panel."""

from ..plot import number_text
from .front import TARGETS, Row, cheapest
from .quality import Quality
from .result import Sweep


def error_text(row: Row) -> str:
    """Such as "1.2 %", or "<0.5 %" where the reference cannot tell."""
    return f"{'<' if row.is_limit else ''}{row.error:.2g} %"


def describe(quality: Quality, *, is_glossy: bool) -> str:
    """Settings in a few words."""
    bins = f", bins {quality.bins}" if is_glossy else ""
    samples = f"{quality.rays} rays, {quality.samples} camera samples"
    return f"{samples}, {number_text(quality.photons)} photons, finest {quality.finest}{bins}"


def table(sweep: Sweep) -> list[str]:
    """The front as lines of text, and the cheapest settings for each target."""
    lines = [_line("error", "time", "rays", "samples", "photons", "finest", "bins", "pyramid")]
    lines += [_line(*cells(row, is_glossy=sweep.is_glossy)) for row in sweep.front]
    for target in TARGETS:
        row = cheapest(sweep.rows, target)
        found = f"{row.seconds:.3g} s {_options(row.quality)}" if row else sweep.not_reached()
        lines.append(f"{target:>4g} %: {found}")
    return lines


def _options(quality: Quality) -> str:
    """As on the command line."""
    return " ".join(f"--set {name}={value}" for name, value in quality.settings().items())


def cells(row: Row, *, is_glossy: bool) -> list[str]:
    """The cells of a row of the table."""
    quality = row.quality
    return [
        error_text(row),
        f"{row.seconds:.3g} s",
        str(quality.rays),
        str(quality.samples),
        number_text(quality.photons),
        str(quality.finest),
        quality.bins if is_glossy else "-",
        f"{row.bytes / 2**20:.1f} MiB",
    ]


def described(row: Row, *, is_glossy: bool) -> list[tuple[str, str]]:
    """The settings of a row, and its memory, each with its name."""
    quality = row.quality
    bins = [("Direction bins", quality.bins)] if is_glossy else []
    return [
        ("Gather rays", str(quality.rays)),
        ("Camera samples", str(quality.samples)),
        ("Photons", number_text(quality.photons)),
        ("Finest resolution", str(quality.finest)),
        *bins,
        ("Pyramid memory", f"{row.bytes / 2**20:.1f} MiB"),
    ]


def _line(*cells: str) -> str:
    return "".join(f"{cell:>10}" for cell in cells)
