use super::*;

/// A floor of (n, n) squares of 1 m, two faces each.
fn floor(n: u32) -> Triangles {
    let corners = (0..=n).flat_map(|j| (0..=n).map(move |i| [f64::from(i), f64::from(j), 0.0])).collect();
    let face = |i: u32, j: u32| {
        let at = j * (n + 1) + i;
        [[at, at + 1, at + n + 2], [at, at + n + 2, at + n + 1]]
    };
    Triangles::new(corners, (0..n).flat_map(|j| (0..n).flat_map(move |i| face(i, j))).collect()).unwrap()
}

#[test]
fn a_small_mesh_is_drawn_as_it_is() {
    let mesh = floor(3);
    let solid = page_solid(&mesh, None);
    assert_eq!((solid.origin, solid.faces.as_slice()), ([1.5, 1.5, 0.0], mesh.faces()));
    assert_eq!(solid.vertices[0], [-1.5, -1.5, 0.0]);
    assert_eq!(solid.axes, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(solid.words, "The mesh has 18 faces.");
}

#[test]
fn a_large_mesh_is_made_coarse_and_says_so() {
    // 2 * 300 * 300 faces are too many: corners of neighbouring squares become one.
    let solid = page_solid(&floor(300), None);
    assert!(solid.faces.len() <= MAX_FACES && solid.faces.len() > MAX_FACES / 4, "{}", solid.faces.len());
    let area = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| glam::Vec3::from(solid.vertices[corner as usize]));
        0.5 * f64::from((b - a).cross(c - a).z)
    };
    // Kept corners are those of the mesh. Cells of some metre at the far edges may lose theirs.
    let all: f64 = solid.faces.iter().map(|face| area(*face)).sum();
    assert!((all - 90_000.0).abs() < 0.02 * 90_000.0, "{all}");
    assert!(solid.words.starts_with("The mesh has 180,000 faces. Of these "), "{}", solid.words);
}

#[test]
fn up_is_the_axis_nearest_to_the_sensors() {
    use raypencil_scene::Pose;
    use raypencil_scene::pattern::Mounting;
    // A sensor in a frame whose y is up: turned about x, so that its own z is that y.
    let pose = Pose::from_axis_angle(DVec3::X, (-90.0_f64).to_radians());
    let mounting = Mounting::Fixed(pose);
    let scan = PageScan { name: "scan", times: None, elevations_deg: None, mounting: &mounting };
    let [right, page_up, up] = page_solid(&floor(1), Some(&scan)).axes.map(DVec3::from_array);
    assert_eq!((right, up), (DVec3::X, DVec3::Y));
    assert_eq!(right.cross(page_up), up);
}
