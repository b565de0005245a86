"""Files that are whole at every moment: whoever is killed, or runs out of disk, leaves what was there before."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Gives a path beside `path` to write to; what was written takes its place at once when the block ends well.

    Raises OSError, and removes what was begun, when it cannot be written to the end.
    """
    path = path.resolve()
    if path.exists() and not path.is_file():
        yield path  # a device or a pipe: nothing to keep
        return
    part = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield part
        with part.open("rb+") as file:
            os.fsync(file.fileno())
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
