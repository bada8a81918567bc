//! Helpers that the whole-house tests share: meshes and scenes from numbers, rigs by pose, both renderers.

pub mod files;
pub mod fixtures;
pub mod hostile;
pub mod light;
pub mod naive;
pub mod plants;
pub mod quadrature;
pub mod reproducers;
pub mod schema;

use std::sync::Arc;

use glam::DVec3;
pub use raypencil::campaign::cases::{at_origin, lattice, mesh, random, scene};
use raypencil::judge::{Class, SensorResult, Side, compare};
pub use raypencil::rig;
use raypencil::scanline::Scanline;
use raypencil::tracer::Tracer;
use raypencil::{
    FaceId, Hit, Image, Maybe, Mesh, RenderOutput, Renderer, Request, Sample, Scene, SensorId, SensorMap,
};

/// The same ground with other faces on other vertices; materials are of no matter here.
pub fn remeshed(original: &Mesh, vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Arc<Mesh> {
    let kinds = vec![0; faces.len()];
    let materials = original.materials().to_vec();
    Arc::new(Mesh::new(original.origin(), vertices, faces, kinds, materials).expect("a mesh"))
}

/// Every face on three vertices of its own.
pub fn unindexed(original: &Mesh) -> Arc<Mesh> {
    let corners = original.faces().iter().flatten();
    let vertices = corners.map(|&v| original.vertices()[v as usize]).collect();
    let faces = (0..original.faces().len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]);
    remeshed(original, vertices, faces.collect())
}

/// Both renderers, fresh.
pub fn renderers() -> [Box<dyn Renderer>; 2] {
    [Box::new(Scanline::default()), Box::new(Tracer::new())]
}

/// What each renderer makes of a scene, with its name.
pub fn render_both(scene: &Scene) -> [(String, RenderOutput); 2] {
    renderers().map(|renderer| (renderer.name().into(), renderer.render(scene, &Request::EVERYTHING)))
}

/// The whole hit of one cell, or `None`.
///
/// # Panics
/// If the quantities of the cell do not say alike whether there is a hit, or one was not rendered.
pub fn hit(map: &SensorMap, i: u32, j: u32) -> Option<Hit> {
    fn at<T: Sample>(raster: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
        raster.as_ref().expect("every quantity was asked for").at(i, j).get()
    }
    let parts = (
        at(&map.face, i, j),
        at(&map.range, i, j),
        at(&map.point, i, j),
        at(&map.normal, i, j),
        at(&map.depth, i, j),
        at(&map.cos_incidence, i, j),
    );
    match parts {
        (Some(face), Some(range), Some(point), Some(normal), Some(depth), Some(cos_incidence)) => {
            Some(Hit { face, range, point, normal, depth, cos_incidence })
        }
        (None, None, None, None, None, None) => None,
        _ => panic!("{} {i},{j}: half a hit: {parts:?}", map.sensor),
    }
}

/// The cells of a map that hit, in reading order.
pub fn cells_hit(map: &SensorMap) -> Vec<(u32, u32)> {
    let cells = (0..map.height).flat_map(|j| (0..map.width).map(move |i| (i, j)));
    cells.filter(|&(i, j)| hit(map, i, j).is_some()).collect()
}

/// The cells of a map that do not hit, in reading order.
pub fn cells_missed(map: &SensorMap) -> Vec<(u32, u32)> {
    let cells = (0..map.height).flat_map(|j| (0..map.width).map(move |i| (i, j)));
    let range = map.range.as_ref().expect("ranges were asked for");
    cells.filter(|&(i, j)| range.at(i, j).get().is_none()).collect()
}

/// The bits of everything that a frame says, in a fixed order; no hit is all ones.
pub fn bits(output: &RenderOutput) -> Vec<u64> {
    const NOTHING: u64 = u64::MAX;
    fn vector(value: Maybe<DVec3>) -> [u64; 3] {
        value.get().map_or([NOTHING; 3], |v| v.to_array().map(f64::to_bits))
    }
    fn number(value: Maybe<f64>) -> u64 {
        value.get().map_or(NOTHING, f64::to_bits)
    }
    fn cells<T: Copy>(raster: &Option<Image<T>>) -> &[T] {
        raster.as_ref().expect("every quantity was asked for").cells()
    }
    let mut bits = Vec::new();
    for map in output.maps() {
        bits.extend([u64::from(map.width), u64::from(map.height)]);
        bits.extend(cells(&map.range).iter().map(|&value| number(value)));
        bits.extend(cells(&map.depth).iter().map(|&value| number(value)));
        let face = |value: Maybe<FaceId>| value.get().map_or(NOTHING, |face| u64::from(face.0));
        bits.extend(cells(&map.face).iter().map(|&value| face(value)));
        bits.extend(cells(&map.point).iter().flat_map(|&value| vector(value)));
        bits.extend(cells(&map.normal).iter().flat_map(|&value| vector(value)));
        bits.extend(cells(&map.cos_incidence).iter().map(|&value| number(value)));
    }
    bits
}

/// The bits of all that a frame says of light, in a fixed order; what is not there is all ones.
pub fn light_bits(output: &RenderOutput) -> Vec<u64> {
    const NOTHING: u64 = u64::MAX;
    fn numbers(bits: &mut Vec<u64>, image: &Option<Image<Maybe<f64>>>) {
        let cells = image.iter().flat_map(|image| image.cells());
        bits.extend(cells.map(|cell| cell.get().map_or(NOTHING, f64::to_bits)));
    }
    let mut bits = Vec::new();
    for returns in &output.returns {
        bits.extend([u64::from(returns.columns), u64::from(returns.rows)]);
        let visible = returns.visible.iter().flat_map(|image| image.cells());
        bits.extend(visible.map(|&visible| u64::from(visible)));
        let pixels = returns.pixel.iter().flat_map(|image| image.cells());
        let index = |pixel: raypencil::Pixel| u64::from(pixel.i) << 32 | u64::from(pixel.j);
        bits.extend(pixels.map(|pixel| pixel.get().map_or(NOTHING, index)));
        for image in [&returns.depth, &returns.cos_off_axis, &returns.cos_view] {
            numbers(&mut bits, image);
        }
        bits.extend(returns.flux.iter().flat_map(|image| image.cells()).map(|flux| flux.to_bits()));
    }
    for image in &output.flux {
        bits.extend(image.cells().iter().map(|flux| flux.to_bits()));
    }
    bits
}

/// The first cell whose bits differ between two frames of one scene, and what each says of it.
pub fn first_difference(a: &RenderOutput, b: &RenderOutput) -> Option<String> {
    if bits(a) == bits(b) {
        return None;
    }
    let show = |hit: Option<Hit>| format!("{hit:?}");
    for (of_a, of_b) in a.maps().zip(b.maps()) {
        for j in 0..of_a.height {
            for i in 0..of_a.width {
                // `Debug` prints as many digits as tell any two numbers apart.
                let (x, y) = (show(hit(of_a, i, j)), show(hit(of_b, i, j)));
                if x != y {
                    return Some(format!("{} {i},{j}: {x} and {y}", of_a.sensor));
                }
            }
        }
    }
    Some("frames of other sizes".into())
}

/// Compares two frames of a scene; the error lists the first defects.
pub fn agreement(scene: &Scene, a: Side<'_>, b: Side<'_>) -> Result<Vec<SensorResult>, String> {
    let sensors = compare(scene, a, b);
    for sensor in &sensors {
        let classes: u64 = sensor.by_class.iter().sum();
        let (width, height) = scene.size(sensor.sensor).expect("a sensor of this scene");
        let cells = u64::from(width) * u64::from(height);
        if classes != sensor.compared() || sensor.compared() != cells || sensor.not_compared != 0 {
            return Err(format!(
                "{}: of {cells} rays {} compared, {} not; the classes hold {classes}",
                sensor.sensor,
                sensor.compared(),
                sensor.not_compared
            ));
        }
    }
    let defects: u64 = sensors.iter().map(|sensor| sensor.of(Class::Defect)).sum();
    if defects == 0 {
        return Ok(sensors);
    }
    let mut message = format!("{defects} defects\n");
    for defect in sensors.iter().flat_map(|sensor| &sensor.defects).take(5) {
        message += &format!("  {}, {}: {}\n", defect.place, defect.item.quantity, defect.what);
    }
    Err(message)
}

/// The sensors of a scene and the names of its renderers, to go through in a test.
pub fn for_each_map(scene: &Scene, mut visit: impl FnMut(&str, &SensorMap)) {
    for (name, output) in &render_both(scene) {
        for sensor in scene.sensors() {
            let map = output.map(sensor).expect("every sensor was asked for");
            visit(&format!("{name} {sensor}"), map);
        }
    }
}

/// Calls `visit` with each renderer's map of one sensor.
pub fn for_each_map_of(scene: &Scene, sensor: SensorId, mut visit: impl FnMut(&str, &SensorMap)) {
    for (name, output) in &render_both(scene) {
        visit(&format!("{name} {sensor}"), output.map(sensor).expect("every sensor was asked for"));
    }
}
