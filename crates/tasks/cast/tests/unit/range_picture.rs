//! Pictures of a few rays, whose places on the page follow by hand.

use super::*;
use crate::answers::FirstHit;
use raypencil_scene::pattern::{Mounting, PatternRays};
use raypencil_scene::{CastRay, FaceId, Side, Sides};

fn hit(range: f64, point: [f64; 3]) -> Reading<FirstHit> {
    Reading::Hit(FirstHit {
        face: FaceId(0),
        side: Side::Front,
        ties: 1,
        t: range,
        range,
        point: DVec3::from_array(point),
        normal: DVec3::Z,
        barycentric: [1.0, 0.0, 0.0],
        cos_incidence: 1.0,
    })
}

/// A set of rays from the origin, and what is read by each.
fn read(
    shape: [u64; 2],
    elevations_deg: Option<Vec<f64>>,
    first: Vec<Reading<FirstHit>>,
) -> (Answers, NamedRaySet) {
    let rays = PatternRays {
        shape: shape.to_vec(),
        rays: vec![CastRay::new(DVec3::ZERO, DVec3::X); first.len()],
        times: None,
        weights: None,
        returns: None,
        elevations_deg,
        mounting: Mounting::HERE,
    };
    let set = NamedRaySet::new("front", rays, Sides::Both).expect("a set");
    (Answers { first, any: None, all: None, margins: None, decided: None }, set)
}

/// The places of all texts that are this one.
fn places(page: &Drawing, words: &str) -> Vec<[f64; 2]> {
    let place = |mark: &Mark| match mark {
        Mark::Text { at, text, .. } if text == words => Some(*at),
        _ => None,
    };
    page.marks.iter().filter_map(place).collect()
}

/// The first cells of a page: their place, size and columns, and their colours.
type Cells<'a> = (([f64; 2], [f64; 2], usize), &'a [Option<Colour>]);

fn cells(page: &Drawing) -> Cells<'_> {
    let of = |mark| match mark {
        &Mark::Cells { at, size, columns, ref cells } => Some(((at, size, columns), cells.as_slice())),
        _ => None,
    };
    page.marks.iter().find_map(of).expect("cells")
}

fn colour(fraction: f64) -> Option<Colour> {
    Some(ColourMap::Sequential.at(fraction))
}

#[test]
fn a_raster_keeps_its_proportions_and_names_its_ends() {
    let near = |range| hit(range, [0.0; 3]);
    // Two rows of three: 900 x 600 pixels. From 2 to 4 m the scale is even.
    let first = vec![near(2.0), near(3.0), Reading::Miss, near(4.0), Reading::TooNear, near(2.5)];
    let (answers, set) = read([2, 3], None, first);
    let page = range_picture(&answers, &set).expect("a picture");
    let colours = [colour(0.0), colour(0.5), Some(MISS), colour(1.0), Some(TOO_NEAR), colour(0.25)];
    assert_eq!(cells(&page), (([74.0, 36.0], [900.0, 600.0], 3), &colours[..]));
    assert_eq!((page.width, page.height), (1000, 36 + 600 + 96));
    for (words, at) in [
        ("row 0", [68.0, 48.0]),
        ("row 1", [68.0, 636.0]),
        ("column", [524.0, 654.0]),
        ("2", [974.0, 654.0]),
        // Behind a square of 14 pixels.
        ("nothing is hit", [704.0, 686.0]),
        ("too near", [854.0, 686.0]),
    ] {
        assert!(places(&page, words).contains(&at), "{words}: {:?}", places(&page, words));
    }
}

#[test]
fn a_head_has_a_row_for_each_channel_and_the_highest_is_on_top() {
    // Three sequences of two channels, at -5 and 5 degrees.
    let first = (0..6).map(|k| hit(2.0 + 0.25 * f64::from(k), [0.0; 3])).collect();
    let (answers, set) = read([3, 2], Some(vec![-5.0, 5.0]), first);
    let page = range_picture(&answers, &set).expect("a picture");
    // The second channel of each sequence, and then the first.
    let colours = [1, 3, 5, 0, 2, 4].map(|k| colour(f64::from(k) / 5.0));
    assert_eq!(cells(&page), (([74.0, 36.0], [900.0, 160.0], 3), &colours[..]));
    assert_eq!(places(&page, "5.0°"), [[68.0, 48.0]]);
    assert_eq!(places(&page, "-5.0°"), [[68.0, 196.0]]);
    assert_eq!(places(&page, "elevation"), [[68.0, 121.0]]);
    assert_eq!(places(&page, "firing sequence, in the order of time"), [[524.0, 214.0]]);
}

#[test]
fn seen_from_above_a_point_is_where_its_coordinates_say() {
    // With the origin of the rays the points take 10 x 10 m about (5, -1): the page shows 4 % more.
    let first = vec![hit(11.0, [10.0, 4.0, 1.0]), hit(6.0, [0.0, -6.0, 2.0])];
    let (answers, set) = read([1, 2], None, first);
    let page = top_picture(&answers, &set).expect("a picture");
    let (place, shown) = cells(&page);
    assert_eq!(place, ([74.0, 36.0], [900.0, 900.0], 900));
    // 5 m are 432.7 pixels from the middle, 450. Each point takes two by two of them.
    let mut expected = vec![None; 900 * 900];
    for (x, y, fraction) in [(882, 17, 0.0), (17, 882, 1.0)] {
        for (x, y) in [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)] {
            expected[900 * y + x] = colour(fraction);
        }
    }
    assert!(shown == expected);
    // A cross at the origin, 5 m to the left of the middle and 1 m above it; one in the key, before its words.
    let crosses: Vec<[f64; 2]> = page
        .marks
        .iter()
        .filter_map(|mark| match mark {
            Mark::Line { points, width: 2.0, .. } if points[0][1] == points[1][1] => {
                Some([points[0][0] + 8.0, points[0][1]])
            }
            _ => None,
        })
        .collect();
    let scale = 900.0 / 10.4;
    let at = [74.0 + 450.0 - 5.0 * scale, 36.0 + 450.0 - scale];
    assert_eq!(crosses.len(), 2);
    assert!((0..2).all(|k| (crosses[0][k] - at[k]).abs() < 1e-9), "{crosses:?} {at:?}");
    assert_eq!(
        (crosses[1], places(&page, "origin of the first ray")),
        ([774.0, 985.0], vec![[788.0, 990.0]])
    );
    // Ticks of x stand below the picture, and their numbers below them.
    let below = |mark: &&Mark| matches!(mark, Mark::Line { points, .. } if points.len() == 2 && points[0][1] == 936.0 && points[1][1] == 941.0);
    let ticks = page.marks.iter().filter(below).count();
    let numbers = page.marks.iter().filter(|mark| matches!(mark, Mark::Text { at, .. } if at[1] == 955.0));
    assert!(ticks >= 2 && ticks == numbers.count(), "{ticks}");
    assert!(!places(&page, "x to the right, y up the page, m").is_empty());
}
