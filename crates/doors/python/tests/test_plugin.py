"""The plugin of pytest: what it hands to tests, and how it fails them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA

import raypencil
from raypencil import testing


def test_hard_rays_come_with_the_package() -> None:
    families = testing.hard_rays()
    told = {one["name"]: one["rays"] for one in json.loads((DATA / "rays/hard/families.json").read_text())}
    assert {name: len(hard.rays) for name, hard in families.items()} == told and len(told) > 10
    assert {path.name for path in (DATA / "rays/hard").iterdir() if path.is_dir()} == set(families)
    hard = families["on-surface"]
    assert hard.rays.shape[1] == 8 and hard.what and hard.goes_wrong and str(hard) == "on-surface"
    answers = raypencil.cast(hard.mesh, hard.rays)
    for name, array in hard.answers.items():
        if name in answers.arrays:
            assert np.array_equal(answers.arrays[name], array, equal_nan=True), name
    assert np.isfinite(hard.t_max).any() and (hard.t_min > 0).any()


def test_packs_are_found() -> None:
    packs = testing.packs_in(DATA / "packs")
    # The input pack asks for triangles, not for rays.
    assert set(packs) - {"input"} == {"facets", "hard", "pyramids"} and list(testing.packs_in(DATA / "packs/hard")) == ["hard"]


SUITE = """
import numpy as np
import raypencil

def test_right(hard_rays, raypencil_check):
    raypencil_check(hard_rays, raypencil.cast(hard_rays.mesh, hard_rays.rays, with_="tracer"))

def test_wrong(hard_rays, raypencil_check):
    answers = raypencil.cast(hard_rays.mesh, hard_rays.origins, hard_rays.directions, t_min=hard_rays.t_min)
    raypencil_check(hard_rays, {"t": answers.range})

def test_pack(raypencil_pack, raypencil_check):
    scene = raypencil.Scene(raypencil_pack / "scene.toml")
    raypencil_check(raypencil_pack, raypencil.render(scene, "tracer"))

def test_wrong_pack(raypencil_packs, raypencil_check):
    scene = raypencil.Scene(raypencil_packs["hard"] / "scene.toml")
    arrays = raypencil.render(scene, "tracer").arrays
    raypencil_check(raypencil_packs["hard"], {key: array[::-1] for key, array in arrays.items()}, name="flipped")
"""


def test_tests_get_hard_rays_and_fail_with_reasons(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(SUITE)
    result = pytester.runpytest_subprocess("-k", "edges or vertices or pack", f"--raypencil-packs={DATA / 'packs/hard'}")
    outcomes = result.parseoutcomes()
    assert outcomes["passed"] == 3 and outcomes["failed"] == 3, result.stdout.str()
    result.stdout.fnmatch_lines_random(
        [
            "*edges: Rays exactly through edges that two faces of a closed mesh share.*",
            "*Why: 100.0000 % agree if t.npy holds the range*",
            "*rays are wrong*",
            "*report: *raypencil-reports*test_wrong-edges*report.html",
            "*report: *raypencil-reports*test_wrong_pack*report.html",
        ]
    )
    assert (pytester.path / "raypencil-reports/test_wrong-edges/report.html").is_file()
    assert (pytester.path / "raypencil-reports/test_wrong_pack/report.html").is_file()
    # What fails is not shown twice: no lines of the plugin itself.
    result.stdout.no_fnmatch_line("*pytest_plugin.py*")


def test_without_packs_tests_are_skipped(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(SUITE)
    result = pytester.runpytest_subprocess("-k", "test_pack or test_wrong_pack")
    assert result.parseoutcomes()["skipped"] == 2
    result = pytester.runpytest_subprocess("--raypencil-packs=nowhere")
    result.stdout.fnmatch_lines(["*no reference packs there*"])


def test_folders_may_stand_in_the_settings(pytester: pytest.Pytester) -> None:
    pytester.makeini(f"[pytest]\nraypencil_packs = {DATA / 'packs/hard'}\nraypencil_reports = reports\n")
    pytester.makepyfile(SUITE)
    result = pytester.runpytest_subprocess("-k", "test_pack or test_wrong_pack")
    assert result.parseoutcomes()["passed"] == 1 and (pytester.path / "reports/test_wrong_pack/report.html").is_file()


def test_assertions_work_without_pytest(tmp_path: Path) -> None:
    hard = testing.hard_rays()["edges"]
    assert testing.assert_answers(hard, {"t": hard.answers["t"]}, reports=tmp_path / "none").passes
    assert not (tmp_path / "none").exists()
    with pytest.raises(AssertionError, match="report.html"):
        testing.assert_answers(hard, {"t": np.full(len(hard.rays), 2.0)}, reports=tmp_path / "some")
    assert (tmp_path / "some/report.html").is_file() and (tmp_path / "some/pack/raypack.json").is_file()
