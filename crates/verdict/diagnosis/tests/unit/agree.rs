//! How near values must be while corrections are tried, by what the file rounds.

use super::*;
use crate::channel::channels_of;
use crate::it::candidates::pyramids;
use raypencil_files::Step;
use raypencil_scene::SensorId;

#[test]
fn each_storage_has_its_own_tolerance() {
    let bench = pyramids();
    let sensors = [SensorId::Beam(0)];
    let channels = channels_of(&bench.exact, &sensors);
    let of =
        |quantity| *channels.iter().find(|channel| channel.item.quantity == quantity).expect("a channel");
    let [range, cosine] = [of(Quantity::Range), of(Quantity::CosIncidence)];
    let place = Place { sensor: sensors[0], i: 0, j: 0 };
    let is = |channel: Channel, storage: Option<Storage>, stated: f64, exact: f64| {
        let mut recorded = bench.exact.clone();
        recorded.storage.remove(&(channel.sensor, channel.item));
        recorded.storage.extend(storage.map(|storage| ((channel.sensor, channel.item), storage)));
        let case = Case { truth: &bench.truth, recorded: &recorded, sensors: &sensors, tolerance: 1e-9 };
        is_near(case, channel, place, Value::Number(stated), Value::Number(exact))
    };
    // 11 bits: an error of a thousandth. 24 bits: an error of four roundings.
    for (storage, most) in [
        (Some(Storage::F16), 1.0 / 1024.0),
        (Some(Storage::F32), 1.0 / f64::from(1 << 22)),
        (Some(Storage::F64), 1e-9),
        (None, 1e-9),
    ] {
        for exact in [3.0, 3e-3] {
            assert!(is(range, storage, exact * (1.0 + 0.999 * most), exact), "{storage:?}");
            assert!(!is(range, storage, exact * (1.0 + 1.001 * most), exact), "{storage:?}");
            // Cosines are compared as parts of 1.
            assert!(is(cosine, storage, exact + 0.999 * most, exact), "{storage:?}");
            assert!(!is(cosine, storage, exact + 1.001 * most, exact), "{storage:?}");
        }
    }
    // Numbers in steps may be a whole one off, where half of it is rounded away.
    let steps = Some(Storage::Steps(Step::new(0.25).expect("a step")));
    assert!(is(range, steps, 3.2499, 3.0) && !is(range, steps, 3.2501, 3.0));
}

#[test]
fn what_a_file_rounds_grows_with_the_unit_and_is_no_error() {
    let absorbed = |storage, stated: f64, corrected: f64, exact: f64| {
        absorbed(storage, Value::Number(stated), Value::Number(corrected), Value::Number(exact))
            == Value::Number(exact)
    };
    // 3 km that were stored in single precision as 3000 m: half a unit is 2^-13 m there, and a thousand times less in kilometres.
    let half = 1.0 / f64::from(1 << 13) / 1000.0;
    assert!(absorbed(Storage::F32, 3000.0, 3.0 + 0.999 * half, 3.0));
    assert!(!absorbed(Storage::F32, 3000.0, 3.0 + 1.001 * half, 3.0));
    // Eight roundings of doubles beside it.
    let eight = 8.0 * 3.0 * f64::EPSILON;
    let ulp = Storage::F64.ulp(3000.0) * 0.5 / 1000.0;
    assert!(absorbed(Storage::F64, 3000.0, 3.0 + 0.9 * eight, 3.0));
    assert!(!absorbed(Storage::F64, 3000.0, 3.0 + 1.1 * eight + ulp, 3.0));
    // What was not corrected is not absorbed, however near it is: half precision has steps of 2^-9 there.
    let half = 1.0 / 1024.0;
    assert!(absorbed(Storage::F16, 3.0 + 2.0 * half, 3.0 + 0.5 * half, 3.0));
    assert!(!absorbed(Storage::F16, 3.0 + 0.5 * half, 3.0 + 0.5 * half, 3.0));
    let of_vectors = |stated: f64, corrected: f64| {
        let [stated, corrected, exact] = [stated, corrected, 3.0].map(|z| Value::Vector(DVec3::Z * z));
        super::absorbed(Storage::F16, stated, corrected, exact) == exact
    };
    assert!(
        of_vectors(3.0 + 2.0 * half, 3.0 + 0.5 * half) && !of_vectors(3.0 + 0.5 * half, 3.0 + 0.5 * half)
    );
    // Beyond half a step it is an error.
    assert!(!of_vectors(3.0 + 2.0 * half, 3.0 + 1.01 * half));
}

/// The first pencil of a beam that hits something.
fn a_hit(sensor: SensorId) -> Place {
    let mut cells = (0..4).flat_map(|j| (0..48).map(move |i| Place { sensor, i, j }));
    cells.find(|place| pyramids().truth.hit(*place).is_some()).expect("a hit")
}

#[test]
fn points_are_compared_as_parts_of_their_distances() {
    let bench = pyramids();
    let sensors = [SensorId::Beam(0)];
    let [range, point] = [Quantity::Range, Quantity::Point]
        .map(|quantity| Channel { sensor: sensors[0], item: quantity.into() });
    let case = Case { truth: &bench.truth, recorded: &bench.exact, sensors: &sensors, tolerance: 1e-9 };
    let (hit, answers) = (a_hit(sensors[0]), bench.truth.answers());
    let (Value::Number(length), Value::Vector(exact)) = (range.at(answers, hit), point.at(answers, hit))
    else {
        panic!("a length and a point")
    };
    // From the origin and from the sensor.
    let most = 1e-9 * (exact.length() + length);
    let is =
        |off: f64| is_near(case, point, hit, Value::Vector(exact + DVec3::X * off), Value::Vector(exact));
    assert!(is(0.999 * most) && !is(1.001 * most));
}

/// The tolerance is a 64th of the median error, of vectors as of numbers; without an error it is the largest.
#[test]
fn the_tolerance_is_a_part_of_the_errors_that_are_to_be_explained() {
    let bench = pyramids();
    let sensor = SensorId::Beam(0);
    let channels = channels_of(&bench.exact, &[sensor]);
    let of =
        |quantity| *channels.iter().find(|channel| channel.item.quantity == quantity).expect("a channel");
    let [range, point] = [of(Quantity::Range), of(Quantity::Point)];
    let exact = bench.truth.answers();
    let hit = a_hit(sensor);
    // Numbers and points that are off by 2^-24 of themselves.
    let off = 1.0 + 1.0 / f64::from(1 << 24);
    let mut recorded = bench.exact.clone();
    let map = recorded.answers.maps.iter_mut().find(|map| map.sensor == sensor).expect("a map");
    if let (Value::Number(length), Value::Vector(vector)) = (range.at(exact, hit), point.at(exact, hit)) {
        map.range.as_mut().expect("ranges").set(hit.i, hit.j, Some(length * off).into());
        map.point.as_mut().expect("points").set(hit.i, hit.j, Some(vector * off).into());
    }
    for channel in [range, point] {
        let tolerance = tolerance_of(&bench.truth, &recorded, &[(channel, hit)]);
        assert!((tolerance * f64::from(1 << 30) - 1.0).abs() < 1e-6, "{tolerance}");
    }
    assert_eq!(tolerance_of(&bench.truth, &recorded, &[]), TRIAL_TOLERANCE);
}
