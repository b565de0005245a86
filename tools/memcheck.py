"""The Embree crate's tests under valgrind, which sees what becomes of memory on both sides of the binding."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

from tools.environment import CORE
from tools.machine import ROOT, run, say

SUPPRESSIONS = ROOT / "tools/valgrind.supp"
MEMORY_ERROR = 99


def check_memory(embree: Path) -> bool:
    """Whether every test passes, touches only memory of its own and loses none. True, and said, without valgrind."""
    if shutil.which("valgrind") is None:
        say("the Embree crate's memory is not checked: there is no valgrind here")
        return True
    command = ["valgrind", "--quiet", f"--error-exitcode={MEMORY_ERROR}", f"--suppressions={SUPPRESSIONS}"]
    command += ["--leak-check=full", "--show-leak-kinds=definite", "--errors-for-leak-kinds=definite"]
    failed = []
    for binary in test_binaries():
        say(f"valgrind {binary.name}")
        # One test after the other: valgrind runs one thread at a time, and Embree's builds need theirs.
        if run([*command, binary, "--test-threads=1"], CORE / "embree", RGP_EMBREE_LIBRARY=str(embree)) != 0:
            failed.append(binary.name)
    say(f"valgrind: failed: {', '.join(failed)}" if failed else "valgrind: nothing found")
    return not failed


def test_binaries() -> list[Path]:
    """Builds the crate's tests."""
    command = ["cargo", "test", "--package", "rgp_embree", "--locked", "--no-run", "--message-format=json"]
    done = subprocess.run(command, cwd=CORE, check=True, stdout=subprocess.PIPE, text=True)
    messages = map(json.loads, done.stdout.splitlines())
    return [Path(message["executable"]) for message in messages if message.get("executable")]
