//! Two mistakes at once are named, exactly these two.

use raypencil_judge::{Quantity, Recorded};

use super::candidates::*;
use super::one::*;

fn rows(candidate: &mut Recorded) {
    moved(candidate, |_, h, i, j| (i, h - 1 - j));
}

fn columns(candidate: &mut Recorded) {
    moved(candidate, |w, _, i, j| (w - 1 - i, j));
}

fn depth_for_range(candidate: &mut Recorded) {
    candidate.answers.maps.iter_mut().for_each(|map| map.range = map.depth.clone());
}

fn one_based(candidate: &mut Recorded) {
    faces(candidate, |face| face + 1);
}

#[test]
fn pairs_are_named() {
    type Change = fn(&mut Recorded);
    let pairs: [(&[Change], [&str; 2]); 14] = [
        (&[rows, |c| in_units(c, 1e3)], ["rows_reversed", "millimetres"]),
        (&[rows, columns], ["rows_reversed", "columns_reversed"]),
        (&[rows, own_order], ["rows_reversed", "faces_reordered"]),
        (&[rows, depth_for_range], ["rows_reversed", "depth_for_range"]),
        (&[rows, y_up], ["rows_reversed", "axes_y_up"]),
        (&[columns, one_based], ["columns_reversed", "faces_shifted"]),
        (&[depth_for_range, own_order], ["depth_for_range", "faces_reordered"]),
        (&[depth_for_range, |c| in_units(c, 1e3)], ["depth_for_range", "millimetres"]),
        (&[parameter_for_range, y_up], ["parameter_for_range", "axes_y_up"]),
        (&[y_up, |c| in_units(c, 1e2)], ["axes_y_up", "centimetres"]),
        (&[one_based, |c| normals(c, |_, n| -n)], ["faces_shifted", "normals_reversed"]),
        (&[columns, |c| flux(c, |x| x * 4.0)], ["columns_reversed", "flux_factor"]),
        (&[rows, |c| as_single(c, &mut 0)], ["rows_reversed", "single_precision"]),
        (&[one_based, other_model], ["faces_shifted", "other_flux_model"]),
    ];
    for (changes, keys) in pairs {
        let candidate = pyramids_with(|candidate| changes.iter().for_each(|change| change(candidate)));
        assert_explained(pyramids(), &candidate, &keys);
    }
}

#[test]
fn a_constant_for_a_miss_is_named_beside_another_mistake() {
    let range = |change: fn(&mut Recorded), miss: f64| {
        let mut candidate = only(&pyramids_with(change), &[Quantity::Range]);
        missed(&mut candidate, miss);
        candidate
    };
    assert_explained(pyramids(), &range(rows, 0.0), &["rows_reversed", "miss_written"]);
    assert_explained(pyramids(), &range(|c| in_units(c, 1e3), 0.0), &["millimetres", "miss_written"]);
    assert_explained(pyramids(), &range(depth_for_range, -1.0), &["depth_for_range", "miss_written"]);
    assert_explained(pyramids(), &range(columns, 20.0), &["columns_reversed", "miss_at_maximum_range"]);
}

#[test]
fn three_mistakes_are_not_explained() {
    let three = pyramids_with(|candidate| {
        rows(candidate);
        in_units(candidate, 1e3);
        y_up(candidate);
    });
    assert_eq!(pyramids().explanation(&three), None);
}
