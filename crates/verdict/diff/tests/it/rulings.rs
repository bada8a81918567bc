//! The referee's rulings on a camera that sees two walls one behind the other: which side is right, and in whose words.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use raypencil_diff::{ChannelRuling, Sides, Thresholds, diff, rule};
use raypencil_files::{Channel, Channels, Storage, Values};
use raypencil_judge::{Class, GroundTruth, Recorded, check};
use raypencil_scene::{
    Atmosphere, FluxModel, Image, Material, Mesh, Mounted, Pose, Precision, Scene, SensorId, Silent, rig,
};

/// A camera of four pixels in a row, which looks along z. Face 0 stands at 2 m and face 1 at 3 m, and the last pixel sees neither.
fn scene() -> Scene {
    let wall = |z: f32| [[0.2, -50.0, z], [-100.0, 0.0, z], [0.2, 50.0, z]];
    let vertices = [wall(2.0), wall(3.0)].concat();
    let ground = Material { name: "ground".into(), reflectivity: 0.25 };
    let mesh =
        Mesh::new(Pose::IDENTITY.position, vertices, vec![[0, 1, 2], [3, 4, 5]], vec![0; 2], vec![ground])
            .expect("two faces");
    let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: rig::camera(4, 1, 1e-3, 1e-2) };
    let air = Atmosphere { attenuation: 0.0 };
    Scene::new(Arc::new(mesh), camera, Vec::new(), air, FluxModel::Radiometric).expect("a scene")
}

/// Ranges and faces of the four pixels.
struct Answers {
    ranges: [f64; 4],
    faces: [f64; 4],
    /// Whether faces are stored as reals, of which "none" is NaN.
    has_real_faces: bool,
}

impl Answers {
    fn exact(truth: &GroundTruth<'_>) -> Self {
        let map = truth.answers().map(SensorId::Camera);
        let range = map.range.as_ref().expect("ranges");
        let ranges = [0, 1, 2, 3].map(|i| range.at(i, 0).get().unwrap_or(f64::INFINITY));
        assert!(ranges[..3].iter().all(|range| (2.0..2.1).contains(range)) && ranges[3].is_infinite());
        Self { ranges, faces: [0.0, 0.0, 0.0, f64::from(u32::MAX)], has_real_faces: false }
    }

    fn channels(&self) -> Channels {
        let channel =
            |storage, values| Channel { file: PathBuf::new(), name: String::new(), storage, values };
        let ranges = Values::Reals(Image::from_cells(4, 1, self.ranges.to_vec()));
        let real = |face: &f64| if *face == f64::from(u32::MAX) { f64::NAN } else { *face };
        let faces = match self.has_real_faces {
            true => channel(
                Storage::F32,
                Values::Reals(Image::from_cells(4, 1, self.faces.iter().map(real).collect())),
            ),
            false => channel(
                Storage::Whole,
                Values::Wholes(Image::from_cells(4, 1, self.faces.iter().map(|face| *face as u32).collect())),
            ),
        };
        let by_key = [
            ("camera/face.I".to_string(), faces),
            ("camera/range.T".to_string(), channel(Storage::F64, ranges)),
        ];
        Channels { by_key: by_key.into(), ..Channels::default() }
    }
}

/// The rulings on what both say, by channel.
fn rulings(truth: &GroundTruth<'_>, [a, b]: [&Answers; 2]) -> BTreeMap<String, ChannelRuling> {
    let channels = [a, b].map(Answers::channels);
    let sides = Sides { names: ["a", "b"], channels: [&channels[0], &channels[1]] };
    let difference = diff(&channels[0], &channels[1], &Thresholds::default()).expect("two channels");
    let checks = ["mine", "yours"].map(|name| {
        let channels = &channels[usize::from(name == "yours")];
        let recorded =
            Recorded::of_channels(name.into(), Path::new("."), truth.scene(), Precision::F64, channels);
        check(truth, &recorded.expect("a recording"), &Silent)
    });
    rule(&difference, &sides, truth, [&checks[0], &checks[1]]).channels
}

const RIGHT_WRONG: (Class, Class) = (Class::Agree, Class::Defect);
const WRONG_RIGHT: (Class, Class) = (Class::Defect, Class::Agree);

#[test]
fn each_side_is_wrong_in_its_own_cells_and_in_its_own_words() {
    let scene = scene();
    let truth = GroundTruth::certified(&scene, &Silent);
    let (mut a, mut b) = (Answers::exact(&truth), Answers::exact(&truth));
    let exact = a.ranges;
    a.ranges[0] = 7.25;
    b.ranges[1] = 8.75;
    (a.ranges[2], b.ranges[2]) = (9.5, 9.75);
    let found = &rulings(&truth, [&a, &b])["camera/range.T"];
    let both = (Class::Defect, Class::Defect);
    assert_eq!(found.by_class, BTreeMap::from([(WRONG_RIGHT, 1), (RIGHT_WRONG, 1), (both, 1)]));
    let told: Vec<_> = found.wrong.iter().map(|cell| (cell.place.i, cell.who)).collect();
    assert_eq!(told, [(0, "A"), (1, "B"), (2, "A and B")]);
    // Where both are wrong, in the words of A.
    for (cell, (said, exact)) in found.wrong.iter().zip([7.25, 8.75, 9.5].into_iter().zip(exact)) {
        let words = format!("off by {:.3e}", said - exact);
        assert!(cell.what.contains(&words), "{}: {}, not {words}", cell.who, cell.what);
    }
}

#[test]
fn a_range_of_a_wrong_face_is_wrong() {
    let scene = scene();
    let truth = GroundTruth::certified(&scene, &Silent);
    let (a, mut b) = (Answers::exact(&truth), Answers::exact(&truth));
    // Right for the face that is named, which stands behind the one that is hit.
    (b.faces[1], b.ranges[1]) = (1.0, 1.5 * b.ranges[1]);
    for (sides, expected) in [([&a, &b], RIGHT_WRONG), ([&b, &a], WRONG_RIGHT)] {
        let found = rulings(&truth, sides);
        for key in ["camera/range.T", "camera/face.I"] {
            assert_eq!(found[key].by_class, BTreeMap::from([(expected, 1)]), "{key}");
        }
    }
}

#[test]
fn cells_that_are_the_same_are_not_ruled_on_whatever_their_type() {
    let scene = scene();
    let truth = GroundTruth::certified(&scene, &Silent);
    let (a, mut b) = (Answers::exact(&truth), Answers::exact(&truth));
    // Two cells differ; of the last, where nothing is hit, one side says 4294967295 and the other NaN.
    (b.faces[1], b.faces[2], b.has_real_faces) = (1.0, 1.0, true);
    for (sides, expected) in [([&a, &b], RIGHT_WRONG), ([&b, &a], WRONG_RIGHT)] {
        assert_eq!(rulings(&truth, sides)["camera/face.I"].by_class, BTreeMap::from([(expected, 2)]));
    }
}
