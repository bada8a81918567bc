//! The plainest values of what is not geometry: each is tried once by itself.

use glam::DVec3;
use std::sync::Arc;

use crate::draft::Draft;
use crate::trials::Trials;
use raypencil_scene::{Filter, FluxModel, Lens, Material, Mesh, Profile};

/// The reflectivity of the default ground, `docs/guide/scene.md`.
const REFLECTIVITY: f64 = 0.25;

/// Farther than rovers see, metres; one binary digit, so that it is as short as can be.
const FAR: f64 = 1024.0;

pub(super) fn plainest(trials: &mut Trials<'_>) {
    trials.stage("plain values");
    trials.change(|draft| draft.flux_model = FluxModel::Radiometric);
    trials.change(|draft| draft.atmosphere.attenuation = 0.0);
    // The whole lens, or as much of it as can be.
    if !trials.change(|draft| draft.camera.sensor.lens = Lens::CLEAR) {
        trials.change(|draft| draft.camera.sensor.lens.filter = Filter::None);
        trials.change(|draft| draft.camera.sensor.lens.transmission = 1.0);
    }
    trials.change(|draft| draft.camera.sensor.max_range = FAR);
    for index in 0..trials.best().beams.len() {
        trials.change(|draft| draft.beams[index].sensor.profile = Profile::Paper);
        trials.change(|draft| draft.beams[index].sensor.power = 1.0);
        trials.change(|draft| draft.beams[index].sensor.max_range = FAR);
    }
    trials.change(|draft| {
        let ground = Material { name: "ground".into(), reflectivity: REFLECTIVITY };
        remade(draft, draft.mesh.origin(), |_| 0, vec![ground]);
    });
    trials.change(|draft| {
        // Only the materials that a face has.
        let mut used = draft.mesh.face_materials().to_vec();
        used.sort_unstable();
        used.dedup();
        let materials = used.iter().map(|kind| draft.mesh.materials()[*kind as usize].clone()).collect();
        let rename = |kind: u16| used.binary_search(&kind).map_or(0, |index| index as u16);
        remade(draft, draft.mesh.origin(), rename, materials);
    });
    trials.change(|draft| {
        let materials = draft.mesh.materials().to_vec();
        remade(draft, DVec3::ZERO, |kind| kind, materials);
    });
}

/// Gives a draft's mesh another origin and other materials.
fn remade(draft: &mut Draft, origin: DVec3, kind: impl Fn(u16) -> u16, materials: Vec<Material>) {
    let old = &draft.mesh;
    let kinds = old.face_materials().iter().map(|&material| kind(material)).collect();
    let mesh = Mesh::new(origin, old.vertices().to_vec(), old.faces().to_vec(), kinds, materials);
    if let Ok(mesh) = mesh {
        draft.mesh = Arc::new(mesh);
    }
}
