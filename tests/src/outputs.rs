//! Both renderers and their outputs: hits, bits, differences.

use raypencil::scanline::Scanline;
use raypencil::tracer::Tracer;
use raypencil::{
    Hit, HitQuantity, HitRaster, HitValue, Image, Maybe, Pixel, RenderOutput, Renderer, Request, Scene,
    SensorId, SensorMap,
};

/// New instances of both renderers.
pub fn renderers() -> [Box<dyn Renderer>; 2] {
    [Box::new(Scanline::default()), Box::new(Tracer::new())]
}

/// The output of each renderer for a scene, with its name.
pub fn render_both(scene: &Scene) -> [(String, RenderOutput); 2] {
    renderers().map(|renderer| (renderer.name().into(), renderer.render(scene, &Request::EVERYTHING)))
}

/// The hit of one cell with all its quantities, or `None`.
///
/// # Panics
/// If only some quantities of the cell have a value, or if one was not rendered.
pub fn hit(map: &SensorMap, i: u32, j: u32) -> Option<Hit> {
    let face = map.face.as_ref().expect("every quantity was asked for").at(i, j).get();
    let values = HitQuantity::ALL.map(|quantity| {
        let raster = map.raster(quantity).expect("every quantity was asked for");
        (quantity, raster.at(i, j))
    });
    let is_like_face = |(_, value): &(HitQuantity, Option<HitValue>)| value.is_some() == face.is_some();
    assert!(
        values.iter().all(is_like_face),
        "{} {i},{j}: some quantities have a value, others have none: {face:?}, {values:?}",
        map.sensor
    );
    map.hit(i, j)
}

/// The cells of a map with a hit, in reading order.
pub fn cells_hit(map: &SensorMap) -> Vec<(u32, u32)> {
    let cells = (0..map.height).flat_map(|j| (0..map.width).map(move |i| (i, j)));
    cells.filter(|&(i, j)| hit(map, i, j).is_some()).collect()
}

/// The cells of a map without a hit, in reading order.
pub fn cells_missed(map: &SensorMap) -> Vec<(u32, u32)> {
    let cells = (0..map.height).flat_map(|j| (0..map.width).map(move |i| (i, j)));
    let range = map.range.as_ref().expect("ranges were asked for");
    cells.filter(|&(i, j)| range.at(i, j).get().is_none()).collect()
}

/// The bits of all maps of an output, in a fixed order. A miss is all ones.
pub fn bits(output: &RenderOutput) -> Vec<u64> {
    const NOTHING: u64 = u64::MAX;
    let mut bits = Vec::new();
    for map in output.maps() {
        bits.extend([u64::from(map.width), u64::from(map.height)]);
        for quantity in HitQuantity::ALL {
            match map.raster(quantity).expect("every quantity was asked for") {
                HitRaster::Scalar(image) => {
                    bits.extend(image.cells().iter().map(|cell| cell.get().map_or(NOTHING, f64::to_bits)));
                }
                HitRaster::Vector(image) => bits.extend(image.cells().iter().flat_map(|cell| {
                    cell.get().map_or([NOTHING; 3], |vector| vector.to_array().map(f64::to_bits))
                })),
            }
            // Faces come after the two lengths, as in the committed digests.
            if quantity == HitQuantity::Depth {
                let faces = map.face.as_ref().expect("every quantity was asked for").cells();
                bits.extend(faces.iter().map(|face| face.get().map_or(NOTHING, |face| u64::from(face.0))));
            }
        }
    }
    bits
}

/// The bits of all light of an output, in a fixed order. An absent value is all ones.
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
        let index = |pixel: Pixel| u64::from(pixel.i) << 32 | u64::from(pixel.j);
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

/// The first cell with different bits in two outputs of one scene, and both hits.
pub fn first_difference(a: &RenderOutput, b: &RenderOutput) -> Option<String> {
    if bits(a) == bits(b) {
        return None;
    }
    let show = |hit: Option<Hit>| format!("{hit:?}");
    for (of_a, of_b) in a.maps().zip(b.maps()) {
        for j in 0..of_a.height {
            for i in 0..of_a.width {
                // `Debug` prints enough digits to distinguish any two numbers.
                let (x, y) = (show(hit(of_a, i, j)), show(hit(of_b, i, j)));
                if x != y {
                    return Some(format!("{} {i},{j}: {x} and {y}", of_a.sensor));
                }
            }
        }
    }
    Some("outputs of different sizes".into())
}

/// Calls `visit` with each map of each renderer, and with the names of renderer and sensor.
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
