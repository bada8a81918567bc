//! A probe as text and as JSON.

use std::fmt;

use glam::DVec3;
use raypencil_judge::name_of;
use raypencil_referee::{Displacement, Explained, Margin, Ruling};
use raypencil_scene::{Hit, Ray, Return};
use serde::Serialize;

use crate::probe::{Probe, ProbedCandidate, ProbedReturn};

impl Probe {
    /// The probe as JSON, for `--json`.
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
                incidence_cosine: hit.cos_incidence,
            })
        };
        let of_return = |back: &Return| {
            serde_json::json!({
                "visible": back.visible,
                "pixel": back.pixel.map(|pixel| [pixel.i, pixel.j]),
                "camera_depth_m": back.depth,
                "off_axis_cosine": back.cos_off_axis,
                "emission_cosine": back.cos_view,
                "flux": back.flux,
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
                    "return": answer.back.as_ref().map(|back| {
                        serde_json::json!({
                            "said": of_return(&back.back),
                            "visible_ruling": in_words(back.ruling.visible),
                            "pixel_ruling": in_words(back.ruling.pixel),
                            "cause": back.cause.as_ref().map(|cause| cause.switches.to_string()),
                        })
                    }),
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
                "return": self.exact_return.as_ref().map(of_return),
                "flux_unit": self.flux_unit,
                "face_margin": margin(&self.face_margin),
                "surface_margin": margin(&self.surface_margin),
                "visibility_margin": self.visibility_margins.as_ref().map(|margins| margin(&margins.visibility)),
                "landing_margin_pixels": self.visibility_margins.as_ref().and_then(|margins| margins.landing),
            },
            "answers": answers,
            "candidates": self.candidates.iter().map(candidate_json).collect::<Vec<_>>(),
        })
    }
}

/// A candidate's answer as JSON.
fn candidate_json(ProbedCandidate { name, ray }: &ProbedCandidate) -> serde_json::Value {
    let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
    let items = ray.items.iter().map(|of| {
        serde_json::json!({
            "quantity": name_of(of.item),
            "said": of.said,
            "true": of.truth,
            "difference": finite(of.difference),
            "difference_unit": of.difference_unit,
            "ratio": finite(of.ratio),
            "class": of.class,
        })
    });
    serde_json::json!({
        "name": name,
        "class": ray.class,
        "ruling": ray.ruling,
        "what": ray.what,
        "quantities": items.collect::<Vec<_>>(),
    })
}

/// The reasons for which a face is added or lost, in words.
fn explained_in_words(one: &Explained) -> String {
    let reasons: Vec<String> = one.reasons.iter().map(ToString::to_string).collect();
    format!("face {} is {}: {}", one.face.0, if one.added { "added" } else { "lost" }, reasons.join("; "))
}

fn in_words(ruling: Ruling) -> String {
    match ruling {
        Ruling::Exact => "exact".into(),
        Ruling::Tie => "one of a tie".into(),
        Ruling::Rounding(Displacement::ZERO) => {
            "rounding: right up to the errors of ranges, normals and points".into()
        }
        Ruling::Rounding(by) => {
            format!("rounding: exact for the ray displaced by {:e}, {:e} cells", by.dx, by.dy)
        }
        Ruling::Wrong => "wrong".into(),
    }
}

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
        if let Some(back) = &self.exact_return {
            write_return(f, back, self.flux_unit)?;
        }
        writeln!(f, "    face margin {}", margin(&self.face_margin))?;
        writeln!(f, "    surface margin {}", margin(&self.surface_margin))?;
        if let Some(margins) = &self.visibility_margins {
            writeln!(f, "    visibility margin {}", margin(&margins.visibility))?;
            if let Some([low, _]) = margins.landing {
                writeln!(f, "    landing margin {low:e} pixels")?;
            }
        }
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
            if let Some(back) = &answer.back {
                write_ruled_return(f, back, self.flux_unit)?;
            }
        }
        for candidate in &self.candidates {
            f.write_str(&candidate.ray.text(&candidate.name))?;
        }
        writeln!(f, "  again: {}", self.command)
    }
}

fn write_values(f: &mut fmt::Formatter<'_>, hit: &Hit) -> fmt::Result {
    writeln!(f, "    range {} m, depth {} m", hit.range, hit.depth)?;
    writeln!(f, "    point {} m", vector(hit.point))?;
    writeln!(f, "    normal {}, cos(psi) {}", vector(hit.normal), hit.cos_incidence)
}

fn write_return(f: &mut fmt::Formatter<'_>, back: &Return, unit: &str) -> fmt::Result {
    let seen = if back.visible { "seen" } else { "not seen" };
    let pixel = back.pixel.map_or("off the image".into(), |pixel| format!("pixel {},{}", pixel.i, pixel.j));
    writeln!(f, "    {seen} by the camera, {pixel}; depth {} m there", back.depth)?;
    writeln!(
        f,
        "    cos(phi) {}, cos(theta) {}, flux {:e} {unit}",
        back.cos_off_axis, back.cos_view, back.flux
    )
}

fn write_ruled_return(f: &mut fmt::Formatter<'_>, answer: &ProbedReturn, unit: &str) -> fmt::Result {
    let ProbedReturn { back, ruling, cause } = answer;
    write_return(f, back, unit)?;
    if ruling.visible != Ruling::Exact {
        let ruling = match cause {
            Some(cause) => format!("approximation: {}", cause.switches),
            None => in_words(ruling.visible),
        };
        writeln!(f, "    whether it is seen ({ruling})")?;
    }
    for one in cause.iter().flat_map(|cause| &cause.explained) {
        let reasons: Vec<String> = one.reasons.iter().map(ToString::to_string).collect();
        writeln!(f, "      face {}: {}", one.face.0, reasons.join("; "))?;
    }
    if ruling.pixel != Ruling::Exact {
        writeln!(f, "    where it lands ({})", in_words(ruling.pixel))?;
    }
    Ok(())
}

/// A vector with all its digits.
fn vector(v: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}
