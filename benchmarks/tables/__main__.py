"""Makes the paper's tables with this engine: renders what is missing, then writes the page, pictures and figures.

An interrupted run goes on where it was; times of one sitting need --fresh. The quick one is rough, and writes to a
folder of its own.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks import capture
from benchmarks.figures import machine
from benchmarks.tables.document import TABLES, core_version, document
from benchmarks.tables.markdown import page
from benchmarks.tables.pictures import draw_pictures, draw_plots
from benchmarks.tables.plan import FULL, QUICK, Pilot, Scale, scene_plan
from benchmarks.tables.runner import Runner, Say
from benchmarks.tables.store import Store
from benchmarks.tables.subjects import Subject, subjects

_ROOT = Path(__file__).resolve().parents[2]
_RENDERS = _ROOT / "out/tables/renders"
_OUTPUT, _QUICK_OUTPUT = _ROOT / "docs/results", _ROOT / "out/tables"


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.tables", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="rough figures in minutes, into out/tables")
    parser.add_argument("--fresh", action="store_true", help="render everything anew")
    parser.add_argument("--scene", action="append", metavar="NAME", help="only this one; can be repeated")
    options = parser.parse_args()
    there = {subject.name: subject for subject in subjects()}
    unknown = set(options.scene or ()) - set(there)
    if unknown:
        parser.error(f"no scene {', '.join(sorted(unknown))}; there are {', '.join(there)}")
    chosen = [there[name] for name in options.scene or there]
    store = Store(_RENDERS, core_version())
    if options.fresh:
        store.clear()
    scale, output, command = (
        (QUICK, _QUICK_OUTPUT, "make tables QUICK=1") if options.quick else (FULL, _OUTPUT, "make tables")
    )
    capture.register()
    make(chosen, scale, store, output, command, _say)


def make(
    subjects: Sequence[Subject], scale: Scale, store: Store, output: Path, command: str, say: Say
) -> None:
    """Renders what is missing and writes everything into the folder `output`; `command` is named as its maker."""
    before = machine()
    runner = Runner(store, subjects, say)
    pilots = [Pilot.of(subject, scale) for subject in subjects]
    found = runner.run([job for pilot in pilots for job in (pilot.photons, pilot.path)])
    plans = [
        scene_plan(subject, scale, found[pilot.photons], found[pilot.path])
        for subject, pilot in zip(subjects, pilots)
    ]
    renders = runner.run([job for plan in plans for job in plan.jobs()])
    figures = document(plans, renders, scale, command, before)
    output.mkdir(parents=True, exist_ok=True)
    for plan in plans:
        name = plan.subject.name
        draw_pictures(plan, renders, output)
        draw_plots(plan.subject, {table: figures[table][name] for table in TABLES}, output)
    (output / "tables.json").write_text(json.dumps(figures, indent=2) + "\n")
    (output / "README.md").write_text(
        page(figures, has_notes=(output / "notes.md").is_file()), encoding="utf-8"
    )
    for verdict in figures["verdicts"]:
        print("{scene:12} {claim:42} {reached:>22}  to reach {to_reach:28} {verdict}".format(**verdict))
    say(f"written to {output.relative_to(_ROOT) if output.is_relative_to(_ROOT) else output}")


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
