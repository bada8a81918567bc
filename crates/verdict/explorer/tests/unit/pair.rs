//! Codes of differences and of bounds.

use std::collections::BTreeMap;

use glam::DVec3;
use raypencil_judge::{Item, ItemTallies};
use raypencil_scene::{Atmosphere, Fidelity, FluxModel, SensorId, rig};

use super::*;
use crate::arrays::tests::read;

#[test]
fn ulps_are_steps_from_one_number_to_the_next() {
    assert_eq!(ulps_between(1.0, 1.0), 0);
    assert_eq!(ulps_between(1.0, 1.0_f64.next_up()), 1);
    assert_eq!(ulps_between(1.0, 1.0_f64.next_down()), -1);
    // Across a power of two the steps below are half as long.
    assert_eq!(ulps_between(2.0_f64.next_down(), 2.0_f64.next_up()), 2);
    // 2^52 steps from 1 to 2.
    assert_eq!((ulps_between(1.0, 2.0), ulps_between(2.0, 1.0)), (i32::MAX, -i32::MAX));
    assert_eq!(ulps_between(f64::NAN, 1.0), i32::MAX);
}

#[test]
fn bounds_keep_their_size_to_nine_percent() {
    let decoded = |code: u8| libm::exp2((f64::from(code) - 1.0) / 4.0 - 60.0);
    for bound in [1e-17, 3e-15, 1e-12, 2.5e-7, 1e-3, 7.0] {
        let code = code_of_bound(bound);
        assert!((decoded(code) / bound - 1.0).abs() < 0.091, "{bound}: {code}");
    }
    // 2^-60 m has the first code; what is smaller shares it, and no bound has none.
    assert_eq!((code_of_bound(libm::exp2(-60.0)), code_of_bound(1e-30)), (1, 1));
    assert_eq!((code_of_bound(0.0), code_of_bound(f64::NAN)), (0, 0));
    assert_eq!(code_of_bound(f64::INFINITY), 254);
}

/// Classes, causes and quantities of all cells of a beam on a page, with these rays of it; `compared` rays were compared.
fn coded(differing: Vec<DifferingRay>, compared: u64, causes: &[Switches]) -> (usize, [Vec<u32>; 3]) {
    let mesh = raypencil_terrain::builtin("pyramids", 0.25).unwrap().into_mesh().unwrap();
    let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
    let air = Atmosphere { attenuation: 0.0 };
    let scene = Scene::new(mesh.into(), camera, beams, air, FluxModel::Radiometric).unwrap();
    let sensor = SensorId::Beam(0);
    let result = SensorResult {
        sensor,
        by_class: [compared, 0, 0, 0, 0, 0],
        not_compared: 0,
        judged: 0,
        items: ItemTallies::default(),
        differing,
        defects: Vec::new(),
        listed: Vec::new(),
        approximations: BTreeMap::new(),
        range_difference: None,
    };
    let mut arrays = Arrays::default();
    let model = pair_model(
        &mut arrays,
        &scene,
        &SensorPair { sides: [0, 1], result: &result, compared: None },
        causes,
    );
    let scripts = arrays.scripts();
    let (width, _) = scene.size(sensor).unwrap();
    (width as usize, ["class", "cause", "quantity"].map(|key| read(&scripts, &model[key])))
}

#[test]
fn every_ray_of_a_page_has_its_own_class_cause_and_quantity() {
    let mut facing = Switches::EXACT;
    facing.set("facing", Fidelity::Paper).unwrap();
    let ray = |i, j, class, quantity: Quantity, causes| DifferingRay {
        i,
        j,
        class,
        item: Item::from(quantity),
        causes,
    };
    let differing = vec![
        ray(3, 0, Class::Rounding, Quantity::Range, Switches::EXACT),
        ray(1, 1, Class::Approximation, Quantity::Face, facing),
        // Switches that are on for a ray which they do not excuse are no cause of it.
        ray(5, 1, Class::Defect, Quantity::Depth, facing),
        ray(6, 1, Class::Approximation, Quantity::Hit, Switches::PAPER),
        ray(7, 1, Class::Tie, Quantity::CosView, Switches::EXACT),
    ];
    let (width, [classes, causes, quantities]) = coded(differing.clone(), 9, &[Switches::PAPER, facing]);
    let none = u32::from(NONE);
    for cell in 0..classes.len() {
        let ray = differing.iter().find(|ray| ray.j as usize * width + ray.i as usize == cell);
        let cause = match ray.map(|ray| (ray.class, ray.causes)) {
            Some((Class::Approximation, causes)) if causes == facing => 1,
            Some((Class::Approximation, _)) => 0,
            _ => none,
        };
        assert_eq!(classes[cell], ray.map_or(0, |ray| ray.class as u32), "{cell}");
        assert_eq!(causes[cell], cause, "{cell}");
        let quantity = ray.map(|ray| Quantity::ALL[quantities[cell] as usize] == ray.item.quantity);
        assert!(quantity.unwrap_or(quantities[cell] == none), "{cell}");
    }
    // Where nothing was compared, nothing agrees.
    let (_, [classes, ..]) = coded(Vec::new(), 0, &[]);
    assert!(classes.iter().all(|class| *class == none));
}
