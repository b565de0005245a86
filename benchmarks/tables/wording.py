"""What is said about the figures in words, from the figures."""

from collections.abc import Iterator, Sequence
from typing import Any

from benchmarks.tables import paper
from benchmarks.tables.plan import PATH, PHOTON_MAP, PYRAMID
from benchmarks.tables.subjects import Subject

Document = dict[str, Any]


def measured_with(document: Document, subjects: Sequence[Subject]) -> Iterator[str]:
    """Machine, settings, and what the columns mean."""
    machine, versions, settings = document["machine"], document["versions"], document["settings"]
    yield (
        f"On {machine['processor']}, {machine['cores']} cores, {settings['threads']} threads, "
        f"{machine['system']}, with a "
        f"load of {machine['load']:.1f} before; commit {versions['commit']}, core {versions['rgp_core']}, Embree "
        f"{versions['embree']}, Blender {versions['blender']}, Python {versions['python']}. The paper had one "
        "processor "
        "of a Pentium D, 3.0 GHz."
    )
    stand_ins = ", ".join(f"`{s.name}` beside {s.published.name}" for s in subjects if s.is_stand_in)
    if stand_ins:
        yield (
            f"The paper's own scenes are not published: {stand_ins} is of about as many triangles and has as "
            "many pixels, "
            "and is another place. Compare ratios, not errors to the third digit."
        )
    share = settings["photon_share"]
    of_them = "" if share == 1 else f", of which {share:.3g} are used"
    bullets = [
        "**Same for all methods:** the photons, the gather rays and their seed, the threads, the direct light. "
        "They differ "
        "in what answers for the light at the end of a gather ray (`gather.estimator`). What the pyramid "
        "retraces (rays "
        "too short for their cell) it traces besides.",
        f"**Settings:** {settings['rays']} gather rays per pixel, {paper.FINEST}³ cells, 8 × 16 bins, unless a "
        "table says "
        "otherwise; 16 camera samples per pixel share the gather rays. The paper draws them uniformly or by "
        "importance and "
        "does not say which a table used; here they follow the reflection (`gather.sampling=cosine`), for all "
        "methods.",
        f"**Photons:** as many as take the paper's memory at {paper.BYTES_PER_PHOTON} bytes each{of_them}; the "
        "number to "
        f"emit comes from a small pilot. An estimate reaches to k = {settings['photons_per_estimate']} "
        "photons; the paper "
        "does not give its k.",
        "**Errors** are of the indirect light alone: root mean square over all pixels and channels, in percent "
        "of the "
        "brightest of them in the photon map's picture. *Against photon map* is the paper's metric: with the "
        "same rays and "
        "photons most of the noise is the same in both, and what the photon map has wrong counts as right.",
        "*Against truth* counts everything, the noise of the gather rays and of the photons too. The truth "
        "follows light "
        "along paths (`gather.estimator=path`) in two independent halves; with both, its own noise drops out "
        "of the error. "
        "To keep the noise of gather rays out of the comparison, table 3 has two rows with "
        f"{settings['many_rays']} rays.",
        *(_sizes(document, subject) for subject in subjects),
    ]
    yield "\n".join(f"- {bullet}" for bullet in bullets)


def _sizes(document: Document, subject: Subject) -> str:
    details = document["details"][subject.name]
    truth = details["truth"]
    timed, small = ("{} × {}".format(*details[name]) for name in ("timed_size", "size"))
    return (
        f"**{subject.name}:** {details['emitted']:,} photons emitted, {details['deposited']:,} stored. Time of "
        f"`{PHOTON_MAP}` and `{PYRAMID}` at {timed} pixels, all else at {small}. Truth: {truth['rays']:,} "
        "paths per pixel, "
        f"{truth['noise']:.3f} % noise; errors below {truth['resolves']:.3f} % cannot be told from none."
    )


def compared(document: Document, subject: Subject) -> str:
    """What the asterisk means, how good it is, and what else belongs to the memory."""
    details = document["details"][subject.name]
    seconds = details["seconds"]
    gather = seconds[PHOTON_MAP]["gather"] / seconds[PYRAMID]["gather"]
    ratios = " and ".join(
        f"{ratio:.2f} for `{setting}`" for setting, ratio in details["scaled_over_timed"].items()
    )
    return (
        f"The gather alone is {gather:.1f} times as fast with the pyramid as with the photon map. \\* Measured "
        "on the small "
        f"picture, its gather multiplied by the number of pixels; done with those that are timed in full, this gives "
        f"{ratios} of the measured seconds. While it is built, the pyramid takes "
        f"{details['pyramid_build_bytes'] / 1e6:.1f} MB more."
    )


def weaknesses(document: Document, subjects: Sequence[Subject]) -> Iterator[str]:
    """Other methods that do better in something, as far as table 3 shows it."""
    bullets = []
    for subject in subjects:
        rows = document["table3"][subject.name]
        ours = rows[PYRAMID]
        # Pictures with other numbers of rays are not comparable, and the photon map is no nearer to itself.
        others = {name: row for name, row in rows.items() if "rays" not in name and name != PYRAMID}
        for key, words, unit, scale in (
            ("seconds", "faster", "s", 1.0),
            ("bytes", "smaller", "MB", 1e-6),
            ("rms_truth", "nearer the truth", "%", 1.0),
        ):
            better = {name: row[key] for name, row in others.items() if row[key] < ours[key]}
            if key == "bytes":
                better.pop(PATH, None)
            if better:
                names = ", ".join(f"`{name}` ({value * scale:.3g} {unit})" for name, value in better.items())
                bullets.append(
                    f"- {subject.name}: {words} than the pyramid ({ours[key] * scale:.3g} {unit}): {names}"
                )
    yield "\n".join(bullets) if bullets else "In no figure of table 3."
