//! The times of `docs/speed.md`: what `reference/speed/speed.py` measures of raypencil, beside Embree.
//!
//! ```sh
//! speed write GROUND FOLDER            # the triangles and the rays of a scene, as Embree is asked
//! speed measure GROUND ROUNDS WHAT...  # milliseconds of each kind of work, as a line of JSON
//! ```
//!
//! `GROUND` is a number of faces of generated ground, or a scene or mesh of your own. `WHAT` is any of `scanline`, `tracer`, `tree`,
//! `validate`, `referee`. The number of threads is that of `RAYON_NUM_THREADS`.

use std::error::Error;
use std::fs::File;
use std::hint::black_box;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;

use rayon::prelude::*;
use raypencil::harness::{Contender, contender, validate};
use raypencil::io::{Overrides, Subject, load, load_text};
use raypencil::judge::JudgeShare;
use raypencil::{
    Camera, Mounted, Quantities, Referee, Renderer, Request, Scanline, Scene, SensorId, Silent, Stage, Tracer,
};
use serde_json::{Map, Value, json};

/// The camera's range map alone.
const CAMERA: Request = Request { beams: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

/// The range maps of the beams alone.
const BEAMS: Request = Request { camera: false, quantities: Quantities::RANGE_MAP, ..Request::MAPS };

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["write", ground, folder] => write(&subject(ground)?.scene, Path::new(folder)),
        ["measure", ground, rounds, ref what @ ..] if !what.is_empty() => {
            let times = measure(&subject(ground)?, rounds.parse()?, what)?;
            println!("{}", Value::Object(times));
            Ok(())
        }
        _ => Err("expected `write GROUND FOLDER` or `measure GROUND ROUNDS WHAT...`".into()),
    }
}

/// The default rig on generated ground of so many faces over 50 m, or the user's own scene.
fn subject(ground: &str) -> Result<Subject, Box<dyn Error>> {
    let loaded = match ground.parse::<u32>() {
        Ok(faces) => load_text(
            &format!(
                "version = 1\n[terrain]\ngenerate = {{ kind = \"plain\", seed = 1, faces = {faces}, extent_m = 50 }}\n"
            ),
            "plain",
        )?,
        Err(_) => load(ground, &Overrides::default())?,
    };
    Ok(Subject {
        vehicle: loaded.standing_vehicle(),
        scene: loaded.scene,
        name: loaded.name,
        arguments: ground.into(),
        sha256: loaded.source_sha256,
    })
}

/// Writes the triangles (`vertices.f32`, `faces.u32`) and the rays of the camera, the beams, and from the camera to all
/// that the beams hit (`camera.f32`, `beams.f32`, `shadow.f32`), little-endian: origin, direction, nearest and farthest t
/// of each ray. Rows of a camera stand below one another; so do those of a beam.
fn write(scene: &Scene, folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mesh = scene.mesh();
    floats(&folder.join("vertices.f32"), mesh.vertices().iter().flatten().copied())?;
    let mut file = BufWriter::new(File::create(folder.join("faces.u32"))?);
    for index in mesh.faces().iter().flatten() {
        file.write_all(&index.to_le_bytes())?;
    }
    file.flush()?;

    let of_sensor = |sensor| {
        let (width, height) = scene.size(sensor).expect("a sensor of the scene");
        let max_range = scene.max_range(sensor).expect("a sensor of the scene");
        let cells = (0..height).flat_map(move |j| (0..width).map(move |i| (i, j)));
        cells.flat_map(move |(i, j)| {
            let ray = scene.ray(sensor, i, j).expect("a cell of the sensor");
            let (o, d) = (ray.origin, ray.direction);
            [o.x, o.y, o.z, d.x, d.y, d.z, 1.0, max_range / d.length()].map(|x| x as f32)
        })
    };
    floats(&folder.join("camera.f32"), of_sensor(SensorId::Camera))?;
    floats(
        &folder.join("beams.f32"),
        (0..scene.beams().len()).flat_map(|beam| of_sensor(SensorId::Beam(beam))),
    )?;

    // From the projection centre towards each point that a pencil hits, as far as the point itself but for what the
    // rounding of its coordinates moves it.
    let request = Request { camera: false, ..Request::MAPS };
    let frame = Scanline::exact().render(scene, &request);
    let Mounted { scene_from_sensor, sensor: Camera { focal_length, .. } } = *scene.camera();
    let centre = scene_from_sensor.position;
    let points = frame.beams.iter().flat_map(|map| map.point.as_ref().expect("asked for").cells());
    let shadow = points.filter_map(|point| point.get()).flat_map(|point| {
        let d = point - centre;
        let near = focal_length / d.length();
        [centre.x, centre.y, centre.z, d.x, d.y, d.z, near, 1.0 - 1e-4].map(|x| x as f32)
    });
    floats(&folder.join("shadow.f32"), shadow)?;
    Ok(())
}

fn floats(path: &Path, numbers: impl Iterator<Item = f32>) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    for number in numbers {
        file.write_all(&number.to_le_bytes())?;
    }
    file.flush()
}

/// Milliseconds of `rounds` runs of each kind of work; peak memory.
fn measure(subject: &Subject, rounds: usize, what: &[&str]) -> Result<Map<String, Value>, Box<dyn Error>> {
    let scene = &subject.scene;
    let mut times = Map::new();
    times.insert("faces".into(), json!(scene.mesh().faces().len()));
    let mut put = |name: &str, run: &mut dyn FnMut() -> f64| {
        times.insert(name.into(), json!((0..rounds).map(|_| run()).collect::<Vec<_>>()));
    };
    for &what in what {
        match what {
            "scanline" => maps(scene, &Scanline::exact(), &mut put),
            "tracer" => maps(scene, &Tracer::new(), &mut put),
            "tree" => {
                let one = Request { camera: false, ..Request::FLUX };
                put(
                    "tree, tracer",
                    &mut (|| {
                        let frame = Tracer::new().render(scene, &one);
                        let tree = frame.stages.iter().find(|stage| stage.name == "hierarchy");
                        1e3 * tree.expect("the tracer's first stage").time.as_secs_f64()
                    }),
                );
            }
            "validate" => {
                let contenders =
                    ["scanline", "tracer"].map(|name| contender(name).expect("a renderer's name"));
                put("validate", &mut (|| timed(|| validated(subject, &contenders))));
                let last = validated(subject, &contenders);
                for stage in &last.stages {
                    put(&format!("validate: {}", stage.name), &mut (|| 1e3 * stage.time.as_secs_f64()));
                }
            }
            "referee" => {
                let referee = Referee::new(scene);
                let (width, height) = scene.size(SensorId::Camera).expect("every scene has a camera");
                put(
                    "referee, rays per second",
                    &mut (|| {
                        let time = timed(|| certify(&referee, width, height));
                        f64::from(width) * f64::from(height) / time * 1e3
                    }),
                );
            }
            other => {
                return Err(format!("`{other}`: expected scanline, tracer, tree, validate or referee").into());
            }
        }
    }
    times.insert("peak memory, bytes".into(), json!(peak_memory()));
    Ok(times)
}

/// The maps of the camera and of the beams, and the rest of the returns.
fn maps(scene: &Scene, renderer: &dyn Renderer, put: &mut dyn FnMut(&str, &mut dyn FnMut() -> f64)) {
    let name = renderer.name();
    for (sensor, request) in [("camera", CAMERA), ("beams", BEAMS)] {
        renderer.render(scene, &request);
        put(&format!("{sensor}, {name}"), &mut || timed(|| renderer.render(scene, &request)));
    }
    // From the pencils' hits on: lines of sight and light, without the maps of the pencils.
    put(&format!("returns, {name}"), &mut || {
        let frame = renderer.render(scene, &Request::FLUX);
        let of_returns = |stage: &&Stage| {
            let is_map = scene.sensors().any(|sensor| sensor.to_string() == stage.name);
            !is_map && !["hierarchy", "tables", "flux tables"].contains(&stage.name.as_str())
        };
        frame.stages.iter().filter(of_returns).map(|stage| 1e3 * stage.time.as_secs_f64()).sum()
    });
}

/// Milliseconds of one run, without the time to give its result's memory back.
fn timed<T>(run: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    let result = run();
    let time = start.elapsed();
    drop(result);
    1e3 * time.as_secs_f64()
}

fn validated(subject: &Subject, contenders: &[Contender]) -> raypencil::harness::Validation {
    let subject = Subject {
        vehicle: subject.vehicle.clone(),
        scene: subject.scene.clone(),
        name: subject.name.clone(),
        arguments: subject.arguments.clone(),
        sha256: subject.sha256.clone(),
    };
    validate(subject, contenders, JudgeShare::Sample, &Silent)
}

/// Every pixel's exact hit with all its values, correctly rounded to f64 and f32.
fn certify(referee: &Referee, width: u32, height: u32) -> usize {
    let values = |i, j| referee.values(SensorId::Camera, i, j);
    (0..height)
        .into_par_iter()
        .map(|j| (0..width).filter(|&i| black_box(values(i, j)).is_some()).count())
        .sum()
}

/// The most memory that this process ever had, bytes; `None` where the system does not say.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}
