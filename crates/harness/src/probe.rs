//! Everything about one ray, from every renderer.

use std::fmt;

use raypencil_referee::{Explained, Margin, Margins, Ruling, Verdict};
use raypencil_scene::{Hit, Ray, Request, SensorId};
use serde::Serialize;

use crate::attribution::{Attributions, Cause};
use crate::compare::{Class, Place};
use crate::judge::{Judge, JudgeShare};
use crate::output::probe_command;
use crate::renderers::Contender;
use crate::run::{Progress, Subject};

/// One ray and what each renderer says of it.
#[derive(Debug, Clone)]
pub struct Probe {
    /// Which ray.
    pub place: Place,
    /// The command that repeats this.
    pub command: String,
    /// The contract's ray, rounded to f64, scene frame.
    pub ray: Ray,
    /// The longest range along it, metres.
    pub max_range: f64,
    /// Each renderer's answer.
    pub answers: Vec<ProbedAnswer>,
    /// The exact verdict.
    pub verdict: Verdict,
    /// What is hit exactly, its values rounded; the lowest face of a tie.
    pub exact: Option<Hit>,
    /// The least displacement that changes the set of nearest faces.
    pub face_margin: Margin,
    /// The least displacement at which the range jumps.
    pub surface_margin: Margin,
}

/// One renderer's answer to a ray, and what it is.
#[derive(Debug, Clone)]
pub struct ProbedAnswer {
    /// The renderer's name.
    pub renderer: String,
    /// What it says; `None` for a miss.
    pub hit: Option<Hit>,
    /// What the referee rules on it.
    pub ruling: Ruling,
    /// What `validate` makes of that; an agreeing answer's values may still be out of bounds.
    pub class: Class,
    /// Why it is wrong, if a cause is confirmed.
    pub cause: Option<Cause>,
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
pub fn probe(
    subject: &Subject,
    place: Place,
    contenders: &[Contender],
    progress: &dyn Progress,
) -> Result<Probe, NoSuchRay> {
    let Place { sensor, i, j } = place;
    let scene = &subject.scene;
    let Some((width, height)) = scene.size(sensor) else {
        let SensorId::Beam(index) = sensor else { unreachable!("every scene has a camera") };
        return Err(NoSuchRay::Beam { index, count: scene.beams().len() });
    };
    let no_such_cell = NoSuchRay::Cell { sensor, i, j, width, height };
    let (Some(ray), Some(max_range)) = (scene.ray(sensor, i, j), scene.max_range(sensor)) else {
        return Err(no_such_cell);
    };
    progress.stage("referee: preparing");
    let judge = Judge::new(scene, JudgeShare::Sample);
    let answers = contenders
        .iter()
        .map(|contender| {
            progress.stage(&format!("{}: rendering", contender.renderer.name()));
            ask(&judge, place, contender)
        })
        .collect();
    let referee = judge.referee();
    let Some(Margins { verdict, face, surface }) = referee.margins(sensor, i, j) else {
        return Err(no_such_cell);
    };
    let exact = verdict.faces.first().and_then(|face| referee.hit(sensor, i, j, *face));
    let command = probe_command(subject, place);
    Ok(Probe {
        place,
        command,
        ray,
        max_range,
        answers,
        verdict,
        exact,
        face_margin: face,
        surface_margin: surface,
    })
}

/// One renderer's answer.
fn ask(judge: &Judge<'_>, place: Place, contender: &Contender) -> ProbedAnswer {
    let Place { sensor, i, j } = place;
    // A whole sensor is rendered for one ray: the answer must be the one that `validate` compares.
    let request = Request {
        camera: sensor == SensorId::Camera,
        beams: sensor != SensorId::Camera,
        ..Request::EVERYTHING
    };
    let renderer = &contender.renderer;
    let frame = renderer.render(judge.scene(), &request);
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
    let (face, range) = (hit.map(|hit| hit.face), hit.map(|hit| hit.range));
    let ruling = judge.rule(place, face, range, renderer.resolution());
    let cause = (ruling == Ruling::Wrong)
        .then(|| Attributions::find(judge, &frame, contender.approximations(), renderer.resolution()))
        .and_then(|attributions| attributions.cause(place).cloned());
    let class = Class::of(ruling, cause.is_some());
    ProbedAnswer { renderer: renderer.name().to_string(), hit, ruling, class, cause }
}

impl Probe {
    /// The same as a value for `--json`.
    pub fn to_json(&self) -> serde_json::Value {
        #[derive(Serialize)]
        struct HitValues {
            face: u32,
            range_m: f64,
            depth_m: f64,
            point_m: [f64; 3],
            normal: [f64; 3],
            incidence_cosine: f64,
        }
        let values = |hit: Option<Hit>| {
            hit.map(|hit| HitValues {
                face: hit.face.0,
                range_m: hit.range,
                depth_m: hit.depth,
                point_m: hit.point.to_array(),
                normal: hit.normal.to_array(),
                incidence_cosine: hit.incidence,
            })
        };
        let margin = |margin: &Margin| {
            let witness = margin.witness.map(|by| [by.dx, by.dy]);
            serde_json::json!({ "cells": [margin.lo, margin.hi], "witness_cells": witness })
        };
        let answers: Vec<serde_json::Value> = self
            .answers
            .iter()
            .map(|answer| {
                let cause = answer.cause.as_ref().map(|cause| {
                    let explained: Vec<String> = cause.explained.iter().map(explained_in_words).collect();
                    let without: Vec<_> = cause
                        .explained_without
                        .iter()
                        .map(|(exact, explained)| {
                            let explained: Vec<String> = explained.iter().map(explained_in_words).collect();
                            serde_json::json!({ "exact": exact.to_string(), "because": explained })
                        })
                        .collect();
                    serde_json::json!({
                        "switches": cause.switches.to_string(),
                        "because": explained,
                        "still_wrong_without": without,
                    })
                });
                serde_json::json!({
                    "renderer": answer.renderer,
                    "class": answer.class,
                    "ruling": in_words(answer.ruling),
                    "cause": cause,
                    "hit": values(answer.hit),
                })
            })
            .collect();
        serde_json::json!({
            "sensor": self.place.sensor.to_string(),
            "cell": [self.place.i, self.place.j],
            "command": self.command,
            "ray": {
                "origin_m": self.ray.origin.to_array(),
                "direction_m": self.ray.direction.to_array(),
                "max_range_m": self.max_range,
            },
            "exact": {
                "faces": self.verdict.faces.iter().map(|face| face.0).collect::<Vec<_>>(),
                "hit": values(self.exact),
                "face_margin": margin(&self.face_margin),
                "surface_margin": margin(&self.surface_margin),
            },
            "answers": answers,
        })
    }
}

/// Why a face is seen or not, in words.
fn explained_in_words(one: &Explained) -> String {
    let reasons: Vec<String> = one.reasons.iter().map(ToString::to_string).collect();
    format!("face {} is {}: {}", one.face.0, if one.added { "added" } else { "lost" }, reasons.join("; "))
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
        if let Some(hit) = &self.exact {
            write_values(f, hit)?;
        }
        writeln!(f, "    face margin {}", margin(&self.face_margin))?;
        writeln!(f, "    surface margin {}", margin(&self.surface_margin))?;
        for answer in &self.answers {
            let said = answer.hit.map_or("no hit".into(), |hit| format!("face {}", hit.face.0));
            let class = match &answer.cause {
                Some(cause) => format!("approximation: {}", cause.switches),
                None => in_words(answer.ruling),
            };
            writeln!(f, "  {}: {said} ({class})", answer.renderer)?;
            for one in answer.cause.iter().flat_map(|cause| &cause.explained) {
                writeln!(f, "    {}", explained_in_words(one))?;
            }
            for (exact, explained) in answer.cause.iter().flat_map(|cause| &cause.explained_without) {
                let explained: Vec<String> = explained.iter().map(explained_in_words).collect();
                writeln!(f, "    and with {exact} exact: {}", explained.join("; "))?;
            }
            if let Some(hit) = &answer.hit {
                write_values(f, hit)?;
            }
        }
        writeln!(f, "  again: {}", self.command)
    }
}

fn write_values(f: &mut fmt::Formatter<'_>, hit: &Hit) -> fmt::Result {
    writeln!(f, "    range {} m, depth {} m", hit.range, hit.depth)?;
    writeln!(f, "    point {} m", vector(hit.point))?;
    writeln!(f, "    normal {}, cos(psi) {}", vector(hit.normal), hit.incidence)
}

fn vector(v: glam::DVec3) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}
