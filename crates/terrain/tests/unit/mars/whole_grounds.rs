//! Whole grounds against their laws: the content of the mesh, not of the lists it is made from.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::ground::tests::{assert_closed_and_outward, normal};
use crate::height_at;

/// Ground of a preset, small enough for many of them.
fn small(name: &str, seed: u64) -> MarsGround {
    let mars = MarsGround::preset(name, seed).expect("a preset");
    // Four crevasses do not fit on 12 m.
    let crevasses = Crevasses { count: mars.crevasses.count.min(2), ..mars.crevasses };
    MarsGround { extent: 12.0, post_spacing: 0.2, crevasses, ..mars }
}

#[test]
fn heights_between_posts_are_bilinear() {
    // Posts 2 m apart along x and 4 m along y, with the heights 0 and 1 in the near row, 10 and 21 in the far one. A
    // quarter of the way along x the rows are at 1/4 and 10 + 11/4; half way between these it is 13/2.
    let posts = HeightGrid {
        columns: 2,
        rows: 2,
        corner: DVec2::new(10.0, 20.0),
        spacing: DVec2::new(2.0, 4.0),
        heights: vec![0.0, 1.0, 10.0, 21.0],
    };
    assert_eq!(sheet::height(&posts, DVec2::new(10.5, 22.0)), 6.5);
    // Outside, the height at the nearest border: 1 at the near right post.
    assert_eq!(sheet::height(&posts, DVec2::new(99.0, -99.0)), 1.0);
}

/// First face that is not of the sheet: rocks come last.
fn first_rock_face(ground: &Ground) -> usize {
    ground.face_materials.iter().position(|&kind| kind == ROCK_MATERIAL).unwrap_or(ground.faces.len())
}

/// Closed bodies of the rocks, as ranges of faces.
fn rocks_of(ground: &Ground) -> Vec<std::ops::Range<usize>> {
    // The faces of each body use its own vertices alone, all later than those of the body before.
    let first = first_rock_face(ground);
    let mut bodies: Vec<std::ops::Range<usize>> = Vec::new();
    let mut highest = 0;
    for (face, corners) in ground.faces.iter().enumerate().skip(first) {
        let new = bodies.is_empty() || *corners.iter().min().unwrap() > highest;
        match bodies.last_mut() {
            Some(body) if !new => body.end = face + 1,
            _ => bodies.push(face..face + 1),
        }
        highest = highest.max(*corners.iter().max().unwrap());
    }
    bodies
}

#[test]
fn every_preset_is_a_mesh_whose_rocks_are_closed_and_outward() {
    for &name in PRESET_NAMES {
        for seed in 0..3 {
            let mars = small(name, seed);
            let ground = mars.build().unwrap();
            let bodies = rocks_of(&ground);
            let promised = mars.rocks.diameters(144.0, seed);
            assert_eq!(bodies.len(), promised.len(), "{name}");
            for (body, diameter) in bodies.into_iter().zip(promised) {
                assert_eq!(body.len(), rocks::tests::faces(diameter));
                assert_closed_and_outward(&ground, body);
            }
            let mesh = ground.into_mesh().unwrap();
            assert_eq!(mesh.zero_area_faces(), 0, "{name}");
            assert!(height_at(&mesh, 0.0, 0.0).is_some(), "{name}");
        }
    }
    assert_eq!(MarsGround::preset("viking2", 0), None);
}

/// Number of faces along each edge of the sheet, in either direction.
fn edges(ground: &Ground) -> BTreeMap<[u32; 2], [u32; 2]> {
    let mut edges: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for &[a, b, c] in &ground.faces[..first_rock_face(ground)] {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            edges.entry([p.min(q), p.max(q)]).or_default()[usize::from(p > q)] += 1;
        }
    }
    edges
}

#[test]
fn the_sheet_has_no_gap_and_no_fold_however_it_is_cut() {
    for name in ["smooth", "crevassed", "worst"] {
        for seed in 0..4 {
            let mars = small(name, seed);
            let ground = mars.build().unwrap();
            let cells = mars.cells();
            // The sheet is closed but for its outer border of four times `cells` edges, and all faces have the
            // same orientation.
            let border = edges(&ground).values().filter(|uses| **uses != [1, 1]).count();
            assert_eq!(border, 4 * cells as usize, "{name}, seed {seed}");
            assert!(edges(&ground).values().all(|uses| uses[0] <= 1 && uses[1] <= 1));
            // Soil faces look up everywhere.
            let sheet = first_rock_face(&ground);
            for (face, &kind) in ground.faces[..sheet].iter().zip(&ground.face_materials) {
                assert!(
                    kind == WALL_MATERIAL || normal(&ground, *face).z > 0.0,
                    "{name}, seed {seed}: {face:?}"
                );
            }
        }
    }
}

#[test]
fn walls_are_walls_and_overhang_only_if_asked_to() {
    let mars = |overhang| {
        let plain = small("crevassed", 3);
        let rocks = Rocks { coverage: 0.0, ..plain.rocks };
        let crevasses = Crevasses { overhang, ..plain.crevasses };
        MarsGround { rocks, crevasses, ..plain }.build().unwrap()
    };
    let walls = |ground: &Ground| -> Vec<DVec3> {
        let faces = ground.faces.iter().zip(&ground.face_materials);
        faces
            .filter(|(_, kind)| **kind == WALL_MATERIAL)
            .map(|(face, _)| normal(ground, *face).normalize())
            .collect()
    };
    let [plain, under] = [0.0, 0.2].map(|overhang| walls(&mars(overhang)));
    assert!(plain.len() > 500);
    // Without an overhang hardly any wall looks down (edges are ragged), and half of all are steeper than 70
    // degrees: |cos| < 0.342.
    let share = |normals: &[DVec3], holds: &dyn Fn(f64) -> bool| {
        normals.iter().filter(|n| holds(n.z)).count() as f64 / normals.len() as f64
    };
    assert!(share(&plain, &|z| z.abs() < 0.342) > 0.5);
    assert!(share(&plain, &|z| z < -0.1) < 0.05);
    assert!(share(&under, &|z| z < -0.1) > 0.15);
    // The depth is at most 1.2 m, and at least 0.7 of that in the middle.
    let ground = mars(0.0);
    let lowest = ground.vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
    let flat = MarsGround {
        crevasses: Crevasses { count: 0, ..small("crevassed", 3).crevasses },
        ..small("crevassed", 3)
    };
    let relief = flat.build().unwrap();
    let least = relief.vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
    assert!(lowest < least - 0.3, "{lowest} against {least}");
}

#[test]
fn coarse_posts_are_vertices_of_the_ground() {
    // 7 x 5 posts, 4 m apart, at map coordinates of a million metres.
    let heights = (0..35).map(|k| f64::from(k * k % 13) * 0.37 - 2.0).collect();
    let coarse = HeightGrid {
        columns: 7,
        rows: 5,
        corner: DVec2::new(1e6 + 0.25, -2e6),
        spacing: DVec2::new(4.0, 4.0),
        heights,
    };
    let mars = MarsGround { coarse: Some(coarse.clone()), post_spacing: 0.3, ..small("smooth", 6) };
    let mars = MarsGround { rocks: Rocks { coverage: 0.0, ..mars.rocks }, ..mars };
    let ground = mars.build().unwrap();
    // 4 m halved four times is 0.25 m.
    assert_eq!(ground.vertices.len(), (6 * 16 + 1) * (4 * 16 + 1));
    for row in 0..5 {
        for column in 0..7 {
            let post = coarse.at(column, row);
            let vertex = ground.vertices[(row * 16 * 97 + column * 16) as usize];
            assert!((vertex - post).abs().max_element() <= 1e-9, "{vertex} for {post}");
        }
    }
}

#[test]
fn a_crater_of_the_ground_has_its_depth_and_rim() {
    // The same ground with and without craters: the difference at the posts of the first crater that lies well
    // inside. Other craters may overlap it, so only seeds in which it is alone are measured.
    let mut measured = 0;
    for seed in 0..400 {
        let mars = MarsGround {
            extent: 30.0,
            post_spacing: 0.1,
            craters: Craters { density: 0.02, smallest: 6.0, largest: 8.0 },
            ..small("smooth", seed)
        };
        let mars = MarsGround { rocks: Rocks { coverage: 0.0, ..mars.rocks }, ..mars };
        let craters = mars.craters.draw(DVec2::ZERO, 30.0, seed);
        let inside = |crater: &&Crater| crater.centre.abs().max_element() < 15.0 - crater.diameter;
        let Some(crater) = craters.iter().find(inside) else { continue };
        let reach = |other: &Crater| 1.5 * (crater.diameter + other.diameter);
        let near = |other: &&Crater| other.centre.distance(crater.centre) < reach(other);
        if craters.iter().filter(near).count() > 1 {
            continue;
        }
        let without = MarsGround { craters: Craters { density: 0.0, ..mars.craters }, ..mars.clone() };
        let (with, without) = (mars.build().unwrap(), without.build().unwrap());
        let (mut floor, mut rim) = (f64::INFINITY, f64::NEG_INFINITY);
        for (a, b) in with.vertices.iter().zip(&without.vertices) {
            let distance = a.truncate().distance(crater.centre);
            if distance <= 1.5 * crater.diameter {
                floor = floor.min(a.z - b.z);
                rim = rim.max(a.z - b.z);
            } else {
                assert!((a.z - b.z).abs() < 1e-12 || craters.len() > 1);
            }
        }
        // Posts lie within 0.07 m of the centre and of any point of the crest. There the bowl, with a slope of at
        // most 0.8, is at most 0.06 m lower than the crest, and 0.2 D (2 * 0.07 / D)^2 < 1e-3 m higher than its
        // lowest point.
        assert!(
            (0.0..0.06).contains(&(crater.rim_height() - rim + 1e-9)),
            "{rim} for {}",
            crater.rim_height()
        );
        let depth = crater.rim_height() - floor;
        assert!((depth - crater.depth()).abs() < 2e-3, "{depth} for {}", crater.depth());
        measured += 1;
    }
    assert!(measured >= 5, "only {measured} lone craters");
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
    for &name in PRESET_NAMES {
        assert_eq!(small(name, 1).build(), small(name, 1).build());
        assert_ne!(small(name, 1).build().unwrap().vertices, small(name, 2).build().unwrap().vertices);
    }
}

#[test]
fn the_bytes_are_these() {
    // A digest (FNV-1a, 64 bits) of all coordinates: it changes if a seed changes its meaning.
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for &name in PRESET_NAMES {
        let ground = small(name, 2024).build().unwrap();
        for byte in ground.vertices.iter().flat_map(|v| v.to_array()).flat_map(f64::to_le_bytes) {
            digest = (digest ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    assert_eq!(format!("{digest:016x}"), "c21aadf62f8f191a");
}

#[test]
fn a_finer_coarse_model_has_a_limit_of_faces() {
    // Eleven halvings, from 4 m to 1/512 m: each cell of the model has 2^22 cells and 2^23 faces. The limit is 2^25.
    let size = |columns: u32, rows: u32| {
        let coarse = HeightGrid {
            columns,
            rows,
            corner: DVec2::ZERO,
            spacing: DVec2::splat(4.0),
            heights: vec![0.0; columns as usize * rows as usize],
        };
        let mars = small("smooth", 6);
        let rocks = Rocks { coverage: 0.0, ..mars.rocks };
        MarsGround { coarse: Some(coarse), post_spacing: 4.0 / 2048.0, rocks, ..mars }.check_size()
    };
    for [columns, rows] in [[2, 4], [4, 2], [2, 5], [5, 2], [3, 3]] {
        assert!(size(columns, rows).is_ok(), "{columns} x {rows}");
    }
    for [columns, rows] in [[2, 6], [6, 2], [4, 3], [3, 4]] {
        assert_eq!(size(columns, rows).unwrap_err().field, "post_spacing_m", "{columns} x {rows}");
    }
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let base = || small("worst", 1);
    let refused = |mars: MarsGround| mars.build().unwrap_err().to_string();
    let cases = [
        (refused(MarsGround { extent: f64::NAN, ..base() }), "extent_m"),
        (refused(MarsGround { extent: 1e5, post_spacing: 0.01, ..base() }), "post_spacing_m"),
        (
            refused(MarsGround {
                rocks: Rocks { smallest: 1e-3, coverage: 0.4, largest: 1.0 },
                extent: 1e3,
                post_spacing: 1.0,
                ..base()
            }),
            "rock_smallest_m",
        ),
        (refused(MarsGround { rocks: Rocks { largest: 0.01, ..base().rocks }, ..base() }), "rock_largest_m"),
        (
            refused(MarsGround {
                craters: Craters { smallest: 0.01, ..base().craters },
                rocks: Rocks { coverage: 0.0, ..base().rocks },
                extent: 1e3,
                post_spacing: 1.0,
                ..base()
            }),
            "crater_smallest_m",
        ),
        (
            refused(MarsGround { crevasses: Crevasses { count: 50, ..base().crevasses }, ..base() }),
            "crevasse_width_m",
        ),
        (
            refused(MarsGround { crevasses: Crevasses { count: u32::MAX, ..base().crevasses }, ..base() }),
            "crevasses",
        ),
        (
            refused(MarsGround {
                roughness: Roughness { octave_gains: vec![f64::INFINITY], ..base().roughness },
                ..base()
            }),
            "octave_gains",
        ),
    ];
    for (message, word) in cases {
        assert!(message.contains(word), "{message} does not name {word}");
    }
    let hole = HeightGrid {
        columns: 2,
        rows: 2,
        corner: DVec2::ZERO,
        spacing: DVec2::ONE,
        heights: vec![0.0, 1.0, f64::NAN, 0.0],
    };
    let message = refused(MarsGround { coarse: Some(hole), ..base() });
    assert!(message.contains("post (0, 1)"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..Default::default() })]

    #[test]
    fn grounds_of_any_numbers_are_meshes(
        seed: u64,
        extent in 2.0..20.0,
        spacing in 0.2..2.0,
        hurst in 0.1..0.95,
        roughness in 0.0..0.5,
        coverage in 0.0..0.4,
        density in 0.0..0.1,
        (count, width, overhang) in (0_u32..4, 0.05..0.3, 0.0..0.3),
        far in -1e6..1e6,
    ) {
        let base = MarsGround::preset("worst", seed).unwrap();
        let mars = MarsGround {
            extent,
            post_spacing: spacing,
            roughness: Roughness { hurst, rms_at_1_m: roughness, octave_gains: Vec::new() },
            rocks: Rocks { coverage, smallest: 0.1, largest: 2.0 },
            craters: Craters { density, smallest: 1.0, largest: 6.0 },
            crevasses: Crevasses { count, width, depth: 1.0, overhang },
            offset: DVec3::new(far, -far, 0.5 * far),
            ..base
        };
        if mars.check_size().is_err() {
            return Ok(());
        }
        let ground = mars.build().unwrap();
        for body in rocks_of(&ground) {
            assert_closed_and_outward(&ground, body);
        }
        let mesh = ground.into_mesh();
        prop_assert!(mesh.is_ok(), "{:?}", mesh.err());
        prop_assert!(height_at(&mesh.unwrap(), far, -far).is_some());
    }
}
