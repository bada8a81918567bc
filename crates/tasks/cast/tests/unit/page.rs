use raypencil_scene::pattern::{EchoLight, Mounting};
use raypencil_scene::{RaySet, Reading, Sides};

use super::*;

fn layout(shape: &[u64]) -> Layout {
    Layout::of(shape, &[], None)
}

#[test]
fn an_array_has_its_own_rows_and_a_list_is_wrapped() {
    let of_array = layout(&[2, 3]);
    assert_eq!((of_array.width, of_array.height), (3, 2));
    assert_eq!(of_array.rays, (0..6).map(Some).collect::<Vec<_>>());
    let of_more = layout(&[2, 3, 4]);
    assert_eq!((of_more.width, of_more.height, of_more.rays.len()), (12, 2, 24));
    // Seven rays: rows of three, and two cells without a ray.
    let of_list = layout(&[7]);
    assert_eq!((of_list.width, of_list.height), (3, 3));
    assert_eq!(of_list.rays[6..], [Some(6), None, None]);
    let of_one = layout(&[]);
    assert_eq!((of_one.width, of_one.height, of_one.rays), (1, 1, vec![Some(0)]));
}

#[test]
fn a_head_has_a_row_for_each_channel_with_the_highest_on_top() {
    // Two firings of three channels; the second channel looks highest, the first lowest.
    let ray = CastRay::new(glam::DVec3::ZERO, glam::DVec3::X);
    let set = NamedRaySet {
        name: "head".into(),
        shape: vec![2, 3],
        set: RaySet::new(vec![ray; 6], Sides::Both).unwrap(),
        times: None,
        weights: None,
        returns: None,
        elevations_deg: Some(vec![-15.0, 15.0, 0.0]),
        mounting: Mounting::HERE,
        echo: EchoLight::default(),
    };
    let found = Layout::of(&set.shape, set.set.rays(), Some(&PageScan::of(&set)));
    assert_eq!((found.width, found.height), (2, 3));
    assert_eq!(found.rays, [1, 4, 2, 5, 0, 3].map(Some));
}

#[test]
fn a_head_has_its_angles_beside_it() {
    // A quarter of a turn to the right at each firing, over the whole turn and on.
    let elevations = [-10.0_f64, 5.0];
    let ray = |firing: usize, elevation: f64| {
        let (azimuth, elevation) = ((120.0 - 90.0 * firing as f64).to_radians(), elevation.to_radians());
        let level = libm::cos(elevation);
        let direction = [level * libm::cos(azimuth), level * libm::sin(azimuth), libm::sin(elevation)];
        CastRay::new(glam::DVec3::ZERO, direction.into())
    };
    let rays: Vec<CastRay> =
        (0..6).flat_map(|firing| elevations.map(|elevation| ray(firing, elevation))).collect();
    let mounting = Mounting::HERE;
    let scan = PageScan { name: "head", times: None, elevations_deg: Some(&elevations), mounting: &mounting };
    let axes = Layout::of(&[6, 2], &rays, Some(&scan)).axes.expect("a head has axes");
    assert_eq!(axes.rows.at, [5.0, -10.0]);
    let expected = [120.0, 30.0, -60.0, -150.0, -240.0, -330.0];
    assert!(axes.columns.at.iter().zip(expected).all(|(at, expected)| (at - expected).abs() < 1e-9));
    assert_eq!(scan.rings(), Some(vec![0, 1]));
}

#[test]
fn rays_without_room_are_joined_and_the_worst_stays() {
    let mounting = Mounting::HERE;
    let elevations = [-10.0, 5.0];
    let ray = CastRay::new(glam::DVec3::ZERO, glam::DVec3::X);
    let scan = PageScan { name: "head", times: None, elevations_deg: Some(&elevations), mounting: &mounting };
    let head = || Layout::of(&[10, 2], &[ray; 20], Some(&scan));
    assert_eq!(head().thinned(20, |_| 0).width, 10);
    // Ray 15 is the second channel's eighth firing.
    let found = head().thinned(8, |ray| u8::from(ray == 15));
    assert_eq!((found.width, found.height), (4, 2));
    // Of three firings the middle one; the last cell has one firing alone.
    assert_eq!(found.rays, [3, 9, 15, 19, 2, 8, 14, 18].map(Some));
    assert_eq!(found.axes.expect("axes").columns.at.len(), 4);
    assert!(
        found
            .words
            .ends_with("Each cell stands for 3 x 1 rays: the one that is worst, or that in their middle.")
    );
    // A raster is joined in both directions.
    let raster = layout(&[100, 100]).thinned(100, |_| 0);
    assert_eq!((raster.width, raster.height, raster.rays.len()), (10, 10, 100));
    assert_eq!(raster.rays[0], Some(505));
}

#[test]
fn what_finds_no_room_is_named() {
    // 450,000 rays on one side: eight channels of thirteen.
    let rays = vec![CastRay::new(glam::DVec3::ZERO, glam::DVec3::X); 450_000];
    let answers = Answers {
        first: vec![Reading::Miss; rays.len()],
        any: None,
        all: None,
        margins: None,
        decided: None,
    };
    let page = CastPage {
        title: "many",
        facts: &[],
        shape: &[450, 1000],
        rays: &rays,
        answers: &answers,
        mesh: None,
        set: None,
        scan: None,
        has_arrays: true,
        compared: None,
    };
    let (group, words) = page.group(&page.layout());
    let names: Vec<&str> = group.channels.iter().map(|(name, _, _)| name.as_str()).collect();
    assert_eq!(names, ["range.T", "face.I", "ray", "P.X", "P.Y", "P.Z", "incidence.V", "side"]);
    assert_eq!(words, "Not among the maps for want of room: faces at this t, t, N.X, N.Y, N.Z.");
}

/// The numbers of both sides of a channel.
fn of_sides(channel: &RasterChannel) -> Vec<Option<Vec<f64>>> {
    match channel {
        RasterChannel::Reals(sides) => {
            let side = |cells: &Vec<f32>| cells.iter().map(|cell| f64::from(*cell)).collect();
            sides.iter().map(|cells| cells.as_ref().map(side)).collect()
        }
        RasterChannel::Wholes(sides) => {
            let side = |cells: &Vec<u32>| cells.iter().map(|cell| f64::from(*cell)).collect();
            sides.iter().map(|cells| cells.as_ref().map(side)).collect()
        }
    }
}

#[test]
fn each_side_of_a_page_shows_its_own_numbers() {
    use crate::{Questions, cast, compare};
    use raypencil_scene::{FaceId, Precision, Silent};

    let corners = vec![[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
    let mesh = Triangles::new(corners, vec![[0, 1, 2]]).unwrap();
    // Directions of length 2.5; the first ray meets the front and the second the back.
    let ray =
        |x: f64, z: f64, up: f64| CastRay::new(glam::DVec3::new(x, 1.0, z), glam::DVec3::new(1.5, 0.0, up));
    let rays = [ray(0.5, 3.0, -2.0), ray(0.25, -1.0, 2.0)];
    let margins = Questions { margins: true, ..Questions::default() };
    let mut answers = cast(&mesh, &rays, Sides::Both, margins, &Silent);
    for (margins, by) in answers.margins.iter_mut().flatten().zip([0.5, 0.25]) {
        (margins.face.lo, margins.surface.lo) = (by * margins.face.hi, 0.75 * by * margins.surface.hi);
    }
    let exact = Stated::of(&answers);
    // Another program, every number of which is another one.
    let other = |numbers: &Option<Vec<f64>>, by: f64| {
        numbers.as_ref().map(|all| all.iter().map(|x| x + by).collect())
    };
    let others = |vectors: &Option<Vec<glam::DVec3>>, by: f64| {
        vectors
            .as_ref()
            .map(|all| all.iter().map(|v| *v + glam::DVec3::new(by, 2.0 * by, 3.0 * by)).collect())
    };
    let stated = Stated {
        face: Some(vec![Some(FaceId(7)), None]),
        t: other(&exact.t, 0.25),
        range: other(&exact.range, 0.5),
        side: Some(vec![Some(Side::Back), Some(Side::Front)]),
        point: others(&exact.point, 0.125),
        normal: others(&exact.normal, 0.0625),
        cos_incidence: other(&exact.cos_incidence, 0.75),
        ..exact.clone()
    };
    let comparison = compare(&mesh, &rays, Sides::Both, &stated, Precision::F64, &Silent);
    let shown = |stated: &Stated| {
        let compared = ComparedHits {
            name: "mine",
            stated,
            comparison: &comparison,
            ray_command: &|ray| ray.to_string(),
        };
        let page = CastPage {
            title: "two rays",
            facts: &[],
            shape: &[2],
            rays: &rays,
            answers: &answers,
            mesh: None,
            set: None,
            scan: None,
            has_arrays: false,
            compared: Some(compared),
        };
        let (layout, mut found) = (page.layout(), std::collections::BTreeMap::new());
        for (name, unit, channel) in page.channels(&layout) {
            let sides = of_sides(&channel).into_iter().map(|cells| cells.map(|cells| cells[..2].to_vec()));
            found.insert(name, (unit, sides.collect::<Vec<_>>()));
        }
        found
    };
    let found = shown(&stated);
    let single = |numbers: &Option<Vec<f64>>| -> Option<Vec<f64>> {
        numbers.as_ref().map(|all| all.iter().map(|x| f64::from(*x as f32)).collect())
    };
    let part = |vectors: &Option<Vec<glam::DVec3>>, axis: usize| {
        single(&vectors.as_ref().map(|all| all.iter().map(|v| v[axis]).collect()))
    };
    let none = f64::from(u32::MAX);
    let mut expected = vec![
        ("range.T", "m", single(&exact.range), single(&stated.range)),
        ("t", "", single(&exact.t), single(&stated.t)),
        ("face.I", "", Some(vec![0.0, 0.0]), Some(vec![7.0, none])),
        ("side", "", Some(vec![1.0, -1.0]), Some(vec![-1.0, 1.0])),
        ("incidence.V", "", single(&exact.cos_incidence), single(&stated.cos_incidence)),
        ("ray", "", Some(vec![0.0, 1.0]), Some(vec![0.0, 1.0])),
        ("faces at this t", "", Some(vec![1.0, 1.0]), None),
    ];
    for (axis, [point, normal]) in [["P.X", "N.X"], ["P.Y", "N.Y"], ["P.Z", "N.Z"]].into_iter().enumerate() {
        expected.push((point, "m", part(&exact.point, axis), part(&stated.point, axis)));
        expected.push((normal, "", part(&exact.normal, axis), part(&stated.normal, axis)));
    }
    // Of a margin the lower bound: no ray that is moved by less has another answer.
    let margins = answers.margins.as_ref().unwrap();
    let faces = single(&Some(margins.iter().map(|margins| margins.face.lo).collect()));
    let surfaces = single(&Some(margins.iter().map(|margins| margins.surface.lo).collect()));
    expected.push(("margin to another face", "m", faces, None));
    expected.push(("margin to another surface", "m", surfaces, None));
    assert_eq!(found.len(), expected.len());
    for (name, unit, exact, other) in expected {
        assert_eq!(found[name], (unit, vec![exact, other]), "{name}");
    }
    // Of a program that gives t alone the range follows from it, as a length.
    let of_t = Stated { range: None, ..stated.clone() };
    let lengths = of_t.t.as_ref().map(|all| all.iter().map(|t| 2.5 * t).collect());
    assert_eq!(shown(&of_t)["range.T"].1[1], single(&lengths));
}

#[test]
fn a_page_says_where_its_rays_stand_and_how_its_numbers_are_read() {
    let rays = [2.5, 3.5].map(|x| CastRay::new(glam::DVec3::new(x, 0.0, 1.0), -glam::DVec3::Z));
    let answers = Answers {
        first: vec![Reading::Miss, Reading::TooNear],
        any: None,
        all: None,
        margins: None,
        decided: None,
    };
    let page = CastPage {
        title: "two rays",
        facts: &[],
        shape: &[2],
        rays: &rays,
        answers: &answers,
        mesh: None,
        set: None,
        scan: None,
        has_arrays: false,
        compared: None,
    };
    let (html, notes) = page.explorer_with_notes();
    // The model that the page's script reads.
    assert!(html.contains("id=\"page-model\"") && html.contains("\"two rays\""));
    let numbers = |arrays: &str| {
        format!(
            "The numbers of this page are in single precision{arrays}. Lengths are in the mesh's own unit, which the scales call m."
        )
    };
    assert_eq!(notes, ["The rays in their order, row by row.".to_string(), numbers("")]);
    let (_, notes) = CastPage { has_arrays: true, ..page }.explorer_with_notes();
    assert_eq!(notes[1], numbers("; the arrays beside it have all digits"));
}
