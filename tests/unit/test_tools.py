"""The tools that set up and package: what they decide, on answers known beforehand."""

import base64
import hashlib
import tomllib
import zipfile
from pathlib import Path

import pytest

from tools import fuzz, machine
from tools.environment import add_local_version
from tools.extension import embreex_requirement, manifest_for

ROOT = Path(__file__).resolve().parents[2]


def test_every_blender_has_a_lock_file_with_its_version_and_only_hashed_packages() -> None:
    for bpy in machine.PYTHON_OF_BPY:
        lock = (ROOT / f"requirements/bpy-{bpy}.txt").read_text()
        assert f"\nbpy=={bpy} \\\n" in lock
        entries = [line for line in lock.splitlines() if line[:1].isalpha()]
        assert entries
        assert all(line.endswith("\\") and "==" in line for line in entries)


def test_the_manifest_and_the_core_have_one_version() -> None:
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    cargo = tomllib.loads((ROOT / "core/Cargo.toml").read_text())
    assert manifest["version"] == cargo["workspace"]["package"]["version"]


def test_an_interpreter_that_does_not_run_is_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = tmp_path / "python3.77"
    broken.write_text("#!/bin/sh\nexit 127\n")
    broken.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    monkeypatch.setattr(machine.Path, "home", lambda: tmp_path)
    assert machine.interpreter("3.77") is None
    good = tmp_path / ".pyenv/versions/3.77.1/bin/python3.77"
    good.parent.mkdir(parents=True)
    good.write_text("#!/bin/sh\necho 3.77\n")
    good.chmod(0o755)
    assert machine.interpreter("3.77") == good


def test_without_a_fitting_python_the_message_names_those_that_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "interpreter", lambda version: None)
    with pytest.raises(SystemExit, match=r"3\.11 .*bpy 5\.0.* or 3\.13 .*bpy 5\.2"):
        machine.available_bpys()
    with pytest.raises(SystemExit, match=r"Python 3\.13 is needed"):
        machine.available_bpys("5.2.3")
    with pytest.raises(SystemExit, match=r"bpy 3\.6 is not one of 4\.2\.23, .*5\.2\.3"):
        machine.available_bpys("3.6")


def test_a_disk_too_full_is_told_with_what_is_needed(tmp_path: Path) -> None:
    machine.check_space(tmp_path, 1e-6, "a byte")
    with pytest.raises(
        SystemExit, match=r"making much takes about 1000000000\.0 GB, and [0-9.]+ GB are free"
    ):
        machine.check_space(tmp_path, 1e9, "making much")


def test_the_blenders_of_one_python_come_oldest_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "interpreter", lambda version: Path("python") if version == "3.11" else None)
    assert machine.available_bpys() == ["4.2.23", "4.5.15", "5.0.1"]
    assert machine.available_bpys("4.5.15") == ["4.5.15"]


def test_a_missing_library_names_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ldd = tmp_path / "ldd"
    ldd.write_text(
        "#!/bin/sh\necho '\tlibXi.so.6 => not found'\necho '\tlibm.so.6 => /lib/libm.so.6 (0x7)'\n"
    )
    ldd.chmod(0o755)
    (tmp_path / "apt-get").write_text("#!/bin/sh\nexit 1\n")
    (tmp_path / "apt-get").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    monkeypatch.setattr(machine.os, "geteuid", lambda: 1000)
    with pytest.raises(SystemExit, match=r"sudo apt-get install -y --no-install-recommends libxi6$"):
        machine.check_libraries(tmp_path / "bpy.so")


def test_a_wheel_gets_a_local_version_everywhere_its_version_stands(tmp_path: Path) -> None:
    wheel = tmp_path / "core-1.2.3-cp311-abi3-linux_x86_64.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("core/core.so", b"binary 1.2.3")
        archive.writestr(
            "core-1.2.3.dist-info/METADATA", "Name: core\nVersion: 1.2.3\nSummary: Version: 1.2.3\n"
        )
        archive.writestr("core-1.2.3.dist-info/RECORD", "old\n")
    copy = add_local_version(wheel, "0a1b", tmp_path / "made")
    assert copy.name == "core-1.2.3+0a1b-cp311-abi3-linux_x86_64.whl"
    with zipfile.ZipFile(copy) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    metadata = b"Name: core\nVersion: 1.2.3+0a1b\nSummary: Version: 1.2.3\n"
    assert content["core/core.so"] == b"binary 1.2.3"
    assert content["core-1.2.3+0a1b.dist-info/METADATA"] == metadata
    digest = base64.urlsafe_b64encode(hashlib.sha256(metadata).digest()).decode().rstrip("=")
    record = content["core-1.2.3+0a1b.dist-info/RECORD"].decode().splitlines()
    assert record[1] == f"core-1.2.3+0a1b.dist-info/METADATA,sha256={digest},{len(metadata)}"
    assert record[-1] == "core-1.2.3+0a1b.dist-info/RECORD,,"
    assert len(record) == len(content) == 3


def test_wheels_are_listed_before_the_first_table_of_the_manifest() -> None:
    manifest = manifest_for((ROOT / "blender_manifest.toml").read_text(), "linux-x64", ["a.whl", "b.whl"])
    parsed = tomllib.loads(manifest)
    assert parsed["wheels"] == ["./wheels/a.whl", "./wheels/b.whl"]
    assert parsed["platforms"] == ["linux-x64"]
    assert parsed["permissions"].keys() == {"files"}


def test_the_embree_wheel_is_pinned_by_hash() -> None:
    entry = "embreex==4.4 \\\n    --hash=sha256:bb \\\n    --hash=sha256:cc\n"
    assert embreex_requirement(f"a==1 \\\n    --hash=sha256:aa\n{entry}    # via x\nz==1\n") == entry


def test_what_cannot_be_fuzzed_is_said_with_what_is_missing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(fuzz, "run", lambda *command, **variables: 1)
    assert fuzz.fuzz_by_coverage(Path("python"), "5.0.1", Path("embree"), 1) == []
    said = capsys.readouterr().out
    assert "the core is not fuzzed by coverage: there is no cargo-fuzz here" in said
    assert "the add-on is not fuzzed by coverage: atheris cannot be installed beside bpy 5.0.1" in said


def test_a_corpus_begins_alike_everywhere_and_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fuzz, "CORPORA", tmp_path)
    monkeypatch.setattr(fuzz, "_core_targets", dict)
    monkeypatch.setattr(fuzz, "_addon_targets", lambda *_: {"addon-one": ["one"], "addon-two": ["two"]})
    commands = []

    def finds_in_two(name: str, command: list[str], *_: object, **__: str) -> int:
        commands.append(list(map(str, command)))
        return int(command[0] == "two")

    monkeypatch.setattr(fuzz, "timed", finds_in_two)
    arguments = (Path("python"), "5.0.1", Path("embree"), 7)
    assert fuzz.fuzz_by_coverage(*arguments) == ["addon-two"]
    assert all("-max_total_time=7" in command for command in commands)
    corpora = [tmp_path / name / "corpus" for name in ("addon-one", "addon-two")]
    one, two = ({path.name: path.read_bytes() for path in corpus.iterdir()} for corpus in corpora)
    assert one == two
    assert len(one) == fuzz.SEEDS
    for seed in list(corpora[0].iterdir())[1:]:
        seed.unlink()
    fuzz.fuzz_by_coverage(*arguments)
    assert len(list(corpora[0].iterdir())) == 1
