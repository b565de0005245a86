"""Passes of a picture that is not finished, in a file, so that a later render goes on where an earlier one ended."""

import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .files import whole_file
from .report import UserError

# What np.load raises of files that are broken, or are none of its own.
_BROKEN = (ValueError, KeyError, EOFError, TypeError, MemoryError, zipfile.BadZipFile)


@dataclass(frozen=True)
class Checkpoint:
    """A file for the passes of one picture."""

    path: Path
    fingerprint: str
    """Of the picture; files with that of another are left alone."""

    def read(self) -> tuple[int, npt.NDArray[np.float32]] | None:
        """Passes and their sums (2, H, W, N); None where nothing was kept. Raises UserError when there is another file,
        or none could be written."""
        if not self.path.parent.is_dir():
            raise UserError(f"The checkpoint {self.path} cannot be written: there is no such folder.")
        if not self.path.exists():
            return None
        try:
            with self.path.open("rb") as file, np.load(file, allow_pickle=False) as kept:
                fingerprint, passes, sums = str(kept["fingerprint"]), int(kept["passes"]), kept["sums"]
        except OSError as error:
            raise UserError(
                f"The checkpoint {self.path} cannot be read: {error.strerror or error}"
            ) from error
        except _BROKEN as error:
            raise UserError(f"{self.path} is no checkpoint, or a broken one; choose another file.") from error
        if fingerprint != self.fingerprint:
            raise UserError(
                f"The checkpoint {self.path} is of another picture: the scene, its settings or the version "
                "of RGP Engine have changed since. Remove it to begin anew, or choose another file."
            )
        return passes, sums

    def write(self, passes: int, sums: npt.NDArray[np.float32]) -> None:
        """Keeps passes in place of those that were kept before. Raises OSError, and leaves these, when it cannot."""
        with whole_file(self.path) as part, part.open("wb") as file:
            np.savez(file, fingerprint=np.array(self.fingerprint), passes=np.array(passes), sums=sums)

    def remove(self) -> None:
        """Forgets what was kept. Raises OSError when it cannot."""
        self.path.unlink(missing_ok=True)
