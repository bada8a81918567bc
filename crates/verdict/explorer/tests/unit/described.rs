use raypencil_scene::SensorId;

use super::*;

fn ray(number: u32, class: Class, size: f64) -> RayToDescribe {
    RayToDescribe { place: Place { sensor: SensorId::Camera, i: number, j: 0 }, pair: 0, class, size }
}

#[test]
fn a_thousand_rays_are_all_described() {
    let all: Vec<RayToDescribe> = (0..1000).map(|number| ray(number, Class::Tie, 0.0)).collect();
    assert_eq!(rays_to_describe(all.clone()), all);
}

#[test]
fn of_more_the_worst_half_and_an_even_sample_of_the_others_are_described() {
    // 300 defects at the end, 2700 roundings whose size falls.
    let rounding = |number| ray(number, Class::Rounding, 1.0 - f64::from(number) / 3000.0);
    let defect = |number| ray(number, Class::Defect, 0.0);
    let all: Vec<RayToDescribe> = (0..2700).map(rounding).chain((2700..3000).map(defect)).collect();
    let chosen = rays_to_describe(all);
    assert_eq!(chosen.len(), 1000);
    // All defects first, then the 200 largest of the others.
    assert!(chosen[..300].iter().all(|ray| ray.class == Class::Defect));
    let numbers: Vec<u32> = chosen[300..].iter().map(|ray| ray.place.i).collect();
    assert_eq!(numbers[..200], (0..200).collect::<Vec<u32>>());
    // 500 of the 2500 that are left: every fifth.
    assert_eq!(numbers[200..], (0..500).map(|k| 200 + 5 * k).collect::<Vec<u32>>());
}
