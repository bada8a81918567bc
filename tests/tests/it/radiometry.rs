//! Laws of light, tested on every renderer: shares of the beam's power, laws of distance, the camera equation as the
//! limit of fine pencils, energy, and statistics of jittered rays. (docs/theory/radiometry.md)

use std::f64::consts::{FRAC_PI_4, FRAC_PI_6, LN_2, PI, TAU};
use std::sync::Arc;

use glam::DVec3;
use raypencil::harness::contender;
use raypencil::{
    Atmosphere, Beam, Camera, Filter, FluxModel, Image, Lens, Material, Mesh, Mounted, Pose, Profile,
    RenderOutput, Renderer, Request, Returns, Sampling, Scene, SensorId,
};
use raypencil_tests::draws::SplitMix64;
use raypencil_tests::light::{LIGHT, evaluations, fluxes, is_visible, looking, relative, total};
use raypencil_tests::quadrature::{gauss_legendre, over_rectangle};
use raypencil_tests::{at_origin, hit, rig, scene};

// ---- The definitions in closed form -----------------------------------------------------------------

/// A plane through `point`. The unit vector `normal` points to the side of its front.
#[derive(Debug, Clone, Copy)]
struct Plane {
    point: DVec3,
    normal: DVec3,
}

impl Plane {
    /// One face that extends at least 100 m around `point`, its vertices rounded to `f32`; and the plane of these
    /// vertices.
    fn mesh(point: DVec3, normal: DVec3, reflectivity: f64) -> (Arc<Mesh>, Self) {
        let along = normal.any_orthonormal_vector();
        let across = normal.cross(along);
        let corners = [(-100.0, -100.0), (200.0, 0.0), (-100.0, 100.0)]
            .map(|(u, v)| (point + along * u + across * v).as_vec3().to_array());
        let materials = vec![Material { name: "plane".into(), reflectivity }];
        let mesh = Mesh::new(DVec3::ZERO, corners.to_vec(), vec![[0, 1, 2]], vec![0], materials);
        let [a, b, c] = corners.map(|corner| DVec3::from_array(corner.map(f64::from)));
        (Arc::new(mesh.expect("a mesh")), Self { point: a, normal: (b - a).cross(c - a).normalize() })
    }
}

/// The point where the ray through (x, y) on the beam's grid meets a plane, with angles and distances to beam and
/// camera.
#[derive(Debug, Clone, Copy)]
struct Landing {
    /// cos(alpha), alpha between the ray and the normal axis.
    cos_alpha: f64,
    /// Range R, metres.
    range: f64,
    /// Cosine of the angle of incidence psi.
    cos_psi: f64,
    /// Depth r in the camera, metres.
    depth: f64,
    /// Distance d from the camera, metres.
    distance: f64,
    /// Cosine of the off-axis angle phi.
    cos_phi: f64,
    /// Cosine of the viewing angle theta.
    cos_theta: f64,
    /// Position on the image, pixels.
    place: [f64; 2],
    /// Area of the plane per area of the grid, from exact derivatives.
    plane_per_grid: f64,
    /// Area of the image per area of the grid, from exact derivatives.
    image_per_grid: f64,
}

impl Landing {
    fn new(scene: &Scene, plane: Plane, x: f64, y: f64) -> Self {
        let Mounted { scene_from_sensor: from_beam, sensor: beam } = scene.beams()[0];
        let Mounted { scene_from_sensor: from_camera, sensor: camera } = *scene.camera();
        // o + t q is on the plane where t = n.(a - o) / n.q.
        let [right, down] = [DVec3::X, DVec3::Y].map(|axis| from_beam.rotate(axis));
        let origin = from_beam * DVec3::new(0.0, y, 0.0);
        let q = from_beam.rotate(DVec3::new(x, 0.0, beam.grid_distance));
        let slope = plane.normal.dot(q);
        let t = plane.normal.dot(plane.point - origin) / slope;
        let point = origin + q * t;
        // dt/dx = -t n.e_x / n.q, dt/dy = -n.e_y / n.q.
        let by_x = right * t - q * (t * plane.normal.dot(right) / slope);
        let by_y = down - q * (plane.normal.dot(down) / slope);

        let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| from_camera.rotate(axis));
        let seen = |v: DVec3| DVec3::new(axes[0].dot(v), axes[1].dot(v), axes[2].dot(v));
        let to_point = point - from_camera.position;
        let (distance, p) = (to_point.length(), seen(to_point));
        // u = f X / Z: du = f (dX - X / Z dZ) / Z.
        let on_image = |v: DVec3| {
            let v = seen(v);
            [v.x - p.x / p.z * v.z, v.y - p.y / p.z * v.z].map(|part| camera.focal_length * part / p.z)
        };
        let ([u_x, v_x], [u_y, v_y]) = (on_image(by_x), on_image(by_y));
        Self {
            cos_alpha: beam.grid_distance / q.length(),
            range: t * q.length(),
            cos_psi: -slope / q.length(),
            depth: p.z,
            distance,
            cos_phi: p.z / distance,
            cos_theta: -plane.normal.dot(to_point) / distance,
            place: [0, 1].map(|k: usize| {
                camera.focal_length * p[k] / p.z / camera.pixel_pitch[k] + camera.principal_point[k]
            }),
            plane_per_grid: by_x.cross(by_y).length(),
            image_per_grid: (u_x * v_y - u_y * v_x).abs(),
        }
    }

    /// The transmission of lens, filter and air, C_loss F(phi) exp(-sigma (R + d)).
    fn transmitted(&self, scene: &Scene) -> f64 {
        let lens = scene.camera().sensor.lens;
        let loss = match lens.filter {
            Filter::None => 1.0,
            Filter::Interference { centre, width, index } => {
                let sin_squared = 1.0 - self.cos_phi * self.cos_phi;
                let moved = centre * (1.0 - sin_squared / (index * index)).sqrt();
                let off = (scene.beams()[0].sensor.wavelength - moved) / width;
                libm::exp(-4.0 * LN_2 * off * off)
            }
        };
        let air = -scene.atmosphere().attenuation * (self.range + self.distance);
        lens.transmission * loss * libm::exp(air)
    }

    /// The flux of the `radiometric` model per area of the grid, with the profile `paper`, W/m^2.
    fn flux_per_grid(&self, scene: &Scene) -> f64 {
        let (beam, aperture) = (scene.beams()[0].sensor, scene.camera().sensor.aperture);
        let power = beam.power * self.cos_alpha / (2.0 * beam.half_width * beam.thickness);
        let lens = 0.25 * aperture * aperture * self.cos_phi * self.cos_phi * self.cos_phi;
        power * reflectivity(scene) * lens * self.cos_theta / (self.depth * self.depth)
            * self.transmitted(scene)
    }

    /// The camera equation: flux per area of the image, W/m^2, (pi / 4) L (D / f)^2 cos^4(phi), with L = r_d E / pi and
    /// E = (I_b / A_b) (R_g / R) cos(psi).
    fn flux_per_image(&self, scene: &Scene) -> f64 {
        let (beam, camera) = (scene.beams()[0].sensor, scene.camera().sensor);
        let of_grid = beam.grid_distance / self.cos_alpha;
        let irradiance = beam.power / (2.0 * beam.half_width * beam.thickness) * (of_grid / self.range);
        let radiance = reflectivity(scene) * irradiance * self.cos_psi / PI;
        let (ratio, square) = (camera.aperture / camera.focal_length, self.cos_phi * self.cos_phi);
        FRAC_PI_4 * radiance * ratio * ratio * square * square * self.transmitted(scene)
    }
}

/// The reflectivity of the first material.
fn reflectivity(scene: &Scene) -> f64 {
    scene.mesh().materials()[0].reflectivity
}

/// The landing of a pencil's central ray.
fn landing(scene: &Scene, plane: Plane, i: u32, j: u32) -> Landing {
    let beam = scene.beams()[0].sensor;
    let (columns, rows) = (f64::from(beam.columns), f64::from(beam.rows));
    let x = beam.half_width * (2.0 * f64::from(i) + 1.0 - columns) / columns;
    let y = beam.thickness * (2.0 * f64::from(j) + 1.0 - rows) / (2.0 * rows);
    Landing::new(scene, plane, x, y)
}

// ---- Shares -----------------------------------------------------------------------------------------

#[test]
fn shares_add_up_to_what_their_profile_says() {
    // A wall 2 m away, square to the beam, and the camera at the position of the beam: cos(theta) = cos(phi), r = 2 m,
    // and only the share P_k of a pencil's flux is unknown:
    // I_k = P_k (1/4) (D^2 / 4) cos^4(phi) / 4, tan^2(phi) = tan^2(alpha) + (y / 2 m)^2.
    let (mesh, _) = Plane::mesh(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z, 0.25);
    // Slopes up to 1: a fan of 30 degrees to either side reaches 0.577.
    let camera = rig::camera(64, 64, 1.0 / 4096.0, 1.0 / 128.0);
    let sum_of = |renderer: &dyn Renderer, columns: u32, profile: Profile| {
        let half_width = Beam::half_width_of(0.1, 2.0 * FRAC_PI_6);
        let beam = Beam {
            half_width,
            thickness: 5e-3,
            power: 3.0,
            profile,
            ..rig::beam(columns, 2, [1.0, 1.0], 0.1)
        };
        let scene = scene(Arc::clone(&mesh), at_origin(camera), vec![at_origin(beam)]);
        let output = renderer.render(&scene, &LIGHT);
        let mut sum = 0.0;
        for j in 0..beam.rows {
            for i in 0..columns {
                let tan_alpha = beam.direction(i).x / 0.1;
                let secant_squared = 1.0 + tan_alpha * tan_alpha + 0.25 * beam.origin(j).y * beam.origin(j).y;
                let of_share = 3.0 * 0.25 * 0.25 * camera.aperture * camera.aperture
                    / (4.0 * secant_squared * secant_squared);
                sum += fluxes(&output.returns[0]).at(i, j) / of_share;
            }
        }
        sum
    };
    // With t = tan(alpha), evenly spaced: the mean of 1 / sqrt(1 + t^2) over (-tan a, tan a) is
    // ln(sec a + tan a) / tan a = ln(sqrt 3) sqrt 3 = 0.9514262. The mean of midpoints is larger by
    // sin^2(a) cos(a) / (6 n^2) (the leading term of the midpoint rule's error), 1.41e-4 for n = 16.
    let limit = libm::log(3.0_f64.sqrt()) * 3.0_f64.sqrt();
    assert!((limit - 0.951_426_15).abs() < 1e-8, "{limit}");
    for renderer in evaluations() {
        let name = renderer.name().to_string();
        for (columns, decimals, last) in [(1024, 0.951_426_2, 1e-7), (16, 0.95157, 1e-5)] {
            let sum = sum_of(&*renderer, columns, Profile::Paper);
            assert!((sum - decimals).abs() <= 0.5 * last, "{name}, {columns} columns: {sum}");
            let excess = 0.25 * 0.75_f64.sqrt() / (6.0 * f64::from(columns * columns));
            // The next term is of fourth order: below 1 / n^4, beside roundings of 1024 numbers.
            let next = 1.0 / f64::from(columns * columns) / f64::from(columns * columns) + 1e-13;
            assert!((sum - limit - excess).abs() < next, "{name}, {columns} columns: {sum}");
            println!(
                "{name}: {columns} columns, paper: {sum:.10}, beyond limit and excess {:e}",
                sum - limit - excess
            );
            for profile in [Profile::UniformAngle, Profile::Gaussian { half_width: 0.3 }] {
                let sum = sum_of(&*renderer, columns, profile);
                println!("{name}: {columns} columns, {profile:?}: 1 + {:e}", sum - 1.0);
                assert!((sum - 1.0).abs() < 1e-13, "{name}, {columns} columns, {profile:?}: {sum}");
            }
        }
    }
}

// ---- Laws of distance -------------------------------------------------------------------------------

/// Maximum relative error of a flux: about 60 roundings of 2^-53 with well-conditioned numbers.
const MAX_RELATIVE_ERROR: f64 = 1e-14;

#[test]
fn flux_falls_with_the_square_of_depth() {
    // One pencil on a wall 2 m away at P = (0, 0, 2); the camera on a straight line from there, at P - s (1/4, -1/8, 1)
    // for s = 1/2, 1, 2 m: the same angles, depth s. I = P r_d (D^2 / 4) cos^4(phi) / s^2, with P = 1 W, r_d = 1/4,
    // cos^2(phi) = 1 / (1 + 5/64) = 64/69.
    let (mesh, _) = Plane::mesh(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z, 0.25);
    let camera = rig::camera(64, 64, 1.0 / 4096.0, 1.0 / 128.0);
    let beam = rig::beam(1, 1, [0.0625, 0.001], 0.1);
    for renderer in evaluations() {
        for s in [0.5, 1.0, 2.0] {
            let position = DVec3::new(0.0, 0.0, 2.0) - DVec3::new(0.25, -0.125, 1.0) * s;
            let camera = Mounted { scene_from_sensor: Pose::from_position(position), sensor: camera };
            let scene = scene(Arc::clone(&mesh), camera, vec![at_origin(beam)]);
            let flux = fluxes(&renderer.render(&scene, &LIGHT).returns[0]).at(0, 0);
            let derived = 0.25 * 0.25 * 4e-6 * (64.0 / 69.0) * (64.0 / 69.0) / (s * s);
            assert!(
                relative(flux, derived) < MAX_RELATIVE_ERROR,
                "{} at {s} m: {flux:e}, {derived:e}",
                renderer.name()
            );
        }
    }
}

#[test]
fn irradiance_falls_with_range() {
    // A wall square to the beam at R = 1, 2, 4 m, seen from 1 m before it. The neighbours of the middle pencil meet it
    // (R / g) (1/512 m) and 1/1024 m beside it: the area of its spot is 2^-19 R / g, its flux the same, and so
    // irradiance falls as 1 / R.
    let camera = rig::camera(64, 64, 1.0 / 4096.0, 1.0 / 128.0);
    let beam = rig::beam(33, 5, [1.0 / 512.0, 1.0 / 1024.0], 0.125);
    for renderer in evaluations() {
        let name = renderer.name().to_string();
        let mut first = None;
        for range in [1.0, 2.0, 4.0] {
            let (mesh, _) = Plane::mesh(DVec3::new(0.0, 0.0, range), DVec3::NEG_Z, 0.25);
            let pose = Pose::from_position(DVec3::new(0.0, 0.0, range - 1.0));
            let camera = Mounted { scene_from_sensor: pose, sensor: camera };
            let output = renderer.render(
                &scene(mesh, camera, vec![at_origin(beam)]),
                &Request { camera: false, ..Request::EVERYTHING },
            );
            let map = output.map(SensorId::Beam(0)).expect("the beam was asked for");
            let point = |i, j| hit(map, i, j).expect("the wall is hit").point;
            let across = (point(17, 2) - point(15, 2)) * 0.5;
            let area = across.cross((point(16, 3) - point(16, 1)) * 0.5).length();
            let flux = fluxes(&output.returns[0]).at(16, 2);
            // 1e-12: points are differences of metres, over millimetres.
            assert!(
                relative(area, 8.0 * range / f64::from(1 << 19)) < 1e-12,
                "{name} at {range} m: {area:e}"
            );
            let (area_1, flux_1) = *first.get_or_insert((area, flux));
            assert!(relative(flux, flux_1) < MAX_RELATIVE_ERROR, "{name} at {range} m: {flux:e}");
            let irradiance = flux / area / (flux_1 / area_1);
            assert!(relative(irradiance, 1.0 / range) < 1e-12, "{name} at {range} m: {irradiance}");
        }
    }
}

// ---- The camera equation ----------------------------------------------------------------------------

/// A plane of any slope, a camera, and a beam of 5 x 3 pencils. Both are on the side of the front, and look at about
/// the same point.
fn tilted(random: &mut SplitMix64) -> (Scene, Plane) {
    let (target, normal) = (random.vector(3.0), random.direction());
    let (mesh, plane) = Plane::mesh(target, normal, random.between(0.1, 1.0));
    let pose = |random: &mut SplitMix64| {
        let up = loop {
            let up = random.direction();
            // At most 72 degrees from the normal: rounding errors grow with 1 / cos.
            if up.dot(normal) > 0.3 {
                break up;
            }
        };
        let distance = random.between(0.5, 5.0);
        let aim = random.vector(0.1);
        looking(target + up * distance, aim - up, random.between(-PI, PI))
    };
    let camera = Camera {
        pixel_pitch: [1.0 / 4096.0, 1.0 / 3072.0],
        aperture: random.between(1e-3, 1e-2),
        ..rig::camera(64, 64, 1.0, random.between(0.006, 0.008))
    };
    let grid_distance = random.between(0.05, 0.2);
    let half_width = Beam::half_width_of(grid_distance, random.between(0.1, 0.7));
    let (thickness, power) = (random.between(1e-3, 1e-2), random.between(0.1, 10.0));
    let beam = Beam { half_width, thickness, power, ..rig::beam(5, 3, [1.0, 1.0], grid_distance) };
    let camera = Mounted { scene_from_sensor: pose(random), sensor: camera };
    let beam = Mounted { scene_from_sensor: pose(random), sensor: beam };
    (scene(mesh, camera, vec![beam]), plane)
}

#[test]
fn a_pencil_s_flux_over_its_spot_is_the_camera_equation() {
    // If the whole footprint of a pixel were lit as the pencil's spot is, the pixel would receive the pencil's flux
    // times the area of the footprint over the area of the spot.
    const TOLERANCE: f64 = 1e-12;
    let mut random = SplitMix64::new(1);
    let cases: Vec<(Scene, Plane)> = (0..200).map(|_| tilted(&mut random)).collect();
    for renderer in evaluations() {
        let (mut tested, mut worst) = (0, [0.0_f64; 3]);
        for (scene, plane) in &cases {
            let (camera, beam) = (scene.camera().sensor, scene.beams()[0].sensor);
            let output = renderer.render(scene, &LIGHT);
            for (i, j) in (0..3).flat_map(|j| (0..5).map(move |i| (i, j))) {
                let at = landing(scene, *plane, i, j);
                // Other pencils of the fan may graze the plane or miss the image.
                if !is_visible(&output.returns[0], i, j) || at.cos_psi < 0.1 || at.cos_theta < 0.1 {
                    continue;
                }
                tested += 1;
                let of_pencil = 2.0 * beam.half_width * beam.thickness / f64::from(beam.columns * beam.rows);
                let of_pixel = camera.pixel_pitch[0] * camera.pixel_pitch[1];
                let grid_range = beam.grid_distance / at.cos_alpha;
                let spot = of_pencil * at.cos_alpha * (at.range / grid_range) / at.cos_psi;
                let patch = of_pixel * at.depth * at.depth * at.cos_phi
                    / (camera.focal_length * camera.focal_length * at.cos_theta);
                // The same two areas from exact derivatives of the point by the position on grid and image.
                let spot_2 = of_pencil * at.plane_per_grid;
                let patch_2 = of_pixel * at.plane_per_grid / at.image_per_grid;
                let found = fluxes(&output.returns[0]).at(i, j) * patch / spot;
                let derived = at.flux_per_image(scene) * of_pixel;
                let errors = [relative(spot, spot_2), relative(patch, patch_2), relative(found, derived)];
                for (worst, error) in worst.iter_mut().zip(errors) {
                    *worst = worst.max(error);
                }
                assert!(
                    errors.iter().all(|error| *error < TOLERANCE),
                    "{} {i},{j}: {errors:?} of {at:?}",
                    renderer.name()
                );
            }
        }
        println!("{}: {tested} pencils, spot, patch, flux: {worst:?}", renderer.name());
        assert!(tested > 2000, "{tested} of 3000 pencils");
    }
}

// ---- Energy -----------------------------------------------------------------------------------------

#[test]
fn the_light_that_leaves_a_point_is_the_reflectivity_times_the_light_on_it() {
    // One pencil of 2 W (alpha = 0, so P = 2 W) on a slope, r_d = 0.3; lenses of D = 2 mm in all directions from the
    // point, 0.75 m away. Flux over the solid angle of the aperture, (pi D^2 / 4) cos(phi) / d^2, is radiant
    // intensity; over the hemisphere before the face it adds up to 0.6 W, behind the face it is 0. Gauss-Legendre
    // nodes in cos(theta), even steps in azimuth. The lens is aimed at the point, or 0.3 rad beside it.
    let normal = DVec3::new(0.3, -0.4, -0.8).normalize();
    let (mesh, plane) = Plane::mesh(DVec3::new(0.0, 0.0, 2.0), normal, 0.3);
    let beam = Beam { power: 2.0, ..rig::beam(1, 1, [0.0625, 0.001], 0.1) };
    let camera = rig::camera(64, 64, 1.0 / 4096.0, 1.0 / 128.0);
    let along = plane.normal.any_orthonormal_vector();
    let across = plane.normal.cross(along);
    // The pencil runs along z.
    let point = DVec3::Z * (plane.normal.dot(plane.point) / plane.normal.z);
    const AZIMUTHS: u32 = 12;
    for renderer in evaluations() {
        for beside in [0.0, 0.3] {
            let (mut sum, mut behind) = (0.0, 0.0);
            for [node, weight] in gauss_legendre(8) {
                let (cos, weight) = (0.5 + 0.5 * node, 0.5 * weight);
                for azimuth in 0..AZIMUTHS {
                    let (s, c) = libm::sincos(TAU * (f64::from(azimuth) + 0.1) / f64::from(AZIMUTHS));
                    let level = (along * c + across * s) * (1.0 - cos * cos).sqrt();
                    let flux = |up: DVec3| {
                        let pose = looking(point + up * 0.75, -up, 0.0)
                            * Pose::from_axis_angle(DVec3::Y, beside)
                            * Pose::from_axis_angle(DVec3::Z, f64::from(azimuth));
                        let camera = Mounted { scene_from_sensor: pose, sensor: camera };
                        let scene = scene(Arc::clone(&mesh), camera, vec![at_origin(beam)]);
                        fluxes(&renderer.render(&scene, &LIGHT).returns[0]).at(0, 0)
                    };
                    let aperture = FRAC_PI_4 * 4e-6 * libm::cos(beside) / (0.75 * 0.75);
                    let solid_angle = weight * TAU / f64::from(AZIMUTHS);
                    sum += flux(level + plane.normal * cos) / aperture * solid_angle;
                    behind += flux(level - plane.normal * cos);
                }
            }
            println!("{}: {beside} rad beside: 0.6 W (1 + {:e})", renderer.name(), sum / 0.6 - 1.0);
            assert!(relative(sum, 0.6) < 1e-6, "{}: {sum} W", renderer.name());
            assert_eq!(behind, 0.0, "{}", renderer.name());
        }
    }
}

/// A rover's rig on a slope: the camera is 1.5 m above the origin of a plane that rises by 0.1 ahead and 0.05 to the
/// left, the beam 0.3 m above the camera. A fan of 60 degrees is wholly on the image of 64 x 64 pixels, in attenuating
/// air, through a filter.
fn slope(
    columns: u32,
    rows: u32,
    thickness: f64,
    reflectivity: f64,
    attenuation: f64,
    model: FluxModel,
) -> (Scene, Plane) {
    let (mesh, plane) = Plane::mesh(DVec3::ZERO, DVec3::new(-0.1, -0.05, 1.0).normalize(), reflectivity);
    let filter = Filter::Interference { centre: 820e-9, width: 40e-9, index: 2.0 };
    let camera = Camera { lens: Lens { transmission: 0.75, filter }, ..rig::camera(64, 64, 170e-6, 8e-3) };
    let beam = Beam {
        thickness,
        half_width: Beam::half_width_of(0.1, 60.0_f64.to_radians()),
        ..rig::beam(columns, rows, [1.0, 1.0], 0.1)
    };
    let camera = rig::pitched(DVec3::new(0.0, 0.0, 1.5), 20.0_f64.to_radians(), camera);
    let beam = rig::pitched(DVec3::new(0.0, 0.0, 1.8), 31.0_f64.to_radians(), beam);
    let air = Atmosphere { attenuation };
    (Scene::new(mesh, camera, vec![beam], air, model).expect("a scene"), plane)
}

#[test]
fn black_ground_returns_nothing() {
    for renderer in evaluations() {
        for model in [FluxModel::Radiometric, FluxModel::Eq1] {
            let (scene, _) = slope(64, 4, 5e-3, 0.0, 0.05, model);
            let output = renderer.render(&scene, &LIGHT);
            // The stripe is visible all the same.
            assert!((0..64).all(|i| is_visible(&output.returns[0], i, 2)), "{}", renderer.name());
            assert!(
                fluxes(&output.returns[0]).cells().iter().all(|flux| *flux == 0.0),
                "{}",
                renderer.name()
            );
            assert!(output.flux[0].cells().iter().all(|flux| *flux == 0.0), "{}", renderer.name());
        }
    }
}

#[test]
fn air_attenuates_by_the_length_of_the_path() {
    // The factor is exp(-sigma (R + d)), in equation (1) exp(-sigma (R + r)).
    for renderer in evaluations() {
        for model in [FluxModel::Radiometric, FluxModel::Eq1] {
            let fluxes_at = |attenuation| {
                let (scene, plane) = slope(64, 4, 5e-3, 0.25, attenuation, model);
                let output = renderer.render(&scene, &LIGHT);
                (fluxes(&output.returns[0]).clone(), total(&output.flux[0]), scene, plane)
            };
            let (clear, mut before, scene, plane) = fluxes_at(0.0);
            for sigma in [1e-3, 0.1, 2.0] {
                let (dusty, all, ..) = fluxes_at(sigma);
                assert!(all < before, "{}: {all:e} W of {before:e} W at {sigma}", renderer.name());
                before = all;
                for (i, j) in (0..4).flat_map(|j| (0..64).map(move |i| (i, j))) {
                    let (of, whole) = (dusty.at(i, j), clear.at(i, j));
                    assert!(0.0 < of && of < whole, "{} {i},{j}: {of:e} of {whole:e}", renderer.name());
                    let at = landing(&scene, plane, i, j);
                    let back = if model == FluxModel::Radiometric { at.distance } else { at.depth };
                    let derived = whole * libm::exp(-sigma * (at.range + back));
                    // The relative error of exp is the absolute error of its argument. This is up to 2 * 9 here: a few
                    // times 2e-15.
                    assert!(
                        relative(of, derived) < 2e-14,
                        "{} {i},{j}: {of:e}, {derived:e}",
                        renderer.name()
                    );
                }
            }
        }
    }
}

// ---- Convergence ------------------------------------------------------------------------------------

#[test]
fn the_flux_of_a_stripe_converges_to_the_camera_equation() {
    // The camera equation, integrated over the image of the sheet: in coordinates of the grid, with the derivative of
    // the image by the grid. The flux of infinitely many pencils is the same integral.
    let (scene, plane) = slope(1, 1, 5e-3, 0.25, 0.05, FluxModel::Radiometric);
    let beam = scene.beams()[0].sensor;
    let grid = [[-beam.half_width, beam.half_width], [-0.5 * beam.thickness, 0.5 * beam.thickness]];
    let camera_equation = |nodes| {
        over_rectangle(grid, nodes, |x, y| {
            let at = Landing::new(&scene, plane, x, y);
            at.flux_per_image(&scene) * at.image_per_grid
        })
    };
    let derived = camera_equation([48, 8]);
    assert!(relative(camera_equation([96, 16]), derived) < 1e-13, "twice as many nodes");
    let of_pencils =
        over_rectangle(grid, [48, 8], |x, y| Landing::new(&scene, plane, x, y).flux_per_grid(&scene));
    assert!(relative(of_pencils, derived) < 1e-13, "{of_pencils:e} W, {derived:e} W");

    for renderer in evaluations() {
        let name = renderer.name().to_string();
        let mut before: Option<f64> = None;
        for (columns, rows, most) in [(512_u32, 16_u32, 1e-6), (2048, 64, 1e-7), (8192, 192, 1e-8)] {
            // The referee's arithmetic is exact and slow: it computes the coarsest grid only.
            if name == "referee" && columns > 512 {
                continue;
            }
            let (scene, _) = slope(columns, rows, 5e-3, 0.25, 0.05, FluxModel::Radiometric);
            let output = renderer.render(&scene, &LIGHT);
            let visible = output.returns[0].visible.as_ref().expect("what is visible is known");
            assert!(visible.cells().iter().all(|seen| *seen), "{name}: the stripe is not wholly in view");
            let error = relative(total(&output.flux[0]), derived);
            // The sheet is so thin that the error depends on the columns alone.
            let order = before.map(|before| libm::log2(before / error) / 2.0);
            println!("{name}: {columns} x {rows} pencils: {error:e}, order {order:?}");
            assert!(error < most, "{name}: {columns} x {rows} pencils: {error:e}");
            assert!(order.is_none_or(|order| (order - 2.0).abs() < 0.2), "{name}: order {order:?}");
            before = Some(error);
        }
    }
}

// ---- Jittered pencils -------------------------------------------------------------------------------

/// A sheet of 1 m, which covers many pixels, of 256 x 128 pencils.
fn thick() -> (Scene, Plane) {
    slope(256, 128, 1.0, 0.25, 0.05, FluxModel::Radiometric)
}

#[test]
fn jittered_rays_have_the_right_mean() {
    // Four series of 24 seeds.
    const SERIES: usize = 4;
    const SEEDS: usize = 24;
    let (scene, plane) = thick();
    let Beam { columns, rows, half_width, thickness, .. } = scene.beams()[0].sensor;
    let size = scene.camera().sensor.width as usize;

    // A ray is uniform in its pencil's cell, so that the expectation of a pixel is the integral of flux over the
    // part of the grid that lands in it. By the midpoint rule with FINE x FINE nodes a pencil: where the border of a
    // pixel cuts a pencil, the part is wrong by about 0.3 / FINE of the pencil, while the mean of SEEDS random of
    // being in or out errs by about 0.4 / sqrt(SEEDS): 11 % of it, which adds 0.7 % to the rms below.
    // A pencil whose four corners land in one pixel has no border: a node for each 8 x 8 is plenty for its smooth flux.
    const FINE: u32 = 32;
    const COARSE: u32 = 4;
    let mut expected = vec![[0.0, 0.0]; size * size];
    // Shares of a pencil, counted from the grid's corner, as a place on the grid.
    let on_grid = |across: f64, down: f64| {
        let x = half_width * (2.0 * across / f64::from(columns) - 1.0);
        Landing::new(&scene, plane, x, thickness * (down / f64::from(rows) - 0.5))
    };
    let pixel = |at: &Landing| {
        let is_on_image = at.place.iter().all(|place| (0.0..size as f64).contains(place));
        is_on_image.then(|| at.place[1] as usize * size + at.place[0] as usize)
    };
    let area = 2.0 * half_width * thickness / (f64::from(columns) * f64::from(rows));
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (f64::from(j), f64::from(i)))) {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let corners = corners.map(|[right, down]| pixel(&on_grid(i + right, j + down)));
        let nodes = if corners.iter().all(|corner| *corner == corners[0]) { COARSE } else { FINE };
        let share = |node: u32| (f64::from(node) + 0.5) / f64::from(nodes);
        for (down, right) in (0..nodes).flat_map(|down| (0..nodes).map(move |right| (down, right))) {
            let at = on_grid(i + share(right), j + share(down));
            if let Some(pixel) = pixel(&at) {
                let [flux, pencils] = &mut expected[pixel];
                *flux += at.flux_per_grid(&scene) * area / f64::from(nodes * nodes);
                *pencils += 1.0 / f64::from(nodes * nodes);
            }
        }
    }

    let tracer = contender("tracer").expect("a renderer of the workspace").renderer;
    let images: Vec<Image<f64>> = (1..=(SERIES * SEEDS) as u64)
        .map(|seed| {
            let request = Request { sampling: Sampling::Jittered { seed }, ..LIGHT };
            tracer.render(&scene, &request).flux.remove(0)
        })
        .collect();
    let mut z_squared = Vec::new();
    for (index, [expectation, pencils]) in expected.into_iter().enumerate() {
        let values: Vec<f64> = images.iter().map(|image| image.cells()[index]).collect();
        // A sum of fewer pencils is not close to a normal distribution.
        if pencils >= 16.0 {
            z_squared.extend(values.chunks(SEEDS).map(|series| {
                let z = standardised(series, expectation);
                z * z
            }));
        }
    }
    // With a standard error of 24 samples z follows Student's t of 23 degrees of freedom, whose variance is 23 / 21:
    // an rms of 1.0465. The rms of n of them scatters by sqrt((kurtosis - 1) / n) / 2, kurtosis 3 + 6 / 19: by 1.3 %
    // for four times 900 pixels, so that 5 % are four of its standard deviations.
    let count = z_squared.len();
    let rms = (z_squared.iter().sum::<f64>() / count as f64).sqrt();
    let derived = (23.0_f64 / 21.0).sqrt();
    println!("{count} means: rms of z {rms}, derived {derived}");
    assert!(count > SERIES * 800, "{count} means");
    assert!(relative(rms, derived) < 0.05, "rms of z {rms}, derived {derived}");

    // The total flux, integrated by Gauss-Legendre, shows systematic errors that are too small for single pixels. Most
    // pencils stay on the image in every draw, so that the total varies little.
    let totals: Vec<f64> = images.iter().map(total).collect();
    let grid = [[-half_width, half_width], [-0.5 * thickness, 0.5 * thickness]];
    let all = over_rectangle(grid, [64, 32], |x, y| Landing::new(&scene, plane, x, y).flux_per_grid(&scene));
    let z = standardised(&totals, all);
    println!("total: {all:e} W, z = {z}");
    // With 96 samples, |z| > 4 has a probability of 1e-4.
    assert!(z.abs() < 4.0, "total: {all:e} W, z = {z}");
}

/// The mean of samples minus its expectation, in standard errors.
fn standardised(samples: &[f64], expectation: f64) -> f64 {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let variance = samples.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (count - 1.0);
    (mean - expectation) / (variance / count).sqrt()
}

#[test]
fn jittered_rays_are_the_same_for_all() {
    let render = |name: &str, scene: &Scene, seed| {
        let request = Request { sampling: Sampling::Jittered { seed }, ..Request::EVERYTHING };
        contender(name).expect("a renderer of the workspace").renderer.render(scene, &request)
    };
    let ground = raypencil::terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh();
    let (mesh, (plane, _)) =
        (Arc::new(ground.expect("a mesh")), slope(96, 12, 0.02, 0.25, 0.05, FluxModel::Radiometric));
    let pyramids =
        Scene::new(mesh, *plane.camera(), plane.beams().to_vec(), plane.atmosphere(), FluxModel::Radiometric)
            .expect("a scene");
    for (what, scene) in [("slope", &plane), ("pyramids", &pyramids)] {
        let mut first: Option<RenderOutput> = None;
        for seed in [1, 0x1234_5678_9abc_def0] {
            let [a, b] = ["tracer", "referee"].map(|name| render(name, scene, seed));
            assert_eq!(a.beams[0].face, b.beams[0].face, "{what}, seed {seed}");
            assert_eq!(a.returns[0].visible, b.returns[0].visible, "{what}, seed {seed}");
            assert_eq!(a.returns[0].pixel, b.returns[0].pixel, "{what}, seed {seed}");
            let pairs = fluxes(&a.returns[0]).cells().iter().zip(fluxes(&b.returns[0]).cells());
            let worst = pairs.filter(|(a, b)| a != b).map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max);
            println!("{what}, seed {seed}: flux {worst:e}");
            assert!(worst < 1e-12, "{what}, seed {seed}: {worst:e}");
            assert!(total(&a.flux[0]) > 0.0 && total(&a.flux[0]).is_finite());
            if let Some(first) = &first {
                assert_ne!(
                    fluxes(&first.returns[0]),
                    fluxes(&a.returns[0]),
                    "{what}: another seed gives other rays"
                );
            }
            first = Some(a);
            // `scanline` does not support jittered rays: it leaves the returns out.
            let none = render("scanline", scene, seed);
            assert_eq!(none.returns, [Returns::unsupported(96, 12)], "{what}");
            assert!(none.flux.is_empty(), "{what}");
        }
    }
}
