//! Rays compared one by one have the same classes as in a comparison of whole outputs.

use raypencil::judge::{
    Class, FirstOfClass, Judge, JudgeShare, class_of_ray, compare_judged, first_of_class,
};
use raypencil::{Place, SensorId};
use raypencil_tests::fixtures::approximate;

#[test]
fn single_rays_have_the_classes_that_a_comparison_counts() {
    let validation = approximate();
    let scene = &validation.subject.scene;
    let judge = Judge::new(scene, JudgeShare::Sample);
    let [a, b] = [0, 1].map(|index| validation.rendered[index].side());
    let whole = compare_judged(&judge, a, b);
    let mut first: Option<FirstOfClass> = None;
    let mut before = 0;
    // The order is that of `first_of_class`: the camera is last.
    for sensor in whole[1..].iter().chain(&whole[..1]) {
        // One row of the camera is enough, because each of its pixels compares all beams.
        let (width, height) = scene.size(sensor.sensor).unwrap();
        let rows = if sensor.sensor == SensorId::Camera { 20..21 } else { 0..height };
        let mut by_class = [0; 6];
        for (i, j) in rows.flat_map(|j| (0..width).map(move |i| (i, j))) {
            let place = Place { sensor: sensor.sensor, i, j };
            let (class, quantity) = class_of_ray(&judge, a, b, place).unwrap();
            by_class[class as usize] += 1;
            before += 1;
            if class == Class::Approximation && first.is_none() {
                first = Some(FirstOfClass { place, quantity, compared: before });
            }
        }
        if sensor.sensor != SensorId::Camera {
            assert_eq!(by_class, sensor.by_class, "{}", sensor.sensor);
        }
        let outside = Place { sensor: sensor.sensor, i: width, j: 0 };
        assert_eq!(class_of_ray(&judge, a, b, outside), None);
    }
    assert!(first.is_some());
    assert_eq!(first_of_class(&judge, a, b, Class::Approximation), first);
    assert_eq!(first_of_class(&judge, a, b, Class::Undecided), None);
}
