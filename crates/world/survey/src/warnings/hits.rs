//! Rules on what the rays of a sensor meet.

use raypencil_report::{count, counted, number};
use raypencil_scanline::Scanline;
use raypencil_scene::{Quantities, Renderer, Request, Scene, SensorId, SensorMap};

use crate::facing::Facing;
use crate::warning::{Warning, WarningCode};

/// Smallest share of a sensor's rays that should hit, tuned. A camera that looks along the horizon still has a tenth of
/// its image on the ground; under a hundredth the sensor looks past the terrain.
const MIN_HIT_SHARE: f64 = 0.01;

/// Largest share of backs among the rays that meet a face, tuned: one half. An overhang or a gap shows some backs, and
/// a terrain with reversed faces shows nothing else.
const MAX_BACK_SHARE: f64 = 0.5;

/// How many rays of a sensor hit the terrain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SensorHits {
    /// The sensor.
    pub sensor: SensorId,
    /// Number of its rays.
    pub rays: u64,
    /// Number of those that hit.
    pub hits: u64,
}

impl SensorHits {
    /// Hits of a sensor's map. `None` if the map has neither ranges nor faces.
    pub fn of_map(map: &SensorMap) -> Option<Self> {
        let hits = match (&map.range, &map.face) {
            (Some(range), _) => range.cells().iter().filter(|cell| cell.get().is_some()).count(),
            (None, Some(face)) => face.cells().iter().filter(|cell| cell.get().is_some()).count(),
            (None, None) => return None,
        };
        Some(Self { sensor: map.sensor, rays: map.cell_count() as u64, hits: hits as u64 })
    }

    /// Hits of every sensor of a scene, by the scanline renderer, which needs no hierarchy.
    pub fn of_scene(scene: &Scene) -> Vec<Self> {
        let face_alone = Quantities { face: true, ..Quantities::NONE };
        let output = Scanline::exact().render(scene, &Request { quantities: face_alone, ..Request::MAPS });
        output.maps().filter_map(Self::of_map).collect()
    }
}

/// Warns if no ray of a sensor hits.
pub fn no_hits(of: SensorHits) -> Option<Warning> {
    (of.hits == 0).then(|| {
        let rays = counted(of.rays, "ray", "rays");
        let sentence = format!("none of its {rays} hits the front of the terrain within the maximum range.");
        Warning::of_sensor(WarningCode::NoHits, of.sensor, sentence)
    })
}

/// Warns if some rays of a sensor hit, but under a hundredth of them.
pub fn few_hits(of: SensorHits) -> Option<Warning> {
    let is_few = of.hits > 0 && (of.hits as f64) < MIN_HIT_SHARE * of.rays as f64;
    is_few.then(|| {
        let percent = number(100.0 * of.hits as f64 / of.rays as f64);
        let sentence =
            format!("only {} of its {} rays hit the terrain, {percent} %.", count(of.hits), count(of.rays));
        Warning::of_sensor(WarningCode::FewHits, of.sensor, sentence)
    })
}

/// Warns if a sensor's rays mostly meet the back of a face first.
pub fn mostly_backs(of: Facing) -> Option<Warning> {
    let met = of.fronts + of.backs;
    let is_back = of.backs as f64 > MAX_BACK_SHARE * met as f64;
    is_back.then(|| {
        let percent = number(100.0 * of.backs as f64 / met as f64);
        let sentence = format!(
            "{percent} % of the rays that meet the terrain meet the back of a face first, which no renderer sees: \
             are the faces wound clockwise, or is the sensor under the ground?"
        );
        Warning::of_sensor(WarningCode::BacksFirst, of.sensor, sentence)
    })
}
