//! Margins of visibility: they hold, they have witnesses, and two are derived by hand.

use std::sync::Arc;

use crate::splitmix::SplitMix64;
use glam::{DQuat, DVec3};
use raypencil_referee::{Displacement, Margin, Referee, VisibilityMargins};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FluxModel, Lens, Material, Mesh, Mounted, Pixel, Pose, Profile, Scene,
};
use raypencil_terrain::{BUILTIN_NAMES, RandomGround, builtin};

/// Scene number `number`: a built-in ground seen from a mast that carries camera and beam apart, as the default rig
/// does, or a malformed ground with both sensors at random places.
fn scene(number: u64) -> Scene {
    let mut random = SplitMix64(number);
    let is_random = number % 3 == 2;
    let mesh: Mesh = if is_random {
        RandomGround::nasty(number, [200, 1500][number as usize % 2]).build().into_mesh()
    } else {
        builtin(BUILTIN_NAMES[number as usize % BUILTIN_NAMES.len()], 0.25)
            .expect("a built-in name")
            .into_mesh()
    }
    .expect("a valid ground");
    let turned = Pose::from_axis_angle(DVec3::Z, random.between(0.0, 6.3))
        * Pose::from_axis_angle(DVec3::Y, random.between(0.2, 0.7));
    let reach = [0.3, 1.5, 3.0][number as usize / 5 % 3];
    let mut part = |size: f64| random.between(-size, size);
    let wobble = DQuat::from_xyzw(part(0.1), part(0.1), part(0.1), 1.0).normalize();
    let position = DVec3::new(part(3.0), part(3.0), 2.0 + part(0.8));
    let apart = turned.rotation * DVec3::new(part(0.2), part(reach), part(0.7));
    let rotation = (turned * Pose::VEHICLE_FROM_FORWARD_SENSOR).rotation;
    let fine = if number.is_multiple_of(2) { 1 } else { 8 };
    let camera = Camera {
        width: 64,
        height: 48,
        pixel_pitch: [1.9e-4; 2],
        focal_length: 8e-3,
        principal_point: [32.3, 23.8],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 48 * fine,
        rows: 4,
        thickness: [0.005, 0.02, 0.3][number as usize / 3 % 3],
        grid_distance: 0.1,
        half_width: 0.06,
        max_range: 20.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    let camera_pose = Pose { position: position + apart, rotation: wobble * rotation };
    Scene::new(
        Arc::new(mesh),
        Mounted { scene_from_sensor: camera_pose, sensor: camera },
        vec![Mounted { scene_from_sensor: Pose { position, rotation }, sensor: beam }],
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )
    .expect("a valid scene")
}

#[test]
fn margins_hold_are_witnessed_and_are_tight() {
    let (mut seen, mut hidden, mut drawn) = (0u32, 0u32, 0u32);
    let (mut capped, mut witnessed, mut loose, mut without) = (0u32, 0u32, 0u32, 0u32);
    for number in 0..90 {
        let scene = scene(number);
        let referee = Referee::new(&scene);
        let mut random = SplitMix64(number ^ 0xabcd);
        let Beam { columns, rows, .. } = scene.beams()[0].sensor;
        for _ in 0..160 {
            let (i, j) = (random.below(columns), random.below(rows));
            let margins = referee.visibility_margins(0, i, j);
            let own = referee.visibility(0, i, j, Displacement::ZERO);
            assert_eq!(margins.map(|margins| margins.sight), own);
            let Some(VisibilityMargins { sight, visibility, landing }) = margins else { continue };
            assert_eq!(landing.is_some(), sight.pixel.is_some());
            *if sight.visible { &mut seen } else { &mut hidden } += 1;
            let Margin { lo, hi, witness } = visibility;
            assert!(0.0 <= lo && lo <= hi && hi <= 1.0);
            let visible = |dx: f64, dy: f64| {
                referee.visibility(0, i, j, Displacement { dx, dy }).is_some_and(|sight| sight.visible)
            };
            match witness {
                Some(by) => {
                    assert_eq!(by.max_norm(), hi);
                    assert_ne!(visible(by.dx, by.dy), sight.visible, "scene {number} {i},{j} {visibility:?}");
                    witnessed += 1;
                    loose += u32::from(hi > 2.0 * lo && hi > 1e-9);
                }
                None => *if lo >= 1.0 { &mut capped } else { &mut without } += 1,
            }
            // Draw from the whole square and from its sides, where a change would begin; more if there is a change.
            for draw in 0..if lo >= 1.0 { 6 } else { 60 } {
                let mut part = || lo * random.between(-1.0, 1.0);
                let (mut dx, mut dy) = (part(), part());
                match draw % 4 {
                    0 => dx = lo.copysign(dx),
                    1 => dy = lo.copysign(dy),
                    _ => {}
                }
                assert_eq!(
                    visible(dx, dy),
                    sight.visible,
                    "scene {number} {i},{j} {visibility:?} {dx:e} {dy:e}"
                );
                drawn += 1;
            }
        }
    }
    println!(
        "{seen} seen, {hidden} not; {capped} capped, {witnessed} witnessed, {loose} of them loose, {without} \
         without; {drawn} drawn"
    );
    assert!(drawn > 80_000 && hidden > 500 && witnessed > 400, "the scenes hold enough: {drawn} {hidden}");
    // Without a proof remain points where an edge that the beam sees from behind comes out of a surface.
    assert!(loose == 0 && without < 20, "{loose} {without}");
}

/// The plane z = 2, its front towards the origin.
const WALL: [[f32; 3]; 3] = [[-8.0, -8.0, 2.0], [-8.0, 8.0, 2.0], [16.0, 0.0, 2.0]];

/// One pencil at the scene's origin along z, and a camera `apart` metres to its right that also looks along z, with
/// 128 x 64 pixels of 1/64 f. A cell is 1 m wide at z = 1: displaced by dx, the pencil meets the wall at (2 dx, dy /
/// 256, 2).
fn by_hand(faces: &[[[f32; 3]; 3]], apart: f64, principal_point: [f64; 2]) -> Scene {
    let vertices = faces.iter().flatten().copied().collect();
    let count = faces.len();
    let corners = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let materials = vec![Material { name: "wall".into(), reflectivity: 0.5 }];
    let mesh = Mesh::new(DVec3::ZERO, vertices, corners, vec![0; count], materials).expect("a mesh");
    let camera = Camera {
        width: 128,
        height: 64,
        pixel_pitch: [1.0 / 8192.0; 2],
        focal_length: 1.0 / 128.0,
        principal_point,
        aperture: 1.0 / 512.0,
        lens: Lens::CLEAR,
        max_range: 20.0,
    };
    let beam = Beam {
        columns: 1,
        rows: 1,
        thickness: 1.0 / 256.0,
        grid_distance: 0.125,
        half_width: 0.0625,
        max_range: 20.0,
        power: 4.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    let at = |x: f64| Pose::from_position(DVec3::new(x, 0.0, 0.0));
    Scene::new(
        Arc::new(mesh),
        Mounted { scene_from_sensor: at(apart), sensor: camera },
        vec![Mounted { scene_from_sensor: at(0.0), sensor: beam }],
        Atmosphere { attenuation: 0.0 },
        FluxModel::Radiometric,
    )
    .expect("a scene")
}

fn margins(scene: &Scene) -> VisibilityMargins {
    Referee::new(scene).visibility_margins(0, 0, 0).expect("the wall is hit")
}

/// Asserts that a margin contains the derived number, and is tight.
fn assert_holds(margin: Margin, derived: f64) {
    let Margin { lo, hi, witness } = margin;
    assert!(witness.is_some() && lo <= derived && derived <= hi && hi <= 2.0 * lo, "{margin:?} {derived}");
}

#[test]
fn a_shadows_edge_by_hand() {
    let centre = [64.0, 32.0];
    // The way from the camera at (1, 0, 0) to (2 dx, 0, 2) passes z = 1 at x = dx + 1/2. A plate that begins at x =
    // 13/16 there hides all from dx = 5/16 on; the pencil meets the plate itself no sooner than dx = 13/16. The left
    // border of the image is x / z = -1, dx = -1/2.
    let plate = [[0.8125, -1.0, 1.0], [0.8125, 1.0, 1.0], [2.0, 0.0, 1.0]];
    for plate in [plate, [plate[0], plate[2], plate[1]]] {
        let found = margins(&by_hand(&[WALL, plate], 1.0, centre));
        assert!(found.sight.visible);
        assert_holds(found.visibility, 0.3125);
    }
    // The same with many faces between wall and plate in x, beside the rays, so that the hierarchy has the plate in a
    // leaf that the line from the pencil's own point misses.
    let aside = (0..64).map(|k| {
        let x = 0.6 + 0.003 * k as f32;
        [[x, 10.0, 1.0], [x, 10.5, 1.0], [x + 0.002, 10.0, 1.0]]
    });
    let faces: Vec<_> = [WALL, plate].into_iter().chain(aside).collect();
    assert_holds(margins(&by_hand(&faces, 1.0, centre)).visibility, 0.3125);
    // From 1/4 to 2 it hides the pencil itself, up to dx = -1/4; two halves of it hide as one.
    let [a, b, c, d] = [[0.25, -1.0, 1.0], [0.25, 1.0, 1.0], [2.0, 1.0, 1.0], [2.0, -1.0, 1.0]];
    let found = margins(&by_hand(&[WALL, [a, c, b], [a, d, c]], 1.0, centre));
    assert!(!found.sight.visible);
    assert_holds(found.visibility, 0.25);
    // Without a plate only the borders are left: x / z = -1 at dx = -1/2.
    assert_holds(margins(&by_hand(&[WALL], 1.0, centre)).visibility, 0.5);
    // Seen from 1/4 the left border is at dx = -7/8, and the wall is met as far as the cell goes.
    assert_holds(margins(&by_hand(&[WALL], 0.25, centre)).visibility, 0.875);
    // On the border itself a displacement of nothing will do.
    let found = margins(&by_hand(&[WALL], 2.0, centre));
    assert!(found.sight.visible && found.visibility.lo == 0.0 && found.visibility.hi <= 1e-9);
}

#[test]
fn a_landing_by_hand() {
    // (-1, 0, 2) from the camera lands at f X / Z / p = -32 pixels from the principal point: at (32.25, 32.375), a
    // quarter of a pixel from the left border of column 32.
    let found = margins(&by_hand(&[WALL], 1.0, [64.25, 32.375]));
    assert_eq!(found.sight.pixel, Some(Pixel { i: 32, j: 32 }));
    let [low, high] = found.landing.expect("a pixel");
    assert!(low <= 0.25 && 0.25 <= high && high - low < 1e-15, "{low} {high}");
    // On a border.
    assert_eq!(margins(&by_hand(&[WALL], 1.0, [64.0, 32.5])).landing, Some([0.0; 2]));
    // Left of the image.
    assert_eq!(margins(&by_hand(&[WALL], 2.5, [64.0, 32.0])).landing, None);
}

#[test]
fn the_landing_contains_the_exact_distance() {
    let mut random = SplitMix64(11);
    for _ in 0..2000 {
        // -32 apart from the principal point, in whole 1/2^20: all of it is exact in f64.
        let whole = |random: &mut SplitMix64, from: u32, to: u32| {
            f64::from((from << 20) + random.below((to - from) << 20)) / f64::from(1 << 20)
        };
        let apart = whole(&mut random, 0, 1);
        let centre = [whole(&mut random, 40, 90), whole(&mut random, 5, 60)];
        let found = margins(&by_hand(&[WALL], apart, centre));
        let from_border = |at: f64| (at - at.floor()).min(at.ceil() - at);
        let exact = from_border(centre[0] - 32.0 * apart).min(from_border(centre[1]));
        let [low, high] = found.landing.expect("a pixel");
        assert!(low <= exact && exact <= high && high - low <= 2e-15 * exact, "{low} {exact} {high}");
    }
}
