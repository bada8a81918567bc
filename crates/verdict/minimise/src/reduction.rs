//! A scene being reduced: its parts, which can be changed one by one and put together again.

use std::sync::Arc;

use raypencil_scene::{
    Atmosphere, Beam, Camera, FluxModel, Mesh, Mounted, Place, Pose, Scene, SceneError, SensorId,
};

/// The parts of a scene, and the ray in question.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Reduction {
    pub(super) mesh: Arc<Mesh>,
    pub(super) camera: Mounted<Camera>,
    pub(super) beams: Vec<Mounted<Beam>>,
    pub(super) atmosphere: Atmosphere,
    pub(super) flux_model: FluxModel,
    pub(super) place: Option<Place>,
}

impl Reduction {
    /// The parts of `scene`, with the ray in question.
    pub(super) fn of(scene: &Scene, place: Option<Place>) -> Self {
        Self {
            mesh: Arc::clone(scene.mesh()),
            camera: *scene.camera(),
            beams: scene.beams().to_vec(),
            atmosphere: scene.atmosphere(),
            flux_model: scene.flux_model(),
            place,
        }
    }

    /// The scene of these parts.
    ///
    /// # Errors
    /// Parts that do not make a valid scene.
    pub(super) fn scene(&self) -> Result<Scene, SceneError> {
        let mesh = Arc::clone(&self.mesh);
        Scene::new(mesh, self.camera, self.beams.clone(), self.atmosphere, self.flux_model)
    }

    /// A copy with the faces `kept` of the mesh, in this order, and with the vertices that they use.
    pub(super) fn with_faces(&self, kept: &[u32]) -> Self {
        let old = &self.mesh;
        let mut is_used = vec![false; old.vertices().len()];
        for &face in kept {
            old.faces()[face as usize].iter().for_each(|&vertex| is_used[vertex as usize] = true);
        }
        let mut renamed = vec![0; is_used.len()];
        let mut vertices = Vec::new();
        for (index, _) in is_used.iter().enumerate().filter(|(_, is_used)| **is_used) {
            renamed[index] = vertices.len() as u32;
            vertices.push(old.vertices()[index]);
        }
        let faces = kept.iter().map(|&face| old.faces()[face as usize].map(|v| renamed[v as usize]));
        let kinds = kept.iter().map(|&face| old.face_materials()[face as usize]);
        let mesh =
            Mesh::new(old.origin(), vertices, faces.collect(), kinds.collect(), old.materials().to_vec());
        Self { mesh: Arc::new(mesh.expect("a part of a mesh is a mesh")), ..self.clone() }
    }

    /// A copy with moved vertices. `None`: the mesh becomes invalid.
    pub(super) fn with_vertices(&self, mut moved: impl FnMut(usize, [f32; 3]) -> [f32; 3]) -> Option<Self> {
        let old = &self.mesh;
        let vertices = old.vertices().iter().enumerate().map(|(index, &at)| moved(index, at)).collect();
        let (faces, kinds) = (old.faces().to_vec(), old.face_materials().to_vec());
        let mesh = Mesh::new(old.origin(), vertices, faces, kinds, old.materials().to_vec()).ok()?;
        Some(Self { mesh: Arc::new(mesh), ..self.clone() })
    }

    /// Pose of the sensor of the ray in question; without such a ray, of the camera.
    pub(super) fn pose(&self) -> Pose {
        match self.place.map(|place| place.sensor) {
            Some(SensorId::Beam(index)) if index < self.beams.len() => self.beams[index].scene_from_sensor,
            _ => self.camera.scene_from_sensor,
        }
    }

    /// The poses of the camera and of each beam.
    pub(super) fn poses_mut(&mut self) -> impl Iterator<Item = &mut Pose> {
        let beams = self.beams.iter_mut().map(|beam| &mut beam.scene_from_sensor);
        std::iter::once(&mut self.camera.scene_from_sensor).chain(beams)
    }
}
