//! A picture of a scene from above and from the side: the ground, the sensors, where the beams meet the ground, and what the
//! camera looks at.

use glam::DVec3;
use raypencil_report::{Anchor, Colour, Drawing, INK, SOFT, axis_from_offset, draw_axes};
use raypencil_scene::{Progress, Renderer, Request, Scene, SensorMap};
use raypencil_tracer::Tracer;

/// Size of each of the two views, pixels.
const VIEW_PX: [f64; 2] = [720.0, 420.0];

/// Left and upper margin of a view, pixels.
const MARGIN_PX: [f64; 2] = [76.0, 46.0];

/// Height of a view with its axes, pixels.
const STEP_PX: f64 = 520.0;

/// Width of a sensor's name above a view, pixels.
const NAME_PX: f64 = 66.0;

/// Maximum number of points that are drawn of a sensor.
const MAX_POINTS: usize = 1500;

/// Colours of the camera and of the beams in turn.
const COLOURS: [Colour; 5] = [[0, 90, 200], [200, 40, 40], [230, 140, 0], [20, 140, 90], [130, 60, 170]];

const GROUND: Colour = [225, 219, 206];

/// One of the two views: the axes of the scene that run to the right and upwards.
struct View {
    name: &'static str,
    axes: [usize; 2],
    names: [&'static str; 2],
}

const VIEWS: [View; 2] = [
    View { name: "from above", axes: [0, 1], names: ["x", "y"] },
    View { name: "from the right side", axes: [0, 2], names: ["x", "z"] },
];

/// What is drawn of a sensor: its name, its place, and the points that its rays meet, in the global frame.
struct Marks {
    name: String,
    position: DVec3,
    points: Vec<DVec3>,
}

/// Draws a scene. Its rays are traced, so that the picture shows what is hit and not what was meant to be.
pub fn scene_picture(scene: &Scene, title: &str, progress: &dyn Progress) -> Drawing {
    progress.stage("tracing the rays");
    let output = Tracer::default().render(scene, &Request::MAPS);
    progress.stage("drawing");
    let origin = scene.mesh().origin();
    let points = |map: &SensorMap| -> Vec<DVec3> {
        let Some(points) = &map.point else { return Vec::new() };
        let hits: Vec<DVec3> = points.cells().iter().filter_map(|point| point.get()).collect();
        hits.iter().step_by(hits.len().div_ceil(MAX_POINTS).max(1)).map(|point| *point + origin).collect()
    };
    let camera = output.camera.as_ref().map(|map| Marks {
        name: "camera".into(),
        position: scene.camera().scene_from_sensor.position + origin,
        points: points(map),
    });
    let beams = output.beams.iter().zip(scene.beams()).enumerate().map(|(index, (map, beam))| Marks {
        name: format!("beam {index}"),
        position: beam.scene_from_sensor.position + origin,
        points: points(map),
    });
    let sensors: Vec<Marks> = camera.into_iter().chain(beams).collect();

    let mut drawing = Drawing::new(
        (MARGIN_PX[0] + VIEW_PX[0] + 24.0) as u32,
        (MARGIN_PX[1] + 2.0 * STEP_PX) as u32,
        &format!("{title}: rig and ground"),
    );
    for (index, view) in VIEWS.iter().enumerate() {
        draw_view(&mut drawing, view, [MARGIN_PX[0], MARGIN_PX[1] + index as f64 * STEP_PX], scene, &sensors);
    }
    drawing
}

/// The interval of an axis that is shown: all sensors and all that they meet.
fn interval(sensors: &[Marks], axis: usize) -> [f64; 2] {
    let of = |sensor: &Marks| {
        sensor.points.iter().chain([&sensor.position]).map(|point| point[axis]).collect::<Vec<f64>>()
    };
    let all: Vec<f64> = sensors.iter().flat_map(of).collect();
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Room around them, and around a single point.
    let room = 0.08 * (high - low) + 0.25;
    [low - room, high + room]
}

fn draw_view(drawing: &mut Drawing, view: &View, at: [f64; 2], scene: &Scene, sensors: &[Marks]) {
    let [x, y] = view.axes.map(|axis| interval(sensors, axis));
    // One scale for both axes, so that angles are true: the shorter interval is widened.
    let metres = ((x[1] - x[0]) / VIEW_PX[0]).max((y[1] - y[0]) / VIEW_PX[1]);
    let widened = |[low, high]: [f64; 2], pixels: f64| {
        let (middle, half) = (0.5 * (low + high), 0.5 * metres * pixels);
        [middle - half, middle + half]
    };
    let (x, y) = (widened(x, VIEW_PX[0]), widened(y, VIEW_PX[1]));
    let place = |point: DVec3| {
        [
            at[0] + (point[view.axes[0]] - x[0]) / metres,
            at[1] + VIEW_PX[1] - (point[view.axes[1]] - y[0]) / metres,
        ]
    };
    let inside = |[px, py]: [f64; 2]| {
        (at[0]..=at[0] + VIEW_PX[0]).contains(&px) && (at[1]..=at[1] + VIEW_PX[1]).contains(&py)
    };
    let frame = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let frame = frame.map(|[u, v]| [at[0] + u * VIEW_PX[0], at[1] + v * VIEW_PX[1]]);
    drawing.polygon(frame.to_vec(), [255, 255, 255], Some(SOFT));
    draw_ground(drawing, scene, &place, &inside);
    for (index, sensor) in sensors.iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        for point in sensor.points.iter().map(|point| place(*point)).filter(|point| inside(*point)) {
            drawing.polygon(square(point, 1.2), colour, None);
        }
    }
    for (index, sensor) in sensors.iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        drawing.polygon(square(place(sensor.position), 5.0), colour, Some(INK));
        // Sensors lie close together, so their names stand above the view.
        let x = at[0] + VIEW_PX[0] - NAME_PX * (sensors.len() - 1 - index) as f64;
        drawing.text([x, at[1] - 12.0], &sensor.name, Anchor::End, colour);
    }
    drawing.text([at[0], at[1] - 12.0], view.name, Anchor::Start, INK);
    // Ticks of rows are counted from above.
    let (columns, across) = axis_from_offset(view.names[0], "m", x, 8);
    let (mut rows, upwards) = axis_from_offset(view.names[1], "m", y, 6);
    rows.iter_mut().for_each(|tick| tick.at = 1.0 - tick.at);
    draw_axes(drawing, at, VIEW_PX, columns, rows, [&across, &upwards]);
}

/// The ground: each face that lies wholly in the view, or of a large ground a share of its vertices.
fn draw_ground(
    drawing: &mut Drawing,
    scene: &Scene,
    place: &dyn Fn(DVec3) -> [f64; 2],
    inside: &dyn Fn([f64; 2]) -> bool,
) {
    /// Faces up to which each is drawn.
    const MAX_FACES: usize = 4000;
    /// Vertices that are drawn of a larger ground.
    const MAX_VERTICES: usize = 12_000;
    let mesh = scene.mesh();
    let vertex = |index: u32| {
        let [x, y, z] = mesh.vertices()[index as usize];
        place(DVec3::new(x.into(), y.into(), z.into()) + mesh.origin())
    };
    if mesh.faces().len() <= MAX_FACES {
        for face in mesh.faces() {
            let corners = face.map(vertex);
            if corners.iter().all(|corner| inside(*corner)) {
                drawing.polygon(corners.to_vec(), GROUND, Some([196, 188, 172]));
            }
        }
        return;
    }
    let count = mesh.vertices().len();
    for index in (0..count).step_by(count.div_ceil(MAX_VERTICES).max(1)) {
        let at = vertex(index as u32);
        if inside(at) {
            drawing.polygon(square(at, 0.8), [196, 188, 172], None);
        }
    }
}

fn square([x, y]: [f64; 2], half: f64) -> Vec<[f64; 2]> {
    vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]]
}

#[cfg(test)]
mod tests {
    use raypencil_scene::Silent;
    use raypencil_scene_io::{Overrides, load};

    use super::*;

    #[test]
    fn the_rig_lies_behind_what_its_beams_meet_and_above_it() {
        let scene = load("pyramids", &Overrides::default()).unwrap().scene;
        let drawing = scene_picture(&scene, "pyramids", &Silent);
        let svg = drawing.svg();
        for word in
            ["from above", "from the right side", "x, m", "y, m", "z, m", "camera", "beam 0", "beam 1"]
        {
            assert!(svg.contains(word), "{word}");
        }
        // In each view the points of a beam lie to the right of its own square: the rig looks along x.
        let squares = |colour: Colour, half: f64| -> Vec<[f64; 2]> {
            let of = |mark: &raypencil_report::Mark| match mark {
                raypencil_report::Mark::Polygon { points, fill, .. }
                    if *fill == colour && (points[1][0] - points[0][0] - 2.0 * half).abs() < 1e-6 =>
                {
                    Some([points[0][0] + half, points[0][1] + half])
                }
                _ => None,
            };
            drawing.marks.iter().filter_map(of).collect()
        };
        let (rig, hits) = (squares(COLOURS[1], 5.0), squares(COLOURS[1], 1.2));
        assert_eq!(rig.len(), 2);
        assert!(hits.len() > 1000, "{}", hits.len());
        let below_first_view = MARGIN_PX[1] + VIEW_PX[1] + 1.0;
        for (place, is_side) in [(rig[0], false), (rig[1], true)] {
            let of_view: Vec<&[f64; 2]> =
                hits.iter().filter(|hit| (hit[1] > below_first_view) == is_side).collect();
            assert!(of_view.len() > 500 && of_view.iter().all(|hit| hit[0] > place[0]));
            // From the side the points lie lower on the page than the rig, which stands 1.8 m above the ground.
            assert!(!is_side || of_view.iter().all(|hit| hit[1] > place[1]));
        }
    }
}
