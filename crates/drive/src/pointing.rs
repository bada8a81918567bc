//! Blur against pointing: how far each moves what a stripe says of the ground. "Calculations show that diffraction effects
//! are not important compared to camera pointing errors arising from vehicle inertial navigation sensors." (Paper, §5)
//! `docs/evidence/results.md` has the table.

use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

use crate::eye::Eye;
use crate::job::{DriveError, DriveJob};
use raypencil_report::number;
use raypencil_rover::{
    Attitude, CameraImage, Detection, Drive, Exposure, Extraction, LocalisationErrors, MeasuredPoint, Rig,
    StripeLocation,
};
use raypencil_scene::{Image, Pose, Renderer, SceneError};
use raypencil_sensor::{Optics, Psf};
use raypencil_terrain::HeightIndex;

/// What an error does to a point of a stripe, to first order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lever {
    /// The point is so far before the vehicle's origin, metres.
    pub ahead: f64,
    /// Range by which it moves away if its image moves down by a pixel, metres: the camera is below the beam.
    pub range_per_pixel: f64,
    /// Elevation by which it falls then, metres.
    pub elevation_per_pixel: f64,
}

impl Lever {
    /// Of a point `ahead` of the vehicle's origin on the sheet of a beam, for a camera and beams that look straight ahead
    /// and down, as in the default rig. How far aside it is does not matter.
    ///
    /// The sheet looks down by beta and passes the camera at a height b above it. Horizontally d before the camera, a point
    /// of the sheet is seen at an angle a below the horizon, and d = b / (tan(beta) - tan(a)). So
    /// dd/da = d^2 / (b cos^2(a)) metres per radian. A pixel p is da = (p / f_c) cos^2(a - gamma) radians there, for a camera
    /// that looks down by gamma. The point stays on the sheet: farther by dd, it is lower by dd tan(beta).
    pub fn at(rig: &Rig, beam: usize, ahead: f64) -> Self {
        let Sheet { eye, gamma, slope, source } = Sheet::of(rig, beam);
        let d = ahead - eye.x;
        let b = source.z - eye.z + slope * (source.x - eye.x);
        let a = libm::atan2(slope * d - b, d);
        let (cos_a, cos_off) = (libm::cos(a), libm::cos(a - gamma));
        let camera = &rig.camera.sensor;
        let pixel = camera.pixel_pitch[1] / camera.focal_length * cos_off * cos_off;
        let range_per_pixel = d * d / (b * cos_a * cos_a) * pixel;
        Self { ahead, range_per_pixel, elevation_per_pixel: range_per_pixel * slope }
    }

    /// Where the sheet meets the ground if that is level.
    pub fn on_level_ground(rig: &Rig, beam: usize) -> Self {
        let Sheet { slope, source, .. } = Sheet::of(rig, beam);
        Self::at(rig, beam, source.x + source.z / slope)
    }

    /// Elevation by which the point falls if the vehicle believes its nose to be lower by `pitch` than it is, metres.
    pub fn elevation_of_pitch(&self, pitch: f64) -> f64 {
        self.ahead * pitch
    }
}

/// A camera and a sheet of light from the side.
struct Sheet {
    eye: DVec3,
    gamma: f64,
    slope: f64,
    source: DVec3,
}

impl Sheet {
    fn of(rig: &Rig, beam: usize) -> Self {
        let (camera, beam) = (rig.camera.vehicle_from_sensor, rig.beams[beam].vehicle_from_sensor);
        let (axis, sheet) = (camera.rotate(DVec3::Z), beam.rotate(DVec3::Z));
        Self {
            eye: camera.position,
            gamma: libm::atan2(-axis.z, axis.x),
            slope: -sheet.z / sheet.x,
            source: beam.position,
        }
    }
}

/// How far the points of one stripe are from those of another view of it, column by column of the image. All but the count
/// are roots of mean squares.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moved {
    /// Columns in which both have just one edge point.
    pub columns: u64,
    /// Of the edge, pixels.
    pub rows: f64,
    /// Of the point's elevation, metres.
    pub elevation: f64,
    /// Of the point's elevation as [`Lever`] has it, metres.
    pub formula: f64,
    /// Of the point's distance before the vehicle, metres: not a move.
    pub ahead: f64,
}

impl Moved {
    fn add(&mut self, rows: f64, elevation: f64, formula: f64, ahead: f64) {
        self.columns += 1;
        self.rows += rows * rows;
        self.elevation += elevation * elevation;
        self.formula += formula * formula;
        self.ahead += ahead * ahead;
    }

    fn roots(self) -> Self {
        let root = |sum: f64| (sum / self.columns.max(1) as f64).sqrt();
        Self {
            columns: self.columns,
            rows: root(self.rows),
            elevation: root(self.elevation),
            formula: root(self.formula),
            ahead: root(self.ahead),
        }
    }

    /// The error of pitch that moves these points' elevations as far, radians.
    pub fn as_pitch(&self) -> f64 {
        self.elevation / self.ahead
    }
}

/// The points of a first frame, where they were taken to be, and the vehicle likewise.
type Look = (Vec<(MeasuredPoint, DVec3)>, Pose);

/// What a drive's first frame measures.
fn look(job: &DriveJob, renderer: &dyn Renderer) -> Result<Look, DriveError> {
    let mut plan = job.plan.clone();
    plan.scans = None;
    let mut drive = Drive::new(plan, Arc::clone(&job.mesh))?;
    let mut exposures = 0;
    let mut develop = |_: Exposure, light: Image<f64>| {
        let numbers = job.sensor.numbers(&light, None, exposures);
        exposures += 1;
        CameraImage::Numbers(numbers)
    };
    let frame = drive.step(&Eye::new(renderer, job, None), &mut develop)?;
    let frame =
        frame.ok_or_else(|| SceneError::new("drive.route", job.plan.route.start, "a frame to look at"))?;
    Ok((frame.measured.iter().map(|&one| (one, frame.believed * one.point)).collect(), frame.believed))
}

/// How far one beam's points moved from one look to another; `formula` says it of a point from the rows by which its edge
/// moved.
fn moved(beam: usize, from: &Look, to: &Look, formula: impl Fn(f64, DVec3) -> f64) -> Moved {
    let columns = |look: &Look| {
        let mut columns: BTreeMap<u32, Vec<(MeasuredPoint, DVec3)>> = BTreeMap::new();
        for &(measured, point) in look.0.iter().filter(|(measured, _)| measured.beam == beam) {
            columns.entry(measured.edge.i).or_default().push((measured, point));
        }
        columns
    };
    let (before, after) = (columns(from), columns(to));
    let mut all = Moved::default();
    for (i, one) in &before {
        if let ([(old, was)], Some([(new, is)])) = (one.as_slice(), after.get(i).map(Vec::as_slice)) {
            let rows = new.edge.row - old.edge.row;
            all.add(rows, is.z - was.z, formula(rows, old.point), old.point.x);
        }
    }
    all.roots()
}

/// The optics of the table: what blurs, and nothing else.
fn blurs(wavelength: f64) -> [(&'static str, Optics); 3] {
    let sharp = Optics { oversampling: 4, ..Optics::PERFECT };
    let airy = Psf::Airy { wavelength, f_number: 4.0, rings: 8 };
    [
        ("diffraction at f/4", Optics { blurs: vec![airy], ..sharp.clone() }),
        ("focused at 4 m", Optics { focus: Some(4.0), ..sharp.clone() }),
        ("focused at 1 m", Optics { focus: Some(1.0), ..sharp }),
    ]
}

/// The errors of pitch of the table, degrees.
const PITCHES: [f64; 4] = [0.01, 0.1, 0.5, 1.0];

/// The table: each error's shift of the first frame's points of a drive, by the whole chain and by [`Lever`].
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
    let mut row = |edge: &str, cause: &str, moved: [Moved; 2], formula: bool| {
        let pair = |of: fn(&Moved) -> f64| moved.each_ref().map(|one| number(of(one))).join(", ");
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
        let sharp = look(&job, renderer)?;
        let ground = HeightIndex::new(&job.mesh);
        let own = [0, 1].map(|beam| {
            let mut own = Moved::default();
            for (measured, point) in sharp.0.iter().filter(|(measured, _)| measured.beam == beam) {
                if let Some(z) = ground.height_at(point.x, point.y) {
                    own.add(0.0, point.z - z, 0.0, measured.point.x);
                }
            }
            own.roots()
        });
        row(words, "none: against the true ground", own, false);
        for (cause, optics) in blurs(job.sensor.wavelength) {
            let blurred = look(&DriveJob { optics, ..job.clone() }, renderer)?;
            let moved = [0, 1].map(|beam| {
                moved(beam, &sharp, &blurred, |rows, point| {
                    // Where the vehicle is tilted, both directions have a share in the elevation.
                    let lever = Lever::at(&rig, beam, point.x);
                    sharp.1.rotate(DVec3::new(lever.range_per_pixel, 0.0, -lever.elevation_per_pixel)).z
                        * rows
                })
            });
            row(words, cause, moved, true);
        }
    }
    job.plan.extraction = usual;
    let level = look(&job, renderer)?;
    for degrees in PITCHES {
        let pitch = degrees.to_radians();
        let attitude_bias = Attitude { pitch_down: pitch, ..Attitude::default() };
        job.plan.errors = LocalisationErrors { attitude_bias, ..LocalisationErrors::default() };
        let tilted = look(&job, renderer)?;
        let moved = [0, 1].map(|beam| {
            moved(beam, &level, &tilted, |_, point| Lever::at(&rig, beam, point.x).elevation_of_pitch(pitch))
        });
        row("fixed, pixel", &format!("pitch, {degrees} deg"), moved, true);
    }
    Ok(out)
}

#[cfg(test)]
#[path = "../tests/unit/pointing.rs"]
mod tests;
