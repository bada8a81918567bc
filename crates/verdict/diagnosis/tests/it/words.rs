//! The words of a diagnosis: plain, and with a place of the documentation that exists.

use std::path::Path;

use raypencil_diagnosis::{AngleUnit, Cosine, Diagnosis, Leg, LengthUnit, Mistake};

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
        Mistake::Axes { from: [1, 0, 2], sign: [1, -1, 1] },
        Mistake::SensorFrame,
        Mistake::GlobalFrame,
        Mistake::NormalsReversed,
        Mistake::NormalsNotUnit,
        Mistake::CosinesNegated,
        Mistake::AngleForCosine(AngleUnit::Radians),
        Mistake::AngleForCosine(AngleUnit::Degrees),
        Mistake::CosinesExchanged([c, b, a]),
        Mistake::PixelRowsFromBottom,
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
        Mistake::CornerRays { columns: -0.5, rows: -0.5 },
    ]
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
    let sentence = |agree, tried| {
        let mistakes = vec![Mistake::DepthForRange, Mistake::Unit(LengthUnit::Millimetres)];
        Diagnosis { mistakes, agree, tried }.sentence()
    };
    assert!(sentence(99_999, 100_000).starts_with("99.99 % agree if range.T holds the depth"));
    assert!(sentence(5, 5).starts_with("100 % agree if "));
    assert!(sentence(1003, 2000).starts_with("50.15 % agree if "));
    assert!(
        sentence(5, 5)
            .contains(", and lengths are in millimetres: the unit is the metre (docs/formats/files.md")
    );
}
