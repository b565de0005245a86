"""What is said about the figures in words, from the figures."""

from collections.abc import Iterator, Sequence
from typing import Any

from benchmarks.tables import paper
from benchmarks.tables.plan import PATH, PHOTON_MAP, PYRAMID
from benchmarks.tables.subjects import Subject

Document = dict[str, Any]

# Kind of figure, what is said of a smaller one, its unit, and units per figure.
_LESS_IS_BETTER = (
    ("seconds", "faster", "s", 1.0),
    ("bytes", "smaller", "MB", 1e-6),
    ("rms_truth", "nearer the truth", "%", 1.0),
)


def one_line(text: str) -> str:
    """The text without its line breaks."""
    return " ".join(text.split())


def measured_with(document: Document, subjects: Sequence[Subject]) -> Iterator[str]:
    """Machine, settings, and what the columns mean."""
    machine, versions, settings = document["machine"], document["versions"], document["settings"]
    yield one_line(f"""
        On {machine["processor"]}, {machine["cores"]} cores, {settings["threads"]} threads, {machine["system"]},
        with a load of {machine["load"]:.1f} before; commit {versions["commit"]}, core {versions["rgp_core"]},
        Embree {versions["embree"]}, Blender {versions["blender"]}, Python {versions["python"]}. The paper had one
        processor of a Pentium D, 3.0 GHz.
    """)
    stand_ins = " and ".join(f"`{s.name}` for {s.published.name}" for s in subjects if s.is_stand_in)
    if stand_ins:
        yield one_line(f"""
            Not every scene of the paper can be had. {stand_ins}: a scene of our own with about as many triangles,
            rendered with as many pixels. It is another place, so compare ratios rather than errors to the third
            digit.
        """)
    bullets = [*_bullets(settings), *(_sizes(document, subject) for subject in subjects)]
    yield "\n".join(f"- {one_line(bullet)}" for bullet in bullets)


def _bullets(settings: dict[str, Any]) -> Iterator[str]:
    yield """
        **Same for all methods:** the photons, the gather rays and their seed, the threads, the direct light. They
        differ in what answers for the light at the end of a gather ray (`gather.estimator`). Rays that are too
        short for their cell the pyramid follows one bounce further; that is part of its time.
    """
    yield f"""
        **Settings:** {settings["rays"]} gather rays per pixel, {paper.FINEST}³ cells and 8 × 16 bins, unless a
        table says otherwise; 16 camera samples per pixel share the gather rays. The paper draws them uniformly or
        by importance and does not say which its tables used; here they follow the reflection for all methods
        (`gather.sampling={settings["sampling"]}`).
    """
    share = settings["photon_share"]
    used = "" if share == 1 else f", of which this run uses {share:.3g}"
    yield f"""
        **Photons:** as many as take the paper's memory at {paper.BYTES_PER_PHOTON} bytes each{used}; how many to
        emit comes from a small pilot. An estimate reaches to k = {settings["photons_per_estimate"]} photons; the
        paper does not give its k.
    """
    yield """
        **Errors** are of the indirect light alone: root mean square over all pixels and channels, in percent of
        the brightest of them in the photon map's picture. *Against photon map* is the paper's metric. The rays
        are the same in both pictures, so most of their noise is too; what the photon map has wrong counts as
        right.
    """
    yield f"""
        *Against truth* counts everything, the noise of gather rays and photons too. The truth follows light along
        paths (`gather.estimator=path`) in two independent halves; by using both, its own noise drops out of the
        error. Table 3 has two rows with {settings["many_rays"]} rays, where the noise of gather rays is smaller, and
        what is wrong there *without noise*: of two pictures with other photons and rays, the error of one times
        that of the other leaves what both have wrong. Which of two errors is the smaller *cannot be told* where
        their squares differ by less than twice the standard error of that difference.
    """


def _sizes(document: Document, subject: Subject) -> str:
    details = document["details"][subject.name]
    truth = details["truth"]
    timed, small = ("{} × {}".format(*details[name]) for name in ("timed_size", "size"))
    return f"""
        **{subject.name}:** {details["emitted"]:,} photons emitted, {details["deposited"]:,} stored.
        `{PHOTON_MAP}` and `{PYRAMID}` in table 3 at {timed} pixels, all else at {small}. Truth: {truth["rays"]:,}
        paths per pixel, with a noise of {truth["noise"]:.3f} %; errors below {truth["resolves"]:.3f} % cannot be
        told from none.
    """


def compared(document: Document, subject: Subject) -> str:
    """What the asterisk means, how good it is, and what else belongs to the memory."""
    details = document["details"][subject.name]
    seconds = details["seconds"]
    gather = seconds[PHOTON_MAP]["gather"] / seconds[PYRAMID]["gather"]
    ratios = " and ".join(
        f"{ratio:.2f} for `{setting}`" for setting, ratio in details["scaled_over_timed"].items()
    )
    return one_line(f"""
        The gather alone is {gather:.1f} times as fast with the pyramid as with the photon map. \\* Measured on
        the small picture, its gather multiplied by the number of pixels; the same done with what is measured in
        full gives {ratios} of the measured seconds. Errors against the truth are all from the small picture.
        While it is built, the pyramid takes {details["pyramid_build_bytes"] / 1e6:.1f} MB besides.
    """)


def weaknesses(document: Document, subjects: Sequence[Subject]) -> Iterator[str]:
    """Other methods that do better in something, as far as table 3 shows it."""
    bullets = []
    for subject in subjects:
        rows = document["table3"][subject.name]
        # Pictures with other numbers of rays are not comparable.
        others = {name: row for name, row in rows.items() if "rays" not in name and name != PYRAMID}
        for key, words, unit, scale in _LESS_IS_BETTER:
            ours = rows[PYRAMID][key]
            better = {name: row[key] for name, row in others.items() if row[key] < ours}
            if key == "bytes":
                better.pop(PATH, None)
            names = ", ".join(f"`{name}` ({value * scale:.3g} {unit})" for name, value in better.items())
            if names:
                bullets.append(
                    f"- {subject.name}: {words} than the pyramid ({ours * scale:.3g} {unit}): {names}"
                )
    yield "\n".join(bullets) if bullets else "In no figure of table 3."
