"""VTK's locators, which PyVista calls too. They take segments, and a tolerance, which is 0 here."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from ..._mesh import Mesh
from .._peer import Built, Hits, Peer, Rays, hits, need, segment_length


_TOLERANCE = "give a tolerance of about 1e-12 of the mesh's width, as in the row *with tolerance*: then rays through edges are stopped"


_LONGER = "give longer segments"

#: The cause of what an OBB tree loses on wide meshes, whoever asks it.
_LARGE_BOXES = (
    "`vtkOBBTree::ComputeOBB` measures along axes 1 long by `vtkLine::DistanceToLine` (Common/DataModel/vtkLine.cxx), which answers"
    " `VTK_DOUBLE_MAX` from 1e+05 on: boxes of a mesh that reaches farther from its middle are as large as that, and drop all rays or none."
)

_BESIDE_EDGES = (
    "`vtkTriangle::IntersectWithLine` (Common/DataModel/vtkTriangle.cxx) rounds the point on the plane, and then asks whether it is"
    " within the tolerance of the triangle: beside an edge it may be in neither face."
)


class VtkObbTree(Peer):
    """`vtkOBBTree`, by the call that all locators have."""

    name, title, package = "vtk-obb", "VTK, OBB tree", "vtk"
    arithmetic = mesh_type = rays_type = "f64"
    is_segment = True
    meets_in_plane = True
    conventions: ClassVar[tuple[str, ...]] = ("It takes a tolerance, which is 0 here.",)
    causes: ClassVar[tuple[str, ...]] = (_BESIDE_EDGES, _LARGE_BOXES)
    advice: ClassVar[tuple[str, ...]] = (_TOLERANCE,)
    # On wide meshes it helps too.
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {("scale", "above"): _TOLERANCE}
    kind = "vtkOBBTree"
    #: In widths of the mesh.
    tolerance = 0.0

    def build(self, mesh: Mesh) -> Built:
        vtk = need("vtkmodules.all", self.package)
        support = need("vtkmodules.util.numpy_support", self.package)
        points, cells, data = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
        points.SetData(support.numpy_to_vtk(np.array(mesh.vertices), deep=True))
        counts = np.arange(0, 3 * len(mesh.faces) + 1, 3, dtype=np.int64)
        flat = mesh.faces.astype(np.int64).ravel()
        kind = vtk.VTK_ID_TYPE
        cells.SetData(
            support.numpy_to_vtk(counts, deep=True, array_type=kind), support.numpy_to_vtk(flat, deep=True, array_type=kind)
        )
        data.SetPoints(points)
        data.SetPolys(cells)
        locator = getattr(vtk, self.kind)()
        locator.SetDataSet(data)
        locator.BuildLocator()
        tolerance = self.tolerance * float(np.ptp(mesh.vertices, axis=0).max())
        return vtk, locator, data, np.array(mesh.vertices), tolerance

    def shoot(self, built: Built, rays: Rays) -> Hits:
        vtk, locator, _, vertices, tolerance = built
        length = segment_length(vertices, rays)
        ends = rays[:, 0:3] + length[:, None] * rays[:, 3:6]
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        at, point, weights, part, cell = vtk.reference(0.0), [0.0] * 3, [0.0] * 3, vtk.reference(0), vtk.reference(-1)
        any_cell = vtk.vtkGenericCell()
        for k in range(len(rays)):
            start, end = rays[k, 0:3].tolist(), ends[k].tolist()
            if locator.IntersectWithLine(start, end, tolerance, at, point, weights, part, cell, any_cell):
                face[k], t[k] = cell.get(), at.get() * length[k]
        return hits(face, t, rays)

    def all(self, mesh: Mesh, rays: Rays) -> list[list[tuple[int, float]]] | None:
        vtk, locator, _, vertices, tolerance = self.build(mesh)
        ends = rays[:, 0:3] + segment_length(vertices, rays)[:, None] * rays[:, 3:6]
        points, cells = vtk.vtkPoints(), vtk.vtkIdList()
        points.SetDataTypeToDouble()
        told = []
        for ray, end in zip(rays, ends, strict=True):
            locator.IntersectWithLine(ray[0:3].tolist(), end.tolist(), tolerance, points, cells)
            axis = int(np.argmax(np.abs(ray[3:6])))
            ts = [(points.GetPoint(k)[axis] - ray[axis]) / ray[3 + axis] for k in range(points.GetNumberOfPoints())]
            told.append(sorted(((cells.GetId(k), float(t)) for k, t in enumerate(ts)), key=lambda hit: hit[1]))
        return told


class VtkObbTreeAll(VtkObbTree):
    """`vtkOBBTree`, by its own call for all points on a line, as `pyvista.PolyData.ray_trace` has it."""

    name, title = "vtk-obb-all", "VTK, OBB tree, as PyVista asks it"
    conventions = ("It tells points and faces, and no t; t is that of the first point, in double precision here and in single in PyVista.",)
    causes = (
        "Its test of triangles (`vtkOBBTreeLineIntersectsTriangle`, Filters/General/vtkOBBTree.cxx) counts a point on an edge to none of the"
        " faces beside it, and takes unit normal times segment of 1e-06 or less for 0. Its tolerance is 0, and since VTK 9.7 `SetTolerance`"
        " changes nothing; 9.6 took the tree's own tolerance, which met the edge unless it was set to 0.",
        _LARGE_BOXES,
    )
    advice = ("ask VTK's static cell locator with a tolerance instead",)
    remedies: ClassVar[Mapping[tuple[str, str], str]] = {("scale", "below"): _LONGER, ("angle", "below"): _LONGER}

    def shoot(self, built: Built, rays: Rays) -> Hits:
        vtk, locator, _, vertices, _ = built
        ends = rays[:, 0:3] + segment_length(vertices, rays)[:, None] * rays[:, 3:6]
        face, t = np.full(len(rays), -1), np.full(len(rays), np.inf)
        points, cells = vtk.vtkPoints(), vtk.vtkIdList()
        points.SetDataTypeToDouble()
        for k, ray in enumerate(rays):
            locator.IntersectWithLine(ray[0:3].tolist(), ends[k].tolist(), points, cells)
            if cells.GetNumberOfIds():
                axis = int(np.argmax(np.abs(ray[3:6])))
                face[k], t[k] = cells.GetId(0), (points.GetPoint(0)[axis] - ray[axis]) / ray[3 + axis]
        return hits(face, t, rays)


class VtkCellLocator(VtkObbTree):
    """`vtkCellLocator`."""

    name, title, kind = "vtk-cells", "VTK, cell locator", "vtkCellLocator"
    causes = (_BESIDE_EDGES,)


class VtkStaticCellLocator(VtkObbTree):
    """`vtkStaticCellLocator`."""

    name, title, kind = "vtk-static", "VTK, static cell locator", "vtkStaticCellLocator"
    causes: ClassVar[tuple[str, ...]] = (_BESIDE_EDGES,)


class VtkTolerance(VtkStaticCellLocator):
    """`vtkStaticCellLocator` with a tolerance of 1e-12 of the mesh's width."""

    name, title = "vtk-tolerance", "VTK, static cell locator, with tolerance"
    conventions = ("Its tolerance is 1e-12 of the mesh's width here.",)
    causes = ()
    advice = ()
    tolerance = 1e-12


class VtkBspTree(VtkObbTree):
    """`vtkModifiedBSPTree`."""

    name, title, kind = "vtk-bsp", "VTK, BSP tree", "vtkModifiedBSPTree"
    causes = (_BESIDE_EDGES,)


class VtkCellTree(VtkObbTree):
    """`vtkCellTreeLocator`."""

    name, title, kind = "vtk-cell-tree", "VTK, cell tree", "vtkCellTreeLocator"
    causes = (_BESIDE_EDGES,)
