//! The whole scene file of a rig on a ground.

use serde::Deserialize;
use toml::Spanned;

use crate::drive::read::DriveKeys;
use crate::parse::camera::CameraKeys;
use crate::parse::key::Key;
use crate::parse::rays::RaysKeys;
use crate::parse::rig::{BeamKeys, VehicleKeys};
use crate::parse::source::Source;
use crate::parse::terrain::TerrainKeys;
use crate::plan::{ScenePlan, Terrain, default_rig};
use crate::resolve::mounted_rig;
use crate::scene_error::SceneIoError;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneKeys {
    #[allow(dead_code, reason = "checked before; named here so that it is a known key")]
    version: Key<i64>,
    #[serde(default)]
    vehicle: VehicleKeys,
    #[serde(default)]
    camera: CameraKeys,
    beam: Option<Vec<BeamKeys>>,
    terrain: Key<TerrainKeys>,
    #[serde(default)]
    atmosphere: AtmosphereKeys,
    #[serde(default)]
    flux: FluxKeys,
    drive: Option<DriveKeys>,
    rays: Option<Vec<Spanned<RaysKeys>>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct AtmosphereKeys {
    attenuation_per_m: Key<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct FluxKeys {
    model: Key<String>,
}

/// Reads a scene file whose kind is [`crate::parse::kind::Kind::Rig`].
pub(crate) fn parse(source: &Source) -> Result<ScenePlan, SceneIoError> {
    let keys: SceneKeys = source.deserialize()?;
    let mut plan = default_rig(Terrain::Builtin("pyramids".to_string()));
    source.vehicle(&keys.vehicle, &mut plan)?;
    plan.camera_digest = source.camera(&keys.camera, &mut plan.camera)?;
    if let Some(beams) = &keys.beam {
        let build = |(index, keys)| source.beam(index, keys);
        plan.beams = beams.iter().enumerate().map(build).collect::<Result<_, _>>()?;
    }
    if let Some(terrain) = &keys.terrain {
        plan.terrain_span = terrain.span();
        source.terrain(terrain, &mut plan)?;
    }
    let name = "atmosphere.attenuation_per_m";
    let attenuation = &keys.atmosphere.attenuation_per_m;
    source.number(attenuation, name, &mut plan.attenuation, 0.0..=1e3, "per metre")?;
    if let Some(model) = &keys.flux.model {
        plan.flux_model = source.flux_model(model)?;
    }
    if let Some(tables) = &keys.rays {
        (plan.ray_sets, plan.ray_digests) = source.ray_sets(tables)?;
    }
    if let Some(keys) = &keys.drive {
        let (drive, kernel_digests) = source.drive(keys, mounted_rig(&plan))?;
        (plan.drive, plan.kernel_digests) = (Some(drive), kernel_digests);
    }
    Ok(plan)
}
