//! The drives whose folders are read back: each is driven once.

use std::path::PathBuf;
use std::sync::LazyLock;

use raypencil_drive::{DriveExtras, DriveJob, RecordContents, drive_with, write_drive};
use raypencil_scanline::Scanline;
use raypencil_scene::{Scene, Silent};
use raypencil_scene_io::load_text;
use tempfile::TempDir;

use super::ground::{mesh, scene_text};

/// Folder of a drive.
pub(crate) struct Driven(TempDir);

impl Driven {
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn recorded(&self, name: &str) -> PathBuf {
        self.0.path().join("recording").join(name)
    }

    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(self.file(name)).unwrap()).unwrap()
    }

    fn over_the_ground(keys: &str) -> Self {
        let mut loaded = load_text(&scene_text(keys), "asymmetric").unwrap();
        let scene = &loaded.scene;
        loaded.scene = Scene::new(
            mesh(),
            *scene.camera(),
            scene.beams().to_vec(),
            scene.atmosphere(),
            scene.flux_model(),
        )
        .unwrap();
        let mut job = DriveJob::new(&loaded, None, "asymmetric.toml".into()).unwrap();
        // The height in the file is that of another ground.
        job.height_off_ground = None;
        let folder = TempDir::new().unwrap();
        let mut contents = RecordContents::default();
        contents.add("all").unwrap();
        let record = Some((folder.path().to_path_buf(), contents));
        let extras = DriveExtras { record, ..DriveExtras::default() };
        let run = drive_with(&job, &[&Scanline::default()], extras, &Silent).unwrap();
        write_drive(&job, &run, folder.path(), &Silent).unwrap();
        Self(folder)
    }
}

/// Keys of a vertical scan in the first frame.
const SCAN: &str = "scan_from_deg = -8\nscan_to_deg = 24\nscan_steps = 17\n";

/// Without noise and without errors.
pub(crate) static CLEAN: LazyLock<Driven> = LazyLock::new(|| Driven::over_the_ground(SCAN));

/// With errors of the inertial sensors, and a camera with noise. Nothing of the camera's noise is the same in all images.
pub(crate) static NOISY: LazyLock<Driven> = LazyLock::new(|| {
    let errors = "sensor = \"cmos\"\nseed = 5\nsensor_seed = 9\nposition_drift_m_per_s = [0.02, -0.01]\n\
        heading_bias_deg = 1\npitch_bias_deg = -0.5\nroll_bias_deg = 0.75\nheading_drift_deg_per_s = 0.1\n\
        electronics = { dsnu_e = 0, prnu = 0, read_noise_e = 12 }";
    Driven::over_the_ground(&format!("{SCAN}{errors}"))
});
