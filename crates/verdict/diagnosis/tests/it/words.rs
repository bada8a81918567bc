//! The words of a diagnosis: plain, and with a place of the documentation that exists.

use std::path::Path;

use raypencil_diagnosis::{
    AngleUnit, Cosine, CutBy, Diagnosis, FrameAxes, Held, Leg, Length, LengthUnit, Mistake, Reason, Turn,
    Vectors,
};
use raypencil_scene::SensorId;

fn all() -> Vec<Mistake> {
    let [a, b, c] = [Cosine::Incidence, Cosine::OffAxis, Cosine::Emission];
    vec![
        Mistake::RowsReversed,
        Mistake::ColumnsReversed,
        Mistake::Transposed,
        Mistake::Shifted { columns: 1, rows: 0 },
        Mistake::Shifted { columns: -1, rows: 0 },
        Mistake::Shifted { columns: 2, rows: -1 },
        Mistake::MissWritten(-1.0),
        Mistake::MissAtMaximumRange,
        Mistake::FacesShifted(1),
        Mistake::FacesReordered,
        Mistake::DepthForRange,
        Mistake::ParameterForRange,
        Mistake::RangeForDepth,
        Mistake::ParameterForDepth,
        Mistake::Unit(LengthUnit::Millimetres),
        Mistake::Unit(LengthUnit::Centimetres),
        Mistake::Unit(LengthUnit::Kilometres),
        Mistake::Unit(LengthUnit::Feet),
        Mistake::AxesYUp,
        Mistake::AxesYUpInverse,
        Mistake::Axes { of: Vectors::Both, from: [1, 0, 2], sign: [1, -1, 1] },
        Mistake::Axes { of: Vectors::Points, from: [1, 0, 2], sign: [1, -1, 1] },
        Mistake::Axes { of: Vectors::Normals, from: [1, 0, 2], sign: [1, -1, 1] },
        Mistake::Inverse(Length::Range),
        Mistake::Squared(Length::All),
        Mistake::ZBuffer { low: 0.0, low_at: 0.1, one_at: 100.0 },
        Mistake::ZBuffer { low: -1.0, low_at: f64::INFINITY, one_at: 0.25 },
        Mistake::HoldsBeam(1),
        Mistake::BeamFluxExchanged,
        Mistake::VisibleReversed,
        Mistake::NoShadowTest,
        Mistake::HitsVisible,
        Mistake::PointsFromSensor,
        Mistake::FluxOfWrongPencils,
        Mistake::PixelPitch { stated: [4e-5; 2], truth: [3.84e-5, 4e-5] },
        Mistake::Thickness { stated: 0.0, truth: 0.02 },
        Mistake::PoseInverted,
        Mistake::QuaternionOrder,
        Mistake::SensorFrame { of: Vectors::Both, axes: FrameAxes::Optical },
        Mistake::SensorFrame { of: Vectors::Points, axes: FrameAxes::OpenGl },
        Mistake::SensorFrame { of: Vectors::Normals, axes: FrameAxes::Body },
        Mistake::PointsRounded(0.001),
        Mistake::DistanceForView,
        Mistake::GlobalFrame,
        Mistake::NormalsReversed,
        Mistake::NormalsNotUnit,
        Mistake::CosinesNegated,
        Mistake::AngleForCosine(AngleUnit::Radians),
        Mistake::AngleForCosine(AngleUnit::Degrees),
        Mistake::CosinesExchanged([c, b, a]),
        Mistake::PixelRowsFromBottom,
        Mistake::PixelColumnsFromRight,
        Mistake::PixelsExchanged,
        Mistake::OtherFluxModel,
        Mistake::AttenuationOn(Leg::Out),
        Mistake::AttenuationOn(Leg::Back),
        Mistake::AttenuationOn(Leg::Neither),
        Mistake::FluxFactor(3.0),
        Mistake::SinglePrecision,
        Mistake::BacksHit,
        Mistake::NearPlaneIgnored,
        Mistake::MaximumRangeIgnored,
        Mistake::MaximumRangeAsDepth,
        Mistake::NearLimit(1.25),
        Mistake::EdgesOpen,
        Mistake::CornerRays { columns: -0.5, rows: -0.5 },
        Mistake::CornerRays { columns: 0.25, rows: 0.0 },
        Mistake::CornerRays { columns: 0.25, rows: -1.5 },
        Mistake::Affine { of: Length::Range, factor: 1.0, offset: 0.01 },
        Mistake::Affine { of: Length::Range, factor: 1.0, offset: -0.01 },
        Mistake::Affine { of: Length::Depth, factor: 1.001, offset: 0.0 },
        Mistake::Affine { of: Length::All, factor: 1.001, offset: 0.5 },
        Mistake::Affine { of: Length::All, factor: 1.001, offset: -0.5 },
        Mistake::PointsMoved([0.0, 0.0, -1.5]),
        Mistake::HalfPrecision(Length::Range),
        Mistake::FromPlane(Length::Range),
        Mistake::FromPlane(Length::All),
        Mistake::Rounded { of: Length::Range, quantum: 0.001, down: false },
        Mistake::Rounded { of: Length::All, quantum: 0.001, down: true },
        cut(CutBy::Range, true, 12.5, 0, Held::NoHit),
        cut(CutBy::Depth, true, 12.5, 0, Held::NoHit),
        cut(CutBy::Range, false, 1.5, 0, Held::NoHit),
        cut(CutBy::RangeOrDepth, true, 12.5, 0, Held::NoHit),
        cut(CutBy::RangeOrDepth, false, 1.5, 0, Held::NoHit),
        cut(CutBy::Range, true, 12.5, 0, Held::Constant(12.5)),
        cut(CutBy::Row, true, 71.0, 1, Held::NoHit),
        cut(CutBy::Row, false, 0.0, 1, Held::NoHit),
        cut(CutBy::Row, true, 70.0, 2, Held::NoHit),
        cut(CutBy::Column, true, 95.0, 1, Held::Constant(0.0)),
        cut(CutBy::Column, true, 95.0, 1, Held::Neighbour),
        cut(CutBy::Column, true, 95.0, 1, Held::Anything),
        Mistake::PrincipalPoint { stated: [46.25, 37.4], truth: [46.75, 37.4] },
        Mistake::PrincipalPoint { stated: [46.25, 37.5], truth: [46.75, 37.4] },
        Mistake::FocalLength { stated: 0.008008, truth: 0.008 },
        Mistake::Fan { stated: 61.0, truth: 60.0 },
        Mistake::Turned { about: Turn::Pitch, degrees: 0.1 },
        Mistake::Turned { about: Turn::Pitch, degrees: -0.1 },
        Mistake::Turned { about: Turn::Yaw, degrees: 0.1 },
        Mistake::Turned { about: Turn::Roll, degrees: 0.1 },
        Mistake::Moved([0.0, 0.0, 0.05]),
        Mistake::Posed { degrees: [0.1, 0.2, 0.3], metres: [0.0; 3] },
        Mistake::Posed { degrees: [0.1, 0.2, 0.3], metres: [0.0, 0.01, 0.02] },
    ]
}

fn cut(by: CutBy, is_above: bool, at: f64, lines: u32, held: Held) -> Mistake {
    Mistake::Cut { by, is_above, at, lines, held }
}

#[test]
fn each_mistake_names_a_place_that_the_documentation_has() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    for mistake in all() {
        let (file, place) = mistake.docs();
        let text =
            std::fs::read_to_string(root.join(file)).expect("a page of the documentation").replace('`', "");
        // A heading, or a paragraph that begins with its name.
        let marks = [format!("# {place}\n"), format!("**{place}.**")];
        let has = marks.iter().any(|mark| text.contains(mark));
        assert!(has, "{}: {file} has no place {place}", mistake.key());
    }
}

#[test]
fn keys_and_words_tell_the_mistakes_apart() {
    let mut words: Vec<String> = all().iter().map(ToString::to_string).collect();
    words.sort();
    words.dedup();
    assert_eq!(words.len(), all().len());
    for mistake in all() {
        assert!(mistake.key().bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_'), "{mistake}");
    }
}

#[test]
fn a_share_is_rounded_down() {
    let sentence = |explained, wrong| {
        let mistakes = vec![Mistake::DepthForRange, Mistake::Unit(LengthUnit::Millimetres)];
        reason(mistakes, &[SensorId::Camera], true, [explained, wrong]).sentence()
    };
    assert!(
        sentence(99_999, 100_000).starts_with("99.99 % of the wrong rays agree if range.T holds the depth")
    );
    assert!(sentence(5, 5).starts_with("100 % of the wrong rays agree if "));
    assert!(sentence(1003, 2000).starts_with("50.15 % of the wrong rays agree if "));
    assert!(
        sentence(5, 5)
            .contains(", and lengths are in millimetres: the unit is the metre (docs/formats/files.md")
    );
}

fn reason(
    mistakes: Vec<Mistake>,
    sensors: &[SensorId],
    is_everywhere: bool,
    [explained, wrong]: [u64; 2],
) -> Reason {
    Reason { sensors: sensors.to_vec(), is_everywhere, mistakes, wrong, explained, right: 40, broken: 0 }
}

#[test]
fn each_reason_names_its_sensors_and_the_others_have_another_cause() {
    let [camera, first, second] = [SensorId::Camera, SensorId::Beam(0), SensorId::Beam(1)];
    let of_camera = Mistake::PrincipalPoint { stated: [46.25, 37.4], truth: [46.75, 37.4] };
    let reasons = vec![
        reason(vec![of_camera], &[camera], false, [40, 40]),
        reason(vec![Mistake::BacksHit], &[first, second], false, [20, 20]),
    ];
    let found = Diagnosis { reasons, unexplained: vec![SensorId::Beam(2)] };
    assert_eq!(
        found.sentence(),
        "100 % of the wrong rays of the camera agree if cx is 46.25 in place of 46.75 px (docs/guide/reasons.md, \
         Numbers of a sensor), and no right ray breaks; 100 % of the wrong rays of beam-0 and beam-1 agree if rays hit \
         the backs of faces: a hit has n.q < 0 (docs/guide/for-implementers.md, The contract for rays), and no right \
         ray breaks; for the wrong rays of beam-2 no reason is known"
    );
    assert_eq!(found.of(second), Some(&found.reasons[1]));
    assert_eq!(found.of(SensorId::Beam(2)), None);
}

#[test]
fn ways_and_units_are_told_truly() {
    let ends = |start: &str, mistake: Mistake| {
        let words = mistake.to_string();
        assert!(words.starts_with(start), "{start}: {words}");
    };
    let shifted = |columns, rows| Mistake::Shifted { columns, rows };
    ends("cells are shifted by 1 column right: ", shifted(1, 0));
    ends("cells are shifted by 2 columns left: ", shifted(-2, 0));
    ends("cells are shifted by 1 row up: ", shifted(0, -1));
    ends("cells are shifted by 1 column left and 3 rows down: ", shifted(-1, 3));
    let off = |offset| Mistake::Affine { of: Length::Range, factor: 1.0, offset };
    ends("range.T is 0.25 m too long", off(0.25));
    ends("range.T is 0.25 m too short", off(-0.25));
    let line = |offset| Mistake::Affine { of: Length::Depth, factor: 2.0, offset };
    ends("depth.Z is 2 times the true length plus 0.5 m", line(0.5));
    ends("depth.Z is 2 times the true length less 0.5 m", line(-0.5));
    for (unit, name) in [
        (LengthUnit::Millimetres, "millimetres"),
        (LengthUnit::Centimetres, "centimetres"),
        (LengthUnit::Kilometres, "kilometres"),
        (LengthUnit::Feet, "feet"),
    ] {
        ends(&format!("lengths are in {name}: "), Mistake::Unit(unit));
    }
    // Stored in metres, told in the units of a scene file; the stated number comes first.
    ends("the focal length is 8 in place of 7.5 mm", Mistake::FocalLength { stated: 0.008, truth: 0.0075 });
    ends("the beam's thickness is 5 in place of 20 mm", Mistake::Thickness { stated: 0.005, truth: 0.02 });
    let pitch = Mistake::PixelPitch { stated: [4e-5, 3e-5], truth: [2e-5, 1e-5] };
    ends("the pixel pitch is 40 x 30 in place of 20 x 10 micrometres", pitch);
    let point = |stated, truth| Mistake::PrincipalPoint { stated, truth };
    ends("cx is 1 in place of 2 px and cy is 3 in place of 4 px", point([1.0, 3.0], [2.0, 4.0]));
    ends("cy is 3 in place of 4 px", point([1.0, 3.0], [1.0, 4.0]));
    let turned = |about, degrees| Mistake::Turned { about, degrees };
    for (about, more, less) in [
        (Turn::Pitch, "looks 2 degrees too far down", "looks 2 degrees too far up"),
        (Turn::Yaw, "looks 2 degrees too far to the right", "looks 2 degrees too far to the left"),
        (Turn::Roll, "is rolled 2 degrees clockwise", "is rolled 2 degrees counter-clockwise"),
    ] {
        ends(&format!("the sensor {more}"), turned(about, 2.0));
        ends(&format!("the sensor {less}"), turned(about, -2.0));
    }
}

#[test]
fn numbers_are_told_with_all_their_digits_and_no_more() {
    let says = |part: &str, mistake: Mistake| {
        let words = mistake.to_string();
        assert!(words.contains(part), "{part}: {words}");
    };
    let of_range = |factor, offset| Mistake::Affine { of: Length::Range, factor, offset };
    says("range.T is 1.0000000000001 times the true length", of_range(1.0000000000001, 0.0));
    says("range.T is 1.000000001 times the true length plus 0.5 m", of_range(1.000000001, 0.5));
    says("the flux is 2 times the true one", Mistake::FluxFactor(2.0));
    says("the flux is 1.00000001 times the true one", Mistake::FluxFactor(1.00000001));
    // The stated number is never told as the true one.
    let focal = Mistake::FocalLength { stated: 0.00800000000001, truth: 0.008 };
    says("the focal length is 8.00000000001 in place of 8 mm", focal);
    says("(0, 0.00000000001, 0) m", Mistake::Moved([0.0, 1e-11, 0.0]));
    // What single precision makes of a tenth.
    let tenth = f64::from(0.1_f32);
    says("the last row holds 0.1 everywhere", cut(CutBy::Row, true, 9.0, 1, Held::Constant(tenth)));
    says("have the length 0.1 m", cut(CutBy::Range, true, 9.0, 0, Held::Constant(tenth)));
}

#[test]
fn json_has_each_count_by_its_name() {
    let reason = Reason {
        sensors: vec![SensorId::Camera, SensorId::Beam(2)],
        is_everywhere: false,
        mistakes: vec![Mistake::RowsReversed],
        wrong: 11,
        explained: 12,
        right: 13,
        broken: 14,
    };
    let json = reason.to_json();
    assert_eq!(["wrong", "explained", "right", "broken"].map(|key| &json[key]), [11, 12, 13, 14]);
    assert_eq!(json["bundles"], serde_json::json!(["camera", "beam-2"]));
}

#[test]
fn what_is_lost_is_told_with_its_end_and_its_number() {
    for (by, is_above, lines, held, words) in [
        (CutBy::Row, true, 1, Held::NoHit, "the last row says \"no hit\" where something is hit"),
        (CutBy::Row, false, 1, Held::Anything, "the first row is wrong, and nothing else"),
        (CutBy::Row, false, 3, Held::NoHit, "the first 3 rows say \"no hit\" where something is hit"),
        (CutBy::Column, true, 2, Held::Neighbour, "the last 2 columns repeat the column beside"),
        (CutBy::Column, false, 1, Held::Neighbour, "the first column repeats the column beside"),
        (CutBy::Column, true, 1, Held::Constant(0.5), "the last column holds 0.5 everywhere"),
        (CutBy::Column, true, 2, Held::Constant(0.5), "the last 2 columns hold 0.5 everywhere"),
        (CutBy::Range, true, 0, Held::NoHit, "hits beyond 12.5 m are lost"),
        (CutBy::Range, false, 0, Held::NoHit, "hits nearer than 12.5 m are lost"),
        (CutBy::Depth, true, 0, Held::NoHit, "hits deeper than 12.5 m are lost"),
        (CutBy::Depth, false, 0, Held::NoHit, "hits less deep than 12.5 m are lost"),
        (CutBy::Range, true, 0, Held::Constant(9.0), "hits beyond 12.5 m have the length 9 m"),
    ] {
        assert_eq!(cut(by, is_above, 12.5, lines, held).to_string(), words);
    }
}

#[test]
fn rays_through_another_point_of_their_cell_are_told_which() {
    let words = |columns, rows| Mistake::CornerRays { columns, rows }.to_string();
    for (columns, rows, place) in [
        (-0.5, -0.5, "the top left corner"),
        (0.5, -0.5, "the top right corner"),
        (-0.5, 0.5, "the bottom left corner"),
        (0.5, 0.5, "the bottom right corner"),
    ] {
        assert!(words(columns, rows).starts_with(&format!("rays go through {place} of their cell")));
    }
    for (columns, rows, off) in [
        (0.25, 0.0, "0.25 columns right"),
        (-0.25, 0.5, "0.25 columns left and 0.5 rows down"),
        (0.0, -0.5, "0.5 rows up"),
    ] {
        assert!(words(columns, rows).starts_with(&format!("rays are {off} off")), "{}", words(columns, rows));
    }
}

#[test]
fn a_sentence_lists_its_sensors_and_counts_what_breaks() {
    let sensors = [SensorId::Camera, SensorId::Beam(0), SensorId::Beam(1)];
    let of =
        |broken| Reason { broken, ..reason(vec![Mistake::RowsReversed], &sensors, false, [3, 4]) }.sentence();
    assert!(
        of(0).starts_with("75.00 % of the wrong rays of the camera, beam-0 and beam-1 agree if "),
        "{}",
        of(0)
    );
    for (broken, end) in [
        (0, ", and no right ray breaks"),
        (1, ", and 1 of 40 right rays breaks"),
        (2, ", and 2 of 40 right rays break"),
    ] {
        assert!(of(broken).ends_with(end), "{}", of(broken));
    }
}
