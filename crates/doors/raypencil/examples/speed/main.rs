//! The times of `docs/speed.md`: what `reference/speed/speed.py` measures of raypencil, beside Embree.
//!
//! ```sh
//! speed write GROUND FOLDER            # the triangles and the rays of a scene, as Embree is asked
//! speed measure GROUND ROUNDS ROW...   # milliseconds of rows of the table, as a line of JSON
//! ```
//!
//! `GROUND` is a number of faces of generated ground (`FACES@SIDE`: seen by a camera of so many pixels a side), or a scene
//! or mesh of your own. `ROW` is `camera, NAME`, `beams, NAME`, `returns, NAME` or `first frame, NAME` of a renderer, or
//! `validate`, `referee`, `drive`, `pack`, `memory` or `floor`. The number of threads is that of `RAYON_NUM_THREADS`.
//! `cargo bench --bench goals` times the same work.

use std::error::Error;
use std::fs::File;
use std::hint::black_box;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use raypencil::harness::{Validator, contender};
use raypencil::io::Subject;
use raypencil::{
    Camera, FaceId, Mounted, Quantities, Referee, Renderer, Request, Scanline, Scene, SensorId, SensorMap,
};
use serde_json::{Map, Value, json};

mod work;

use work::{
    BEAMS, CAMERA, DriveCycles, both_renderers, certify, is_kept, is_map, milliseconds_of, subject,
    validated, write_whole_pack,
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["write", ground, folder] => write(&subject(ground)?.scene, Path::new(folder)),
        ["measure", ground, rounds, ref rows @ ..] if !rows.is_empty() => {
            let times = measure(&subject(ground)?, rounds.parse()?, rows)?;
            println!("{}", Value::Object(times));
            Ok(())
        }
        _ => Err("expected `write GROUND FOLDER` or `measure GROUND ROUNDS ROW...`".into()),
    }
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

/// What each row of the table measures, `rounds` times; and the most memory that it took.
fn measure(subject: &Subject, rounds: usize, rows: &[&str]) -> Result<Map<String, Value>, Box<dyn Error>> {
    let mut measured = Map::new();
    measured.insert("faces".into(), json!(subject.scene.mesh().faces().len()));
    for &row in rows {
        match row.split_once(", ") {
            Some((what @ ("camera" | "beams" | "returns" | "first frame"), name)) => {
                let renderer =
                    || contender(name).ok_or(format!("`{name}` is no renderer")).map(|of| of.renderer);
                let times = maps(&subject.scene, what, rounds, &mut || renderer())?;
                measured.insert(row.into(), json!(times));
            }
            _ => measured.extend(work(subject, row, rounds)?),
        }
    }
    measured.insert("peak memory, bytes".into(), json!(peak_memory()));
    Ok(measured)
}

/// Milliseconds of a renderer's maps of the camera or of the beams; of the rest of the returns; or of the tree that its first
/// frame begins with.
fn maps(
    scene: &Scene,
    what: &str,
    rounds: usize,
    renderer: &mut dyn FnMut() -> Result<Box<dyn Renderer>, String>,
) -> Result<Vec<f64>, String> {
    let kept = renderer()?;
    let request = if what == "camera" { CAMERA } else { BEAMS };
    // The first frame makes what a renderer keeps.
    kept.render(scene, if what == "returns" { &Request::FLUX } else { &request });
    (0..rounds)
        .map(|_| match what {
            // From the pencils' hits on: lines of sight and light.
            "returns" => {
                Ok(milliseconds_of(scene, kept.as_ref(), |stage| !is_map(scene, stage) && !is_kept(stage)))
            }
            "first frame" => Ok(milliseconds_of(scene, renderer()?.as_ref(), is_kept)),
            _ => Ok(timed(|| kept.render(scene, &request))),
        })
        .collect()
}

/// What belongs to no single renderer.
fn work(subject: &Subject, row: &str, rounds: usize) -> Result<Map<String, Value>, Box<dyn Error>> {
    let mut measured = Map::new();
    match row {
        "validate" => {
            let contenders = both_renderers();
            let mut validator = Validator::default();
            validated(subject, &contenders, &mut validator);
            let mut stages: Vec<(String, Vec<f64>)> = vec![("validate".into(), Vec::new())];
            for _ in 0..rounds {
                let start = Instant::now();
                let validation = validated(subject, &contenders, &mut validator);
                stages[0].1.push(1e3 * start.elapsed().as_secs_f64());
                for stage in &validation.stages {
                    let (name, time) = (format!("validate: {}", stage.name), 1e3 * stage.time.as_secs_f64());
                    match stages.iter_mut().find(|(of, _)| *of == name) {
                        Some((_, times)) => times.push(time),
                        None => stages.push((name, vec![time])),
                    }
                }
            }
            measured.extend(stages.into_iter().map(|(name, times)| (name, json!(times))));
        }
        "drive" => {
            let mut cycles = DriveCycles::new(subject)?;
            cycles.step();
            let times = (0..rounds).map(|_| timed(|| cycles.step()));
            measured.insert(row.into(), json!(times.collect::<Vec<_>>()));
        }
        "pack" => {
            let times = (0..rounds).map(|_| timed(|| write_whole_pack(subject)));
            measured.insert(row.into(), json!(times.collect::<Vec<_>>()));
        }
        "memory" => {
            // The peak is told of every run: here it is that of one validation alone.
            validated(subject, &both_renderers(), &mut Validator::default());
        }
        "floor" => {
            let mesh = subject.scene.mesh();
            let read = || -> u64 {
                let vertices = mesh.vertices().iter().flatten().map(|x| u64::from(x.to_bits()));
                vertices.fold(0, u64::wrapping_add)
                    + mesh.faces().iter().flatten().map(|&v| u64::from(v)).sum::<u64>()
            };
            let times = (0..rounds).map(|_| timed(|| black_box(read())));
            measured.insert("floor: the mesh read once".into(), json!(times.collect::<Vec<_>>()));
            let (width, height) = subject.scene.size(SensorId::Camera).expect("every scene has a camera");
            let write = || {
                let mut map = SensorMap::unwritten(SensorId::Camera, width, height, Quantities::RANGE_MAP);
                for row in &mut map.rows_mut() {
                    (0..width).for_each(|i| row.put_place(i, FaceId(i), 1.0, 1.0, DVec3::ZERO));
                }
                map
            };
            let times = (0..rounds).map(|_| timed(|| black_box(write())));
            measured.insert("floor: the map written once".into(), json!(times.collect::<Vec<_>>()));
        }
        "referee" => {
            let referee = Referee::new(&subject.scene);
            let (width, height) = subject.scene.size(SensorId::Camera).expect("every scene has a camera");
            let rays_per_second = |time: f64| f64::from(width) * f64::from(height) / time * 1e3;
            let rates = (0..rounds).map(|_| rays_per_second(timed(|| certify(&referee, width, height))));
            measured.insert(row.into(), json!(rates.collect::<Vec<_>>()));
        }
        other => return Err(format!("`{other}`: no row of the table").into()),
    }
    Ok(measured)
}

/// Milliseconds of one run, without the time to give its result's memory back.
fn timed<T>(run: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    let result = run();
    let time = start.elapsed();
    drop(result);
    1e3 * time.as_secs_f64()
}

/// The most memory that this process ever had, bytes; `None` where the system does not say.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}
