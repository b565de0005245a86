"""Files that are whole at every moment."""

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from rgp_engine.files import whole_file

ROOT = Path(__file__).parents[2]


def run(code: str, path: Path) -> int:
    """Runs code in a process of its own, with `path` and `whole_file` at hand; its exit code."""
    head = "import os, resource, signal, sys; from pathlib import Path; from rgp_engine.files import whole_file\n"
    text = head + f"path = Path({str(path)!r})\n" + textwrap.dedent(code)
    return subprocess.run([sys.executable, "-c", text], cwd=ROOT, check=False, capture_output=True).returncode


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    path = tmp_path / "picture.exr"
    path.write_bytes(b"what was there before")
    return path


def assert_untouched(path: Path) -> None:
    assert path.read_bytes() == b"what was there before"


def test_what_is_written_takes_the_place_of_what_was_there(kept: Path) -> None:
    with whole_file(kept) as part:
        part.write_bytes(b"new")
        assert_untouched(kept)
    assert kept.read_bytes() == b"new"
    assert list(kept.parent.iterdir()) == [kept]


def test_a_failure_keeps_what_was_there(kept: Path) -> None:
    def write() -> None:
        with whole_file(kept) as part:
            part.write_bytes(b"half")
            raise ValueError("half way")

    with pytest.raises(ValueError, match="half way"):
        write()
    assert_untouched(kept)
    assert list(kept.parent.iterdir()) == [kept]


def test_a_killed_process_keeps_what_was_there(kept: Path) -> None:
    code = """
        with whole_file(path) as part:
            part.write_bytes(b"half")
            os.kill(os.getpid(), signal.SIGKILL)
    """
    assert run(code, kept) == -9
    assert_untouched(kept)


def test_a_full_disk_keeps_what_was_there(kept: Path) -> None:
    """A limit on the size of files stands in for the disk: writes fail half way."""
    code = """
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        try:
            with whole_file(path) as part:
                part.write_bytes(b"x" * 5000)
        except OSError:
            sys.exit(3)
    """
    assert run(code, kept) == 3
    assert_untouched(kept)
    assert list(kept.parent.iterdir()) == [kept]


def test_a_picture_on_a_full_disk_keeps_what_was_there(kept: Path) -> None:
    code = """
        import numpy as np
        from rgp_engine.cli import CommandError, exr
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        try:
            exr.write(path, np.random.default_rng(1).random((64, 64, 4), np.float32))
        except CommandError as error:
            sys.exit(3 if "cannot be written" in str(error) else 4)
    """
    assert run(code, kept) == 3
    assert_untouched(kept)
    assert list(kept.parent.iterdir()) == [kept]


def test_a_device_is_written_to_itself() -> None:
    with whole_file(Path("/dev/null")) as part:
        part.write_bytes(b"x")
    assert Path("/dev/null").is_char_device()
