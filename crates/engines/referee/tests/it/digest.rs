//! Digests of the referee's answers to some rays, down to the last bit, committed here. (Contract: same bits)
//!
//! A digest changes with any change of a ground, a rig, or the way in which a margin or a ruling is found. Verdicts
//! and values are exact, so theirs change with scenes alone. When a digest changes, the commit must say why.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

use crate::splitmix::SplitMix64;
use glam::{DQuat, DVec3};
use raypencil_referee::{Approximations, Displacement, Referee, Tolerance, VisibilityApproximations};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FaceId, Filter, FluxModel, Lens, Mounted, Pose, Profile, Sampling, Scene,
    SensorId,
};
use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin};
use sha2::{Digest, Sha256};

/// Subject and SHA-256 of all answers about it.
const DIGESTS: &[[&str; 2]] = &[
    ["explained", "82acde6d542fdecaad32680ff237e354139e94c866aa4fc9a040e082cd2bf868"],
    ["explained sights", "1069791694b8b2205057d6f974a6c1eb6e18d10ced543eaa9fb09beaef443887"],
    ["face margins", "b31aa923f1169b500d862f9bac83f5478b738159c16b53f062ab1b13cdd1000f"],
    ["light", "1d95c104903cbbe9c5f77e7db2b4a08d270662c3d8009f3cf056d04e12f9c9d8"],
    ["light on pixels", "d88162a776582d596c31d5bc87ad37c16ee4f9b110c822942b198cee20f68069"],
    ["rays", "1eacad71f16e54a8f1ed9273a36735ce4a59e3afe420047ae41e479d93242f51"],
    ["rulings", "1deb3cb78dd01c07b452cb90c94459b9a6ec51dc72066e0ec834108dfb25c91a"],
    ["sight margins", "a4ede55252cff7fd2ceec06d4db818987cdb34ab13047b0141caebf08006aab5"],
    ["sight rulings", "a9668315ab97e49df7e250b5462e5eabafd62cecf3621cca963a4daefdcefc3f"],
    ["sights", "564e6b2bed35c8f0a5f1ae883c9f3baf0cbd24eccc4ee7e3797ac0ff5b16261a"],
    ["surface margins", "bcebae7af1a4ec48e02b38d40300a15392984249709da94ad24924e0cdd55f35"],
    ["values", "4624ad4bbbc45d1f1446c4ce4b7ec38c9e3603552cdc89d98c2f689e0e205231"],
    ["verdicts", "d43823beccd0fce7e574a6be68567cc1f0eac38edf5e1a2167e970450679ff5c"],
];

/// The same for margins of more rays.
const MANY: &[[&str; 2]] = &[
    ["face margins", "681a33bebc97ed28f5fce6317132a58e318c51c7fdecfd5ef3fb79c08b6c5ccd"],
    ["sight margins", "5e3e4738261762d01409df25e0ab70272bf03df1bfdc2623ac3ecf20fd4a2fb8"],
    ["surface margins", "fc140398f81976c1cf86cb89e4653836dc849125f7b1a179f1f7a1bfdbecdb7f"],
];

/// Scene number `number`: built-in and malformed grounds, at the origin and far from it; sheets of 5 mm to half a
/// metre; every profile, filter and model; cells so coarse that several faces lie in one.
fn scene(number: u64) -> Scene {
    let mut random = SplitMix64(number);
    let offset = DVec3::splat([0.0, 1e3, 1e6][number as usize / 2 % 3]);
    let ground = if number.is_multiple_of(2) {
        builtin(BUILTIN_NAMES[number as usize / 2 % BUILTIN_NAMES.len()], 0.25).expect("a built-in name")
    } else {
        RandomGround { offset, ..RandomGround::nasty(number, [150, 700][number as usize / 4 % 2]) }.build()
    };
    let mesh = Arc::new(ground.into_mesh().expect("a valid ground"));
    let origin = mesh.origin();
    let turned = Pose::from_axis_angle(DVec3::Z, 3.2 * random.part())
        * Pose::from_axis_angle(DVec3::Y, 0.45 + 0.25 * random.part());
    let position = DVec3::new(3.0 * random.part(), 3.0 * random.part(), 2.0 + 0.8 * random.part());
    let apart = turned.rotation * DVec3::new(0.2 * random.part(), 0.3 + random.part(), 0.7 * random.part());
    let rotation = (turned * Pose::VEHICLE_FROM_FORWARD_SENSOR).rotation;
    let wobble = DQuat::from_xyzw(
        0.1 * random.part(),
        0.1 * random.part(),
        0.1 * random.part(),
        1.0 + 0.5 * random.part(),
    );
    let filter = match number % 3 {
        0 => Filter::None,
        _ => Filter::Interference { centre: 815e-9, width: 15e-9, index: 2.0 },
    };
    let camera = Camera {
        width: 40,
        height: 30,
        pixel_pitch: [3.1e-4, 2.9e-4],
        focal_length: 8e-3,
        principal_point: [20.3, 14.8],
        aperture: 2e-3,
        lens: Lens { transmission: 0.8, filter },
        max_range: [20.0, 6.0][number as usize % 2],
    };
    let beam = Beam {
        columns: 48,
        rows: 4,
        thickness: [0.005, 0.02, 0.5][number as usize / 3 % 3],
        grid_distance: 0.1,
        half_width: [0.06, 0.3][number as usize / 5 % 2],
        max_range: [20.0, 5.0][number as usize / 7 % 2],
        power: 1.0,
        wavelength: 810e-9,
        profile: [Profile::Paper, Profile::UniformAngle, Profile::Gaussian { half_width: 0.2 }]
            [number as usize / 2 % 3],
    };
    let model = [FluxModel::Radiometric, FluxModel::Eq1][number as usize / 4 % 2];
    let at = |position: DVec3, rotation: DQuat| Pose { position: origin + position, rotation };
    Scene::new(
        mesh,
        Mounted { scene_from_sensor: at(position + apart, wobble * rotation), sensor: camera },
        vec![Mounted { scene_from_sensor: at(position, rotation), sensor: beam }],
        Atmosphere { attenuation: [0.0, 0.02][number as usize % 2] },
        model,
    )
    .expect("a valid scene")
}

/// Names of types and fields, today's and those of the day on which the digests were committed. A digest is of Debug
/// text, which holds names: a new name is no new answer.
const NAMES: [[&str; 2]; 4] = [
    ["Visibility", "Sight"],
    ["cos_incidence:", "incidence:"],
    ["cos_off_axis:", "off_axis:"],
    ["cos_view:", "emission:"],
];

/// The digest of the answers and their number, by subject.
#[derive(Default)]
struct Transcript(BTreeMap<&'static str, (Sha256, u32)>);

impl Transcript {
    /// Adds an answer. Debug text tells two f64 apart whenever their bits differ, except for the payload of a NaN.
    fn record(&mut self, subject: &'static str, what: &impl Debug) {
        let (sha256, count) = self.0.entry(subject).or_default();
        let text = format!("{what:?}\n");
        let text = NAMES.iter().fold(text, |text, [now, then]| text.replace(now, then));
        sha256.update(text.as_bytes());
        // Count answers other than 'None'.
        *count += u32::from(text != "None\n");
    }
}

const TOLERANCES: [Tolerance; 3] = [
    Tolerance { lateral: 1.0, depth: 1e-12, position: 1e-9, unit_roundoff: 0.0 },
    Tolerance { lateral: 0.3, depth: 0.05, position: 1e-3, unit_roundoff: 0.0 },
    Tolerance { lateral: 1e-9, depth: 1e-12, position: 0.0, unit_roundoff: 1e-5 },
];

fn record_ray(
    transcript: &mut Transcript,
    scene: &Scene,
    referee: &Referee<'_>,
    random: &mut SplitMix64,
    id: SensorId,
) {
    let (width, height) = scene.size(id).expect("a sensor");
    let (i, j) = (random.below(width), random.below(height));
    let (verdict, margins) = referee.verdict_with_margins(id, i, j).expect("a cell");
    transcript.record("verdicts", &verdict);
    transcript.record("face margins", &margins.face);
    transcript.record("surface margins", &margins.surface);
    transcript.record("values", &referee.values(id, i, j));
    transcript.record("rays", &referee.ray(id, i, j));

    let mut answers = vec![None, Some(FaceId(random.below(scene.mesh().faces().len() as u32)))];
    for reach in [0.2, 1.0, 1.0, 3.0] {
        let by = Displacement { dx: reach * random.part(), dy: reach * random.part() };
        let beside = referee.verdict_beside(id, i, j, by).expect("a cell");
        transcript.record("verdicts", &beside);
        answers.push(beside.faces.first().copied());
    }
    for answer in answers {
        for tolerance in TOLERANCES {
            transcript.record("rulings", &referee.rule(id, i, j, answer, tolerance));
            for (beam_edges, skip_rules) in [(true, false), (false, true), (true, true)] {
                let with = Approximations { beam_edges, skip_rules };
                transcript.record("explained", &referee.explain(id, i, j, answer, with, tolerance));
            }
        }
    }
}

fn record_pencil(transcript: &mut Transcript, scene: &Scene, referee: &Referee<'_>, random: &mut SplitMix64) {
    let Beam { columns, rows, .. } = scene.beams()[0].sensor;
    let (i, j) = (random.below(columns), random.below(rows));
    let margins = referee.visibility_margins(0, i, j);
    transcript.record("sight margins", &margins);
    let Some(face) =
        referee.verdict(SensorId::Beam(0), i, j).and_then(|verdict| verdict.faces.first().copied())
    else {
        return;
    };
    for reach in [0.0, 0.5, 2.0] {
        let by = Displacement { dx: reach * random.part(), dy: reach * random.part() };
        let sight = referee.visibility(0, i, j, by);
        transcript.record("sights", &sight);
        let pixel = sight.and_then(|sight| sight.pixel);
        for (visible, tolerance) in [true, false].into_iter().flat_map(|v| TOLERANCES.map(|t| (v, t))) {
            let at = Displacement::ZERO;
            transcript.record(
                "sight rulings",
                &referee.rule_visibility(0, i, j, at, face, visible, pixel, tolerance),
            );
            for (facing, extent, place) in [
                (true, None, false),
                (false, Some(4.0), false),
                (false, None, true),
                (true, Some(3.0), true),
                (false, Some(2.0), true),
            ] {
                let with = VisibilityApproximations { facing, extent, place };
                let explained = referee.explain_visibility(0, i, j, face, visible, with, tolerance);
                transcript.record("explained sights", &explained);
            }
        }
    }
}

#[test]
fn answers_to_rays_have_the_committed_bits() {
    let mut transcript = Transcript::default();
    for number in 0..24 {
        let scene = scene(number);
        let referee = Referee::new(&scene);
        let mut random = SplitMix64(number ^ 0xabcd);
        for id in [SensorId::Camera, SensorId::Beam(0)] {
            for _ in 0..14 {
                record_ray(&mut transcript, &scene, &referee, &mut random, id);
            }
        }
        for _ in 0..14 {
            record_pencil(&mut transcript, &scene, &referee, &mut random);
        }
        for sampling in [Sampling::Centres, Sampling::Jittered { seed: 3 }] {
            let light = referee.certified_returns(0, sampling).expect("a beam");
            transcript.record("light", &light.returns);
            transcript.record("light on pixels", &light.sums);
        }
    }
    assert_digests(transcript, DIGESTS);
}

/// More margins: only few rays lie near the end of a surface, or near a change of visibility.
#[test]
fn margins_of_many_rays_have_the_committed_bits() {
    let mut transcript = Transcript::default();
    for number in 0..24 {
        let scene = scene(number);
        let referee = Referee::new(&scene);
        let mut random = SplitMix64(number ^ 0x1234);
        for id in [SensorId::Camera, SensorId::Beam(0)] {
            let (width, height) = scene.size(id).expect("a sensor");
            for _ in 0..120 {
                let margins = referee.margins(id, random.below(width), random.below(height)).expect("a cell");
                transcript.record("face margins", &margins.face);
                transcript.record("surface margins", &margins.surface);
            }
        }
        let Beam { columns, rows, .. } = scene.beams()[0].sensor;
        for _ in 0..60 {
            transcript.record(
                "sight margins",
                &referee.visibility_margins(0, random.below(columns), random.below(rows)),
            );
        }
    }
    assert_digests(transcript, MANY);
}

fn assert_digests(transcript: Transcript, committed: &[[&str; 2]]) {
    let found: Vec<[String; 2]> = transcript
        .0
        .into_iter()
        .map(|(subject, (sha256, count))| {
            assert!(count > 40, "{subject}: only {count} answers");
            let digest = sha256.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
            println!("    [\"{subject}\", \"{digest}\"],");
            [subject.to_string(), digest]
        })
        .collect();
    assert!(found == committed, "the digests are now {found:#?}");
}
