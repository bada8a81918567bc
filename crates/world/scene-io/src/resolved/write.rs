//! A resolved scene to TOML and GLB. Every number reads back to the last bit.

use std::fmt::Write as _;
use std::path::Path;

use raypencil_files::{Fault, FileError, write_atomically};
use raypencil_mesh_io::write_glb;
use raypencil_scene::{Filter, Pose, Profile, Scene};

/// Writes `scene` as a resolved scene file `path` and, beside it, its mesh as the GLB `mesh_file_name`.
/// [`load`](crate::load()) gives back the same scene bit for bit. The same scene gives the same bytes.
///
/// # Errors
/// A mesh file name that contains a folder or does not end in `.glb`; errors of [`write_glb`] and of the file system.
///
/// ```
/// use raypencil_scene_io::{Overrides, load, write_resolved};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("copy.toml");
/// let scene = load("pyramids", &Overrides::default())?.scene;
/// write_resolved(&path, &scene, "copy.glb")?;
/// // Every number is written so that it reads back to the last bit.
/// assert_eq!(load(&path.to_string_lossy(), &Overrides::default())?.scene, scene);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_resolved(path: impl AsRef<Path>, scene: &Scene, mesh_file_name: &str) -> Result<(), FileError> {
    let path = path.as_ref();
    // The name stands between quotes in the file, and must mean the same on any system.
    let plain = |c: char| c.is_ascii_alphanumeric() || "._- ".contains(c);
    if !mesh_file_name.ends_with(".glb") || !mesh_file_name.chars().all(plain) {
        let expected = "a plain file name that ends in .glb";
        let fault = Fault::new("terrain.file", format!("{mesh_file_name:?}"), expected);
        return Err(FileError::Gltf(fault.in_file(path)));
    }
    // The mesh comes first: where there is a scene file, there is its ground.
    write_glb(path.with_file_name(mesh_file_name), scene.mesh())?;
    let text = text(scene, mesh_file_name);
    write_atomically(path, |file| file.write_all(text.as_bytes()))
}

/// Text of the scene file. Keys and units are those of `docs/guide/scene.md`.
fn text(scene: &Scene, mesh_file_name: &str) -> String {
    let mut text = String::from(
        "# A resolved scene: the very numbers that renderers compute with, in SI units.\nversion = 1\nkind = \"resolved\"\n",
    );
    let mut line = |key: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = match value.is_empty() {
            true => writeln!(text, "\n{key}"),
            false => writeln!(text, "{key} = {value}"),
        };
    };
    let heading = String::new;

    line("[camera]", heading());
    let camera = scene.camera();
    line("scene_from_camera", pose(&camera.scene_from_sensor));
    let camera = &camera.sensor;
    line("width_px", camera.width.to_string());
    line("height_px", camera.height.to_string());
    line("pixel_pitch_m", list(&camera.pixel_pitch));
    line("focal_length_m", real(camera.focal_length));
    line("principal_point_px", list(&camera.principal_point));
    line("aperture_m", real(camera.aperture));
    line("transmission", real(camera.lens.transmission));
    if let Filter::Interference { centre, width, index } = camera.lens.filter {
        let [centre, width, index] = [centre, width, index].map(real);
        line("filter", format!("{{ centre_m = {centre}, width_m = {width}, index = {index} }}"));
    }
    line("max_range_m", real(camera.max_range));

    for beam in scene.beams() {
        line("[[beam]]", heading());
        line("scene_from_beam", pose(&beam.scene_from_sensor));
        let beam = &beam.sensor;
        line("columns", beam.columns.to_string());
        line("rows", beam.rows.to_string());
        line("thickness_m", real(beam.thickness));
        line("grid_distance_m", real(beam.grid_distance));
        line("half_width_m", real(beam.half_width));
        line("max_range_m", real(beam.max_range));
        line("power_w", real(beam.power));
        line("wavelength_m", real(beam.wavelength));
        let (profile, width) = match beam.profile {
            Profile::Paper => ("paper", None),
            Profile::UniformAngle => ("uniform_angle", None),
            Profile::Gaussian { half_width } => ("gaussian", Some(half_width)),
        };
        line("profile", format!("\"{profile}\""));
        if let Some(width) = width {
            line("gaussian_half_width_rad", real(width));
        }
    }

    line("[terrain]", heading());
    line("file", format!("\"{mesh_file_name}\""));
    line("origin_m", list(&scene.mesh().origin().to_array()));
    line("[atmosphere]", heading());
    line("attenuation_per_m", real(scene.atmosphere().attenuation));
    line("[flux]", heading());
    line("model", format!("\"{}\"", scene.flux_model().word()));
    text
}

/// Shortest decimal that reads back as the same double. `{:?}` always has a point or an exponent, by which TOML tells a
/// float from an integer.
fn real(value: f64) -> String {
    format!("{value:?}")
}

fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|&value| real(value)).collect();
    format!("[{}]", values.join(", "))
}

fn pose(pose: &Pose) -> String {
    let (position, rotation) = (list(&pose.position.to_array()), list(&pose.rotation.to_array()));
    format!("{{ position_m = {position}, quaternion_xyzw = {rotation} }}")
}
