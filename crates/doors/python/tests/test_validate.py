"""Validations and differences: the command's verdicts, counts and folders."""

from __future__ import annotations

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import SMALL, Command, same_bits

import raypencil
from raypencil import RaypencilError, Scene, diff, validate

#: What differs between two runs of the same: times, and folders.
TIMES = {"stages", "time_s", "seconds", "time"}


def without_times(document: object) -> object:
    if isinstance(document, dict):
        return {key: without_times(value) for key, value in document.items() if key not in TIMES}
    if isinstance(document, list):
        return [without_times(value) for value in document]
    return document


@pytest.mark.parametrize("judge", ["sample", "all"])
def test_a_validation_is_the_commands(command: Command, tmp_path: Path, judge: str) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    command("validate", "small.toml", "--judge", judge, "-o", "theirs")
    result = validate(Scene(SMALL, name="small"), judge=judge, output=tmp_path / "ours")  # type: ignore[arg-type]
    theirs, ours = (json.loads((tmp_path / name / "summary.json").read_text()) for name in ("theirs", "ours"))
    assert without_times(theirs) == without_times(ours) == without_times(result.summary)
    assert result and result.counts["compared"] == 48 * 36 + 64 * 4 + 48 * 2 and result.counts["defects"] == 0
    assert (result.counts["judged"] == result.counts["compared"]) == (judge == "all")
    for file in ["tracer/camera.exr", "scanline/beam-1.exr"]:
        assert (tmp_path / "theirs" / file).read_bytes() == (tmp_path / "ours" / file).read_bytes()


def test_nothing_is_written_unless_it_is_asked_for(small: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert validate(small).passes and list(tmp_path.iterdir()) == []


def test_a_validation_has_the_maps_of_its_renderers(small: Scene) -> None:
    result = validate(small, ("tracer", "scanline", "referee"))
    assert list(result.renders) == ["tracer", "scanline", "referee"] and len(result.summary["pairs"]) == 3
    alone = raypencil.render(small, "tracer")
    assert same_bits(result.renders["tracer"].camera["range"], alone.camera["range"])
    again = pickle.loads(pickle.dumps(result))
    assert again.counts == result.counts and same_bits(again.renders["referee"]["beam-1"]["face"], result.renders["referee"]["beam-1"]["face"])
    assert result.report().startswith("<!") and "rays agree" in result._repr_html_()
    with pytest.raises(RaypencilError, match="not pickled"):
        again.report()


def test_the_papers_errors_are_told_apart(small: Scene) -> None:
    result = validate(small.replace(**{"beam.thickness_mm": 80}), ["scanline-paper", "tracer"])
    assert result.summary["approximations"] and result.counts["agree"] < result.counts["compared"]


def test_a_candidate_is_checked(small: Scene, tmp_path: Path) -> None:
    raypencil.render(small, "tracer", output=tmp_path / "mine")
    assert validate(small, candidates=[tmp_path / "mine"]).passes
    raypencil.render(small.replace(**{"camera.pitch_down_deg": 21}), "tracer", output=tmp_path / "wrong")
    wrong = validate(small, candidates=[tmp_path / "wrong"])
    assert not wrong and wrong.counts["defects"] == 0 and wrong.summary["candidates"]["wrong"] == 1


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"with_": ["tracer"]}, "expected at least 2 renderers"),
        ({"with_": "tracer,tracer"}, "tracer is named twice"),
        ({"judge": "some"}, "judge is 'some'"),
        ({"candidates": ["nowhere"]}, "nowhere"),
    ],
)
def test_what_is_wrong_is_named(small: Scene, options: dict[str, object], words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        validate(small, **options)  # type: ignore[arg-type]


def test_a_difference_is_the_commands(small: Scene, command: Command, tmp_path: Path) -> None:
    for renderer in ("scanline", "tracer"):
        raypencil.render(small, renderer, output=tmp_path / renderer)
    a, b = tmp_path / "scanline", tmp_path / "tracer"
    equal = diff(a, a)
    assert equal and equal.summary["verdict"] == "equal" and len(equal.channels) > 20
    words = [a, b, "--fail-ulp", 1, "--shared-only"]
    printed = json.loads(command("--json", "diff", *words, code=0 if diff(a, b, fail_ulp=1, shared_only=True) else 1).stdout)
    assert diff(a, b, fail_ulp=1, shared_only=True).summary == printed
    # A cell that is off by a millimetre, and what allows it.
    (tmp_path / "c/camera").mkdir(parents=True)
    (tmp_path / "d/camera").mkdir(parents=True)
    cells = np.ones((4, 5))
    np.save(tmp_path / "c/camera/range.T.npy", cells)
    cells[1, 3] += 0.001
    np.save(tmp_path / "d/camera/range.T.npy", cells)
    c, d = tmp_path / "c", tmp_path / "d"
    (channel,) = diff(c, d).channels
    assert not diff(c, d) and (channel["worst"]["column"], channel["worst"]["row"], channel["differing"]) == (3, 1, 1)
    assert diff(c, d, fail=0.0011) and not diff(c, d, fail=0.0009) and diff(c, d, fail_relative=0.0011)
    assert diff(c, d, fail_percent=5) and not diff(c, d, fail_percent=4.9) and not diff(c, d, fail=1, hard_fail=0.0005)


def test_the_referee_rules_on_differences(small: Scene, tmp_path: Path) -> None:
    for renderer in ("scanline", "tracer"):
        raypencil.render(small, renderer, output=tmp_path / renderer)
    ruled = diff(tmp_path / "scanline", tmp_path / "tracer", scene=small, output=tmp_path / "out")
    assert ruled and (tmp_path / "out/report.html").is_file() and ruled.summary["rulings"] is not None


@pytest.mark.parametrize(
    ("options", "words"),
    [({"fail": -1}, "fail is -1"), ({"fail_percent": 101}, "fail_percent is 101"), ({"hard_fail": np.nan}, "hard_fail is nan")],
)
def test_thresholds_are_checked(tmp_path: Path, options: dict[str, float], words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        diff(tmp_path, tmp_path, **options)  # type: ignore[arg-type]


def test_a_recording_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="nowhere"):
        diff(tmp_path / "nowhere", tmp_path)
    with pytest.raises(FileNotFoundError, match="nowhere"):
        raypencil.read(tmp_path / "nowhere.exr")


def test_recordings_are_read_in_their_types(tmp_path: Path) -> None:
    kinds = {"f8": np.float64, "f4": np.float32, "f2": np.float16, "u4": np.uint32, "b1": np.bool_}
    for name, kind in kinds.items():
        np.save(tmp_path / f"{name}.npy", np.arange(6).reshape(2, 3).astype(kind))
    arrays = raypencil.read(tmp_path)
    types = {name: array.dtype for name, array in arrays.items()}
    assert types == {"f8": np.float64, "f4": np.float32, "f2": np.float32, "u4": np.uint32, "b1": np.uint32}
    assert arrays["f8"].tolist() == [[0, 1, 2], [3, 4, 5]] and not arrays["f8"].flags.writeable
