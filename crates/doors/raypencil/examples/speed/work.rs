//! The work that is timed: for `docs/speed.md` by the example, and by `cargo bench --bench goals`.

// Each of the two uses a part of it.
#![allow(dead_code)]

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;

use rayon::prelude::*;
use raypencil::drive::DriveJob;
use raypencil::harness::{Contender, Validation, Validator, contender};
use raypencil::io::{Overrides, Subject, load, load_text};
use raypencil::judge::JudgeShare;
use raypencil::pack::{PackLabel, write_pack};
use raypencil::rover::{CameraImage, Drive};
use raypencil::sensor::{FixedPattern, ImageSensor};
use raypencil::{Image, Quantities, Referee, Renderer, Request, Scanline, Scene, SensorId, Silent, Stage};

/// The camera's range map alone.
pub const CAMERA: Request = Request { beams: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

/// The range maps of the beams alone.
pub const BEAMS: Request = Request { camera: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

/// The default rig on generated ground of so many faces over 50 m, or the user's own scene.
pub fn subject(ground: &str) -> Result<Subject, Box<dyn Error>> {
    // `FACES@SIDE`: a camera of that many pixels across and down, over the same field of view.
    let (faces, side) = ground.split_once('@').unwrap_or((ground, "1024"));
    let loaded = match faces.parse::<u32>() {
        Ok(faces) => {
            let side: u32 = side.parse()?;
            let pitch_um = 9.0 * 1024.0 / f64::from(side);
            let text = format!(
                "version = 1\n[terrain]\ngenerate = {{ kind = \"plain\", seed = 1, faces = {faces}, extent_m = 50 }}\n\
                 [camera]\nwidth_px = {side}\nheight_px = {side}\npixel_pitch_um = {pitch_um}\n"
            );
            load_text(&text, "plain")?
        }
        Err(_) => load(ground, &Overrides::default())?,
    };
    Ok(loaded.into_subject(ground.into()))
}

/// The two renderers of a validation.
pub fn both_renderers() -> [Contender; 2] {
    ["scanline", "tracer"].map(|name| contender(name).expect("a renderer's name"))
}

/// Whether a stage makes the maps of a sensor.
pub fn is_map(scene: &Scene, stage: &Stage) -> bool {
    scene.sensors().any(|sensor| sensor.to_string() == stage.name)
}

/// Whether a stage makes what a renderer keeps from frame to frame.
pub fn is_kept(stage: &Stage) -> bool {
    ["hierarchy", "clusters", "tables", "flux tables"].contains(&stage.name.as_str())
}

/// Milliseconds of some stages of a frame of the beams' flux.
pub fn milliseconds_of(scene: &Scene, renderer: &dyn Renderer, counts: impl Fn(&Stage) -> bool) -> f64 {
    let frame = renderer.render(scene, &Request::FLUX);
    frame.stages.iter().filter(|stage| counts(stage)).map(|stage| 1e3 * stage.time.as_secs_f64()).sum()
}

/// A whole validation: both renderers, every quantity, each difference, and one ray of 64 judged.
pub fn validated(subject: &Subject, contenders: &[Contender], validator: &mut Validator) -> Validation {
    let subject = Subject {
        vehicle: subject.vehicle,
        scene: subject.scene.clone(),
        name: subject.name.clone(),
        arguments: subject.arguments.clone(),
        sha256: subject.sha256.clone(),
        file_facts: subject.file_facts.clone(),
    };
    validator.validate(subject, contenders, JudgeShare::Sample, &Silent)
}

/// Every pixel's exact hit with all its values, correctly rounded to f64 and f32.
pub fn certify(referee: &Referee, width: u32, height: u32) -> usize {
    let values = |i, j| referee.values(SensorId::Camera, i, j);
    (0..height)
        .into_par_iter()
        .map(|j| (0..width).filter(|&i| black_box(values(i, j)).is_some()).count())
        .sum()
}

/// Writes the pack of a scene, with all answers and margins, and removes it again.
pub fn write_whole_pack(subject: &Subject) {
    let folder = tempfile::tempdir().expect("a folder for a while");
    write_pack(subject, None, &PackLabel::NONE, folder.path(), &Silent).expect("a pack");
}

/// A drive of the rover over a ground, cycle by cycle, with the noise of a camera chip.
pub struct DriveCycles {
    drive: Drive,
    renderer: Scanline,
    sensor: ImageSensor,
    pattern: FixedPattern,
    exposures: u64,
}

impl DriveCycles {
    /// A drive over the ground of a subject.
    pub fn new(subject: &Subject) -> Result<Self, Box<dyn Error>> {
        let ground = match subject.arguments.parse::<u32>() {
            Ok(faces) => {
                format!("generate = {{ kind = \"plain\", seed = 1, faces = {faces}, extent_m = 50 }}")
            }
            Err(_) => format!("file = {:?}", std::path::absolute(&subject.arguments)?),
        };
        let text = format!(
            "version = 1\n[vehicle]\nposition_m = [-15, 0]\n[terrain]\n{ground}\n[drive]\nwaypoints_m = [[30, 0]]\n\
             scans = false\n"
        );
        let job = DriveJob::new(&load_text(&text, "drive")?, None, String::new())?;
        let (_, sensor) = raypencil::sensor::preset("cmos").ok_or("the preset `cmos`")?;
        let camera = job.plan.rig.camera.sensor;
        Ok(Self {
            drive: Drive::new(job.plan.clone(), Arc::clone(&job.mesh))?,
            renderer: Scanline::exact(),
            pattern: sensor.fixed_pattern(camera.width, camera.height),
            sensor,
            exposures: 0,
        })
    }

    /// The next cycle.
    pub fn step(&mut self) {
        let Self { drive, renderer, sensor, pattern, exposures } = self;
        let mut camera_pipeline = |_, flux: Image<f64>| {
            *exposures += 1;
            CameraImage::Numbers(sensor.numbers_with(Some(pattern), &flux, None, *exposures))
        };
        let frame = drive.step(renderer, &mut camera_pipeline).expect("a frame");
        assert!(black_box(frame).is_some(), "the route is too short");
    }
}
