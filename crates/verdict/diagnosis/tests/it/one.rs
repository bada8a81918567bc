//! Each mistake alone, made on the exact answers, is named; and what is no mistake of a convention is not.

use glam::DVec3;
use raypencil_judge::{Quantity, Recorded};
use raypencil_scene::{Precision, SensorId};

use super::candidates::*;

/// Asserts that exactly these mistakes explain a candidate.
#[track_caller]
pub fn assert_explained(bench: &Bench, candidate: &Recorded, keys: &[&str]) {
    let (mut found, share) =
        bench.explanation(candidate).unwrap_or_else(|| panic!("no explanation for {keys:?}"));
    let mut keys = keys.to_vec();
    found.sort_unstable();
    keys.sort_unstable();
    assert_eq!(found, keys);
    assert!(share > 0.97, "{keys:?}: {share}");
}

/// The exact answers to the pyramids with a change.
pub fn pyramids_with(change: impl FnOnce(&mut Recorded)) -> Recorded {
    let mut candidate = pyramids().exact.clone();
    change(&mut candidate);
    candidate
}

#[test]
fn an_honest_candidate_has_no_explanation() {
    for bench in [pyramids(), walls()] {
        assert_eq!(bench.explanation(&bench.exact), None);
        assert_eq!(bench.explanation(&stored_single(&bench.exact)), None);
    }
}

#[test]
fn random_errors_have_no_explanation() {
    // A hash of the index in place of a random number, from -1 to 1.
    let noise = |index: usize| {
        let bits = (index as u64)
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .rotate_left(29)
            .wrapping_mul(0xd1b5_4a32_d192_ed03);
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    for size in [1e-2, 1e-4, 1e-6, 1e-9] {
        let every_third = pyramids_with(|candidate| {
            ranges(candidate, |index, x| if index % 3 == 0 { x * (1.0 + size * noise(index)) } else { x });
        });
        assert_eq!(pyramids().explanation(&every_third), None, "{size}");
        let only_range = only(&every_third, &[Quantity::Range]);
        assert_eq!(pyramids().explanation(&only_range), None, "{size}, ranges alone");
    }
    let mut count = 0;
    let any_face = pyramids_with(|candidate| {
        faces(candidate, |_| {
            count += 1;
            (noise(count).abs() * 224.0) as u32
        });
    });
    assert_eq!(pyramids().explanation(&any_face), None);
    let any_point = pyramids_with(|candidate| points(candidate, |index, p| p * noise(index)));
    assert_eq!(pyramids().explanation(&any_point), None);
}

#[test]
fn cells_in_another_order_are_named() {
    let rows = pyramids_with(|c| moved(c, |_, h, i, j| (i, h - 1 - j)));
    assert_explained(pyramids(), &rows, &["rows_reversed"]);
    assert_explained(pyramids(), &only(&rows, &[Quantity::Range]), &["rows_reversed"]);
    assert_explained(pyramids(), &stored_single(&rows), &["rows_reversed"]);
    let columns = pyramids_with(|c| moved(c, |w, _, i, j| (w - 1 - i, j)));
    assert_explained(pyramids(), &columns, &["columns_reversed"]);
    // Column by column: the cell of index k row by row holds the one of index k column by column.
    let transposed = pyramids_with(|c| moved(c, |w, h, i, j| ((j * w + i) / h, (j * w + i) % h)));
    assert_explained(pyramids(), &transposed, &["transposed"]);
    for (di, dj) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
        let moved_by = |k: u32, by: i32, n: u32| (k as i32 - by).clamp(0, n as i32 - 1) as u32;
        let shifted = pyramids_with(|c| moved(c, |w, h, i, j| (moved_by(i, di, w), moved_by(j, dj, h))));
        assert_explained(pyramids(), &shifted, &["shifted"]);
    }
    let mut camera = rows;
    camera.answers.maps[1..].clone_from_slice(&pyramids().exact.answers.maps[1..]);
    for (light, exact) in camera.answers.light.iter_mut().zip(&pyramids().exact.answers.light) {
        light.returns = exact.returns.clone();
        light.other_flux = exact.other_flux.clone();
    }
    assert_explained(pyramids(), &camera, &["rows_reversed"]);
}

#[test]
fn other_lengths_are_named() {
    let swap = |c: &mut Recorded| c.answers.maps.iter_mut().for_each(|map| map.range = map.depth.clone());
    assert_explained(pyramids(), &pyramids_with(swap), &["depth_for_range"]);
    assert_explained(pyramids(), &only(&pyramids_with(swap), &[Quantity::Range]), &["depth_for_range"]);
    let back = |c: &mut Recorded| c.answers.maps.iter_mut().for_each(|map| map.depth = map.range.clone());
    assert_explained(pyramids(), &pyramids_with(back), &["range_for_depth"]);
    assert_explained(pyramids(), &pyramids_with(parameter_for_range), &["parameter_for_range"]);
    let parameter_for_depth = pyramids_with(|c| {
        let ranges: Vec<_> = c.answers.maps.iter().map(|map| map.range.clone()).collect();
        parameter_for_range(c);
        for (map, range) in c.answers.maps.iter_mut().zip(ranges) {
            map.depth = std::mem::replace(&mut map.range, range);
        }
    });
    assert_explained(pyramids(), &parameter_for_depth, &["parameter_for_depth"]);
    for (key, factor) in
        [("millimetres", 1e3), ("centimetres", 1e2), ("kilometres", 1e-3), ("feet", 1.0 / 0.3048)]
    {
        let scaled = pyramids_with(|c| in_units(c, factor));
        assert_explained(pyramids(), &scaled, &[key]);
        assert_explained(pyramids(), &stored_single(&scaled), &[key]);
    }
}

/// t = depth / f_c, or depth / g, in place of the range.
pub fn parameter_for_range(candidate: &mut Recorded) {
    let scene = pyramids().scene;
    for map in &mut candidate.answers.maps {
        let axis = match map.sensor {
            SensorId::Camera => scene.camera().sensor.focal_length,
            SensorId::Beam(beam) => scene.beams()[beam].sensor.grid_distance,
        };
        map.range = map.depth.clone();
        for cell in map.range.as_mut().unwrap().cells_mut() {
            *cell = cell.get().map(|depth| depth / axis).into();
        }
    }
}

/// All lengths times a factor.
pub fn in_units(candidate: &mut Recorded, factor: f64) {
    let is_length = |number| matches!(number, Number::Range | Number::Depth | Number::View);
    numbers(candidate, |number, x| if is_length(number) { x * factor } else { x });
    points(candidate, |_, p| p * factor);
}

/// Points and normals in glTF's axes.
pub fn y_up(candidate: &mut Recorded) {
    points(candidate, |_, p| DVec3::new(p.x, p.z, -p.y));
    normals(candidate, |_, n| DVec3::new(n.x, n.z, -n.y));
}

#[test]
fn other_axes_and_frames_are_named() {
    assert_explained(pyramids(), &pyramids_with(y_up), &["axes_y_up"]);
    let inverse = pyramids_with(|c| {
        points(c, |_, p| DVec3::new(p.x, -p.z, p.y));
        normals(c, |_, n| DVec3::new(n.x, -n.z, n.y));
    });
    assert_explained(pyramids(), &inverse, &["axes_y_up_inverse"]);
    let left_handed = pyramids_with(|c| {
        points(c, |_, p| DVec3::new(p.x, -p.y, p.z));
        normals(c, |_, n| DVec3::new(n.x, -n.y, n.z));
    });
    assert_explained(pyramids(), &left_handed, &["axes"]);
    let turned = pyramids_with(|c| {
        points(c, |_, p| DVec3::new(p.y, p.z, p.x));
        normals(c, |_, n| DVec3::new(n.y, n.z, n.x));
    });
    assert_explained(pyramids(), &turned, &["axes"]);
    let of_sensor = pyramids_with(|c| {
        let scene = pyramids().scene;
        for (sensor, map) in scene.sensors().zip(&mut c.answers.maps) {
            let pose = match sensor {
                SensorId::Camera => scene.camera().scene_from_sensor,
                SensorId::Beam(beam) => scene.beams()[beam].scene_from_sensor,
            };
            for cell in map.point.as_mut().unwrap().cells_mut() {
                *cell = cell.get().map(|p| pose.inverse() * p).into();
            }
            for cell in map.normal.as_mut().unwrap().cells_mut() {
                *cell = cell.get().map(|n| pose.inverse().rotate(n)).into();
            }
        }
    });
    assert_explained(pyramids(), &of_sensor, &["sensor_frame"]);
    assert_explained(pyramids(), &pyramids_with(|c| normals(c, |_, n| -n)), &["normals_reversed"]);
    let origin = DVec3::new(1024.0, -2048.0, 512.0);
    let far_walls = walls_at(origin);
    let mut global = only(&far_walls.exact, &[Quantity::Range, Quantity::Point]);
    points(&mut global, |_, p| p + origin);
    assert_explained(&far_walls, &global, &["global_frame"]);
    let long = pyramids_with(|c| normals(c, |index, n| n * (1.0 + (index % 7) as f64)));
    assert_explained(pyramids(), &long, &["normals_not_unit"]);
}

#[test]
fn other_faces_are_named() {
    let one_based = pyramids_with(|c| faces(c, |face| face + 1));
    assert_explained(pyramids(), &one_based, &["faces_shifted"]);
    let one_less = pyramids_with(|c| faces(c, |face| face.saturating_sub(1)));
    assert_explained(pyramids(), &one_less, &["faces_shifted"]);
    assert_explained(pyramids(), &pyramids_with(own_order), &["faces_reordered"]);
    // Without a length nothing proves that the rays are right.
    let alone = only(&pyramids_with(own_order), &[Quantity::Face]);
    assert_eq!(pyramids().explanation(&alone), None);
}

/// Another order of the 224 faces: 137 and 224 have no common divisor.
pub fn own_order(candidate: &mut Recorded) {
    faces(candidate, |face| (137 * face + 5) % 224);
}

#[test]
fn constants_for_a_miss_are_named() {
    let range = [Quantity::Range];
    for (constant, key) in [
        (0.0, "miss_written"),
        (-1.0, "miss_written"),
        (1e10, "miss_written"),
        (20.0, "miss_at_maximum_range"),
    ] {
        let mut candidate = only(&pyramids().exact, &range);
        missed(&mut candidate, constant);
        assert_explained(pyramids(), &candidate, &[key]);
    }
    let mut both = only(&pyramids().exact, &[Quantity::Range, Quantity::Depth]);
    missed(&mut both, 0.0);
    assert_explained(pyramids(), &both, &["miss_written"]);
}

#[test]
fn single_precision_is_named() {
    // A relative error of one to three units of single precision on each number, stored in double precision.
    let mut count = 0;
    let single = pyramids_with(|c| as_single(c, &mut count));
    assert_explained(pyramids(), &single, &["single_precision"]);
    assert_explained(pyramids(), &only(&single, &[Quantity::Range, Quantity::Face]), &["single_precision"]);
    // It is declared: nothing is wrong.
    let declared = Recorded { precision: Precision::F32, ..single };
    assert_eq!(pyramids().explanation(&declared), None);
}

/// Numbers as a program in single precision computes them.
pub fn as_single(candidate: &mut Recorded, count: &mut u32) {
    numbers(candidate, |_, x| {
        *count += 1;
        let single = x as f32;
        f64::from(if count.is_multiple_of(2) { single.next_up() } else { single })
    });
    points(candidate, |_, p| DVec3::from_array(p.to_array().map(|x| f64::from((x as f32).next_up()))));
    normals(candidate, |_, n| DVec3::from_array(n.to_array().map(|x| f64::from(x as f32))));
}

#[test]
fn other_light_is_named() {
    let exchanged = pyramids_with(|c| {
        for (map, light) in c.answers.maps[1..].iter_mut().zip(&mut c.answers.light) {
            std::mem::swap(&mut map.cos_incidence, &mut light.returns.cos_view);
        }
    });
    assert_explained(pyramids(), &exchanged, &["cosines_exchanged"]);
    // Any other order of the three, and one channel alone.
    for turn in 1..=4 {
        let turned = pyramids_with(|c| {
            for (map, light) in c.answers.maps[1..].iter_mut().zip(&mut c.answers.light) {
                let own = [&map.cos_incidence, &light.returns.cos_off_axis, &light.returns.cos_view];
                let [psi, phi, theta] = own.map(Clone::clone);
                let [a, b, d] = match turn {
                    1 => [phi, psi, theta],
                    2 => [psi, theta, phi],
                    3 => [phi, theta, psi],
                    _ => [theta, psi, phi],
                };
                (map.cos_incidence, light.returns.cos_off_axis, light.returns.cos_view) = (a, b, d);
            }
        });
        assert_explained(pyramids(), &turned, &["cosines_exchanged"]);
    }
    let one_alone = pyramids_with(|c| {
        for (map, light) in c.answers.maps[1..].iter_mut().zip(&mut c.answers.light) {
            map.cos_incidence = light.returns.cos_view.clone();
        }
    });
    assert_explained(pyramids(), &one_alone, &["cosines_exchanged"]);
    let negated = pyramids_with(|c| {
        numbers(c, |number, x| if number == Number::Incidence { -x } else { x });
    });
    assert_explained(pyramids(), &negated, &["cosines_negated"]);
    let is_cosine = |number| matches!(number, Number::Incidence | Number::OffAxis | Number::Emission);
    for (key, unit) in [("radians_for_cosine", 1.0), ("degrees_for_cosine", 180.0 / std::f64::consts::PI)] {
        let angles = pyramids_with(|c| {
            numbers(c, |number, x| if is_cosine(number) { libm::acos(x.min(1.0)) * unit } else { x });
        });
        assert_explained(pyramids(), &angles, &[key]);
    }
    assert_explained(pyramids(), &pyramids_with(other_model), &["other_flux_model"]);
    assert_explained(pyramids(), &pyramids_with(|c| flux(c, |x| x * 3.0)), &["flux_factor"]);
    for (out, back) in [(true, false), (false, true), (false, false)] {
        assert_explained(pyramids(), &pyramids_with(|c| attenuated(c, out, back)), &["attenuation"]);
    }
    let height = pyramids().scene.camera().sensor.height;
    let from_bottom = pyramids_with(|c| {
        for light in &mut c.answers.light {
            for cell in light.returns.pixel.as_mut().unwrap().cells_mut() {
                *cell = cell.get().map(|p| raypencil_scene::Pixel { j: height - 1 - p.j, ..p }).into();
            }
        }
    });
    assert_explained(pyramids(), &from_bottom, &["pixel_rows_from_bottom"]);
    let width = pyramids().scene.camera().sensor.width;
    let from_right = pyramids_with(|c| {
        for light in &mut c.answers.light {
            for cell in light.returns.pixel.as_mut().unwrap().cells_mut() {
                *cell = cell.get().map(|p| raypencil_scene::Pixel { i: width - 1 - p.i, ..p }).into();
            }
        }
    });
    assert_explained(pyramids(), &from_right, &["pixel_columns_from_right"]);
    let square = pyramids_of(56, 56);
    let mut exchanged = square.exact.clone();
    for light in &mut exchanged.answers.light {
        for cell in light.returns.pixel.as_mut().unwrap().cells_mut() {
            *cell = cell.get().map(|p| raypencil_scene::Pixel { i: p.j, j: p.i }).into();
        }
    }
    assert_explained(&square, &exchanged, &["pixels_exchanged"]);
}

/// The flux of the other model in place of the scene's.
pub fn other_model(candidate: &mut Recorded) {
    for light in &mut candidate.answers.light {
        light.returns.flux = light.other_flux.clone();
        light.image = light.other_image.clone();
    }
    candidate.storage.retain(|(_, item), _| !item.is_other_model);
    candidate.answers.light.iter_mut().for_each(|light| {
        light.other_flux = None;
        light.other_image = None;
    });
}

/// The flux of pencils with attenuation on a part of the way; the image is left out.
pub fn attenuated(candidate: &mut Recorded, out: bool, back: bool) {
    let sigma = pyramids().scene.atmosphere().attenuation;
    candidate.storage.retain(|(_, item), _| item.beam.is_none() && !item.is_other_model);
    for (map, light) in candidate.answers.maps[1..].iter().zip(&mut candidate.answers.light) {
        (light.image, light.other_image, light.other_flux) = (None, None, None);
        let returns = &mut light.returns;
        for (index, flux) in returns.flux.as_mut().unwrap().cells_mut().iter_mut().enumerate() {
            let at = |image: &Option<raypencil_scene::Image<raypencil_scene::Maybe<f64>>>| {
                image.as_ref().unwrap().cells()[index].get()
            };
            let ways = at(&map.range).zip(at(&returns.depth)).zip(at(&returns.cos_off_axis));
            if let Some(((range, depth), cosine)) = ways {
                let left_out = if out { 0.0 } else { range } + if back { 0.0 } else { depth / cosine };
                *flux *= libm::exp(sigma * left_out);
            }
        }
    }
}
