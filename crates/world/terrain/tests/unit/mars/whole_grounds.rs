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
    MarsGround { extent: 12.0, post_spacing: 0.2, fine_radius: 1.0, crevasses, ..mars }
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
                assert_eq!(body.len(), rock_bodies::tests::faces(diameter));
                assert_closed_and_outward(&ground, body);
            }
            let mesh = ground.into_mesh().unwrap();
            assert_eq!(mesh.zero_area_faces(), 0, "{name}");
            assert!(height_at(&mesh, 0.0, 0.0).is_some(), "{name}");
        }
    }
    assert_eq!(MarsGround::preset("viking2", 0), None);
}

#[test]
fn no_rock_hangs_over_a_crevasse() {
    let mut rocks = 0;
    for seed in 0..6 {
        let plain = small("crevassed", seed);
        let mars = MarsGround { rocks: Rocks { coverage: 0.3, ..plain.rocks }, ..plain };
        let ground = mars.build().unwrap();
        let crevasses = mars.crevasses.draw(&mars.field(), mars.seed);
        for body in rocks_of(&ground) {
            let corners: Vec<DVec2> = ground.faces[body]
                .as_flattened()
                .iter()
                .map(|&v| ground.vertices[v as usize].truncate())
                .collect();
            let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
            assert!(!crevasses.iter().any(|one| one.overlaps_disc(middle, 0.0)), "a rock at {middle}");
            rocks += 1;
        }
    }
    assert!(rocks > 500, "{rocks}");
}

#[test]
fn floors_lie_below_the_lower_edge_by_the_depth() {
    // Soil that rises by 0.3 along x: one edge of a crevasse is higher than the other.
    let plain = small("crevassed", 2);
    let coarse = HeightGrid {
        columns: 4,
        rows: 4,
        corner: DVec2::splat(-6.0),
        spacing: DVec2::splat(4.0),
        heights: (0..16).map(|k| 1.2 * f64::from(k % 4)).collect(),
    };
    let mars = MarsGround {
        coarse: Some(coarse),
        roughness: Roughness { rms_at_1_m: 0.0, ..plain.roughness.clone() },
        rocks: Rocks { coverage: 0.0, ..plain.rocks },
        craters: Craters { density: 0.0, ..plain.craters },
        ..plain
    };
    let (ground, relief) = (mars.build().unwrap(), mars.relief());
    let (mut floors, mut aslant) = (0, 0);
    for crevasse in mars.crevasses.draw(&mars.field(), mars.seed) {
        for node in 1..crevasse.last() {
            let [right, left] =
                [-1.0, 1.0].map(|side| relief.height(relief.middle + crevasse.wall(node, side, 0.0)));
            aslant += u32::from((right - left).abs() > 0.05);
            let place = relief.middle + crevasse.wall(node, -1.0, 1.0);
            let floor = ground.vertices.iter().find(|v| v.truncate().distance(place) < 1e-9);
            let floor = floor.expect("the floor has a vertex there").z;
            assert!((right.min(left) - floor - crevasse.depth(node)).abs() < 1e-9, "node {node}");
            floors += 1;
        }
    }
    assert!(floors > 50 && aslant > 20, "{floors} floors, {aslant} with edges of different heights");
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

/// Checks that the sheet is closed but for its outer border, that all faces have one orientation, and that soil looks up.
fn assert_one_sheet(ground: &Ground, half: DVec2, what: &str) {
    let edges = edges(ground);
    assert!(edges.values().all(|uses| uses[0] <= 1 && uses[1] <= 1), "{what}: an edge of three faces");
    let mut border = 0.0;
    for (edge, _) in edges.iter().filter(|(_, uses)| **uses != [1, 1]) {
        let [a, b] = edge.map(|v| ground.vertices[v as usize].truncate());
        let on = |p: DVec2| (p.abs() - half).abs().cmplt(DVec2::splat(1e-9));
        assert!((on(a) & on(b)).any(), "{what}: an open edge from {a} to {b}");
        border += a.distance(b);
    }
    assert!((border - 4.0 * (half.x + half.y)).abs() < 1e-6, "{what}: {border} m of border");
    let sheet = first_rock_face(ground);
    for (face, &kind) in ground.faces[..sheet].iter().zip(&ground.face_materials) {
        assert!(kind == WALL_MATERIAL || normal(ground, *face).z > 0.0, "{what}: {face:?}");
    }
    // Soil and floors cover the ground once: walls that stand or recede add nothing, seen from above.
    let area: f64 = ground.faces[..sheet].iter().map(|face| 0.5 * normal(ground, *face).z).sum();
    assert!((area / (4.0 * half.x * half.y) - 1.0).abs() < 1e-9, "{what}: {area} square metres");
}

#[test]
fn the_sheet_has_no_gap_and_no_fold_however_it_is_cut() {
    for name in ["smooth", "crevassed", "worst"] {
        for seed in 0..8 {
            for fine_radius in [0.0, 1.0, 2.0, 9.0] {
                let mars = MarsGround { fine_radius, ..small(name, seed) };
                let ground = mars.build().unwrap();
                let walls = ground.face_materials.iter().filter(|kind| **kind == WALL_MATERIAL).count();
                assert_eq!(walls > 500, mars.crevasses.count > 0, "{name}: {walls} faces of walls");
                assert_one_sheet(
                    &ground,
                    DVec2::splat(6.0),
                    &format!("{name}, seed {seed}, fine {fine_radius} m"),
                );
                // Every vertex is used.
                let mut used = vec![false; ground.vertices.len()];
                ground.faces.as_flattened().iter().for_each(|&v| used[v as usize] = true);
                assert!(used.iter().all(|used| *used));
            }
        }
    }
}

#[test]
fn a_crevasse_finer_than_the_posts_is_cut_all_the_same() {
    // Cracks of 4 cm between posts of 1 m, and on posts of two spacings.
    for seed in 0..10 {
        let plain = small("crevassed", seed);
        let crevasses = Crevasses { width: 0.04, ..plain.crevasses };
        let rocks = Rocks { coverage: 0.0, ..plain.rocks };
        let mars = MarsGround { post_spacing: 1.0, crevasses, rocks, ..plain.clone() };
        let ground = mars.build().unwrap();
        assert!(ground.face_materials.contains(&WALL_MATERIAL));
        assert_one_sheet(&ground, DVec2::splat(6.0), &format!("seed {seed}"));
        let coarse = HeightGrid {
            columns: 5,
            rows: 9,
            corner: DVec2::new(1e5 - 8.0, 2e5 - 8.0),
            spacing: DVec2::new(4.0, 2.0),
            heights: (0..45).map(|k| f64::from(k * 7 % 5) * 0.1).collect(),
        };
        let mars = MarsGround { coarse: Some(coarse), post_spacing: 0.5, ..mars };
        let mut ground = mars.build().unwrap();
        ground.vertices.iter_mut().for_each(|v| *v -= DVec3::new(1e5, 2e5, 0.0));
        assert_one_sheet(&ground, DVec2::splat(8.0), &format!("coarse, seed {seed}"));
    }
}

#[test]
fn near_the_middle_no_face_of_soil_is_large_or_stands_out() {
    // Within 3.5 m the posts are 2.5 cm apart: no side of a face is longer than a diagonal of about 3.6 cm in plan.
    // Neighbours differ by less than on posts of 10 cm: the median angle between them is under half of that there.
    let angles = |fine_radius: f64| {
        let plain = MarsGround::preset("viking1", 5).unwrap();
        let rocks = Rocks { coverage: 0.0, ..plain.rocks };
        let ground = MarsGround { extent: 10.0, fine_radius, rocks, ..plain }.build().unwrap();
        let near =
            |face: &[u32; 3]| face.iter().all(|&v| ground.vertices[v as usize].truncate().length() < 3.5);
        let mut longest: f64 = 0.0;
        let mut normals: BTreeMap<[u32; 2], Vec<DVec3>> = BTreeMap::new();
        for face in ground.faces.iter().filter(|face| near(face)) {
            for [p, q] in [[0, 1], [1, 2], [2, 0]].map(|pair| pair.map(|k: usize| face[k])) {
                let [a, b] = [p, q].map(|v| ground.vertices[v as usize].truncate());
                longest = longest.max(a.distance(b));
                let normal = normal(&ground, *face).normalize();
                normals.entry([p.min(q), p.max(q)]).or_default().push(normal);
            }
        }
        let pairs = normals.values().filter(|pair| pair.len() == 2);
        let mut angles: Vec<f64> =
            pairs.map(|pair| libm::acos(pair[0].dot(pair[1]).min(1.0)).to_degrees()).collect();
        angles.sort_unstable_by(f64::total_cmp);
        (longest, angles[angles.len() / 2])
    };
    let ((longest, fine), (coarse_longest, coarse)) = (angles(4.0), angles(0.0));
    println!("median angle between neighbouring faces: {fine} degrees, without fine posts {coarse}");
    assert!(longest < 0.036 && coarse_longest > 0.14, "{longest} m and {coarse_longest} m");
    assert!(fine < 0.5 * coarse, "{fine} and {coarse} degrees");
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
    let mars = MarsGround {
        coarse: Some(coarse.clone()),
        post_spacing: 0.3,
        fine_radius: 0.0,
        ..small("smooth", 6)
    };
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
    // On level ground, the first crater that lies well inside, in seeds where it is alone.
    let mut measured = 0;
    for seed in 0..400 {
        let plain = small("smooth", seed);
        let mars = MarsGround {
            extent: 30.0,
            post_spacing: 0.1,
            fine_radius: 0.0,
            roughness: Roughness { rms_at_1_m: 0.0, ..plain.roughness.clone() },
            craters: Craters { density: 0.02, smallest: 6.0, largest: 8.0 },
            rocks: Rocks { coverage: 0.0, ..plain.rocks },
            ..plain
        };
        let craters = mars.crater_list();
        let inside = |crater: &&Crater| crater.centre.abs().max_element() < 15.0 - crater.diameter;
        let Some(crater) = craters.iter().find(inside) else { continue };
        let reach = |other: &Crater| 1.5 * (crater.diameter + other.diameter);
        let near = |other: &&Crater| other.centre.distance(crater.centre) < reach(other);
        if craters.iter().filter(near).count() > 1 {
            continue;
        }
        let ground = mars.build().unwrap();
        let (mut floor, mut rim) = (f64::INFINITY, f64::NEG_INFINITY);
        for post in &ground.vertices {
            let distance = post.truncate().distance(crater.centre);
            if distance <= 1.4 * crater.diameter {
                floor = floor.min(post.z);
                rim = rim.max(post.z);
            } else {
                assert!(post.z.abs() < 0.03 * crater.diameter || craters.len() > 1);
            }
        }
        // The crest is up to 0.25 (1/2 + ... + 1/6) = 36 % higher than its mean. Posts lie within 0.07 m of the centre and
        // of any point of the crest: there the bowl, with a slope of at most 0.8, is at most 0.06 m lower than the
        // crest, and 0.2 D (2 * 0.07 / D)^2 < 1e-3 m higher than its lowest point.
        let mean = crater.rim_height();
        assert!((mean - 0.06..1.37 * mean).contains(&rim), "{rim} for {mean}");
        let depth = mean - floor;
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
    assert_eq!(format!("{digest:016x}"), "0f761cdae7d239d8");
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
        MarsGround { coarse: Some(coarse), post_spacing: 4.0 / 2048.0, fine_radius: 0.0, rocks, ..mars }
            .check_size()
    };
    for [columns, rows] in [[2, 4], [4, 2], [2, 5], [5, 2], [3, 3]] {
        assert!(size(columns, rows).is_ok(), "{columns} x {rows}");
    }
    for [columns, rows] in [[2, 6], [6, 2], [4, 3], [3, 4]] {
        assert_eq!(size(columns, rows).unwrap_err().field, "post_spacing_m", "{columns} x {rows}");
    }
}

#[test]
fn sizes_are_those_of_the_real_side_and_are_asked_before_the_work() {
    // Two cells of 360 m, on which the smallest rocks would have more faces than a file may.
    let long = MarsGround {
        extent: 720.0,
        post_spacing: 360.0,
        rocks: Rocks { coverage: 0.3, smallest: 0.02, largest: 2.0 },
        ..small("viking1", 3)
    };
    assert_eq!(long.extents(), DVec2::splat(720.0));
    let error = long.validate().unwrap_err();
    assert_eq!(error.field, "rock_smallest_m", "{error}");
    // On a side of 4 m they fit; but two cells of 360 m are no side of 4 m.
    MarsGround { extent: 4.0, post_spacing: 0.5, ..long.clone() }.validate().unwrap();
    let error = MarsGround { extent: 4.0, ..long.clone() }.validate().unwrap_err();
    assert_eq!(error.field, "extent_m", "{error}");
    // The largest spacing of all, and craters.
    let long = MarsGround { extent: 2e4, ..long };
    let error = MarsGround { post_spacing: 1e4, ..long.clone() }.validate().unwrap_err();
    assert_eq!(error.field, "rock_smallest_m", "{error}");
    let rocks = Rocks { coverage: 0.0, ..long.rocks };
    let craters = Craters { density: 0.5, smallest: 0.1, largest: 1.0 };
    let error = MarsGround { post_spacing: 1e4, rocks, craters, ..long }.validate().unwrap_err();
    assert_eq!(error.field, "crater_smallest_m", "{error}");
}

#[test]
fn a_coverage_by_rocks_that_has_no_law_is_refused() {
    let ground = |coverage: f64, smallest: f64| {
        let rocks = Rocks { coverage, smallest, largest: 1.0 };
        MarsGround { rocks, ..small("smooth", 3) }
    };
    // q = 1.79 + 0.152 / k is infinite below k = 8.5e-310, and with one size of rocks their number was infinity times 0.
    for smallest in [0.1, 1.0] {
        for coverage in [5e-324, 8e-310] {
            let error = ground(coverage, smallest).validate().unwrap_err();
            assert_eq!(error.field, "rock_coverage", "{error}");
        }
        // Just above it the law is whole: rocks of infinitely thin a share, so none.
        let thin = ground(1e-300, smallest);
        thin.validate().unwrap();
        assert_eq!(thin.rock_diameters(), Vec::<f64>::new());
        ground(0.0, smallest).validate().unwrap();
    }
}

#[test]
fn a_side_may_grow_a_little_to_whole_spacings() {
    // 100.1 spacings make 101; 3 (4.1 / 3) are 4.1 m whatever the rounding of the quotient.
    for (extent, post_spacing) in [(10.01, 0.1), (4.1, 4.1 / 3.0), (4.1, 4.1 / 7.0), (2.0, 1.0)] {
        let ground = MarsGround { extent, post_spacing, fine_radius: 0.0, ..small("smooth", 1) };
        ground.validate().expect("a ground");
    }
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let base = || small("worst", 1);
    let refused = |mars: MarsGround| mars.build().unwrap_err().to_string();
    let cases = [
        (refused(MarsGround { extent: f64::NAN, ..base() }), "extent_m"),
        (refused(MarsGround { extent: 1e5, post_spacing: 0.01, ..base() }), "post_spacing_m"),
        // Whole spacings would make it 12, 60 and 200 m long; and one spacing is no ground.
        (refused(MarsGround { extent: 10.0, post_spacing: 4.0, ..base() }), "extent_m"),
        (refused(MarsGround { extent: 40.0, post_spacing: 30.0, ..base() }), "extent_m"),
        (refused(MarsGround { extent: 40.0, post_spacing: 100.0, ..base() }), "extent_m"),
        (refused(MarsGround { extent: 40.0, post_spacing: 40.0, ..base() }), "extent_m"),
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
            "crevasses is 50: expected at most",
        ),
        (
            refused(MarsGround { fine_radius: 100.0, extent: 400.0, ..base() }),
            "fine_radius_m is 100 m: up to",
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
        (far, fine_radius) in (-1e6..1e6, 0.0..4.0),
    ) {
        let base = MarsGround::preset("worst", seed).unwrap();
        let mars = MarsGround {
            extent,
            post_spacing: spacing,
            roughness: Roughness { hurst, rms_at_1_m: roughness, octave_gains: Vec::new() },
            rocks: Rocks { coverage, smallest: 0.1, largest: 2.0 },
            craters: Craters { density, smallest: 1.0, largest: 6.0 },
            crevasses: Crevasses { count, width, depth: 1.0, overhang },
            fine_radius,
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
        let mut near = ground.clone();
        near.vertices.iter_mut().for_each(|v| *v -= mars.offset);
        assert_one_sheet(&near, 0.5 * mars.extents(), "about the middle");
        let mesh = ground.into_mesh();
        prop_assert!(mesh.is_ok(), "{:?}", mesh.err());
        prop_assert!(height_at(&mesh.unwrap(), far, -far).is_some());
    }
}
