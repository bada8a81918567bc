//! Classes of differences at the limit of arithmetic: a crack is a defect at any width, and a choice between faces
//! closer than the rounding error is not.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil::campaign::{Campaign, PartName, scene_of};
use raypencil::judge::{Class, Judge, JudgeShare, Quantity, SensorResult, Side, compare_judged};
use raypencil::referee::{Displacement, Ruling, aspect};
use raypencil::scanline::Scanline;
use raypencil::terrain::builtin;
use raypencil::tracer::Tracer;
use raypencil::{
    Camera, FaceId, Maybe, Mesh, Mounted, Place, Pose, Precision, RenderOutput, Renderer, Request, Scene,
    SensorId,
};
use raypencil_tests::draws::SplitMix64;
use raypencil_tests::naive::{Fault, Naive};
use raypencil_tests::{hit, lattice, mesh, renderers, rig, scene, single};

fn compared(scene: &Scene, a: &dyn Renderer, b: &dyn Renderer) -> Vec<SensorResult> {
    let outputs = [a, b].map(|renderer| renderer.render(scene, &Request::EVERYTHING));
    let side = |renderer: &dyn Renderer, output| Side {
        name: if renderer.name() == a.name() { "a" } else { "b" },
        output,
        precision: renderer.precision(),
        attributions: None,
    };
    let judge = Judge::new(scene, JudgeShare::All);
    compare_judged(&judge, side(a, &outputs[0]), side(b, &outputs[1]))
}

#[test]
fn a_crack_of_any_width_is_a_defect() {
    // Every ray passes an edge of two faces within a relative distance of 1e-16, and nothing is behind the edge. A
    // renderer that computes the edge twice, with the rounding of two different corners, misses with some of the rays.
    // The crack is about 1e-13 cells wide, and a correct renderer may displace a ray by 1e-9: but no displaced ray
    // misses.
    let scene = lattice::turned(101);
    let cracked = Naive { fault: Some(Fault::EdgesComputedApart) };
    let map = cracked.render(&scene, &Request::EVERYTHING).camera.expect("the camera was asked for");
    let through: u64 = (0..101)
        .flat_map(|j| (0..101).map(move |i| (i, j)))
        .filter(|&(i, j)| hit(&map, i, j).is_none())
        .count() as u64;
    assert!(through > 20, "{through} of 10201 rays miss");
    for honest in renderers() {
        let sensors = compared(&scene, &*honest, &cracked);
        assert_eq!(sensors[0].sensor, SensorId::Camera);
        assert_eq!(sensors[0].of(Class::Defect), through, "{}", honest.name());
    }
    let [a, b] = renderers();
    assert_eq!(compared(&scene, &*a, &*b)[0].of(Class::Defect), 0);
}

/// Two faces with a common edge in a row of pixels. The third corner of the second is moved by one unit in the last
/// place of `f32`. The camera has a general orientation.
fn nearly_coincident() -> Scene {
    let pose =
        Pose { position: DVec3::new(0.3, -1.7, 2.9), rotation: DQuat::from_xyzw(0.31, -0.52, 0.23, 0.74) };
    let camera = rig::camera(1024, 9, 9e-6, 8e-3);
    let camera = Mounted { scene_from_sensor: pose, sensor: camera };
    let at = |i: f64, j: f64, z: f64| {
        let q = DVec3::new((i - 512.0) * 9e-6, (j - 4.5) * 9e-6, 8e-3);
        (pose * (q * (z / 8e-3))).as_vec3().to_array()
    };
    // The edge lies in the middle row, from beyond the left border to beyond the right one.
    let (left, right, below) = (at(-5.0, 4.5, 2.0), at(1029.0, 4.5, 3.0), at(512.0, 700.0, 2.5));
    let moved = [below[0], below[1], below[2].next_up()];
    let vertices = vec![left, right, below, moved];
    let ground = |faces: Vec<[u32; 3]>| -> Arc<Mesh> { mesh(vertices.clone(), faces) };
    scene(ground(vec![[0, 2, 1], [0, 3, 1]]), camera, Vec::new())
}

#[test]
fn faces_one_ulp_apart_are_rounding() {
    let scene = nearly_coincident();
    let [a, b] = renderers();
    let found = &compared(&scene, &*a, &*b)[0];
    let of = |class| found.of(class);
    // Far from the edge the two faces are up to 2e-7 m apart, which f64 resolves; at the edge less than 1e-15 m.
    assert_eq!(of(Class::Defect) + of(Class::Undecided), 0, "{:?}", found.defects);
    assert!(of(Class::Rounding) > 0, "no ray is close enough: {:?}", found.by_class);
    assert!(of(Class::Agree) > 4000, "{:?}", found.by_class);
    assert_eq!(found.judged, found.compared());
}

/// The output of the paper's algorithm with injected errors, and their number. Every 97th pencil loses its hit if it is
/// not visible; every 89th has its visibility inverted.
fn altered(scene: &Scene, paper: &Scanline) -> (RenderOutput, u64) {
    let mut output = paper.render(scene, &Request::EVERYTHING);
    let mut altered_count = 0;
    for (map, returns) in output.beams.iter_mut().zip(&mut output.returns) {
        for j in 0..map.height {
            for i in 0..map.width {
                let index = j * map.width + i;
                let Some(hit) = hit(map, i, j) else { continue };
                let visible = returns.visible.as_mut().expect("visibility was asked for");
                let seen = visible.at(i, j);
                if index % 97 == 0 && !seen {
                    // The pencil is not visible, so that its flux of 0 stays correct.
                    map.face.as_mut().expect("faces").set(i, j, Maybe::NONE);
                    map.range.as_mut().expect("ranges").set(i, j, Maybe::NONE);
                    altered_count += 1;
                } else if index % 89 == 0 && hit.cos_incidence > 0.1 {
                    visible.set(i, j, !seen);
                    altered_count += 1;
                }
            }
        }
    }
    (output, altered_count)
}

#[test]
fn an_approximation_does_not_cover_other_errors() {
    // Thick sheets, so that the paper's approximations err too. The injected errors are independent of them.
    let ground = builtin("facets", 0.25).expect("a built-in name").into_mesh().expect("a mesh");
    let (camera, mut beams) = rig::default_rig(4, DVec3::ZERO, 0.3);
    for beam in &mut beams {
        beam.sensor.thickness = 0.08;
    }
    let scene = scene(Arc::new(ground), camera, beams);
    let (paper, tracer) = (Scanline::paper(), Tracer::new());
    let (output, altered_count) = altered(&scene, &paper);
    assert!(altered_count > 15, "{altered_count} answers are altered");
    let honest = tracer.render(&scene, &Request::EVERYTHING);
    let judge = Judge::new(&scene, JudgeShare::Sample);
    let attributions =
        raypencil::harness::attribute(&judge, &output, paper.options().switches, paper.precision());
    let side =
        |name, output, attributions| Side { name, output, precision: tracer.precision(), attributions };
    let sensors =
        compare_judged(&judge, side("altered", &output, Some(&attributions)), side("tracer", &honest, None));
    let beams = &sensors[1..];
    let defects: u64 = beams.iter().map(|sensor| sensor.of(Class::Defect)).sum();
    let approximated: u64 = beams.iter().map(|sensor| sensor.of(Class::Approximation)).sum();
    assert_eq!(defects, altered_count);
    assert!(approximated > 0, "the paper errs as well");
}

#[test]
fn an_approximation_does_not_cover_a_wrong_value() {
    // Where the paper's face is wrong, its range or flux is doubled: the correct values of that face are known all the
    // same.
    let ground = builtin("facets", 0.25).expect("a built-in name").into_mesh().expect("a mesh");
    let (camera, mut beams) = rig::default_rig(2, DVec3::ZERO, 0.3);
    for beam in &mut beams {
        beam.sensor.thickness = 0.3;
    }
    let scene = scene(Arc::new(ground), camera, beams);
    let (paper, tracer) = (Scanline::paper(), Tracer::new());
    let output = paper.render(&scene, &Request::EVERYTHING);
    let honest = tracer.render(&scene, &Request::EVERYTHING);
    let judge = Judge::new(&scene, JudgeShare::Sample);
    let attributions =
        raypencil::harness::attribute(&judge, &output, paper.options().switches, paper.precision());
    let precision = tracer.precision();
    let compared = |output: &RenderOutput| {
        let sensors = compare_judged(
            &judge,
            Side { name: "paper", output, precision, attributions: Some(&attributions) },
            Side { name: "tracer", output: &honest, precision, attributions: None },
        );
        sensors[1..].iter().fold([0, 0], |[defects, approximated], sensor| {
            [defects + sensor.of(Class::Defect), approximated + sensor.of(Class::Approximation)]
        })
    };
    let [defects, approximated] = compared(&output);
    assert_eq!(defects, 0);
    assert!(approximated > 20, "{approximated}");

    let mut altered_outputs = [output.clone(), output];
    let mut counts = [0, 0];
    for index in 0..scene.beams().len() {
        let (columns, rows) = scene.size(SensorId::Beam(index)).expect("a beam");
        for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
            let place = Place { sensor: SensorId::Beam(index), i, j };
            if attributions.cause(place).is_none() && attributions.visibility_cause(place).is_none() {
                continue;
            }
            let ranges = altered_outputs[0].beams[index].range.as_mut().expect("ranges");
            if let Some(range) = ranges.at(i, j).get() {
                ranges.set(i, j, Maybe::some(2.0 * range));
                counts[0] += 1;
            }
            let fluxes = altered_outputs[1].returns[index].flux.as_mut().expect("fluxes");
            if fluxes.at(i, j) > 0.0 {
                fluxes.set(i, j, 2.0 * fluxes.at(i, j));
                counts[1] += 1;
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 5), "{counts:?}");
    for (output, count) in altered_outputs.iter().zip(counts) {
        assert_eq!(compared(output)[0], count);
    }
}

/// Found by a campaign. The ray of pixel (0, 0) meets an edge of the second face exactly on the projection plane, t =
/// 1, and behind it, at t = 2, exactly a corner of the first face: two coincidences, each of measure zero. To lose the
/// nearer hit by the rounding of 1/t would be admissible, because a neighbouring ray misses. But then the corner
/// behind would be reported, which no neighbouring ray meets first.
#[test]
fn a_hit_exactly_on_the_projection_plane_before_a_corner_exactly_on_the_ray() {
    let corner = [-0.0234375, -0.0234375, 0.125];
    let vertices = vec![
        corner,
        [0.0, 0.0, 4.0],
        [-0.5, 0.0, 4.0],
        [-0.005859375, -0.015625, 0.03125],
        [-0.017578125, -0.0078125, 0.09375],
        [0.0, -0.0078125, 0.125],
    ];
    let ground = mesh(vertices, vec![[0, 2, 1], [3, 4, 5]]);
    let camera = Camera { principal_point: [12.5, 12.5], ..rig::camera(1, 1, 1.0 / 1024.0, 1.0 / 16.0) };
    let scene = scene(ground, raypencil_tests::at_origin(camera), Vec::new());
    let [scanline, tracer] = renderers();
    let face = |renderer: &dyn Renderer| {
        let map = renderer.render(&scene, &Request::EVERYTHING).camera.expect("the camera was asked for");
        hit(&map, 0, 0).map(|hit| (hit.face.0, hit.depth))
    };
    assert_eq!(face(&*tracer), Some((1, 0.0625)));
    assert_eq!(face(&*scanline), Some((1, 0.0625)));
    assert_eq!(compared(&scene, &*scanline, &*tracer)[0].of(Class::Defect), 0);
}

/// Found by a campaign. Two faces tie, and the pencil grazes both at different angles: their fluxes differ by nearly
/// the error bound of the flux at grazing incidence.
#[test]
fn the_difference_of_tied_faces_is_not_an_error_of_flux() {
    let scene = scene_of(&Campaign::new(1, 911), 910, PartName::Lattice).expect("a random scene");
    let [a, b] = renderers();
    let sensors = compared(&scene, &*a, &*b);
    let beam = sensors.iter().find(|sensor| sensor.sensor == SensorId::Beam(0)).expect("a beam");
    let flux = beam.items.iter().find(|(item, _)| item.quantity == Quantity::PencilFlux);
    let (_, flux) = flux.expect("both say what each pencil delivers");
    assert!(flux.of(Class::Tie) > 20 && flux.of(Class::Defect) == 0, "{flux:?}");
    let worst = flux.worst_ratio.clone().expect("pencils that agree");
    assert!(worst.value < 0.1, "{worst:?}");
}

/// Found by a campaign: a needle whose normal a file's first corner gives without any rounding, and the lowest corner, at which
/// both renderers begin, with a thousand roundings. Neither is wrong.
#[test]
#[allow(clippy::excessive_precision, reason = "the numbers of a campaign, to the last digit")]
fn a_renderer_may_begin_at_any_corner_of_a_face() {
    let [a, b, c] = [
        [2.298424005508423, -4.474820137023926, -0.189406618475914],
        [-0.12348393350839615, -5.487187385559082, 0.6740085482597351],
        [2.2967379093170166, -4.475577354431152, -0.1887989044189453],
    ];
    let exact_normal = DVec3::new(0.28852999696550724, 0.1199101848090539, 0.9499326231002613);
    // Straight down onto the middle of the needle, from 10 m above it.
    let above = DVec3::new(1.4905593, -4.8125283, 10.0);
    let pose = Pose { position: above, rotation: DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0) };
    let camera = Mounted { scene_from_sensor: pose, sensor: rig::camera(9, 9, 1e-7, 1e-2) };
    for corners in [[a, b, c], [b, c, a], [c, a, b]] {
        let scene = scene(mesh(corners.to_vec(), vec![[0, 1, 2]]), camera, Vec::new());
        let [scanline, tracer] = renderers();
        let map = scanline.render(&scene, &Request::EVERYTHING).camera.expect("the camera was asked for");
        let of_hits: Vec<_> = (0..81).filter_map(|k| hit(&map, k % 9, k / 9)).collect();
        let error = of_hits.iter().map(|hit| (hit.normal - exact_normal).length()).fold(0.0, f64::max);
        assert!(error > 5e-14, "{} hits, {error}", of_hits.len());
        let found = &compared(&scene, &*scanline, &*tracer)[0];
        assert_eq!(found.of(Class::Defect), 0, "{:?}", found.defects);
        assert!(found.judged > 0);
    }
}

/// A plank of 2 to 20 m by 5 to 50 mm, seen along its length by a camera whose middle pixel looks at the plank's middle;
/// behind it a wall, or nothing. The cosine between the pixel's ray and the plank's normal is `angle` times 5 kappa u of
/// single precision.
fn plank_on_end(draws: &mut SplitMix64, angle: f64) -> Scene {
    let (length, width) = (draws.between(2.0, 20.0), draws.between(5e-3, 0.05));
    let along = draws.direction();
    let across = along.cross(draws.direction()).normalize();
    let at = draws.vector(3.0);
    let corners = [at, at + length * along + width * across, at + draws.between(0.0, 1.0) * length * along];
    let corners = corners.map(|corner| corner.as_vec3());
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let (middle, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a).normalize());
    let cosine = angle * 5.0 * aspect([a, b, c]) * Precision::F32.unit_roundoff;
    let forward = ((b - a).normalize() - cosine * normal).normalize();
    let position = middle - draws.between(0.7, 3.0) * length * forward;
    let rotation = DQuat::from_rotation_arc(DVec3::Z, forward);
    let sensor = rig::camera(9, 9, 1e-5, 1e-2);
    let mut vertices = corners.map(|corner| corner.to_array()).to_vec();
    let mut faces = vec![[0, 1, 2]];
    if draws.between(0.0, 1.0) < 0.5 {
        let far = middle + draws.between(0.8, 2.0) * length * forward;
        let (right, down) = forward.any_orthonormal_pair();
        let wall = [[-1.0, -1.0], [2.0, -1.0], [-1.0, 2.0]].map(|[x, y]| far + 5.0 * (x * right + y * down));
        vertices.extend(wall.map(|corner| corner.as_vec3().to_array()));
        faces.push([3, 5, 4]);
    }
    let camera = Mounted { scene_from_sensor: Pose { position, rotation }, sensor };
    scene(mesh(vertices, faces), camera, Vec::new())
}

/// Where a face is so slender that rounding turns its normal by more than the angle at which it is seen, an honest program may
/// take its front for its back. That is not wrong; a program that does so at sixty times this angle is.
#[test]
fn an_honest_program_may_lose_a_needle_that_it_sees_edge_on() {
    let place = Place { sensor: SensorId::Camera, i: 4, j: 4 };
    let mut draws = SplitMix64::new(36);
    // Rulings on a program that never sees the plank: where it is edge-on, and at sixty to a hundred times that angle.
    let [mut edge_on, mut slanting] = [BTreeMap::new(), BTreeMap::new()];
    let mut lost_in_single = 0;
    for k in 0..4000 {
        let is_slanting = k % 4 == 0;
        let angle = if is_slanting { draws.between(60.0, 100.0) } else { draws.between(-1.0, 1.0) };
        let scene = plank_on_end(&mut draws, angle);
        let ray = scene.ray(place.sensor, place.i, place.j).expect("a pixel");
        let judge = Judge::new(&scene, JudgeShare::All);
        let rule = |stated| judge.rule(place, stated, None, Precision::F32);
        let honest = single::first_hit(scene.mesh(), &ray, 1e3);
        assert_ne!(rule(honest), Ruling::Wrong, "{k}: {honest:?}");
        let exact = judge.referee().verdict(place.sensor, place.i, place.j).expect("a pixel");
        if exact.faces != [FaceId(0)] {
            continue;
        }
        let behind = (scene.mesh().faces().len() > 1).then_some(FaceId(1));
        lost_in_single += u32::from(honest == behind && rule(honest) == Ruling::Rounding(Displacement::ZERO));
        let kind = match rule(behind) {
            Ruling::Rounding(Displacement::ZERO) => "edge-on",
            Ruling::Rounding(_) => "displaced",
            Ruling::Wrong => "wrong",
            Ruling::Exact | Ruling::Tie => panic!("{k}: the plank is met"),
        };
        *(if is_slanting { &mut slanting } else { &mut edge_on }).entry(kind).or_insert(0) += 1;
    }
    let of = |kinds: &BTreeMap<&str, u32>, kind| kinds.get(kind).copied().unwrap_or(0);
    assert!(of(&edge_on, "edge-on") > 500 && of(&edge_on, "wrong") == 0, "{edge_on:?}");
    assert!(of(&slanting, "wrong") > 950, "{slanting:?}");
    assert!(lost_in_single > 30, "only {lost_in_single} planks are lost by the honest program");
}
