"""What is to be reached, and whether it is."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from benchmarks.tables import paper
from benchmarks.tables.plan import PHOTON_MAP, PYRAMID, many_rays_setting
from benchmarks.tables.subjects import Subject

Table = dict[str, dict[str, Any]]


@dataclass(frozen=True)
class Verdict:
    """One claim about one scene."""

    claim: str
    scene: str
    paper: str
    to_reach: str
    reached: str
    is_reached: bool
    is_told: bool = True
    """False where the figures differ by less than is known of them."""

    @property
    def word(self) -> str:
        """For readers."""
        if not self.is_told:
            return "cannot be told"
        return "pass" if self.is_reached else "falls short"


def verdicts(
    subject: Subject, tables: dict[str, Table], many_rays: int, doubts: dict[str, float]
) -> list[Verdict]:
    """All claims about a scene; `tables` holds its rows by table and setting, and `doubts` what is known of their
    errors, as written."""
    return [
        *_claims(subject, tables["table3"], many_rays, doubts["without_noise"]),
        *_finer_grid(subject, tables["table2"], doubts["finer_grid"]),
    ]


def _are_told_apart(one: float, other: float, doubt: float) -> bool:
    return abs(one**2 - other**2) > doubt**2


def _claims(subject: Subject, table: Table, many_rays: int, doubt: float) -> Iterator[Verdict]:
    scene, published, goal, pyramid = subject.name, subject.published, subject.goal, table[PYRAMID]
    yield Verdict(
        "speed-up over the photon map",
        scene,
        f"{published.speedup:g}",
        f"≥ {goal.speedup:g}",
        f"{pyramid['speedup']:.1f}",
        pyramid["speedup"] >= goal.speedup,
    )
    yield Verdict(
        "RMS against the photon map",
        scene,
        f"{published.rms_by_finest[paper.FINEST]:.3f} %",
        f"≤ {goal.rms_paper:g} %",
        f"{pyramid['rms_paper']:.3f} %",
        pyramid["rms_paper"] <= goal.rms_paper,
    )
    ours, theirs = (
        table[many_rays_setting(name, many_rays)]["rms_systematic"] for name in (PYRAMID, PHOTON_MAP)
    )
    yield Verdict(
        f"RMS against the truth, {many_rays} rays, noise removed",
        scene,
        "–",
        f"< {theirs:.3f} % (photon map)",
        f"{ours:.3f} %",
        ours < theirs,
        _are_told_apart(ours, theirs, doubt),
    )
    yield Verdict(
        "memory",
        scene,
        f"{published.pyramid_bytes / 1e6:.0f} MB",
        f"≤ {goal.bytes / 1e6:.0f} MB",
        f"{pyramid['bytes'] / 1e6:.1f} MB",
        pyramid["bytes"] <= goal.bytes,
    )


def _finer_grid(subject: Subject, table: Table, doubt: float) -> Iterator[Verdict]:
    """A grid that is too fine starves its cells of photons; rounded as the paper's figures are."""
    usual, finer = (table[f"{PYRAMID} {finest}"] for finest in (paper.FINEST, paper.FINER))
    published = subject.published.rms_by_finest
    for name, kind in (("rms_paper", "the photon map"), ("rms_truth", "the truth")):
        a, b = round(usual[name], 3), round(finer[name], 3)
        yield Verdict(
            f"RMS against {kind}, {paper.FINER}³ and {paper.FINEST}³",
            subject.name,
            f"{published[paper.FINER]:.3f} % and {published[paper.FINEST]:.3f} %"
            if name == "rms_paper"
            else "–",
            "not worse",
            f"{b:.3f} % and {a:.3f} %",
            b <= a,
            b <= a or name == "rms_paper" or _are_told_apart(a, b, doubt),
        )
