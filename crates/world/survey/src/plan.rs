//! A plan from above: the terrain's outline, the vehicle, and what each sensor sees.

use glam::DVec3;
use raypencil_report::{Anchor, Colour, Drawing, INK, SOFT};
use raypencil_scene::{Pose, Scene, SensorId};

/// Width and height of the page, pixels.
const PAGE_PX: u32 = 420;

/// Room around the plan for axes and the scale bar, pixels.
const MARGIN_PX: f64 = 40.0;

/// The plan shows so many times the distance to which a sensor sees.
const ROOM: f64 = 1.1;

/// Colour of the terrain inside its outline.
const GROUND: Colour = [240, 234, 224];

/// Colour of the camera's field of view.
const CAMERA: Colour = [38, 98, 166];

/// Colour of the beams' fans.
const BEAM: Colour = [190, 50, 50];

/// Number of directions along the far edge of a field of view.
const DIRECTIONS: u32 = 17;

/// A square of the global plane on the page.
struct Window {
    centre: DVec3,
    half_m: f64,
}

impl Window {
    /// Place on the page of a global point: x to the right, y upwards.
    fn at(&self, point: DVec3) -> [f64; 2] {
        let span = f64::from(PAGE_PX) - 2.0 * MARGIN_PX;
        let along = |offset: f64| 0.5 * (1.0 + (offset / self.half_m).clamp(-1.0, 1.0)) * span + MARGIN_PX;
        [along(point.x - self.centre.x), along(self.centre.y - point.y)]
    }
}

/// Draws the plan of a scene; `vehicle` is the vehicle's pose in the global frame. The terrain is the rectangle of its
/// bounds. A field of view reaches to the sensor's maximum range, seen from above.
pub fn plan(scene: &Scene, vehicle: Option<&Pose>) -> Drawing {
    let origin = scene.mesh().origin();
    let camera = scene.camera().scene_from_sensor.position + origin;
    let centre = vehicle.map_or(camera, |vehicle| vehicle.position);
    let bounds = scene.mesh().bounds().map(|bounds| bounds.map(|corner| corner + origin));
    // The plan ends where the sensors' views end, or where the terrain ends.
    let reach = scene.sensors().filter_map(|sensor| scene.max_range(sensor)).fold(0.0, f64::max);
    let farthest = bounds.map_or(reach, |[low, high]| {
        let far = (low - centre).abs().max((high - centre).abs());
        far.x.max(far.y)
    });
    let half_m = (ROOM * reach.min(farthest)).max(1.0);
    let window = Window { centre, half_m };

    let mut page = Drawing::new(PAGE_PX, PAGE_PX, "Plan from above");
    if let Some([low, high]) = bounds {
        let corners = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
        let outline = corners.map(|(x, y)| window.at(DVec3::new(x, y, 0.0)));
        page.polygon(outline.to_vec(), GROUND, Some(SOFT));
    }
    for sensor in scene.sensors() {
        let colour = if sensor == SensorId::Camera { CAMERA } else { BEAM };
        let edge = far_edge(scene, sensor).into_iter().map(|point| window.at(point + origin));
        page.line(edge.collect(), colour, 1.2);
    }
    if let Some(vehicle) = vehicle {
        // An arrow of a twelfth of the plan, along the vehicle's x axis.
        let [forward, left] = [DVec3::X, DVec3::Y].map(|axis| vehicle.rotate(axis) * (half_m / 6.0));
        let at = vehicle.position;
        let corners = [at + forward, at + left * 0.3, at - left * 0.3].map(|corner| window.at(corner));
        page.polygon(corners.to_vec(), INK, None);
    }
    axes(&mut page);
    scale_bar(&mut page, half_m);
    let key = |page: &mut Drawing, x: f64, name: &str, colour| {
        page.text([x, MARGIN_PX - 14.0], name, Anchor::Start, colour);
    };
    key(&mut page, MARGIN_PX, "camera", CAMERA);
    key(&mut page, MARGIN_PX + 70.0, "beams", BEAM);
    key(&mut page, MARGIN_PX + 130.0, "terrain", SOFT);
    page
}

/// Points from a sensor along the far edge of its view and back, scene frame: the ends of rays of its middle row at its
/// maximum range.
fn far_edge(scene: &Scene, sensor: SensorId) -> Vec<DVec3> {
    let (Some((columns, rows)), Some(range)) = (scene.size(sensor), scene.max_range(sensor)) else {
        return Vec::new();
    };
    let column = |k: u32| (u64::from(k) * u64::from(columns - 1) / u64::from(DIRECTIONS - 1)) as u32;
    let rays = (0..DIRECTIONS).filter_map(|k| scene.ray(sensor, column(k), rows / 2));
    let ends: Vec<DVec3> = rays.clone().map(|ray| ray.origin + ray.direction.normalize() * range).collect();
    let start = rays.map(|ray| ray.origin).next();
    start.into_iter().chain(ends).chain(start).collect()
}

/// Arrows of the global x axis, from which headings are counted, and of the y axis.
fn axes(page: &mut Drawing) {
    let (left, low) = (MARGIN_PX * 0.4, f64::from(PAGE_PX) - MARGIN_PX * 0.4);
    let length = 34.0;
    page.line(vec![[left, low], [left + length, low]], SOFT, 1.0);
    page.line(
        vec![[left + length - 5.0, low - 3.0], [left + length, low], [left + length - 5.0, low + 3.0]],
        SOFT,
        1.0,
    );
    page.line(vec![[left, low], [left, low - length]], SOFT, 1.0);
    page.line(
        vec![[left - 3.0, low - length + 5.0], [left, low - length], [left + 3.0, low - length + 5.0]],
        SOFT,
        1.0,
    );
    page.text([left + length + 4.0, low + 4.0], "x, heading 0", Anchor::Start, SOFT);
    page.text([left - 3.0, low - length - 5.0], "y", Anchor::Start, SOFT);
}

/// A bar of a round number of metres, at most a third of the plan long.
fn scale_bar(page: &mut Drawing, half_m: f64) {
    let span = f64::from(PAGE_PX) - 2.0 * MARGIN_PX;
    let longest = 2.0 * half_m / 3.0;
    let mut metres = 1.0;
    // The plan shows 1 m to 1e7 m to each side: steps of 1, 2, 5, 10 ...
    for step in [2.0, 2.5, 2.0].into_iter().cycle().take(30) {
        if metres * step > longest {
            break;
        }
        metres *= step;
    }
    if metres > longest {
        metres = 0.5;
    }
    let right = f64::from(PAGE_PX) - MARGIN_PX;
    let (from, y) = (right - metres / (2.0 * half_m) * span, f64::from(PAGE_PX) - MARGIN_PX * 0.4);
    page.line(vec![[from, y - 4.0], [from, y], [right, y], [right, y - 4.0]], INK, 1.5);
    page.text([0.5 * (from + right), y - 6.0], format!("{metres} m"), Anchor::Middle, INK);
}
