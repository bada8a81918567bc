//! Everything about one ray, from every renderer.

use std::fmt;

use raypencil_referee::{Margin, Ruling, Verdict};
use raypencil_scene::{Hit, Ray, Renderer, Request, SensorId};
use serde::Serialize;

use crate::compare::Place;
use crate::judge::{Judge, JudgeShare};
use crate::run::Subject;

/// One ray and what each renderer says of it.
#[derive(Debug, Clone)]
pub struct Probe {
    /// Which ray.
    pub place: Place,
    /// The contract's ray, rounded to f64, scene frame.
    pub ray: Ray,
    /// The longest range along it, metres.
    pub max_range: f64,
    /// Each renderer's name, answer, and what the referee rules on it.
    pub answers: Vec<(String, Option<Hit>, Ruling)>,
    /// The exact verdict.
    pub verdict: Verdict,
    /// The least displacement that changes the set of nearest faces.
    pub face_margin: Margin,
    /// The least displacement at which the range jumps.
    pub surface_margin: Margin,
}

/// Why there is no such ray.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoSuchRay {
    /// The scene has fewer beams.
    #[error("there is no beam {index}: the scene has {count}, counted from 0")]
    Beam {
        /// The beam asked for.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// The sensor has fewer cells.
    #[error("{sensor} has no cell {i},{j}: it is {width} x {height}, counted from 0,0")]
    Cell {
        /// The sensor asked for.
        sensor: SensorId,
        /// The column asked for.
        i: u32,
        /// The row asked for.
        j: u32,
        /// Its columns.
        width: u32,
        /// Its rows.
        height: u32,
    },
}

/// Asks every renderer about one ray.
///
/// # Errors
/// If the scene has no such ray.
pub fn probe(subject: &Subject, place: Place, renderers: &[&dyn Renderer]) -> Result<Probe, NoSuchRay> {
    let Place { sensor, i, j } = place;
    let scene = &subject.scene;
    let Some((width, height)) = scene.size(sensor) else {
        let SensorId::Beam(index) = sensor else { unreachable!("every scene has a camera") };
        return Err(NoSuchRay::Beam { index, count: scene.beams().len() });
    };
    let (Some(ray), Some(max_range)) = (scene.ray(sensor, i, j), scene.max_range(sensor)) else {
        return Err(NoSuchRay::Cell { sensor, i, j, width, height });
    };
    // A whole sensor is rendered for one ray: the answer must be the one that `validate` compares.
    let request = Request {
        camera: sensor == SensorId::Camera,
        beams: sensor != SensorId::Camera,
        ..Request::EVERYTHING
    };
    let judge = Judge::new(scene, JudgeShare::Sample);
    let answers = renderers
        .iter()
        .map(|renderer| {
            let frame = renderer.render(scene, &request);
            let hit = frame.map(sensor).and_then(|map| {
                Some(Hit {
                    face: map.face.as_ref()?.at(i, j).get()?,
                    range: map.range.as_ref()?.at(i, j).get()?,
                    point: map.point.as_ref()?.at(i, j).get()?,
                    normal: map.normal.as_ref()?.at(i, j).get()?,
                    depth: map.depth.as_ref()?.at(i, j).get()?,
                    incidence: map.incidence.as_ref()?.at(i, j).get()?,
                })
            });
            let face = hit.map(|hit| hit.face);
            let ruling = judge.rule(place, face, hit.map(|hit| hit.range), renderer.resolution());
            (renderer.name().to_string(), hit, ruling)
        })
        .collect();
    let referee = judge.referee();
    let (Some(verdict), Some(face_margin), Some(surface_margin)) = (
        referee.verdict(sensor, i, j),
        referee.face_margin(sensor, i, j),
        referee.surface_margin(sensor, i, j),
    ) else {
        return Err(NoSuchRay::Cell { sensor, i, j, width, height });
    };
    Ok(Probe { place, ray, max_range, answers, verdict, face_margin, surface_margin })
}

impl Probe {
    /// The same as a value for `--json`.
    pub fn to_json(&self) -> serde_json::Value {
        #[derive(Serialize)]
        struct Answer {
            renderer: String,
            ruling: String,
            hit: Option<HitValues>,
        }
        #[derive(Serialize)]
        struct HitValues {
            face: u32,
            range_m: f64,
            depth_m: f64,
            point_m: [f64; 3],
            normal: [f64; 3],
            incidence_cosine: f64,
        }
        let answers: Vec<Answer> = self
            .answers
            .iter()
            .map(|(renderer, hit, ruling)| Answer {
                renderer: renderer.clone(),
                ruling: in_words(*ruling),
                hit: hit.map(|hit| HitValues {
                    face: hit.face.0,
                    range_m: hit.range,
                    depth_m: hit.depth,
                    point_m: hit.point.to_array(),
                    normal: hit.normal.to_array(),
                    incidence_cosine: hit.incidence,
                }),
            })
            .collect();
        serde_json::json!({
            "sensor": self.place.sensor.to_string(),
            "cell": [self.place.i, self.place.j],
            "ray": {
                "origin_m": self.ray.origin.to_array(),
                "direction_m": self.ray.direction.to_array(),
                "max_range_m": self.max_range,
            },
            "exact": {
                "faces": self.verdict.faces.iter().map(|face| face.0).collect::<Vec<_>>(),
                "face_margin_cells": [self.face_margin.lo, self.face_margin.hi],
                "surface_margin_cells": [self.surface_margin.lo, self.surface_margin.hi],
            },
            "answers": answers,
        })
    }
}

/// A ruling in words.
fn in_words(ruling: Ruling) -> String {
    match ruling {
        Ruling::Exact => "exact".into(),
        Ruling::Tie => "one of a tie".into(),
        Ruling::Rounding(by) => {
            format!("rounding: exact for the ray displaced by {:e}, {:e} cells", by.dx, by.dy)
        }
        Ruling::Wrong => "wrong".into(),
    }
}

/// A margin in words.
fn margin(margin: &Margin) -> String {
    match margin.witness {
        None if margin.lo >= 1.0 => "at least 1 cell".into(),
        None => format!("at least {:e} cells", margin.lo),
        Some(by) => {
            format!("{:e} to {:e} cells, witness {:e}, {:e}", margin.lo, margin.hi, by.dx, by.dy)
        }
    }
}

impl fmt::Display for Probe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Ray { origin, direction } = self.ray;
        let vector = |v: glam::DVec3| format!("({:?}, {:?}, {:?})", v.x, v.y, v.z);
        writeln!(f, "{}", self.place)?;
        writeln!(f, "  ray, scene frame: origin {} m", vector(origin))?;
        writeln!(f, "    direction {} m; t = 1 at the projection plane", vector(direction))?;
        writeln!(f, "    longest range {} m, t = {}", self.max_range, self.max_range / direction.length())?;
        let faces: Vec<String> = self.verdict.faces.iter().map(|face| face.0.to_string()).collect();
        match faces.as_slice() {
            [] => writeln!(f, "  exactly: no hit")?,
            [face] => writeln!(f, "  exactly: face {face}")?,
            faces => writeln!(f, "  exactly: a tie of faces {}", faces.join(", "))?,
        }
        writeln!(f, "    face margin {}", margin(&self.face_margin))?;
        writeln!(f, "    surface margin {}", margin(&self.surface_margin))?;
        for (name, hit, ruling) in &self.answers {
            let ruling = in_words(*ruling);
            let Some(hit) = hit else {
                writeln!(f, "  {name}: no hit ({ruling})")?;
                continue;
            };
            writeln!(f, "  {name}: face {} ({ruling})", hit.face.0)?;
            writeln!(f, "    range {} m, depth {} m", hit.range, hit.depth)?;
            writeln!(f, "    point {} m", vector(hit.point))?;
            writeln!(f, "    normal {}, cos(psi) {}", vector(hit.normal), hit.incidence)?;
        }
        Ok(())
    }
}
