//! Where wrong rays are separated from right ones, at the limits of what is a cut.

use super::*;

fn ray(number: f64, is_wrong: bool, face: u32) -> Ray {
    Ray { number, is_wrong, face }
}

/// So many right rays at 1, 2, ... and so many wrong ones beyond them, all on one face.
fn rays(right: usize, wrong: usize) -> Vec<Ray> {
    (0..right + wrong).map(|k| ray((k + 1) as f64, k >= right, 7)).collect()
}

#[test]
fn a_cut_needs_twelve_right_hits_and_hardly_a_ray_on_the_wrong_side() {
    let expected = |off| Some(Split { is_above: true, between: [12.0, 13.0], off });
    assert_eq!(split(&mut rays(12, 3), true), expected(0));
    assert_eq!(split(&mut rays(11, 3), true), None);
    assert_eq!(split(&mut rays(12, 0), true), None);
    // One of fifty wrong rays may lie on the other side, and not one of forty-nine.
    let with_one_below = |wrong: usize| {
        let mut all = rays(12, wrong - 1);
        all.push(ray(0.5, true, 7));
        all
    };
    assert_eq!(split(&mut with_one_below(50), true), expected(1));
    assert_eq!(split(&mut with_one_below(49), true), None);
    // Nothing separates them from the other end.
    assert_eq!(split(&mut rays(12, 3), false), None);
    let mut turned: Vec<Ray> = rays(12, 3).iter().map(|one| Ray { number: -one.number, ..*one }).collect();
    assert_eq!(split(&mut turned, false), Some(Split { is_above: false, between: [-13.0, -12.0], off: 0 }));
}

#[test]
fn a_cut_runs_through_a_face_and_between_two_numbers() {
    // All wrong rays on faces of their own.
    let mut of_faces: Vec<Ray> =
        rays(12, 3).iter().map(|one| Ray { face: u32::from(one.is_wrong), ..*one }).collect();
    assert_eq!(split(&mut of_faces, true), None);
    // The first wrong ray has the number of the last right one: no cut separates these two.
    let alike = |wrong: usize| {
        let mut all = rays(12, wrong);
        all[12].number = 12.0;
        all.swap(11, 12);
        all
    };
    assert_eq!(split(&mut alike(60), true), Some(Split { is_above: true, between: [12.0, 14.0], off: 1 }));
    assert_eq!(split(&mut alike(3), true), None);
}
