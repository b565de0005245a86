"""A sweep in a process of its own, and the last one's result for the panels."""

import subprocess
from collections.abc import Sequence
from pathlib import Path

from .front import Row
from .result import FILE, Sweep

_LOG = "log.txt"


class BackgroundSweep:
    """A sweep that another process makes and writes into a folder. It ends with the process that started it."""

    def __init__(self, command: Sequence[str], folder: Path, directory: Path) -> None:
        """Starts the command, which writes into the folder and stops when its standard input ends. Raises OSError."""
        self.folder = folder
        self.sweep: Sweep | None = None
        """What is known so far."""
        self.is_stopped = False
        """Stopping was asked for."""
        with (folder / _LOG).open("wb") as log:
            self._process = subprocess.Popen(
                command, cwd=directory, stdin=subprocess.PIPE, stdout=log, stderr=subprocess.STDOUT
            )

    @property
    def is_running(self) -> bool:
        """The process runs."""
        if self._process.poll() is None:
            return True
        self._close_input()
        return False

    def refresh(self) -> None:
        """Reads what is new."""
        if (self.folder / FILE).is_file():
            self.sweep = Sweep.read(self.folder)

    @property
    def error(self) -> str:
        """Why there is no result, in the words of the process; empty while it runs and when it went well."""
        if self.is_running or self._process.returncode == 0 or self.is_stopped:
            return ""
        lines = (self.folder / _LOG).read_text(errors="replace").splitlines()
        reasons = [line.partition("error: ")[2] for line in lines if line.startswith("error: ")]
        return reasons[-1] if reasons else (lines[-1] if lines else "The measurement ended without a word")

    def stop(self) -> None:
        """Asks the process to end with what there is; returns at once."""
        self.is_stopped = True
        self._close_input()

    def end(self) -> None:
        """Ends the process and waits until it is gone."""
        self.is_stopped = True
        self._process.kill()
        self._process.wait()
        self._close_input()

    def _close_input(self) -> None:
        if self._process.stdin is not None:
            self._process.stdin.close()


_last: BackgroundSweep | None = None


def publish(background: BackgroundSweep) -> None:
    """Makes this sweep the one the panels show."""
    global _last
    _last = background


def last() -> BackgroundSweep | None:
    """The sweep that runs or was the last to run in this process; None before the first."""
    return _last


def front() -> list[Row]:
    """Rows worth their time of the last sweep, fastest first."""
    return _last.sweep.front if _last is not None and _last.sweep is not None else []
