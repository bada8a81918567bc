//! SHA-256 of the numbers of a scene.

use sha2::{Digest, Sha256};

use raypencil_files::{Sha256Digest, hex_digits};
use raypencil_scene::{Filter, FluxModel, Mesh, Pose, Profile, Scene};

/// SHA-256 of a resolved scene, in hexadecimal digits. It covers every number that a renderer sees, as little-endian
/// bytes, and no name: two files that resolve to the same numbers have the same digest. Sets of rays are left out: the
/// digest names what camera and beams see, for packs and candidates.
///
/// ```
/// use raypencil_scene_io::{load_text, scene_sha256};
///
/// // The wavelength 810 nm is the default, so writing it out changes no number; 811 nm does.
/// let sha = |nm: &str| {
///     let text = format!("version = 1\n[[beam]]\n{nm}\n");
///     load_text(&text, "scene").map(|loaded| scene_sha256(&loaded.scene))
/// };
/// assert_eq!(sha("")?, sha("wavelength_nm = 810")?);
/// assert_ne!(sha("")?, sha("wavelength_nm = 811")?);
/// # Ok::<(), raypencil_scene_io::SceneIoError>(())
/// ```
pub fn scene_sha256(scene: &Scene) -> String {
    hex_digits(&resolved(scene))
}

/// A file that a scene names, as it is named there, and its digest.
pub(crate) type NamedDigest = (String, Sha256Digest);

/// [`scene_sha256`] as bytes.
pub(crate) fn resolved(scene: &Scene) -> Sha256Digest {
    let mut hash = Numbers(Sha256::new());
    hash.mesh(scene.mesh());
    let camera = scene.camera();
    hash.pose(&camera.scene_from_sensor);
    let sensor = &camera.sensor;
    hash.count(sensor.width.into());
    hash.count(sensor.height.into());
    hash.reals(&sensor.pixel_pitch);
    hash.reals(&sensor.principal_point);
    hash.reals(&[sensor.focal_length, sensor.aperture, sensor.max_range, sensor.lens.transmission]);
    match sensor.lens.filter {
        Filter::None => hash.count(0),
        Filter::Interference { centre, width, index } => {
            hash.count(1);
            hash.reals(&[centre, width, index]);
        }
    }
    hash.count(scene.beams().len() as u64);
    for beam in scene.beams() {
        hash.pose(&beam.scene_from_sensor);
        let sensor = &beam.sensor;
        hash.count(sensor.columns.into());
        hash.count(sensor.rows.into());
        hash.reals(&[sensor.thickness, sensor.grid_distance, sensor.half_width]);
        hash.reals(&[sensor.max_range, sensor.power, sensor.wavelength]);
        match sensor.profile {
            Profile::Paper => hash.count(0),
            Profile::UniformAngle => hash.count(1),
            Profile::Gaussian { half_width } => {
                hash.count(2);
                hash.reals(&[half_width]);
            }
        }
    }
    hash.reals(&[scene.atmosphere().attenuation]);
    hash.count(match scene.flux_model() {
        FluxModel::Radiometric => 0,
        FluxModel::Eq1 => 1,
    });
    hash.0.finalize().into()
}

/// SHA-256 of a mesh alone.
pub(crate) fn mesh(mesh: &Mesh) -> Sha256Digest {
    let mut hash = Numbers(Sha256::new());
    hash.mesh(mesh);
    hash.0.finalize().into()
}

/// Hash of numbers. Before every list stands its length, so that no two lists run together.
struct Numbers(Sha256);

impl Numbers {
    fn count(&mut self, value: u64) {
        self.0.update(value.to_le_bytes());
    }

    fn reals(&mut self, values: &[f64]) {
        for value in values {
            self.0.update(value.to_le_bytes());
        }
    }

    fn pose(&mut self, pose: &Pose) {
        self.reals(&pose.position.to_array());
        self.reals(&pose.rotation.to_array());
    }

    fn mesh(&mut self, mesh: &Mesh) {
        self.reals(&mesh.origin().to_array());
        self.count(mesh.vertices().len() as u64);
        for coordinate in mesh.vertices().as_flattened() {
            self.0.update(coordinate.to_le_bytes());
        }
        self.count(mesh.faces().len() as u64);
        for index in mesh.faces().as_flattened() {
            self.0.update(index.to_le_bytes());
        }
        for material in mesh.face_materials() {
            self.0.update(material.to_le_bytes());
        }
        self.count(mesh.materials().len() as u64);
        for material in mesh.materials() {
            self.reals(&[material.reflectivity]);
        }
    }
}
