//! Blur against pointing errors: how far each moves the measured points of a stripe. "Calculations show that
//! diffraction effects are not important compared to camera pointing errors arising from vehicle inertial navigation
//! sensors." (Paper, §5) `docs/evidence/results.md` has the table.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use raypencil::drive::{DriveError, DriveJob, ThroughOptics};
use raypencil::report::number;
use raypencil::rover::{
    Attitude, CameraImage, Detection, Drive, Exposure, Extraction, LocalisationErrors, MeasuredPoint,
    StripeLocation,
};
use raypencil::sensor::{Optics, Psf};
use raypencil::terrain::HeightIndex;
use raypencil::{Image, Pose, Renderer, SceneError};

use super::sensitivity::StripeSensitivity;

/// Pitch errors of the table, degrees.
const PITCHES_DEG: [f64; 4] = [0.01, 0.1, 0.5, 1.0];

/// Shift of a stripe's points between two measurements, column by column of the image. All values but the count are
/// root mean squares.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StripeShift {
    /// Number of columns in which both measurements have exactly one edge point.
    pub columns: u64,
    /// Shift of the edge, pixels.
    pub rows: f64,
    /// Shift of the point's elevation, metres.
    pub elevation: f64,
    /// Shift of the point's elevation by [`StripeSensitivity`], metres.
    pub formula: f64,
    /// Distance of the point before the vehicle, metres (no shift).
    pub ahead: f64,
}

impl StripeShift {
    /// Adds the squares of one column.
    fn add(&mut self, rows: f64, elevation: f64, formula: f64, ahead: f64) {
        self.columns += 1;
        self.rows += rows * rows;
        self.elevation += elevation * elevation;
        self.formula += formula * formula;
        self.ahead += ahead * ahead;
    }

    /// Root mean squares of the sums of squares.
    fn root_mean_squares(self) -> Self {
        let root = |sum: f64| (sum / self.columns.max(1) as f64).sqrt();
        Self {
            columns: self.columns,
            rows: root(self.rows),
            elevation: root(self.elevation),
            formula: root(self.formula),
            ahead: root(self.ahead),
        }
    }

    /// Pitch error that shifts the elevations of these points as far, radians.
    pub fn as_pitch(&self) -> f64 {
        self.elevation / self.ahead
    }
}

/// Measurement of a drive's first frame.
pub struct FirstFrame {
    /// Measured points, each with its estimated global position.
    points: Vec<(MeasuredPoint, DVec3)>,
    /// Estimated pose, `global_from_vehicle`.
    believed: Pose,
}

/// Drives the first frame of a job, without scans.
pub fn first_frame(job: &DriveJob, renderer: &dyn Renderer) -> Result<FirstFrame, DriveError> {
    let mut plan = job.plan.clone();
    plan.scans = None;
    let mut drive = Drive::new(plan, Arc::clone(&job.mesh))?;
    let mut exposures = 0;
    let mut camera_pipeline = |_: Exposure, flux: Image<f64>| {
        let numbers = job.sensor.numbers(&flux, None, exposures);
        exposures += 1;
        CameraImage::Numbers(numbers)
    };
    let frame = drive.step(&ThroughOptics::new(renderer, job), &mut camera_pipeline)?;
    let frame = frame
        .ok_or_else(|| SceneError::new("drive.route", job.plan.route.start, "a route with a first frame"))?;
    let points = frame.measured.iter().map(|&one| (one, frame.believed * one.point)).collect();
    Ok(FirstFrame { points, believed: frame.believed })
}

/// Shift of one beam's points from one measurement to another. `formula` gives the predicted shift of the elevation of
/// a point, metres, from the shift of its edge, pixels, and from the point in the vehicle frame.
pub fn shift(
    beam: usize,
    from: &FirstFrame,
    to: &FirstFrame,
    formula: impl Fn(f64, DVec3) -> f64,
) -> StripeShift {
    let columns = |measurement: &FirstFrame| {
        let mut columns: BTreeMap<u32, Vec<(MeasuredPoint, DVec3)>> = BTreeMap::new();
        for &(measured, point) in measurement.points.iter().filter(|(measured, _)| measured.beam == beam) {
            columns.entry(measured.edge.i).or_default().push((measured, point));
        }
        columns
    };
    let (before, after) = (columns(from), columns(to));
    let mut all = StripeShift::default();
    for (i, one) in &before {
        if let ([(old, was)], Some([(new, is)])) = (one.as_slice(), after.get(i).map(Vec::as_slice)) {
            let rows = new.edge.row - old.edge.row;
            all.add(rows, is.z - was.z, formula(rows, old.point), old.point.x);
        }
    }
    all.root_mean_squares()
}

/// Optics of the table, with their names: each blurs in one way.
fn blurs(wavelength: f64) -> [(&'static str, Optics); 3] {
    let sharp = Optics { oversampling: 4, ..Optics::PERFECT };
    let airy = Psf::Airy { wavelength, f_number: 4.0, rings: 8 };
    [
        ("diffraction at f/4", Optics { blurs: vec![airy], ..sharp.clone() }),
        ("focused at 4 m", Optics { focus: Some(4.0), ..sharp.clone() }),
        ("focused at 1 m", Optics { focus: Some(1.0), ..sharp }),
    ]
}

/// Table in Markdown: the shift of the points of a drive's first frame by each blur and each pitch error, once by the
/// whole simulation and once by [`StripeSensitivity`].
///
/// # Errors
/// As [`Drive::new`] and [`Drive::step`].
pub fn pointing_table(job: &DriveJob, renderer: &dyn Renderer) -> Result<String, DriveError> {
    let mut job = job.clone();
    job.plan.errors = LocalisationErrors::default();
    job.optics = Optics { oversampling: 4, ..Optics::PERFECT };
    let rig = job.plan.rig.clone();
    let mut out = String::from(
        "| edge | error | edge shift, pixels | elevation, mm | by formula, mm | as a pitch error of |\n\
         | --- | --- | ---: | ---: | ---: | ---: |\n",
    );
    let mut row = |edge: &str, cause: &str, shifts: [StripeShift; 2], formula: bool| {
        let pair = |of: fn(&StripeShift) -> f64| shifts.each_ref().map(|one| number(of(one))).join(", ");
        let formula = if formula { pair(|one| 1e3 * one.formula) } else { String::new() };
        out += &format!(
            "| {edge} | {cause} | {} | {} | {formula} | {} deg |\n",
            pair(|one| one.rows),
            pair(|one| 1e3 * one.elevation),
            pair(|one| one.as_pitch().to_degrees()),
        );
    };

    let usual = job.plan.extraction;
    let otsu = Extraction { detection: Detection::Otsu, place: StripeLocation::SubPixel, ..usual };
    for (words, extraction) in [("fixed, pixel", usual), ("Otsu, sub-pixel", otsu)] {
        job.plan.extraction = extraction;
        let sharp = first_frame(&job, renderer)?;
        let ground = HeightIndex::new(&job.mesh);
        let own = [0, 1].map(|beam| {
            let mut own = StripeShift::default();
            for (measured, point) in sharp.points.iter().filter(|(measured, _)| measured.beam == beam) {
                if let Some(z) = ground.height_at(point.x, point.y) {
                    own.add(0.0, point.z - z, 0.0, measured.point.x);
                }
            }
            own.root_mean_squares()
        });
        row(words, "none: against the true ground", own, false);
        for (cause, optics) in blurs(job.sensor.wavelength) {
            let blurred = first_frame(&DriveJob { optics, ..job.clone() }, renderer)?;
            let shifts = [0, 1].map(|beam| {
                shift(beam, &sharp, &blurred, |rows, point| {
                    // On a tilted vehicle, both components contribute to the elevation.
                    let StripeSensitivity { range_per_pixel, elevation_per_pixel, .. } =
                        StripeSensitivity::at(&rig, beam, point.x);
                    sharp.believed.rotate(DVec3::new(range_per_pixel, 0.0, -elevation_per_pixel)).z * rows
                })
            });
            row(words, cause, shifts, true);
        }
    }
    job.plan.extraction = usual;
    let level = first_frame(&job, renderer)?;
    for degrees in PITCHES_DEG {
        let pitch = degrees.to_radians();
        let attitude_bias = Attitude { pitch_down: pitch, ..Attitude::default() };
        job.plan.errors = LocalisationErrors { attitude_bias, ..LocalisationErrors::default() };
        let tilted = first_frame(&job, renderer)?;
        let shifts = [0, 1].map(|beam| {
            shift(beam, &level, &tilted, |_, point| {
                StripeSensitivity::at(&rig, beam, point.x).elevation_of_pitch(pitch)
            })
        });
        row("fixed, pixel", &format!("pitch, {degrees} deg"), shifts, true);
    }
    Ok(out)
}
