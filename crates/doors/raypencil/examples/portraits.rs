//! Draws `docs/figures/ground-NAME.svg`: each preset of generated terrain under a low sun, from above and as a camera
//! 1.8 m above it sees it.
//!
//! ```text
//! cargo run --release -p raypencil --features examples --example portraits -- docs/figures
//! ```

use std::path::PathBuf;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DQuat, DVec2, DVec3};
use raypencil::io::write_atomically;
use raypencil::terrain::{MarsGround, PRESET_NAMES, height_at};
use raypencil::tracer::Tracer;
use raypencil::{
    Atmosphere, Camera, FluxModel, Mesh, Mounted, Pose, Renderer, Request, Scene, SensorId, SensorMap, rig,
};

/// Seed of all terrains.
const SEED: u64 = 7;

/// Height of both pictures, pixels.
const HEIGHT: u32 = 420;

/// Width of the camera's picture, pixels.
const VIEW_WIDTH: u32 = 760;

/// Supersampling: each pixel is the mean of a square with this many rays on each side.
const RAYS_PER_PIXEL_SIDE: u32 = 3;

const SUN_ELEVATION_DEG: f64 = 22.0;

/// Azimuth of the sun, degrees to the left of the x axis: behind the camera to its left.
const SUN_AZIMUTH_DEG: f64 = 140.0;

/// Angle of the camera's view to the left of the x axis, degrees, where there is no crevasse: not exactly along a line of
/// posts.
const YAW_DEG: f64 = 8.0;

/// Distance of the camera from the crevasse that it looks at, metres.
const CREVASSE_DISTANCE_M: f64 = 3.5;

/// Light of the sky relative to that of the sun.
const SKY_LIGHT: f64 = 0.18;

/// Distance of the shadow map's camera, metres.
const SUN_DISTANCE_M: f64 = 2_000.0;

/// Side length of the shadow map, pixels.
const SHADOW_MAP_SIDE: u32 = 4_096;

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).expect("a folder to write to"));
    for &name in PRESET_NAMES {
        let ground = MarsGround::preset(name, SEED).expect("a preset");
        let extent = ground.extent;
        let mesh = Arc::new(ground.build().expect("a ground").into_mesh().expect("a mesh"));
        let figure = figure(name, extent, &mesh);
        let path = folder.join(format!("ground-{name}.svg"));
        write_atomically(&path, |file| file.write_all(figure.as_bytes())).expect("a folder to write to");
        println!("{}: {} faces, {} kB", path.display(), mesh.faces().len(), figure.len() / 1000);
    }
}

/// The SVG: both pictures under a title, with the scale of the picture from above.
fn figure(name: &str, extent: f64, mesh: &Arc<Mesh>) -> String {
    let tracer = Tracer::new();
    let sun = Sun::new(mesh, &tracer, extent);
    let above = {
        let side = HEIGHT * RAYS_PER_PIXEL_SIDE;
        let distance = 1_000.0;
        // The terrain's side fills the picture at the height of the origin.
        let pitch = 1e-5;
        let focal_length = distance * f64::from(side) * pitch / extent;
        let camera = Camera { max_range: 2.0 * distance, ..rig::camera(side, side, pitch, focal_length) };
        // Looks down with y upwards: the sensor's x is the scene's x, its y the scene's -y.
        let rotation = DQuat::from_rotation_x(std::f64::consts::PI);
        let pose = Pose { position: DVec3::new(0.0, 0.0, distance), rotation };
        picture(mesh, &tracer, &sun, Mounted { scene_from_sensor: pose, sensor: camera })
    };
    let (eye, heading) = eye(mesh);
    let seen = {
        let (width, height) = (VIEW_WIDTH * RAYS_PER_PIXEL_SIDE, HEIGHT * RAYS_PER_PIXEL_SIDE);
        // 70 degrees across.
        let pitch = 1e-5;
        let focal_length = 0.5 * f64::from(width) * pitch / libm::tan(35_f64.to_radians());
        let camera = Camera { max_range: 1e3, ..rig::camera(width, height, pitch, focal_length) };
        let above = height_at(mesh, eye.x, eye.y).expect("ground under the camera") + 1.8;
        let turned = Pose { position: eye.extend(above), ..Pose::from_axis_angle(DVec3::Z, heading) };
        let pitched = rig::pitched(DVec3::ZERO, 12_f64.to_radians(), camera);
        let scene_from_sensor = turned * pitched.scene_from_sensor;
        picture(mesh, &tracer, &sun, Mounted { scene_from_sensor, ..pitched })
    };
    let (top, gap) = (26, 16);
    let (all_wide, all_high) = (HEIGHT + gap + VIEW_WIDTH, top + HEIGHT + 40);
    let bar = 10.0 / extent * f64::from(HEIGHT);
    let base = top + HEIGHT;
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {all_wide} {all_high}" font-family="sans-serif" font-size="14">
<rect width="100%" height="100%" fill="#fff"/>
<text x="0" y="17" font-weight="bold">{name}, seed {SEED}: {faces} faces on {extent} x {extent} m</text>
<image x="0" y="{top}" width="{HEIGHT}" height="{HEIGHT}" href="data:image/png;base64,{above}"/>
<image x="{left}" y="{top}" width="{VIEW_WIDTH}" height="{HEIGHT}" href="data:image/png;base64,{seen}"/>
<path d="M1 {tick} v8 M1 {bar_y} h{bar:.1} m0 -4 v8" stroke="#000" stroke-width="2" fill="none"/>
<text x="{bar_text:.1}" y="{text_y}">10 m; x to the right, y up</text>
<text x="{left}" y="{text_y}">from ({x:.1}, {y:.1}), 1.8 m above ground, {yaw:.0} degrees left of x, 12 degrees down, 70 degrees across; sun {sun_high} degrees high</text>
</svg>
"##,
        faces = mesh.faces().len(),
        above = STANDARD.encode(above),
        seen = STANDARD.encode(seen),
        left = HEIGHT + gap,
        tick = base + 12,
        bar_y = base + 16,
        bar_text = bar + 10.0,
        text_y = base + 21,
        sun_high = SUN_ELEVATION_DEG,
        x = eye.x,
        y = eye.y,
        yaw = heading.to_degrees(),
    )
}

/// Place of the camera, and the angle of its view to the left of the x axis, radians: in the middle of the ground, or
/// before the nearest crevasse.
fn eye(mesh: &Mesh) -> (DVec2, f64) {
    let is_wall = |kind: u16| mesh.materials()[usize::from(kind)].name == "crevasse wall";
    let walls = mesh.faces().iter().zip(mesh.face_materials()).filter(|(_, kind)| is_wall(**kind));
    let corners = walls.flat_map(|(face, _)| {
        face.map(|vertex| {
            let [x, y, _] = mesh.vertices()[vertex as usize].map(f64::from);
            DVec2::new(x, y)
        })
    });
    match corners.min_by(|a, b| a.length().total_cmp(&b.length())) {
        None => (DVec2::ZERO, YAW_DEG.to_radians()),
        Some(wall) => {
            let distance = (wall.length() - CREVASSE_DISTANCE_M).max(0.0);
            (wall.normalize() * distance, libm::atan2(wall.y, wall.x))
        }
    }
}

/// A scene of a mesh and a camera, and the camera's map.
fn map_of(mesh: &Arc<Mesh>, tracer: &Tracer, camera: Mounted<Camera>) -> (Scene, SensorMap) {
    let clear = Atmosphere { attenuation: 0.0 };
    let scene =
        Scene::new(Arc::clone(mesh), camera, Vec::new(), clear, FluxModel::Radiometric).expect("a scene");
    let mut output = tracer.render(&scene, &Request::MAPS);
    let map = output.camera.take().expect("a camera has a map");
    (scene, map)
}

/// The sun's direction, and a shadow map: the ranges that a camera at the sun sees.
struct Sun {
    direction: DVec3,
    camera: Mounted<Camera>,
    map: SensorMap,
}

impl Sun {
    fn new(mesh: &Arc<Mesh>, tracer: &Tracer, extent: f64) -> Self {
        let (elevation, azimuth) = (SUN_ELEVATION_DEG.to_radians(), SUN_AZIMUTH_DEG.to_radians());
        let ((sin_h, cos_h), (sin_s, cos_s)) = (libm::sincos(elevation), libm::sincos(azimuth));
        let direction = DVec3::new(cos_h * cos_s, cos_h * sin_s, sin_h);
        let pitch = 1e-5;
        // As wide as the terrain's diagonal.
        let focal_length = SUN_DISTANCE_M * f64::from(SHADOW_MAP_SIDE) * pitch / (1.5 * extent);
        let sensor = Camera {
            max_range: 2.0 * SUN_DISTANCE_M,
            ..rig::camera(SHADOW_MAP_SIDE, SHADOW_MAP_SIDE, pitch, focal_length)
        };
        // z points to the ground, y down in the picture.
        let z = -direction;
        let x = z.cross(DVec3::Z).normalize();
        let rotation = DQuat::from_mat3(&glam::DMat3::from_cols(x, z.cross(x), z));
        let pose = Pose { position: direction * SUN_DISTANCE_M, rotation };
        let camera = Mounted { scene_from_sensor: pose, sensor };
        let (_, map) = map_of(mesh, tracer, camera);
        Self { direction, camera, map }
    }

    fn lights(&self, point: DVec3, normal: DVec3) -> bool {
        let camera = &self.camera.sensor;
        // A point slightly above the surface, since a texel of the shadow map is 1.5 cm wide.
        let local = self.camera.scene_from_sensor.inverse();
        let lifted = point + normal * 0.02;
        let local = local.position + local.rotate(lifted);
        let at = |axis: usize, coordinate: f64| {
            let pixels = camera.focal_length * coordinate / local.z / camera.pixel_pitch[axis];
            (pixels + camera.principal_point[axis]).floor()
        };
        let (i, j) = (at(0, local.x), at(1, local.y));
        let side = f64::from(SHADOW_MAP_SIDE);
        if !((0.0..side).contains(&i) && (0.0..side).contains(&j)) {
            return true;
        }
        let range = self.map.range.as_ref().and_then(|range| range.at(i as u32, j as u32).get());
        range.is_none_or(|nearest| local.length() < nearest + 0.03)
    }
}

/// The shaded view of a camera, as an indexed PNG.
fn picture(mesh: &Arc<Mesh>, tracer: &Tracer, sun: &Sun, camera: Mounted<Camera>) -> Vec<u8> {
    let (scene, map) = map_of(mesh, tracer, camera);
    let (width, height) = scene.size(SensorId::Camera).expect("there is a camera");
    let [points, normals] = [map.point.as_ref(), map.normal.as_ref()].map(|map| map.expect("all quantities"));
    let faces = map.face.as_ref().expect("all quantities");
    let bright = |i: u32, j: u32| {
        let (point, normal, face) = (points.at(i, j).get()?, normals.at(i, j).get()?, faces.at(i, j).get()?);
        let kind = mesh.face_materials()[face.0 as usize];
        let reflectivity = mesh.materials()[usize::from(kind)].reflectivity;
        let direct = normal.dot(sun.direction).max(0.0);
        let direct = if direct > 0.0 && sun.lights(point, normal) { direct } else { 0.0 };
        // Faces that look up get more light from the sky.
        let sky = SKY_LIGHT * (0.6 + 0.4 * normal.z);
        Some((direct + sky) * reflectivity)
    };
    let shades: Vec<Vec<Option<f64>>> =
        (0..height).map(|j| (0..width).map(|i| bright(i, j)).collect()).collect();
    // Level soil in full sun is at about two thirds of the scale.
    let full = 0.25 * (sun.direction.z + SKY_LIGHT) * 1.6;
    let (columns, rows) = (width / RAYS_PER_PIXEL_SIDE, height / RAYS_PER_PIXEL_SIDE);
    let mut cells = Vec::with_capacity((columns * rows) as usize);
    for j in 0..rows {
        for i in 0..columns {
            let block = (0..RAYS_PER_PIXEL_SIDE * RAYS_PER_PIXEL_SIDE).map(|k| {
                shades[(j * RAYS_PER_PIXEL_SIDE + k / RAYS_PER_PIXEL_SIDE) as usize]
                    [(i * RAYS_PER_PIXEL_SIDE + k % RAYS_PER_PIXEL_SIDE) as usize]
            });
            let (mut sum, mut ground) = (0.0, 0_u32);
            for shade in block.flatten() {
                // The square root approximates the screen's gamma.
                sum += (shade / full).min(1.0).sqrt();
                ground += 1;
            }
            let is_ground = 2 * ground >= RAYS_PER_PIXEL_SIDE * RAYS_PER_PIXEL_SIDE;
            cells.push(if is_ground { (sum / f64::from(ground) * 250.0).round() as u8 } else { 255 });
        }
    }
    encode(columns, rows, &cells)
}

/// Encodes the picture with a palette of browns for the ground and one colour for the sky.
fn encode(width: u32, height: u32, cells: &[u8]) -> Vec<u8> {
    let shade = |index: u8| {
        let t = f64::from(index) / 250.0;
        // From a dark brown to a light butterscotch.
        [(22.0, 238.0), (13.0, 190.0), (9.0, 140.0)]
            .map(|(dark, light): (f64, f64)| (dark + (light - dark) * t).min(255.0) as u8)
    };
    let palette: Vec<u8> = (0..255).flat_map(shade).chain([214, 186, 150]).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("a picture");
    writer.write_image_data(cells).expect("as many cells as the picture has");
    writer.finish().expect("writing to memory");
    bytes
}
