//! The simplest values of everything but geometry. Each is tried once, by itself.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scene::{Filter, FluxModel, Lens, Material, Mesh, Profile};

use crate::reducer::Reducer;
use crate::reduction::Reduction;

/// Reflectivity of the default ground, `docs/guide/scene.md`.
const GROUND_REFLECTIVITY: f64 = 0.25;

/// Maximum range that exceeds those of rovers, m. It has one binary digit, the fewest possible.
const LONG_RANGE_M: f64 = 1024.0;

/// Tries the simplest flux model, air, lens, ranges, profiles, powers, materials and mesh origin.
pub(super) fn simplify_values(reducer: &mut Reducer<'_>) {
    reducer.stage("simplest values");
    reducer.try_change(|reduction| reduction.flux_model = FluxModel::Radiometric);
    reducer.try_change(|reduction| reduction.atmosphere.attenuation = 0.0);
    // The clear lens, or else its parts.
    if !reducer.try_change(|reduction| reduction.camera.sensor.lens = Lens::CLEAR) {
        reducer.try_change(|reduction| reduction.camera.sensor.lens.filter = Filter::None);
        reducer.try_change(|reduction| reduction.camera.sensor.lens.transmission = 1.0);
    }
    reducer.try_change(|reduction| reduction.camera.sensor.max_range = LONG_RANGE_M);
    for index in 0..reducer.best().beams.len() {
        reducer.try_change(|reduction| reduction.beams[index].sensor.profile = Profile::Paper);
        reducer.try_change(|reduction| reduction.beams[index].sensor.power = 1.0);
        reducer.try_change(|reduction| reduction.beams[index].sensor.max_range = LONG_RANGE_M);
    }
    reducer.try_change(|reduction| {
        let ground = Material { name: "ground".into(), reflectivity: GROUND_REFLECTIVITY };
        remake_mesh(reduction, reduction.mesh.origin(), |_| 0, vec![ground]);
    });
    reducer.try_change(|reduction| {
        // Only materials that a face has.
        let mut used = reduction.mesh.face_materials().to_vec();
        used.sort_unstable();
        used.dedup();
        let materials = used.iter().map(|kind| reduction.mesh.materials()[*kind as usize].clone()).collect();
        let rename = |kind: u16| used.binary_search(&kind).map_or(0, |index| index as u16);
        remake_mesh(reduction, reduction.mesh.origin(), rename, materials);
    });
    reducer.try_change(|reduction| {
        let materials = reduction.mesh.materials().to_vec();
        remake_mesh(reduction, DVec3::ZERO, |kind| kind, materials);
    });
}

/// Replaces origin and materials of the mesh. Nothing changes if they make no valid mesh.
fn remake_mesh(
    reduction: &mut Reduction,
    origin: DVec3,
    kind: impl Fn(u16) -> u16,
    materials: Vec<Material>,
) {
    let old = &reduction.mesh;
    let kinds = old.face_materials().iter().map(|&material| kind(material)).collect();
    let mesh = Mesh::new(origin, old.vertices().to_vec(), old.faces().to_vec(), kinds, materials);
    if let Ok(mesh) = mesh {
        reduction.mesh = Arc::new(mesh);
    }
}
