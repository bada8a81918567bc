//! Drives for tests: a small camera, and ground on which stripes are known beforehand.

use std::sync::Arc;

use glam::DVec3;
use raypencil_scanline::Scanline;
use raypencil_scene::{Material, Mesh, Renderer, Silent};
use raypencil_scene_io::{LoadedScene, load_text};
use raypencil_tracer::Tracer;

use crate::job::DriveJob;
use crate::run::{DriveRun, drive};

/// Terrain that rises nowhere by a micrometre.
pub(crate) const FLAT: &str = "[terrain]\ngenerate = { preset = \"viking1\", seed = 3, extent_m = 30, \
    post_spacing_m = 5, fine_radius_m = 0, roughness_m = 1e-9, rock_coverage = 0, crater_density = 0 }";

/// Route of 0.6 m in 7 frames, with obstacle maps of frames 0, 3 and 6.
pub(crate) const SHORT: &str =
    "waypoints_m = [[0.6, 0]]\nframes_per_s = 3\nscans = false\nobstacles_every_frames = 3";

/// Sun 2 degrees high, behind the vehicle: it leaves the wide pixels of the small camera room for the stripes.
pub(crate) const LOW_SUN: &str = "sun = { elevation_deg = 2, azimuth_deg = 180, optical_depth = 1 }";

/// Filter of 10 nm around the laser's 810 nm, a key of `[camera]`.
const FILTER: &str = "filter = { centre_nm = 810, width_nm = 10, index = 2.0 }";

/// Text of a scene with a camera of 128 x 128 pixels, further keys of `[camera]`, and this number of beams.
pub(crate) fn scene_text(camera: &str, beams: usize, terrain: &str, drive: &str) -> String {
    let beams = "[[beam]]\nrows = 4\ncolumns = 64\n".repeat(beams);
    format!(
        "version = 1\n[camera]\nwidth_px = 128\nheight_px = 128\npixel_pitch_um = 72\n{camera}\n\
         {beams}{terrain}\n[drive]\n{drive}\n"
    )
}

/// Scene with two beams.
pub(crate) fn scene(terrain: &str, drive: &str) -> LoadedScene {
    load_text(&scene_text("", 2, terrain, drive), "small").unwrap()
}

/// Job of a scene with two beams.
pub(crate) fn job(terrain: &str, drive: &str) -> DriveJob {
    DriveJob::new(&scene(terrain, drive), None, "small.toml".into()).unwrap()
}

/// Job on flat ground whose camera has a filter.
pub(crate) fn filtered(drive: &str) -> DriveJob {
    let loaded = load_text(&scene_text(FILTER, 2, FLAT, drive), "small").unwrap();
    DriveJob::new(&loaded, None, "small.toml".into()).unwrap()
}

fn renderer(name: &str) -> Box<dyn Renderer> {
    match name {
        "scanline" => Box::new(Scanline::default()),
        "tracer" => Box::new(Tracer::new()),
        other => panic!("no renderer is called {other}"),
    }
}

/// Drives a job with one renderer or two, by their names.
pub(crate) fn driven(job: &DriveJob, names: &[&str]) -> DriveRun {
    let renderers: Vec<Box<dyn Renderer>> = names.iter().map(|name| renderer(name)).collect();
    let renderers: Vec<_> = renderers.iter().map(AsRef::as_ref).collect();
    drive(job, &renderers, &Silent).unwrap()
}

/// Mesh of one material.
pub(crate) fn mesh(vertices: &[DVec3], faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let materials = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let face_materials = vec![0; faces.len()];
    Arc::new(Mesh::from_global(vertices, faces, face_materials, materials).unwrap())
}
