//! Asks, before the work begins, whether the memory for it is there: a clear refusal in place of an abort.
//!
//! What a command takes grows with the faces of the ground, and with the rays or cells that it answers. The numbers of bytes for
//! each were measured (`docs/reference/limits.md` has them, and `tests/memory/main.rs` measures them again) and have a quarter
//! or more on top: they are tuned, not derived.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use bytesize::ByteSize;
use raypencil::cast::{is_cloud, stated_points};
use raypencil::io::{bytes, limit_memory};
use raypencil::pack::{FileRole, Manifest};
use raypencil::report::counted;
use raypencil::{Scene, SensorId};
use serde_json::Value;

use crate::Trouble;

/// What the program itself takes for most commands, bytes: its code as well, of which an unoptimised build has more.
const BASE: u64 = 28 << 20;

/// Bytes that a command takes for each part of a scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rates {
    /// Name of the command.
    command: &'static str,
    base: u64,
    face: u64,
    /// For each pixel of the camera.
    pixel: u64,
    /// For each pencil of all beams.
    pencil: u64,
}

impl Rates {
    pub(crate) const RENDER: Self =
        Self { command: "render", base: BASE, face: 180, pixel: 320, pencil: 700 };
    pub(crate) const VALIDATE: Self =
        Self { command: "validate", base: BASE, face: 300, pixel: 440, pencil: 900 };
    pub(crate) const MINIMISE: Self = Self { command: "minimise", ..Self::VALIDATE };
    pub(crate) const PACK: Self = Self { command: "pack", base: BASE, face: 350, pixel: 720, pencil: 1400 };
    pub(crate) const CHECK: Self = Self { command: "check", base: BASE, face: 350, pixel: 600, pencil: 900 };
    pub(crate) const PROBE: Self = Self { command: "probe", base: BASE, face: 260, pixel: 120, pencil: 40 };
    /// With two renderers, and the maps of some hundred frames.
    pub(crate) const DRIVE: Self =
        Self { command: "drive", base: 208 << 20, face: 600, pixel: 180, pencil: 1000 };
}

/// Bytes that `drive` takes for each cell of its optics: the image, and what a blur makes of it.
const FINE_CELL: u64 = 10;

/// Maximum number of these cells.
const MAX_FINE_CELLS: u64 = 1 << 28;

/// Bytes that `cast` takes for each ray, and for each face.
const CAST: [u64; 2] = [800, 380];

/// Bytes that `cast --scans` takes for each ray of a set whose rays are all made: the ray itself and its time. Answers are those of one scan.
const RAY_OF_SCANS: u64 = 100;

/// Bytes that `check` takes for each ray of a pack of rays, for each of its faces, and for each point of a cloud.
const CHECK_RAYS: [u64; 3] = [900, 380, 200];

/// The limit of `--max-memory`, bytes; 0: none was given.
static GIVEN: AtomicU64 = AtomicU64::new(0);

/// Sets the limit. Without one it is the memory of the machine.
pub(crate) fn begin(max: Option<ByteSize>) {
    GIVEN.store(max.map_or(0, |max| max.as_u64()), Ordering::Relaxed);
    // What files claim is asked where they are read.
    if let Some(bytes) = max.map(|max| max.as_u64()).or_else(of_machine) {
        limit_memory(bytes);
    }
}

/// The memory of the machine, or of the container if that has less, bytes; `None` where the system does not say.
fn of_machine() -> Option<u64> {
    let kind = sysinfo::MemoryRefreshKind::nothing().with_ram();
    let system = sysinfo::System::new_with_specifics(sysinfo::RefreshKind::nothing().with_memory(kind));
    let whole = system.total_memory();
    let least = system.cgroup_limits().map_or(whole, |limits| whole.min(limits.total_memory));
    (least > 0).then_some(least)
}

/// Refuses work on a scene for which the memory is not there.
pub(crate) fn ask(rates: Rates, scene: &Scene) -> Result<(), Trouble> {
    refuse_scene(rates, counts(scene), None)
}

/// Refuses a drive for which the memory is not there: for its scene, and for the cells of its optics, `oversampling` along the side of
/// each pixel.
pub(crate) fn ask_drive(scene: &Scene, oversampling: u32) -> Result<(), Trouble> {
    let [faces, pixels, pencils] = counts(scene);
    let side = u64::from(oversampling);
    // More cells than an image may have are refused as such, with their place in the file.
    let cells = Some(pixels * side * side).filter(|cells| side > 1 && *cells <= MAX_FINE_CELLS);
    refuse_scene(Rates::DRIVE, [faces, pixels, pencils], cells)
}

/// Faces, pixels of the camera, and pencils of all beams.
fn counts(scene: &Scene) -> [u64; 3] {
    let cells = |sensor: SensorId| {
        scene.size(sensor).map_or(0, |(columns, rows)| u64::from(columns) * u64::from(rows))
    };
    let pencils = scene.sensors().filter(|sensor| *sensor != SensorId::Camera).map(cells).sum();
    [scene.mesh().faces().len() as u64, cells(SensorId::Camera), pencils]
}

/// `cells`: those of optics.
fn refuse_scene(rates: Rates, [faces, pixels, pencils]: [u64; 3], cells: Option<u64>) -> Result<(), Trouble> {
    let Rates { command, base, face, pixel, pencil } = rates;
    let parts = [(faces, face), (pixels, pixel), (pencils, pencil), (cells.unwrap_or(0), FINE_CELL)];
    let words = [
        Some(counted(faces, "face", "faces")),
        Some(counted(pixels, "pixel", "pixels")),
        Some(counted(pencils, "pencil", "pencils")),
        cells.map(|cells| counted(cells, "cell of its optics", "cells of its optics")),
    ];
    let words: Vec<String> = words.into_iter().flatten().collect();
    refuse_above(command, needed(base, &parts), &words.join(", "))
}

/// Refuses a pack for whose answers the memory is not there. One that cannot be read is told of by its reader.
pub(crate) fn ask_check(pack: &Path) -> Result<(), Trouble> {
    let Ok(manifest) = Manifest::read(pack) else { return Ok(()) };
    let cells = |is_camera: bool| {
        let sensors = manifest.sensors.iter().filter(|sensor| (sensor.name == "camera") == is_camera);
        sensors.map(|sensor| u64::from(sensor.columns) * u64::from(sensor.rows)).sum::<u64>()
    };
    // A face takes 18 bytes of the file or more: three indices, and half a vertex.
    let terrain = manifest.files.iter().filter(|file| file.role == FileRole::Terrain);
    let faces = terrain.map(|file| file.bytes / 18).sum();
    refuse_scene(Rates::CHECK, [faces, cells(true), cells(false)], None)
}

/// Refuses rays on a mesh for which the memory is not there.
pub(crate) fn ask_cast(rays: usize, faces: usize, in_scans: bool) -> Result<(), Trouble> {
    let [ray, face] = CAST;
    let ray = if in_scans { RAY_OF_SCANS } else { ray };
    let (rays, faces) = (rays as u64, faces as u64);
    let words = format!("{}, {}", counted(rays, "ray", "rays"), counted(faces, "face", "faces"));
    refuse_above("cast", needed(BASE, &[(rays, ray), (faces, face)]), &words)
}

/// Refuses a pack of rays, and a point cloud held to it, for which the memory is not there. What cannot be read is told of by its reader.
pub(crate) fn ask_check_rays(pack: &Path, candidate: &Path) -> Result<(), Trouble> {
    let Ok(text) = bytes::read_file(&pack.join("raypack.json"), 1 << 20) else { return Ok(()) };
    let Ok(document) = serde_json::from_slice::<Value>(&text) else { return Ok(()) };
    let rays = document["counts"]["rays"].as_u64().unwrap_or(0);
    let of_file = |name: &str| {
        let files = document["files"].as_array()?;
        files.iter().find(|file| file["path"] == name)?["bytes"].as_u64()
    };
    // Three indices of four bytes, after a header of 128.
    let faces = of_file("faces.npy").unwrap_or(0).saturating_sub(128) / 12;
    let points = if is_cloud(candidate) { stated_points(candidate).unwrap_or(0) } else { 0 };
    let [ray, face, point] = CHECK_RAYS;
    let mut words = format!("{}, {}", counted(rays, "ray", "rays"), counted(faces, "face", "faces"));
    if points > 0 {
        words += &format!(", {}", counted(points, "point", "points"));
    }
    refuse_above("check", needed(BASE, &[(rays, ray), (faces, face), (points, point)]), &words)
}

/// Bytes for so many parts at so many bytes each.
fn needed(base: u64, parts: &[(u64, u64)]) -> u64 {
    parts.iter().fold(base, |sum, (count, bytes)| sum.saturating_add(count.saturating_mul(*bytes)))
}

fn refuse_above(command: &str, needed: u64, words: &str) -> Result<(), Trouble> {
    let given = GIVEN.load(Ordering::Relaxed);
    let (max, whose) = match given {
        0 => {
            (of_machine().unwrap_or(u64::MAX), "the memory of this machine; --max-memory says another limit")
        }
        _ => (given, "the limit of --max-memory"),
    };
    if needed <= max {
        return Ok(());
    }
    let [needed, max] = [needed, max].map(|bytes| ByteSize(bytes).display().si().to_string());
    Err(Trouble::Usage(format!("{command}: {words} take about {needed}; expected at most {max}, {whose}")))
}

/// Bytes as people write them: `2GB`, `512 MiB`, `1500000`.
pub(crate) fn size(text: &str) -> Result<ByteSize, String> {
    match text.parse::<ByteSize>() {
        Ok(size) if size.as_u64() > 0 => Ok(size),
        _ => Err("expected a size, such as 2GB, 512MiB or a number of bytes".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_as_people_write_them() {
        for (text, bytes) in [
            ("2GB", 2_000_000_000),
            ("512MiB", 512 << 20),
            ("1500000", 1_500_000),
            ("1.5 kB", 1500),
            ("4G", 4_000_000_000),
        ] {
            assert_eq!(size(text).map(|size| size.as_u64()), Ok(bytes), "{text}");
        }
        for text in ["", "0", "many", "-1GB", "nan", "2 GBs"] {
            assert!(size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn no_number_of_parts_wraps_around() {
        assert_eq!(needed(BASE, &[(u64::MAX, 2), (1, 1)]), u64::MAX);
        assert_eq!(needed(BASE, &[(10, 3), (7, 2)]), BASE + 44);
    }

    #[test]
    fn exactly_the_limit_is_enough_and_a_byte_more_is_not() {
        GIVEN.store(1000, Ordering::Relaxed);
        let is_allowed = [999, 1000, 1001].map(|needed| refuse_above("cast", needed, "1 ray").is_ok());
        GIVEN.store(0, Ordering::Relaxed);
        assert_eq!(is_allowed, [true, true, false]);
    }

    #[test]
    fn pixels_are_the_camera_s_and_pencils_those_of_all_beams() {
        let loaded = raypencil::io::load("pyramids", &raypencil::io::Overrides::default());
        let scene = loaded.expect("the built-in scene").scene;
        let cells = |sensor| scene.size(sensor).map(|(columns, rows)| u64::from(columns) * u64::from(rows));
        let beams = (0..scene.beams().len()).filter_map(|beam| cells(SensorId::Beam(beam))).sum();
        let camera = cells(SensorId::Camera).expect("a camera");
        assert_ne!(camera, beams);
        assert_eq!(counts(&scene), [scene.mesh().faces().len() as u64, camera, beams]);
    }

    #[test]
    fn the_machine_has_some_memory() {
        let bytes = of_machine().expect("a system that says it");
        assert!((64 << 20..1 << 50).contains(&bytes), "{bytes}");
    }
}
