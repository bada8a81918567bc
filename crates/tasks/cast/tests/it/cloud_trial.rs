//! What tests of clouds share: a room, a head in it, the points of a right simulator, and a pack with the file of a cloud.

use std::path::{Path, PathBuf};

use glam::DVec3;
use raypencil_cast::{
    CandidateConventions, CastSource, CloudConventions, CloudFrame, Questions, RayPackChecked, cast,
    check_ray_pack, write_scan_pack,
};
use raypencil_scene::pattern::{Mounting, Spinning, TimedPose, TimedPoses};
use raypencil_scene::{NamedRaySet, Pose, Precision, Sides, Silent, Triangles};

use super::kept_packs::put_pack;

/// A room without any symmetry, with a ridge in it and a gap in a wall: rays through the gap miss.
pub(super) fn room() -> Triangles {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let mut quad = |corners: [[f64; 3]; 4]| {
        let first = vertices.len() as u32;
        vertices.extend(corners);
        faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    quad([[-7.0, -5.0, 0.0], [12.0, -5.0, 0.3], [12.0, 9.0, 0.9], [-7.0, 9.0, 0.1]]);
    quad([[12.0, -5.0, -1.0], [12.0, 9.0, -1.0], [12.0, 9.0, 5.0], [12.0, -5.0, 5.0]]);
    quad([[-7.0, 9.0, -1.0], [-7.0, -5.0, -1.0], [-7.0, -5.0, 5.0], [-7.0, 9.0, 5.0]]);
    quad([[12.0, 9.0, -1.0], [-7.0, 9.0, -1.0], [-7.0, 9.0, 5.0], [12.0, 9.0, 5.0]]);
    // The last wall ends at x = 5.
    quad([[-7.0, -5.0, -1.0], [5.0, -5.0, -1.0], [5.0, -5.0, 5.0], [-7.0, -5.0, 5.0]]);
    quad([[3.0, 2.0, 0.0], [5.0, 6.0, 0.0], [4.5, 6.0, 3.0], [4.0, 2.5, 2.5]]);
    Triangles::new(vertices, faces).expect("a room")
}

/// A head of 16 channels and 120 sequences of 0.8 ms, which turns clockwise from 25 degrees on.
pub(super) fn head() -> Spinning {
    let preset = Spinning::preset("vlp-16").expect("a preset");
    let mut head =
        Spinning { azimuth_start_deg: 25.0, azimuth_step_deg: -3.0, steps: 120, period_s: 8e-4, ..preset };
    head.channels.iter_mut().for_each(|channel| channel.firing_s *= 12.0);
    head
}

/// A drive along a bend, from before the scan until after it: 3 m/s, and 40 degrees in a tenth of a second.
pub(super) fn bend() -> Mounting {
    let at = |k: i32| {
        let time_s = f64::from(k) * 0.025;
        let turn = Pose::from_axis_angle(DVec3::Z, time_s * 7.0);
        TimedPose {
            time_s,
            pose: Pose { position: DVec3::new(30.0 * time_s, 40.0 * time_s * time_s, 1.4), ..turn },
        }
    };
    Mounting::Moving(TimedPoses::new((-1..6).map(at).collect(), "poses").expect("poses"))
}

pub(super) fn still() -> Mounting {
    let turn = Pose::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.4);
    Mounting::Fixed(Pose { position: DVec3::new(1.0, 0.5, 1.5), ..turn })
}

pub(super) fn set_of(head: &Spinning, mounting: &Mounting) -> NamedRaySet {
    let rays = mounting.place(head.rays("rays").expect("rays"), "rays").expect("poses");
    NamedRaySet::new("head", rays, Sides::Both).expect("a set")
}

pub(super) fn of_frame(frame: CloudFrame) -> CandidateConventions<'static> {
    let cloud = CloudConventions { frame, ..CloudConventions::default() };
    CandidateConventions { cloud, ..CandidateConventions::default() }
}

/// A point as a simulator writes it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) place: DVec3,
    pub(super) ring: u16,
    pub(super) time: f64,
    pub(super) range: f64,
}

/// The points of a right simulator, in a frame, one for each ray: NaN for a miss.
pub(super) fn points(set: &NamedRaySet, frame: CloudFrame) -> Vec<Point> {
    let answers = cast(&room(), set.set.rays(), Sides::Both, Questions::default(), &Silent);
    let elevations = set.elevations_deg.as_ref().expect("a head");
    let rank =
        |channel: usize| elevations.iter().filter(|other| **other < elevations[channel]).count() as u16;
    let times = set.times.as_ref().expect("times");
    // Channel 0 fires first, the last one last.
    let end = |time: f64| set.mounting.at(time).expect("a pose");
    let [start, end] = [end(times[0]), end(times[times.len() - 1])];
    let point = |(index, read): (usize, &raypencil_scene::Reading<raypencil_cast::FirstHit>)| {
        let (place, range) = read.hit().map_or((DVec3::NAN, f64::NAN), |hit| (hit.point, hit.range));
        let pose = match frame {
            CloudFrame::Mesh => Pose::IDENTITY,
            CloudFrame::Sensor => set.mounting.at(times[index]).expect("a pose"),
            CloudFrame::SensorAtStart => start,
            CloudFrame::SensorAtEnd => end,
        };
        Point {
            place: pose.inverse() * place,
            ring: rank(index % elevations.len()),
            time: times[index],
            range,
        }
    };
    answers.first.iter().enumerate().map(point).collect()
}

/// What a cloud's file has beside x, y and z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fields {
    /// Nothing.
    None,
    /// ring and time.
    Keys,
    /// ring alone.
    Ring,
    /// time alone.
    Time,
    /// range.
    Range,
}

/// A pack of a scan, and the file of a cloud.
pub(super) struct Trial {
    pub(super) folder: tempfile::TempDir,
    pub(super) set: NamedRaySet,
}

impl Trial {
    pub(super) fn new(head: &Spinning, mounting: &Mounting) -> Self {
        Self::of(set_of(head, mounting))
    }

    pub(super) fn of(set: NamedRaySet) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let source = CastSource { mesh: "room".into(), rays: "head".into(), ..CastSource::default() };
        let pack = folder.path().join("pack");
        put_pack(&pack, &(&source, &set), |pack| {
            write_scan_pack(pack, (&room(), &set, Sides::Both), &source, &Silent).expect("a pack");
        });
        Self { folder, set }
    }

    /// Writes single precision, binary.
    pub(super) fn write(&self, points: &[Point], fields: Fields, [width, height]: [usize; 2]) -> PathBuf {
        let path = self.folder.path().join("theirs.pcd");
        let (names, sizes, kinds) = match fields {
            Fields::None => ("", "", ""),
            Fields::Keys => (" ring time", " 2 4", " U F"),
            Fields::Ring => (" ring", " 2", " U"),
            Fields::Time => (" time", " 4", " F"),
            Fields::Range => (" range", " 4", " F"),
        };
        let mut bytes = format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z{names}\nSIZE 4 4 4{sizes}\nTYPE F F F{kinds}\nWIDTH {width}\nHEIGHT {height}\n\
             VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
            points.len()
        )
        .into_bytes();
        for point in points {
            point.place.to_array().iter().for_each(|part| bytes.extend((*part as f32).to_le_bytes()));
            match fields {
                Fields::None => {}
                Fields::Keys => {
                    bytes.extend(point.ring.to_le_bytes());
                    bytes.extend((point.time as f32).to_le_bytes());
                }
                Fields::Ring => bytes.extend(point.ring.to_le_bytes()),
                Fields::Time => bytes.extend((point.time as f32).to_le_bytes()),
                Fields::Range => bytes.extend((point.range as f32).to_le_bytes()),
            }
        }
        std::fs::write(&path, bytes).expect("a file");
        path
    }

    pub(super) fn check(
        &self,
        file: &Path,
        conventions: CandidateConventions<'_>,
    ) -> Result<RayPackChecked, String> {
        self.check_of(file, Precision::F64, conventions)
    }

    pub(super) fn check_of(
        &self,
        file: &Path,
        precision: Precision,
        conventions: CandidateConventions<'_>,
    ) -> Result<RayPackChecked, String> {
        check_ray_pack(&self.folder.path().join("pack"), file, precision, conventions, &Silent)
            .map_err(|error| error.to_string())
    }

    /// Checks points, organised as the pack's rays, in a frame.
    pub(super) fn judge(&self, points: &[Point], fields: Fields, frame: CloudFrame) -> RayPackChecked {
        let file = self.write(points, fields, [16, points.len() / 16]);
        self.check(&file, of_frame(frame)).expect("a check")
    }

    /// The same points without those that are none, and without order.
    pub(super) fn judge_dense(&self, points: &[Point], fields: Fields, frame: CloudFrame) -> RayPackChecked {
        let dense: Vec<Point> = points.iter().copied().filter(|point| point.place.is_finite()).collect();
        let file = self.write(&dense, fields, [dense.len(), 1]);
        self.check(&file, of_frame(frame)).expect("a check")
    }

    /// The points fail, and this is why.
    #[track_caller]
    pub(super) fn expect_why(&self, points: &[Point], fields: Fields, frame: CloudFrame, words: &str) {
        expect(&self.judge(points, fields, frame), words);
    }
}

/// A cloud is wrong, and these words say why of all of it.
#[track_caller]
pub(super) fn expect(checked: &RayPackChecked, words: &str) {
    assert!(!checked.passes());
    let why = checked.why.as_deref().unwrap_or("no reason");
    assert!(why.contains(words) && why.starts_with("100.0000 %"), "{why}");
}
