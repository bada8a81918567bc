//! What tests of clouds of several returns share: a pack of beams with a width, and the file of a cloud.

use std::path::{Path, PathBuf};

use glam::DVec3;
use raypencil_cast::{
    BeamReturns, CastSource, CloudFrame, Questions, RayPackChecked, cast, check_ray_pack, write_scan_pack,
};
use raypencil_scene::pattern::{Cone, Keep, Mounting, PatternRays, Returns, Spinning};
use raypencil_scene::{CastRay, NamedRaySet, Precision, Sides, Silent, Triangles};

use super::cloud_trial::{expect, head, of_frame, room};
use super::kept_packs::put_pack;

pub(super) const SENSOR: CloudFrame = CloudFrame::Sensor;

/// A point of a return as a simulator writes it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) place: DVec3,
    pub(super) ring: u16,
    pub(super) time: f64,
    pub(super) number: u32,
}

/// What a cloud's file has beside x, y and z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fields {
    None,
    /// ring and time.
    Keys,
    /// These and the number of the return.
    Numbers,
}

/// The head of 16 channels with beams of 30 mrad, 1 + 6 rays each: at 5 m a beam is 15 cm wide.
pub(super) fn set_of(mounting: &Mounting, keep: Keep) -> NamedRaySet {
    turn_of(20, mounting, keep)
}

/// A turn of that head in so many steps.
pub(super) fn turn_of(steps: u64, mounting: &Mounting, keep: Keep) -> NamedRaySet {
    let head = Spinning { steps, azimuth_step_deg: -360.0 / steps as f64, ..head() };
    let cone = Cone { divergence_rad: 0.03, rings: 1 };
    let beams = cone.spread(&head.rays("rays").expect("rays"), "cone").expect("a cone");
    let beams = PatternRays { returns: Some(Returns { keep, separation_m: 0.5 }), ..beams };
    NamedRaySet::new("head", mounting.place(beams, "rays").expect("poses"), Sides::Both).expect("a set")
}

/// A pack of beams.
pub(super) struct Trial {
    pub(super) folder: tempfile::TempDir,
    pub(super) set: NamedRaySet,
    pub(super) returns: BeamReturns,
    pub(super) mesh: Triangles,
}

impl Trial {
    pub(super) fn new(mesh: Triangles, set: NamedRaySet) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let pack = folder.path().join("pack");
        put_pack(&pack, &(&mesh, &set), |pack| {
            write_scan_pack(pack, (&mesh, &set, Sides::Both), &CastSource::default(), &Silent)
                .expect("a pack");
        });
        let answers = cast(&mesh, set.set.rays(), Sides::Both, Questions::default(), &Silent);
        let returns = BeamReturns::of(&answers, &set).expect("returns");
        Self { folder, set, returns, mesh }
    }

    pub(super) fn of_room(mounting: &Mounting, keep: Keep) -> Self {
        Self::new(room(), set_of(mounting, keep))
    }

    /// The points of returns in the sensor's frame, so many places a beam. `place` gives the point by the leading ray and the range.
    pub(super) fn points(
        &self,
        returns: &BeamReturns,
        place: &dyn Fn(&CastRay, f64, f64) -> DVec3,
    ) -> Vec<Point> {
        let elevations = self.set.elevations_deg.as_ref().expect("a head");
        let times = self.set.times.as_ref().expect("times");
        let of = |(index, told): (usize, &Option<raypencil_cast::BeamReturn>)| {
            let beam = index / returns.most();
            let channel = beam % elevations.len();
            let ring = elevations.iter().filter(|other| **other < elevations[channel]).count() as u16;
            let time = times[beam * returns.rays_of_beam()];
            let pose = self.set.mounting.at(time).expect("a pose").inverse();
            let place = told.as_ref().map_or(DVec3::NAN, |told| {
                pose * place(&self.set.set.rays()[told.ray], told.range, told.mean_range)
            });
            Point { place, ring, time, number: told.as_ref().map_or(0, |told| told.number) }
        };
        returns.told().iter().enumerate().map(of).collect()
    }

    pub(super) fn right(&self) -> Vec<Point> {
        self.points(&self.returns, &|ray, range, _| ray.origin + ray.direction * range)
    }

    /// The points that another rule would tell.
    pub(super) fn by(&self, keep: Keep) -> Vec<Point> {
        let set = set_of(&self.set.mounting, keep);
        let answers = cast(&self.mesh, set.set.rays(), Sides::Both, Questions::default(), &Silent);
        let returns = BeamReturns::of(&answers, &set).expect("returns");
        self.points(&returns, &|ray, range, _| ray.origin + ray.direction * range)
    }

    pub(super) fn write(&self, points: &[Point], fields: Fields) -> PathBuf {
        let path = self.folder.path().join("theirs.pcd");
        let (names, sizes, kinds) = match fields {
            Fields::None => ("", "", ""),
            Fields::Keys => (" ring time", " 2 4", " U F"),
            Fields::Numbers => (" ring time return", " 2 4 1", " U F U"),
        };
        let count = points.len();
        let mut bytes = format!(
            "VERSION 0.7\nFIELDS x y z{names}\nSIZE 4 4 4{sizes}\nTYPE F F F{kinds}\nWIDTH {count}\nHEIGHT 1\nPOINTS {count}\nDATA binary\n"
        )
        .into_bytes();
        for point in points {
            point.place.to_array().iter().for_each(|part| bytes.extend((*part as f32).to_le_bytes()));
            if fields != Fields::None {
                bytes.extend(point.ring.to_le_bytes());
                bytes.extend((point.time as f32).to_le_bytes());
            }
            if fields == Fields::Numbers {
                bytes.push(point.number as u8);
            }
        }
        std::fs::write(&path, bytes).expect("a file");
        path
    }

    pub(super) fn check(&self, file: &Path, precision: Precision) -> Result<RayPackChecked, String> {
        let conventions = of_frame(SENSOR);
        check_ray_pack(&self.folder.path().join("pack"), file, precision, conventions, &Silent)
            .map_err(|error| error.to_string())
    }

    /// All places in their order, and without the empty ones by ring and time, and by the numbers too.
    pub(super) fn judge_all(&self, points: &[Point]) -> [RayPackChecked; 3] {
        let dense: Vec<Point> = points.iter().copied().filter(|point| point.place.is_finite()).collect();
        [(Fields::None, points), (Fields::Keys, &dense), (Fields::Numbers, &dense)]
            .map(|(fields, points)| self.check(&self.write(points, fields), Precision::F64).expect("a check"))
    }

    #[track_caller]
    pub(super) fn expect_why(&self, points: &[Point], words: &str) {
        for checked in self.judge_all(points) {
            expect(&checked, words);
        }
    }
}

pub(super) const RULES: [Keep; 5] = [Keep::First, Keep::Strongest, Keep::Last, Keep::UpTo(2), Keep::UpTo(3)];
