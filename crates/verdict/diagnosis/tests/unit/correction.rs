//! Which numbers a correction changes, and by what.

use super::*;
use crate::mistake::{AngleUnit, Leg, LengthUnit};

#[test]
fn a_number_is_scaled_only_where_the_exact_ones_have_a_ratio() {
    assert_eq!((scaled(6.0, 2.0, 3.0), scaled(6.0, 0.0, 3.0)), (4.0, 0.0));
    let (inf, nan) = (f64::INFINITY, f64::NAN);
    for (own, held) in [(2.0, 0.0), (0.0, 0.0), (2.0, inf), (inf, 3.0), (nan, 3.0), (2.0, nan)] {
        assert_eq!(scaled(6.0, own, held), 6.0, "{own} {held}");
    }
}

#[test]
fn a_correction_changes_the_quantities_that_it_is_about_and_no_other() {
    use Quantity::*;
    let all = [
        Hit,
        Face,
        Range,
        Depth,
        Point,
        Normal,
        CosIncidence,
        Visible,
        Pixel,
        CameraDepth,
        CosOffAxis,
        CosView,
        PencilFlux,
        PixelFlux,
    ];
    let cosines = [CosIncidence, CosOffAxis, CosView];
    for (mistake, touched) in [
        (Mistake::FacesReordered, &[Face][..]),
        (Mistake::DepthForRange, &[Range]),
        (Mistake::RangeForDepth, &[Depth]),
        (Mistake::Unit(LengthUnit::Feet), &[Range, Depth, Point, CameraDepth]),
        (Mistake::AxesYUp, &[Point, Normal]),
        (Mistake::PointsRounded(0.5), &[Point]),
        (Mistake::NormalsReversed, &[Normal]),
        (Mistake::DistanceForView, &[CameraDepth]),
        (Mistake::CosinesNegated, &cosines),
        (Mistake::AngleForCosine(AngleUnit::Degrees), &cosines),
        (Mistake::PixelsExchanged, &[Pixel]),
        (Mistake::AttenuationOn(Leg::Out), &[PencilFlux, PixelFlux]),
        (Mistake::Affine { of: Length::All, factor: 2.0, offset: 0.0 }, &[Range, Depth, Point, CameraDepth]),
        (Mistake::Affine { of: Length::All, factor: 2.0, offset: 0.5 }, &[Range, Depth]),
        (Mistake::Affine { of: Length::Range, factor: 2.0, offset: 0.0 }, &[Range]),
        // Depths in the camera are depths, too.
        (Mistake::Rounded { of: Length::Depth, quantum: 0.5, down: false }, &[Depth, CameraDepth]),
        (Mistake::Rounded { of: Length::All, quantum: 0.5, down: false }, &[Range, Depth, CameraDepth]),
        (Mistake::Rounded { of: Length::Range, quantum: 0.5, down: false }, &[Range]),
        (Mistake::HalfPrecision(Length::Depth), &[Depth, CameraDepth]),
        (Mistake::Inverse(Length::All), &[Range, Depth, CameraDepth]),
        (Mistake::Squared(Length::Range), &[Range]),
        (Mistake::FromPlane(Length::Depth), &[Depth]),
        (Mistake::ZBuffer { low: 0.0, low_at: 0.5, one_at: 100.0 }, &[Depth]),
        (Mistake::HoldsBeam(1), &all),
        (Mistake::BeamFluxExchanged, &[]),
        (Mistake::VisibleReversed, &[Visible]),
        (Mistake::HitsVisible, &[Visible, PencilFlux]),
        (Mistake::BacksHit, &[]),
    ] {
        let correction = Correction::from(mistake);
        let is_touched = |quantity: &Quantity| {
            correction.touches(Channel { sensor: SensorId::Beam(0), item: (*quantity).into() })
        };
        let found: Vec<Quantity> = all.into_iter().filter(is_touched).collect();
        assert_eq!(found, touched, "{mistake}");
    }
    let of_camera = |mistake: Mistake, quantity: Quantity| {
        Correction::from(mistake).touches(Channel { sensor: SensorId::Camera, item: quantity.into() })
    };
    assert!(of_camera(Mistake::BeamFluxExchanged, PixelFlux) && !of_camera(Mistake::HoldsBeam(1), Range));
}

#[test]
fn of_two_changes_of_the_same_convention_only_one_is_made() {
    let affine = |of| Mistake::Affine { of, factor: 2.0, offset: 0.0 };
    let law = Mistake::ZBuffer { low: 0.0, low_at: 0.5, one_at: 100.0 };
    let unit = Mistake::Unit(LengthUnit::Feet);
    let shifted = Mistake::Shifted { columns: 1, rows: 0 };
    for (a, b, is_one) in [
        (Mistake::MissWritten(0.0), Mistake::MissAtMaximumRange, true),
        (Mistake::FacesShifted(1), Mistake::FacesReordered, true),
        (shifted, shifted, true),
        (unit, affine(Length::Range), true),
        (affine(Length::Depth), Mistake::ParameterForDepth, true),
        (affine(Length::Range), Mistake::ParameterForDepth, false),
        (law, Mistake::FromPlane(Length::Depth), true),
        (law, Mistake::Inverse(Length::All), true),
        (law, Mistake::Inverse(Length::Range), false),
        (unit, Mistake::RowsReversed, false),
        (Mistake::RowsReversed, Mistake::ColumnsReversed, false),
        (shifted, Mistake::FacesShifted(1), false),
    ] {
        let [one, other] = [a, b].map(Correction::from);
        assert_eq!([one.excludes(&other), other.excludes(&one)], [is_one; 2], "{a}; {b}");
    }
}

#[test]
fn what_makes_other_lengths_of_lengths_is_of_their_size() {
    for (mistake, is) in [
        (Mistake::Unit(LengthUnit::Feet), true),
        (Mistake::Affine { of: Length::Range, factor: 2.0, offset: 0.0 }, true),
        (Mistake::Inverse(Length::Range), true),
        (Mistake::DepthForRange, true),
        (Mistake::RowsReversed, false),
        (Mistake::Rounded { of: Length::Range, quantum: 0.5, down: false }, false),
    ] {
        assert_eq!(Correction::from(mistake).is_of_the_size_of_lengths(), is, "{mistake}");
    }
}
