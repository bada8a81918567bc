//! Triangles from arrays and files.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use numpy::ndarray::ArrayView2;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use raypencil::cast::open_edges;
use raypencil::io::{hex_digits, read_triangles};
use raypencil::referee::{CastTree, ExactCast};
use raypencil::tracer::TracerCast;
use raypencil::{Progress, Scene, Triangles};

use crate::failure::Failure;
use crate::watch::{on_threads, watched};

/// Triangles, and what is made of them once.
#[pyclass(frozen, module = "raypencil._raypencil")]
#[derive(Debug, Clone)]
pub(crate) struct MeshCore {
    pub(crate) triangles: Arc<Triangles>,
    /// The referee's tree; made when it is first needed, and kept.
    exact: Arc<OnceLock<CastTree>>,
    /// The tracer's.
    tracer: Arc<OnceLock<TracerCast>>,
    /// Number of open edges; counted when it is first needed.
    open_edges: Arc<OnceLock<u64>>,
    /// SHA-256 of the files that it was read from.
    digests: Vec<String>,
}

impl MeshCore {
    pub(crate) fn from_triangles(triangles: Triangles) -> Self {
        Self {
            triangles: Arc::new(triangles),
            exact: Arc::default(),
            tracer: Arc::default(),
            open_edges: Arc::default(),
            digests: Vec::new(),
        }
    }

    /// The terrain of a scene, in the scene frame.
    pub(crate) fn of_scene(scene: &Scene) -> Self {
        Self::from_triangles(Triangles::from(scene.mesh().as_ref()))
    }

    /// The referee on this mesh.
    pub(crate) fn exact(&self) -> ExactCast<'_> {
        self.exact.get_or_init(|| CastTree::new(&self.triangles)).cast()
    }

    /// The tracer on this mesh.
    pub(crate) fn tracer(&self) -> &TracerCast {
        self.tracer.get_or_init(|| TracerCast::new(&self.triangles))
    }

    /// Whether the tree of one of them is built.
    pub(crate) fn is_built(&self, by_tracer: bool) -> bool {
        if by_tracer { self.tracer.get().is_some() } else { self.exact.get().is_some() }
    }

    /// Builds the tree of one of them, if it is not built.
    pub(crate) fn build_tree(&self, by_tracer: bool, progress: &dyn Progress) {
        if !self.is_built(by_tracer) {
            progress.stage(&format!("building a tree of {} faces", self.triangles.faces().len()));
            if by_tracer {
                self.tracer();
            } else {
                self.exact();
            }
        }
    }

    /// Number of edges that are not run through once in each direction.
    pub(crate) fn open_edges(&self) -> u64 {
        *self.open_edges.get_or_init(|| open_edges(&self.triangles))
    }
}

#[pymethods]
impl MeshCore {
    #[new]
    fn new(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        faces: PyReadonlyArray2<'_, u32>,
    ) -> PyResult<Self> {
        let vertices = vertices.as_array().rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect();
        let faces = faces.as_array().rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect();
        let made = py.detach(|| Triangles::new(vertices, faces));
        made.map(Self::from_triangles).map_err(|error| Failure::from(error).into_exception(py))
    }

    /// The vertices, (N, 3), as they lie in memory.
    #[allow(unsafe_code, reason = "an array of NumPy on memory that this object owns")]
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let cells = slf.get().triangles.vertices();
        let view = ArrayView2::from_shape((cells.len(), 3), cells.as_flattened());
        let view = view.map_err(|error| Failure::from(error).into_exception(slf.py()))?;
        // SAFETY: the numbers belong to this object, which the array keeps alive, and which never changes them.
        let array = unsafe { PyArray2::borrow_from_array(&view, slf.as_any().clone()) };
        Ok((*array.readwrite().make_nonwriteable()).clone())
    }

    /// The faces, (M, 3), as they lie in memory.
    #[allow(unsafe_code, reason = "an array of NumPy on memory that this object owns")]
    #[getter]
    fn faces<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let cells = slf.get().triangles.faces();
        let view = ArrayView2::from_shape((cells.len(), 3), cells.as_flattened());
        let view = view.map_err(|error| Failure::from(error).into_exception(slf.py()))?;
        // SAFETY: as for the vertices.
        let array = unsafe { PyArray2::borrow_from_array(&view, slf.as_any().clone()) };
        Ok((*array.readwrite().make_nonwriteable()).clone())
    }

    #[getter]
    fn zero_area_faces(&self) -> usize {
        self.triangles.zero_area_faces()
    }

    /// Whether the tree of the tracer, or else that of the referee, is built.
    fn has_tree(&self, by_tracer: bool) -> bool {
        self.is_built(by_tracer)
    }

    /// Builds one of the trees, if it is not built.
    #[pyo3(signature = (by_tracer, threads, on_stage=None))]
    fn build(
        &self,
        py: Python<'_>,
        by_tracer: bool,
        threads: usize,
        on_stage: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let mesh = self.clone();
        watched(py, on_stage, move |watch| on_threads(threads, || mesh.build_tree(by_tracer, watch)))
    }

    /// Number of edges that are not run through once in each direction: 0 if the mesh is closed.
    fn count_open_edges(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.open_edges())
    }

    #[getter]
    fn digests(&self) -> Vec<String> {
        self.digests.clone()
    }
}

/// Reads the triangles of a file.
#[pyfunction]
#[pyo3(signature = (path, on_stage=None))]
pub(crate) fn load_mesh(
    py: Python<'_>,
    path: PathBuf,
    on_stage: Option<&Bound<'_, PyAny>>,
) -> PyResult<MeshCore> {
    watched(py, on_stage, move |_| {
        let read = read_triangles(&path)?;
        let digests = read.digests.iter().map(hex_digits).collect();
        Ok(MeshCore { digests, ..MeshCore::from_triangles(read.triangles) })
    })
}
