//! A drive, ready to be driven: the rover's plan and the camera that turns light into numbers.

use glam::{DVec2, DVec3};

use raypencil_rover::{DrivePlan, Extraction, Rig, Route, StripeLocation};
use raypencil_scene::{Pose, Scene, SceneError};
use raypencil_sensor::{ImageSensor, Optics, PRESET_NAMES, Psf, Speckle, Sunlight, preset};

/// Maximum cells of the fine image on which optics blur: 2 GiB of them.
const MAX_FINE_CELLS: u64 = 1 << 28;

/// Pencils across each pixel of the camera, along the fan. CHOICE: with fewer than two some columns of the image see no
/// pencil and the stripe has gaps; four leave it unbroken on slanted ground too.
const DEFAULT_PENCILS_PER_PIXEL: f64 = 4.0;

/// Frame in which waypoints are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WaypointFrame {
    /// That of the vehicle at its start: x forward, y to the left, metres.
    #[default]
    Vehicle,
    /// The global one.
    Global,
}

/// A drive as a scene file describes it, in SI. All that a file leaves out has the default of `rover` or of the sensor
/// preset.
///
/// The keys are written straight into these values while the file is read, so that a message can point to its key. Rig,
/// start and heading follow later, once the ground is loaded and the vehicle stands on it: [`DriveSetup::place`] is the
/// step that remains.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveSetup {
    /// Plan of the rover.
    pub plan: DrivePlan,
    /// Waypoints in their frame, metres. [`DriveSetup::place`] makes the route's waypoints of them.
    pub waypoints: Vec<DVec2>,
    /// Frame of the waypoints.
    pub waypoint_frame: WaypointFrame,
    /// Whether the file asks for a camera: a sensor preset, optics, electronics or a sun.
    pub has_camera: bool,
    /// Threshold as a share of the image's maximum, where the image is one of flux.
    pub threshold_share: f64,
    /// Name of the sensor preset, one of [`PRESET_NAMES`].
    pub preset: &'static str,
    /// Optics of the camera: step 6.
    pub optics: Optics,
    /// Image sensor of the camera: steps 7 and 8.
    pub sensor: ImageSensor,
    /// Sun and sky behind the stripes; `None`: only the laser shines.
    pub sunlight: Option<Sunlight>,
    /// Whether a second image without the laser is subtracted from each.
    pub subtract_unlit: bool,
    /// Minimum number of pencils across each pixel of the camera; beams with fewer get more columns.
    pub pencils_per_pixel: f64,
    /// Change of the light or the electronics, in words, that the [`default_threshold`] in use does not account for.
    /// `None`: no such change, or the file gives the threshold. The numbers alone cannot tell: a file may give the
    /// default.
    pub threshold_ignores: Option<&'static str>,
}

/// Default threshold of images of flux, as a share of their maximum. CHOICE: as in [`default_threshold`], a fiftieth.
const DEFAULT_THRESHOLD_SHARE: f64 = 0.02;

/// Default threshold between lit and dark pixels for a sensor preset, DN; for an unknown name that of `ideal`.
///
/// CHOICE: about a fiftieth of a stripe of the default rig (24,000, 84 and 1620 DN, docs/theory/sensor.md) above the
/// bias, so that a stripe 10 m away still passes; several times what noise reaches.
pub fn default_threshold(preset: &str) -> f64 {
    match preset {
        "ccd_1989" => 4.0,
        "cmos" => 100.0,
        _ => 400.0,
    }
}

/// Rig of a scene whose vehicle stands at `vehicle` in the global frame.
pub(crate) fn rig_of(scene: &Scene, vehicle: &Pose) -> Rig {
    let position = vehicle.position - scene.mesh().origin();
    Rig::from_scene(scene, Pose { position, ..*vehicle })
}

impl DriveSetup {
    /// Drive of a rig over these waypoints (metres, in their frame), with the preset `ideal` and all other defaults.
    ///
    /// ```
    /// use raypencil_scene_io::{DriveSetup, Overrides, WaypointFrame, load};
    ///
    /// let loaded = load("pyramids", &Overrides::default())?;
    /// let ahead = vec![[3.0, 0.0].into()];
    /// let mut drive = DriveSetup::new(loaded.rig(), ahead, WaypointFrame::Vehicle);
    /// drive.place(&loaded.scene, &loaded.vehicle);
    /// // The default vehicle stands at (0, 0) and drives 0.3 m/s: 3 m take 10 s, 100 frames and the first.
    /// assert_eq!(drive.plan.route.frame(100).map(|pose| pose.driven), Some(3.0));
    /// assert_eq!(drive.plan.route.frame(101), None);
    /// # Ok::<(), raypencil_scene_io::SceneIoError>(())
    /// ```
    pub fn new(rig: Rig, waypoints: Vec<DVec2>, waypoint_frame: WaypointFrame) -> Self {
        let name = PRESET_NAMES[0];
        let (optics, sensor) = preset(name).expect("a name of the list of presets");
        // CHOICE: centroids. A stripe of the default rig is about a pixel thin, and the last lit pixel of it is off by half
        // a pixel either way; on level ground by the same on all of it, so that the map would rise or fall on the way.
        let threshold = Extraction::thresholding(default_threshold(name));
        let extraction = Extraction { place: StripeLocation::Centroid, ..threshold };
        let mut drive = Self {
            plan: DrivePlan::new(rig, Route::through(DVec2::ZERO, Vec::new()), extraction),
            waypoints,
            waypoint_frame,
            has_camera: false,
            threshold_share: DEFAULT_THRESHOLD_SHARE,
            preset: name,
            optics,
            sensor,
            sunlight: None,
            subtract_unlit: false,
            pencils_per_pixel: DEFAULT_PENCILS_PER_PIXEL,
            threshold_ignores: None,
        };
        drive.fit_to_camera();
        drive
    }

    /// Takes optics and sensor from a preset.
    pub(crate) fn use_preset(&mut self, name: &'static str) {
        self.preset = name;
        (self.optics, self.sensor) = preset(name).expect("a name of the list of presets");
        self.fit_to_camera();
    }

    /// Places the drive in a resolved scene, with the vehicle at `vehicle` in the global frame. Sets rig, start,
    /// heading, air and model of the flux, and fits optics and sensor to the rig.
    pub fn place(&mut self, scene: &Scene, vehicle: &Pose) {
        let forward = vehicle.rotate(DVec3::X);
        self.plan.rig = rig_of(scene, vehicle);
        self.plan.route.start = vehicle.position.truncate();
        self.plan.route.heading = libm::atan2(forward.y, forward.x);
        self.plan.route.waypoints = match self.waypoint_frame {
            WaypointFrame::Global => self.waypoints.clone(),
            WaypointFrame::Vehicle => {
                let (start, ahead) = (self.plan.route.start, forward.truncate().normalize_or_zero());
                self.waypoints.iter().map(|at| start + ahead * at.x + ahead.perp() * at.y).collect()
            }
        };
        self.plan.atmosphere = scene.atmosphere();
        self.plan.flux_model = scene.flux_model();
        self.plan.times.duration = self.sensor.exposure;
        self.plan.times.has_unlit = self.subtract_unlit;
        self.fit_to_camera();
    }

    /// Diffraction of the rig's camera at the wavelength of the first beam, up to so many dark rings.
    pub(crate) fn airy(&self, rings: u32) -> Psf {
        let camera = &self.plan.rig.camera.sensor;
        Psf::Airy {
            wavelength: self.sensor.wavelength,
            f_number: camera.focal_length / camera.aperture,
            rings,
        }
    }

    /// Speckle of this contrast behind the rig's camera, of the first beam's light. `None` for a contrast of 0.
    pub(crate) fn speckle(&self, contrast: f64) -> Option<Speckle> {
        let camera = &self.plan.rig.camera.sensor;
        (contrast != 0.0).then(|| Speckle::behind(camera, self.sensor.wavelength, contrast))
    }

    /// Fits wavelength, speckle and diffraction, which a preset has for the default rig, to the rig of this drive.
    fn fit_to_camera(&mut self) {
        if let Some(beam) = self.plan.rig.beams.first() {
            self.sensor.wavelength = beam.sensor.wavelength;
        }
        if let Some(speckle) = self.optics.speckle {
            self.optics.speckle = self.speckle(speckle.contrast);
        }
        for index in 0..self.optics.blurs.len() {
            if let Psf::Airy { rings, .. } = self.optics.blurs[index] {
                self.optics.blurs[index] = self.airy(rings);
            }
        }
    }

    /// Checks optics and sensor, alone and together with the rig's camera.
    ///
    /// # Errors
    /// Names the first field that is out of range, as a part of `drive`.
    pub fn validate_camera(&self) -> Result<(), SceneError> {
        let Self { optics, sensor, .. } = self;
        let camera = self.plan.rig.camera.sensor;
        optics.validate("drive.optics")?;
        if let Some(focus) = optics.focus.filter(|&focus| focus <= camera.focal_length) {
            let expected = format!("beyond the focal length, {} m", camera.focal_length);
            return Err(SceneError::new("drive.optics.focus", focus, expected));
        }
        let fine = [camera.width, camera.height].map(|side| u64::from(side) * u64::from(optics.oversampling));
        if fine[0] * fine[1] > MAX_FINE_CELLS {
            let value = format!("{}, an image of {} x {} cells", optics.oversampling, fine[0], fine[1]);
            let expected = format!("an image of at most {MAX_FINE_CELLS} cells");
            return Err(SceneError::new("drive.optics.oversampling", value, expected));
        }
        if let Some(speckle) = optics.speckle {
            let cell = camera.pixel_pitch.map(|pitch| pitch / f64::from(optics.oversampling));
            speckle.validate_on("drive.optics.speckle", cell)?;
        }
        sensor.validate("drive.electronics")
    }
}
