//! The answers to one ray, and counts of many, as text and as JSON.

use std::fmt::Write as _;

use raypencil_referee::{Displacement, Margin, Margins};
use raypencil_report::{count, counted};
use raypencil_scene::{CastRay, Reading, Side};
use serde_json::{Value, json};

use crate::answers::{Answers, GroupAtT};

fn side_word(side: Side) -> &'static str {
    match side {
        Side::Front => "front",
        Side::Back => "back",
    }
}

/// How many rays hit, tie, are too near and miss, as one line.
pub fn counts_text(answers: &Answers) -> String {
    let (hits, ties) = answers.counts();
    // Only a sensor's rays can be too near.
    let too_near = match answers.too_near() as u64 {
        0 => String::new(),
        rays => format!("{} too near; ", count(rays)),
    };
    format!(
        "{}: {} hit, {} of them at a tie; {too_near}{} miss",
        counted(answers.first.len() as u64, "ray", "rays"),
        count(hits as u64),
        count(ties as u64),
        count(answers.misses() as u64)
    )
}

/// The answers to the ray with this index, in lines.
pub fn ray_text(ray: &CastRay, answers: &Answers, index: usize) -> String {
    let three = |v: [f64; 3]| format!("({}, {}, {})", v[0], v[1], v[2]);
    let mut text = format!("from {} along {}", three(ray.origin.to_array()), three(ray.direction.to_array()));
    if ray.t_min > 0.0 || ray.t_max < f64::INFINITY {
        let _ = write!(text, ", t from {} to {}", ray.t_min, ray.t_max);
    }
    if ray.t_blind > 0.0 {
        let _ = write!(text, ", blind before t {}", ray.t_blind);
    }
    text.push('\n');
    match &answers.first[index] {
        Reading::Miss => text.push_str("  nothing is hit\n"),
        Reading::TooNear => {
            let _ = writeln!(text, "  too near     the nearest surface is met before t {}", ray.t_blind);
        }
        Reading::Hit(hit) => {
            let _ = writeln!(text, "  first        face {}, {}", hit.face.0, side_word(hit.side));
            if hit.ties > 1 {
                let _ =
                    writeln!(text, "  tie          {} faces at this very t; this is the lowest", hit.ties);
            }
            let _ = writeln!(text, "  t            {}\n  range        {}", hit.t, hit.range);
            let _ = writeln!(text, "  point        {}", three(hit.point.to_array()));
            let _ = writeln!(text, "  normal       {}", three(hit.normal.to_array()));
            let _ = writeln!(text, "  barycentric  {}", three(hit.barycentric));
            let _ = writeln!(text, "  cos(psi)     {}", hit.cos_incidence);
        }
    }
    if let Some(any) = &answers.any {
        let _ = writeln!(text, "  any          {}", if any[index] { "yes" } else { "no" });
    }
    if let Some(all) = &answers.all {
        for group in &all[index] {
            let _ = writeln!(text, "  all          t {}: {}", group.t, group_text(group));
        }
    }
    if let Some(margins) = &answers.margins {
        let Margins { face, surface } = &margins[index];
        for (name, Margin { lo, hi, .. }) in [("face", face), ("surface", surface)] {
            let _ = writeln!(text, "  margin       {name}: {lo} to {hi}");
        }
    }
    text
}

fn group_text(group: &GroupAtT) -> String {
    let faces: Vec<String> =
        group.faces.iter().map(|met| format!("face {} ({})", met.face.0, side_word(met.side))).collect();
    let crossing = match group.crossing {
        0 => "no net crossing".to_string(),
        1.. => format!(
            "{} to the inside",
            counted(group.crossing.unsigned_abs().into(), "crossing", "crossings")
        ),
        _ => format!(
            "{} to the outside",
            counted(group.crossing.unsigned_abs().into(), "crossing", "crossings")
        ),
    };
    format!("{}; {crossing}", faces.join(", "))
}

/// The answers to the ray with this index, for programs.
pub fn ray_json(ray: &CastRay, answers: &Answers, index: usize) -> Value {
    let read = &answers.first[index];
    let first = read.hit().map(|hit| {
        json!({
            "face": hit.face.0,
            "side": side_word(hit.side),
            "ties": hit.ties,
            "t": hit.t,
            "range": hit.range,
            "point": hit.point.to_array(),
            "normal": hit.normal.to_array(),
            "barycentric": hit.barycentric,
            "cosIncidence": hit.cos_incidence,
        })
    });
    let group = |group: &GroupAtT| {
        let faces: Vec<Value> = group
            .faces
            .iter()
            .map(|met| json!({ "face": met.face.0, "side": side_word(met.side) }))
            .collect();
        json!({ "t": group.t, "faces": faces, "crossing": group.crossing })
    };
    let mut answer = json!({
        "origin": ray.origin.to_array(),
        "direction": ray.direction.to_array(),
        "tMin": ray.t_min,
        // JSON has no infinity.
        "tMax": (ray.t_max < f64::INFINITY).then_some(ray.t_max),
        "tBlind": ray.t_blind,
        "tooNear": matches!(read, Reading::TooNear),
        "first": first,
    });
    if let Some(any) = &answers.any {
        answer["any"] = json!(any[index]);
    }
    if let Some(all) = &answers.all {
        answer["all"] = all[index].iter().map(group).collect();
    }
    if let Some(margins) = &answers.margins {
        let of = |Margin { lo, hi, witness }: &Margin| json!({ "lo": lo, "hi": hi, "witness": witness.map(Displacement::to_array) });
        let Margins { face, surface } = &margins[index];
        let across = ray.across().map(|vector| vector.to_array());
        answer["margins"] = json!({ "face": of(face), "surface": of(surface), "across": across });
    }
    answer
}
