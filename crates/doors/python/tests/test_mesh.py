"""Meshes: what is taken, what is refused, and with which words."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DATA

import raypencil
from raypencil import Mesh, RaypencilError

VERTICES = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]


def test_arrays_of_other_types_and_strides_give_the_same_mesh() -> None:
    wide = np.zeros((3, 6), dtype=np.float32)
    wide[:, ::2] = VERTICES
    kinds: list[tuple[Any, Any]] = [
        (VERTICES, [[0, 1, 2]]),
        (wide[:, ::2], np.array([[0, 1, 2]], dtype=np.uint16)),
        (np.asfortranarray(VERTICES), np.asfortranarray([[0, 1, 2]], dtype=np.int64)),
        (np.array(VERTICES)[::-1][::-1], np.array([[2, 1, 0]])[:, ::-1]),
        (np.array(VERTICES, dtype=int), np.array([[0, 1, 2]], dtype=">i4")),
    ]
    for vertices, faces in kinds:
        mesh = Mesh(vertices, faces)
        assert mesh.vertices.tolist() == VERTICES and mesh.vertices.dtype == np.float64
        assert mesh.faces.tolist() == [[0, 1, 2]] and mesh.faces.dtype == np.uint32


def test_arrays_that_may_not_be_written_are_taken_and_given() -> None:
    vertices = np.array(VERTICES)
    vertices.flags.writeable = False
    mesh = Mesh(vertices, [[0, 1, 2]])
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 1
    with pytest.raises(ValueError, match="read-only"):
        mesh.faces[0, 0] = 1
    # It is no way around it either.
    with pytest.raises(ValueError, match="WRITEABLE|writeable"):
        mesh.vertices.flags.writeable = True


def test_a_mesh_does_not_follow_the_arrays_that_it_was_made_of() -> None:
    vertices = np.array(VERTICES)
    mesh = Mesh(vertices, [[0, 1, 2]])
    vertices[1, 0] = 99
    assert mesh.vertices[1, 0] == 4


def test_the_arrays_outlive_the_mesh_and_are_no_copies() -> None:
    mesh = Mesh(np.arange(30_000, dtype=float).reshape(-1, 3), [[0, 1, 2]])
    vertices, again = mesh.vertices, mesh.vertices
    assert vertices.__array_interface__["data"] == again.__array_interface__["data"]
    del mesh, again
    assert vertices[9_999].tolist() == [29_997, 29_998, 29_999]


@pytest.mark.parametrize(
    ("vertices", "faces", "words"),
    [
        # The engine's own words.
        ([[0, 0, 0], [1, 0, np.nan], [0, 1, 0]], [[0, 1, 2]], r"vertices\[1\] is \(1, 0, NaN\): expected three finite"),
        ([[0, 0, 0], [1, 0, 0], [0, 1e31, 0]], [[0, 1, 2]], r"vertices\[2\]"),
        (VERTICES, [[0, 1, 2], [0, 3, 1]], r"faces\[1\] is \[0, 3, 1\]: expected three vertex indices below 3"),
        # Those of the package.
        (VERTICES, [[0, 1, -2]], r"faces\[0\] is \[0, 1, -2\]"),
        (VERTICES, [[0, 1, 2**32]], r"faces\[0\]"),
        (VERTICES, [[0.0, 1.0, 2.0]], r"faces is of type float64; expected integers"),
        (VERTICES, [[0, 1]], r"faces has the shape \(1, 2\); expected \(m, 3\)"),
        ([[0, 0], [1, 0]], [[0, 1, 1]], r"vertices has the shape \(2, 2\); expected \(n, 3\)"),
        (np.array(VERTICES) * 1j, [[0, 1, 2]], r"vertices is of type complex128"),
        ([["a", "b", "c"]], [[0, 0, 0]], r"vertices is of type <U1"),
    ],
)
def test_what_is_wrong_is_named(vertices: object, faces: object, words: str) -> None:
    with pytest.raises(RaypencilError, match=words):
        Mesh(vertices, faces)  # type: ignore[arg-type]


def test_a_mesh_may_be_empty() -> None:
    mesh = Mesh([], [])
    assert mesh.vertices.shape == (0, 3) and mesh.faces.shape == (0, 3) and mesh.bounds is None
    assert not raypencil.cast(mesh, [[0, 0, 0]], [[0, 0, 1]]).hit.any()


def test_pickles_are_the_same_mesh(cube: Mesh) -> None:
    again = pickle.loads(pickle.dumps(cube))
    assert again.vertices.tolist() == cube.vertices.tolist() and again.faces.tolist() == cube.faces.tolist()


def test_a_saved_mesh_is_loaded_again(cube: Mesh, tmp_path: Path) -> None:
    cube.save(tmp_path / "mesh")
    again = raypencil.load(tmp_path / "mesh")
    assert isinstance(again, Mesh)
    assert again.vertices.tobytes() == cube.vertices.tobytes() and again.faces.tolist() == cube.faces.tolist()


def test_load_tells_meshes_from_scenes() -> None:
    meshes: list[str | Path] = [DATA / "rays/cube.obj", DATA / "packs/hard/terrain.glb", str(DATA / "scenes/ramp.gltf")]
    for mesh in meshes:
        assert isinstance(raypencil.load(mesh), Mesh), mesh
    scenes: list[str | Path] = ["facets", DATA / "scenes/ramp.toml"]
    for scene in scenes:
        assert isinstance(raypencil.load(scene), raypencil.Scene), scene


def test_files_that_are_not_there_are_not_found(tmp_path: Path) -> None:
    for name in ["none.obj", "none.toml", "none.glb"]:
        with pytest.raises(FileNotFoundError, match=name) as caught:
            raypencil.load(tmp_path / name)
        assert isinstance(caught.value, RaypencilError) and isinstance(caught.value, ValueError)


def test_a_broken_file_is_refused_with_its_place(tmp_path: Path) -> None:
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0 x\n")
    with pytest.raises(RaypencilError, match=r"bad.obj.*2"):
        raypencil.load(tmp_path / "bad.obj")


def test_the_cube_is_where_its_file_says(cube: Mesh) -> None:
    assert cube.bounds is not None
    assert cube.bounds.tolist() == [[-1, -1, -1], [1, 1, 1]] and cube.zero_area_faces == 0


def test_what_other_packages_have_is_a_mesh(cube: Mesh) -> None:
    class Of:
        """Something with these attributes."""

        def __init__(self, **attributes: Any) -> None:
            self.__dict__.update(attributes)

    class Tensor:
        """As one of Open3D."""

        def __init__(self, values: Any) -> None:
            self.values = values

        def cpu(self) -> Tensor:
            return self

        def numpy(self) -> Any:
            return np.asarray(self.values)

    expected = raypencil.cast(cube, [0.25, 0.5, 3], [0, 0, -2]).t
    vertices, faces = cube.vertices, cube.faces
    same: list[Any] = [
        (vertices, faces),
        [vertices.tolist(), faces.tolist()],
        Of(vertices=vertices, faces=faces, triangles=vertices[faces]),
        Of(vertices=vertices, triangles=faces.astype(np.int32)),
        Of(vertex={"positions": Tensor(vertices)}, triangle={"indices": Tensor(faces.astype(np.int64))}),
    ]
    for mesh in same:
        assert raypencil.cast(mesh, [0.25, 0.5, 3], [0, 0, -2]).t == expected == 1.0
    with pytest.raises(RaypencilError, match=r"mesh is of type tuple; expected a Mesh, \(vertices, faces\)"):
        raypencil.cast((vertices, faces, faces), [0, 0, 0], [0, 0, 1])


def test_tensors_are_taken_by_dlpack_without_a_copy() -> None:
    class Tensor:
        """Gives its memory by DLPack alone, as a tensor of another package."""

        def __init__(self, array: Any, error: Exception | None = None) -> None:
            self.array, self.error = array, error

        def __dlpack__(self, **options: Any) -> Any:
            if self.error:
                raise self.error
            return self.array.__dlpack__(**options)

        def __dlpack_device__(self) -> Any:
            return self.array.__dlpack_device__()

    from raypencil import _arrays

    numbers = np.arange(12.0).reshape(4, 3)
    assert np.shares_memory(_arrays.reals("x", Tensor(numbers)), numbers)
    mesh = Mesh(Tensor(np.array(VERTICES)), Tensor(np.array([[0, 1, 2]])))  # type: ignore[arg-type]
    origins = np.array([[1, 1, 3], [9, 9, 3]], dtype=np.float32)
    answers = raypencil.cast(mesh, Tensor(origins), Tensor(np.array([0.0, 0.0, -2.0])))  # type: ignore[arg-type]
    assert answers.t.tolist() == [1.5, np.inf]
    wrong = Tensor(numbers, BufferError("it needs a gradient"))
    with pytest.raises(RaypencilError, match=r"origins is a .*Tensor that is no array here \(it needs a gradient\); .*detach"):
        raypencil.cast(mesh, wrong, [0, 0, 1])  # type: ignore[arg-type]


def test_open_edges_are_counted(cube: Mesh) -> None:
    assert cube.open_edges == 0 and Mesh(VERTICES, [[0, 1, 2]]).open_edges == 3
