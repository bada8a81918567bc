//! Each warning on rays that deserve it, and on rays that do not.

use raypencil_scene::Silent;
use raypencil_scene::pattern::{Mounting, PatternRays};

use super::*;
use crate::answers::{Questions, cast};

/// A box around the origin with its faces outwards, `half` to every side; without its lid it is open.
fn cube(half: f64, has_lid: bool) -> Triangles {
    let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(|bit| if bit == 1 { half } else { -half });
    let squares = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6]];
    let count = if has_lid { 6 } else { 5 };
    let faces = squares[..count].iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    Triangles::new((0..8).map(corner).collect(), faces.collect()).unwrap()
}

/// A square of ground of `side`, from the origin on, in the plane of two axes, with its front along the third.
fn ground(side: f64, [u, v]: [usize; 2]) -> Triangles {
    let corner = |[a, b]: [f64; 2]| {
        let mut at = [0.0; 3];
        (at[u], at[v]) = (a, b);
        at
    };
    let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]].map(corner);
    Triangles::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

fn ray(origin: [f64; 3], direction: [f64; 3]) -> CastRay {
    CastRay::new(DVec3::from_array(origin), DVec3::from_array(direction))
}

fn found(mesh: &Triangles, rays: &[CastRay], sides: Sides, all: bool) -> Vec<(WarningCode, String)> {
    let answers = cast(mesh, rays, sides, Questions { all, ..Questions::default() }, &Silent);
    let warnings = cast_warnings((mesh, MeshHome::default()), rays, sides, None, &answers);
    warnings.into_iter().map(|warning| (warning.code, warning.sentence)).collect()
}

/// Asserts that there is one warning of a code, whose sentence has all of these parts.
#[track_caller]
fn assert_one(found: Vec<(WarningCode, String)>, code: WarningCode, parts: &[&str]) {
    assert_eq!(found.iter().map(|(code, _)| *code).collect::<Vec<_>>(), [code], "{found:?}");
    assert!(parts.iter().all(|part| found[0].1.contains(part)), "{}", found[0].1);
}

#[test]
fn rays_that_are_fine_have_none() {
    let rays = [ray([0.1, 0.2, -5.0], [0.0, 0.0, 1.0]), ray([9.0, 9.0, 9.0], [1.0, 0.0, 0.0])];
    assert_eq!(found(&cube(1.0, true), &rays, Sides::Both, true), []);
    assert_eq!(found(&cube(1.0, false), &rays, Sides::Both, false), []);
    assert_eq!(found(&cube(1.0, true), &[], Sides::Both, true), []);
}

#[test]
fn limits_that_end_before_the_mesh_are_told_with_their_numbers() {
    // 3 x 1000 rays to walls at 2000 and more; a direction of length 2 reaches twice as far as its t.
    let rays: Vec<CastRay> = (0..3000)
        .map(|k| CastRay { t_max: 50.0, ..ray([0.0, f64::from(k % 7), 0.0], [2.0, 0.0, 0.0]) })
        .collect();
    let words = [
        "none of the 3,000 rays",
        "3000 of 3000",
        "the nearest at 2000 where the limit is 100",
        "is the mesh in millimetres (--scale 0.001)? 1287 of 3000 would hit then.",
    ];
    assert_one(found(&cube(2000.0, true), &rays, Sides::Both, false), WarningCode::NoHits, &words);
    // Of more rays some are tried.
    let many: Vec<CastRay> = (0..3).flat_map(|_| rays.clone()).collect();
    let words = ["none of the 9,000 rays", "3000 of 3000"];
    assert_one(found(&cube(2000.0, true), &many, Sides::Both, false), WarningCode::NoHits, &words);
    // Of equally near ones the first is told of.
    let both = [100.0, 50.0].map(|t_max| CastRay { t_max, ..ray([0.0; 3], [1.0, 0.0, 0.0]) });
    let words = ["2 of 2", "the nearest at 2000 where the limit is 100: "];
    assert_one(found(&cube(2000.0, true), &both, Sides::Both, false), WarningCode::NoHits, &words);
    // What lies before t_min counts as well.
    let behind = [CastRay { t_min: 9.0, ..ray([-5.0, 0.1, 0.2], [1.0, 0.0, 0.0]) }];
    assert_one(
        found(&cube(1.0, true), &behind, Sides::Both, false),
        WarningCode::NoHits,
        &["the nearest at 4.00, before the 9.00 from which its hits count (t_min)."],
    );
}

/// A question about a unit or an axis that lets no ray hit would lead nowhere.
#[test]
fn another_unit_or_axis_is_asked_about_only_where_it_lets_rays_hit() {
    // The floor stays as far below if it is made smaller.
    let far = [CastRay { t_max: 1.0, ..ray([5.0, 5.0, 2.0], [0.0, 0.0, -1.0]) }];
    let below = found(&ground(30.0, [0, 1]), &far, Sides::Both, false);
    assert!(below[0].1.ends_with("the nearest at 2.00 where the limit is 1.00."), "{below:?}");
    // With y up, the floor is x and z, and z of its file runs to -y.
    let down = |at: [f64; 3]| [ray(at, [0.0, 0.0, -1.0])];
    let words = ["however far it reaches", "is y up in the mesh's file (--up y)? 1 of 1 would hit then."];
    let y_up = ground(30.0, [2, 0]);
    assert_one(found(&y_up, &down([5.0, -5.0, 2.0]), Sides::Both, false), WarningCode::NoHits, &words);
    let beside = found(&y_up, &down([5.0, 5.0, 2.0]), Sides::Both, false);
    assert!(beside[0].1.ends_with("(5.00, 5.00, 2.00)."), "{beside:?}");
    // Of ten rays one is enough, of eleven it is not.
    let wide = cube(2000.0, true);
    let inside = |reach: f64| CastRay { t_max: reach, ..ray([0.0; 3], [1.0, 0.0, 0.0]) };
    let of = |count: usize| [vec![inside(100.0)], vec![inside(1.0); count - 1]].concat();
    assert!(found(&wide, &of(10), Sides::Both, false)[0].1.ends_with("1 of 10 would hit then."));
    assert!(found(&wide, &of(11), Sides::Both, false)[0].1.ends_with("."), "nothing is asked");
    assert!(!found(&wide, &of(11), Sides::Both, false)[0].1.contains('?'));
}

#[test]
fn rays_beside_the_mesh_are_told_with_both_places() {
    let rays = [ray([0.0, 0.0, 5.0], [1.0, 0.0, 0.0]), ray([2.0, 0.0, 7.0], [1.0, 0.0, 0.0])];
    let words = [
        "however far they reach",
        "(-1.00, -1.00, -1.00) and (1.00, 1.00, 1.00)",
        "(0, 0, 5.00) and (2.00, 0, 7.00)",
    ];
    assert_one(found(&cube(1.0, true), &rays, Sides::Both, false), WarningCode::NoHits, &words);
    let words = ["the ray does not hit the mesh, however far it reaches.", "the ray begins at (0, 0, 5.00)"];
    assert_one(found(&cube(1.0, true), &rays[..1], Sides::Both, false), WarningCode::NoHits, &words);
}

#[test]
fn backs_are_told_whether_they_are_hit_or_passed() {
    let inside = [ray([0.0, 0.1, 0.2], [1.0, 0.0, 0.0]), ray([0.0, 0.1, 0.2], [0.0, 1.0, 0.0])];
    let words = ["100 % of the rays that hit meet the back"];
    assert_one(found(&cube(1.0, true), &inside, Sides::Both, false), WarningCode::BacksFirst, &words);
    let words = ["at a front. 2 of 2 that were tried meet the back"];
    assert_one(found(&cube(1.0, true), &inside, Sides::Fronts, false), WarningCode::NoHits, &words);
    // Half of them are no majority.
    let half = [inside[0], ray([5.0, 0.1, 0.2], [-1.0, 0.0, 0.0])];
    assert_eq!(found(&cube(1.0, true), &half, Sides::Both, false), []);
}

#[test]
fn an_open_mesh_is_told_where_crossings_are_asked_for() {
    let rays = [ray([0.1, 0.2, -5.0], [0.0, 0.0, 1.0])];
    let words = ["4 open edges"];
    assert_one(found(&cube(1.0, false), &rays, Sides::Both, true), WarningCode::OpenMesh, &words);
    // Each square with corners of its own, one at -0: closed all the same.
    let whole = cube(1.0, true);
    let apart: Vec<[f64; 3]> = whole
        .faces()
        .iter()
        .flatten()
        .map(|&corner| whole.vertices()[corner as usize].map(|part| part - 1.0))
        .collect();
    let apart: Vec<[f64; 3]> = apart
        .iter()
        .enumerate()
        .map(|(k, at)| at.map(|part| if part == 0.0 && k % 2 == 0 { -0.0 } else { part }))
        .collect();
    let faces = (0..apart.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let rays = [ray([-0.9, -0.8, -5.0], [0.0, 0.0, 1.0])];
    assert_eq!(found(&Triangles::new(apart, faces).unwrap(), &rays, Sides::Both, true), []);
}

#[test]
fn a_pattern_is_told_of_another_axis_and_another_unit() {
    let of_set = |mesh: &Triangles, rays: Vec<CastRay>| {
        let shape = vec![rays.len() as u64];
        let pattern = PatternRays {
            shape,
            rays,
            times: None,
            weights: None,
            returns: None,
            elevations_deg: None,
            mounting: Mounting::HERE,
        };
        let set = NamedRaySet::new("os1", pattern, Sides::Both).unwrap();
        let answers = cast(mesh, set.set.rays(), Sides::Both, Questions::default(), &Silent);
        let home = MeshHome::default();
        let warnings = cast_warnings((mesh, home), set.set.rays(), Sides::Both, Some(&set), &answers);
        assert!(warnings.iter().all(|warning| warning.sentence.starts_with("os1: ")), "{warnings:?}");
        warnings.into_iter().map(|warning| (warning.code, warning.sentence)).collect::<Vec<_>>()
    };
    let sees = |at: [f64; 3], along: [f64; 3], t_max: f64| vec![CastRay { t_max, ..ray(at, along) }];
    // Its front along +y: z and x span it.
    let y_up = ground(30.0, [2, 0]);
    let words = ["--up y"];
    assert_one(
        of_set(&y_up, sees([5.0, 2.0, 5.0], [0.0, -1.0, 0.0], 100.0)),
        WarningCode::TerrainOnItsSide,
        &words,
    );
    let z_up = ground(30.0, [0, 1]);
    assert_eq!(of_set(&z_up, sees([5.0, 5.0, 2.0], [0.0, 0.0, -1.0], 100.0)), []);
    // Rays of no set have the axes of their file.
    assert_eq!(found(&y_up, &sees([5.0, 2.0, 5.0], [0.0, -1.0, 0.0], 100.0), Sides::Both, false), []);
    let large = ground(30_000.0, [0, 1]);
    let words = ["millimetres", "--scale 0.001"];
    assert_one(
        of_set(&large, sees([5.0, 5.0, 2.0], [0.0, 0.0, -1.0], 100.0)),
        WarningCode::TerrainTooLarge,
        &words,
    );
}

/// Warnings about rays on the terrain of a scene, whose origin is moved in its map.
fn found_in_scene(mesh: &Triangles, rays: &[CastRay], sides: Sides) -> Vec<(WarningCode, String)> {
    let home = MeshHome { is_scene: true, origin: [491_000.0, 5_540_123.0, 212.0] };
    let answers = cast(mesh, rays, sides, Questions::default(), &Silent);
    let warnings = cast_warnings((mesh, home), rays, sides, None, &answers);
    warnings.into_iter().map(|warning| (warning.code, warning.sentence)).collect()
}

#[test]
fn rays_in_coordinates_of_the_map_are_told_where_the_origin_lies() {
    let floor = ground(30.0, [0, 1]);
    let down = |at: [f64; 3]| ray(at, [0.0, 0.0, -1.0]);
    let in_map = [down([491_005.0, 5_540_130.0, 214.0]), down([491_500.0, 5_540_130.0, 214.0])];
    let words = [
        "none of the 2 rays hits the mesh. 1 of 2 that were tried would if they began (491000, 5540123, 212) less",
        "frame of the scene",
    ];
    assert_one(found_in_scene(&floor, &in_map, Sides::Both), WarningCode::RaysInMap, &words);
    // Of a mesh file nothing is subtracted.
    assert_one(found(&floor, &in_map, Sides::Both, false), WarningCode::NoHits, &["however far they reach"]);
    // With the same limits and sides: neither would hit.
    let short = [CastRay { t_max: 1.0, ..in_map[0] }];
    let [(code, sentence)] = found_in_scene(&floor, &short, Sides::Both).try_into().unwrap();
    assert_eq!(code, WarningCode::NoHits, "{sentence}");
    let from_below = [ray([491_005.0, 5_540_130.0, 200.0], [0.0, 0.0, 1.0])];
    let [(code, sentence)] = found_in_scene(&floor, &from_below, Sides::Fronts).try_into().unwrap();
    assert_eq!(code, WarningCode::NoHits, "{sentence}");
    // What the remedy says of a scene are the keys of its file.
    let ahead = [CastRay { t_max: 100.0, ..ray([0.0; 3], [1.0, 0.0, 0.0]) }];
    let words = ["is the mesh in millimetres (--set terrain.scale=0.001)? 1 of 1 would hit then."];
    assert_one(found_in_scene(&cube(2000.0, true), &ahead, Sides::Both), WarningCode::NoHits, &words);
}
