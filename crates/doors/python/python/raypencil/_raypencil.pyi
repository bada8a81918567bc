"""What the Rust library gives. Not for people: the modules beside it are."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__version__: str

_OnStage = Callable[[str], object] | None
_Path = str | PathLike[str]
_Pairs = Sequence[tuple[str, str]]
_Arrays = dict[str, NDArray[Any]]
_Counts = tuple[int, int, int]
_Decided = tuple[int, int, int]

@final
class MeshCore:
    def __new__(cls, vertices: NDArray[np.float64], faces: NDArray[np.uint32]) -> MeshCore: ...
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    @property
    def zero_area_faces(self) -> int: ...
    @property
    def digests(self) -> list[str]: ...
    def has_tree(self, by_tracer: bool) -> bool: ...
    def build(self, by_tracer: bool, threads: int, on_stage: _OnStage = None) -> None: ...
    def count_open_edges(self) -> int: ...

@final
class SceneCore:
    def __new__(
        cls, source: str, is_text: bool, name: str, settings: _Pairs, on_stage: _OnStage = None
    ) -> SceneCore: ...
    @property
    def name(self) -> str: ...
    @property
    def source_sha256(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def arguments(self) -> str: ...
    @property
    def has_drive(self) -> bool: ...
    @property
    def flux_unit(self) -> str: ...
    @property
    def origin(self) -> NDArray[np.float64]: ...
    @property
    def vehicle(self) -> _Arrays | None: ...
    @property
    def camera(self) -> dict[str, Any]: ...
    @property
    def beams(self) -> list[dict[str, Any]]: ...
    @property
    def ray_sets(self) -> dict[str, dict[str, Any]]: ...
    def mesh(self) -> MeshCore: ...
    def reflectivity(self) -> NDArray[np.float64]: ...

def parse_axis(text: str) -> tuple[str, list[str]]: ...
def refuse_contradictions(settings: list[tuple[str, str]]) -> None: ...

@final
class CampaignCore:
    def __new__(
        cls,
        terrains: int,
        seed: int,
        scenes: _Path | None = None,
        rig: _Path | None = None,
        candidate_command: str | None = None,
        timeout: float | None = None,
        partial: bool = False,
        arithmetic: str | None = None,
        parts: Sequence[str] | None = None,
        max_faces: int | None = None,
    ) -> CampaignCore: ...
    @property
    def terrains(self) -> int: ...
    def shard(self, index: int, count: int, folder: _Path, on_stage: _OnStage = None) -> PathLike[str]: ...
    def has_result(self, index: int, count: int, folder: _Path) -> bool: ...
    def merge(self, folders: Sequence[_Path], output: _Path | None = None) -> tuple[bool, str, str]: ...

@final
class SharedCore:
    def __new__(cls, folder: _Path, force: bool, sweep: tuple[str, str] | None = None) -> SharedCore: ...
    def release(self) -> None: ...

@final
class SweepCore:
    def __new__(
        cls,
        scene: str,
        axes: Sequence[tuple[Sequence[str], Sequence[Sequence[str]]]],
        task: str,
        renderers: Sequence[str],
        as_printed: bool,
    ) -> SweepCore: ...
    @property
    def runs(self) -> int: ...
    def part(self, index: int, count: int, folder: _Path, on_stage: _OnStage = None) -> None: ...
    def has_part(self, index: int, count: int, folder: _Path) -> bool: ...
    def finish(
        self, folders: Sequence[_Path], charts: Sequence[str], output: _Path
    ) -> tuple[bool, str, str, dict[str, list[Any]]]: ...

@final
class ValidationCore:
    @property
    def passes(self) -> bool: ...
    @property
    def renderers(self) -> list[str]: ...
    def json(self) -> str: ...
    def text(self) -> str: ...
    def report(self) -> str: ...
    def maps(self, index: int) -> dict[str, _Arrays]: ...

@final
class DriveCore:
    def __new__(
        cls,
        scene: SceneCore,
        to: Sequence[tuple[float, float]],
        to_global: bool,
        as_printed: bool,
        rules: _Pairs,
        record: Sequence[str],
        names: Sequence[str],
        switches: _Pairs,
        images: bool,
        output: _Path | None = None,
        stripes: tuple[_Path, bool] | None = None,
        force: bool = False,
        on_stage: _OnStage = None,
    ) -> DriveCore: ...
    @property
    def planned(self) -> int: ...
    def next(self) -> dict[str, Any] | None: ...
    def close(self) -> None: ...
    def summary(self) -> tuple[bool, str, str] | None: ...

def load_mesh(path: _Path, on_stage: _OnStage = None) -> MeshCore: ...
def cast(
    mesh: MeshCore,
    rays: NDArray[np.float64],
    shape: tuple[int, ...],
    first: int,
    values: int,
    by_tracer: bool,
    fronts_only: bool,
    any: bool,
    all: bool,
    margins: bool,
    threads: int,
    warn: bool,
    on_stage: _OnStage = None,
) -> tuple[_Arrays, _Counts, _Decided | None, list[str]]: ...
def beam_returns(
    ranges: NDArray[np.float64],
    cosines: NDArray[np.float64],
    weights: Sequence[float],
    beams: Sequence[int],
    keep: str | int,
    separation_m: float,
    light: tuple[float, float],
) -> _Arrays: ...
def check_rays(rays: NDArray[np.float64], first: int) -> None: ...
def cast_warnings(
    mesh: MeshCore, rays: NDArray[np.float64], fronts_only: bool, all: bool, counts: _Counts
) -> list[str]: ...
def judge(
    mesh: MeshCore,
    rays: NDArray[np.float64],
    name: str,
    arithmetic: str,
    fronts_only: bool,
    face: NDArray[np.int64] | None = None,
    t: NDArray[np.float64] | None = None,
    range: NDArray[np.float64] | None = None,
    hit: NDArray[np.bool_] | None = None,
    side: NDArray[np.float64] | None = None,
    point: NDArray[np.float64] | None = None,
    normal: NDArray[np.float64] | None = None,
    barycentric: NDArray[np.float64] | None = None,
    cos_incidence: NDArray[np.float64] | None = None,
    stored: dict[str, NDArray[np.float64]] | None = None,
    on_stage: _OnStage = None,
) -> dict[str, Any]: ...
def render(
    scene: SceneCore,
    name: str,
    switches: _Pairs,
    jitter: int | None = None,
    output: _Path | None = None,
    force: bool = False,
    on_stage: _OnStage = None,
) -> dict[str, _Arrays]: ...
def validate(
    scene: SceneCore,
    names: Sequence[str],
    switches: _Pairs,
    judge_all: bool,
    candidates: Sequence[_Path],
    channels: _Pairs,
    scale: float | None,
    allow_empty: bool,
    output: _Path | None = None,
    force: bool = False,
    on_stage: _OnStage = None,
) -> ValidationCore: ...
def pack_scene(
    scene: SceneCore,
    output: _Path,
    bench: bool,
    version: str | None = None,
    licence: str | None = None,
    force: bool = False,
    on_stage: _OnStage = None,
) -> None: ...
def pack_rays(
    mesh: MeshCore,
    rays: NDArray[np.float64],
    shape: Sequence[int],
    output: _Path,
    fronts_only: bool,
    force: bool = False,
    on_stage: _OnStage = None,
) -> list[str]: ...
def pack_ray_sets(
    mesh: MeshCore,
    rays: _Path,
    output: _Path,
    fronts_only: bool,
    force: bool = False,
    on_stage: _OnStage = None,
) -> list[str]: ...
def check(
    pack: _Path,
    candidate: _Path,
    channels: _Pairs,
    scale: float | None,
    arithmetic: str | None = None,
    miss: float | None = None,
    no_faces: bool = False,
    frame: str | None = None,
    topic: str | None = None,
    message: int | None = None,
    verify: bool = False,
    output: _Path | None = None,
    force: bool = False,
    on_stage: _OnStage = None,
) -> dict[str, Any]: ...
def diff(
    a: _Path,
    b: _Path,
    channels: _Pairs,
    scale: float | None,
    fail: float,
    fail_relative: float,
    fail_ulp: float,
    fail_percent: float,
    hard_fail: float | None,
    shared_only: bool,
    scene: SceneCore | None = None,
    arithmetic: str | None = None,
    output: _Path | None = None,
    force: bool = False,
    on_stage: _OnStage = None,
) -> tuple[bool, str, str]: ...
def read_recording(
    path: _Path,
    channels: _Pairs,
    scale: float | None,
    on_stage: _OnStage = None,
) -> _Arrays: ...
def generate_ground(
    preset: str,
    seed: int,
    extent: float | None = None,
    post_spacing: float | None = None,
    fine_radius: float | None = None,
    rock_coverage: float | None = None,
    rock_smallest: float | None = None,
    crevasses: int | None = None,
    coarse: _Path | None = None,
    on_stage: _OnStage = None,
) -> MeshCore: ...
def picture(map: NDArray[np.float64], max_side: int, light: bool) -> bytes: ...
def command(arguments: Sequence[str]) -> int: ...
