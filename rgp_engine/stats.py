"""The stats file: what the core measured, completed with what only the host knows, and its table."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from .report import Problem


def complete(
    core_stats: Mapping[str, Any],
    export_seconds: float,
    versions: Mapping[str, str],
    settings: Mapping[str, Mapping[str, Any]],
    problems: Sequence[Problem],
) -> dict[str, Any]:
    """The stats file's content: the core's, with export time, versions, settings and problems."""
    seconds = {"export": export_seconds, **core_stats["seconds"]}
    seconds["total"] += export_seconds
    return {
        **core_stats,
        "seconds": seconds,
        "versions": versions,
        "settings": settings,
        "problems": [asdict(problem) for problem in problems],
    }


def rows(stats: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The figures of a stats file as labelled lines of text; those that are not there are left out."""
    lines = [(f"{_title(name)} time", f"{value:.2f} s") for name, value in stats["seconds"].items()]
    lines += [(f"{_title(name)} rays", f"{value:,}") for name, value in stats.get("rays", {}).items()]
    lines += [(f"Photons {name}", f"{value:,}") for name, value in stats.get("photons", {}).items()]
    for name, value in stats.get("pyramid", {}).items():
        lines.append(
            (f"Pyramid {_words(name)}", _mebibytes(value) if name.endswith("bytes") else _number(value))
        )
    if stats.get("error"):
        lines.append(("Error", f"{stats['error']['rms_clipped']:.3g} %"))
    lines += _audit_rows(stats.get("audit"))
    if "memory_peak_bytes" in stats:
        lines.append(("Peak memory", _mebibytes(stats["memory_peak_bytes"])))
    return lines


def _audit_rows(audit: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """What an audit says of the pyramid; nothing where there was none, or nothing to follow."""
    if not audit or not audit["hits"]:
        return []
    lines = [("Pyramid bias", f"{audit['bias']:+.2g} % ± {audit['interval']:.2g} %")]
    if audit["cells_disagreeing"]:
        counts = f"{audit['cells_disagreeing']:,} of {audit['cells_tested']:,}"
        lines.append(("Cells that disagree", counts))
    return lines


def effect_rows(stats: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The effects plan of a stats file as labelled lines of text."""
    lines = []
    for effect in stats.get("effects", ()):
        cost = ", ".join(effect_costs(effect)) if effect["computed"] else ""
        answer = ": ".join(text for text in (effect_answer(effect), cost) if text)
        lines.append((effect_label(effect), answer))
    return lines


def effect_label(effect: Mapping[str, Any]) -> str:
    """Such as "Direct light"."""
    return _title(effect["name"])


def effect_answer(effect: Mapping[str, Any]) -> str:
    """Whether an effect was computed and why, such as "on, glass on 'Bottle'"."""
    answer = "on" if effect["computed"] else "off"
    chosen = "" if effect["switch"] == "auto" else " by choice"
    return f"{answer}{chosen}, {effect['because']}"


def effect_costs(effect: Mapping[str, Any]) -> list[str]:
    """Time and, where there is any, memory of one effect."""
    memory = [_mebibytes(effect["bytes"])] if effect["bytes"] else []
    return [f"{effect['seconds']:.2f} s", *memory]


def outlook(progress: Mapping[str, Any], target: float) -> str:
    """How good the picture is and where that leads, such as "0.8 % after 12 s; 0.4 % in about 48 s". `target` in
    percent, 0 for none."""
    now = f"{progress['error']:.2g} % after {_seconds(progress['seconds_elapsed'])}"
    if target <= 0.0:
        return f"{now}; about {progress['error_at_end']:.2g} % at the end"
    if progress["seconds_to_target"] is None:
        return f"{now}; {target:g} % not with these rays and photons"
    return f"{now}; {target:g} % in about {_seconds(progress['seconds_to_target'])}"


def _seconds(seconds: float) -> str:
    """Such as "48 s" or "02:05"."""
    return f"{seconds:.0f} s" if seconds < 100.0 else clock(seconds)


def clock(seconds: float) -> str:
    """Such as "01:05" or "2:00:03"."""
    minutes, seconds_left = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds_left:02}" if hours else f"{minutes:02}:{seconds_left:02}"


def _words(name: str) -> str:
    return name.replace("_", " ").replace("bytes", "memory")


def _title(name: str) -> str:
    return _words(name).capitalize()


def _number(value: float) -> str:
    return f"{value:,}" if isinstance(value, int) else f"{value:.4g}"


def _mebibytes(count: int) -> str:
    return f"{count / 2**20:.1f} MiB"
