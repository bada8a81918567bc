//! Draws `docs/figures/eq1-along-stripe.svg`: the flux of the pencils along a stripe on flat ground with both flux
//! models, each divided by its maximum, and the quotient of both.
//!
//! ```text
//! cargo run --release -p raypencil --features examples --example eq1_along_stripe > docs/figures/eq1-along-stripe.svg
//! ```

use std::sync::Arc;

use glam::DVec3;
use raypencil::io::{Overrides, load};
use raypencil::scanline::Scanline;
use raypencil::{FluxModel, Material, Mesh, Renderer, Request, Scene};

/// Width of the chart's box, SVG units.
const WIDTH: f64 = 720.0;

/// Height of the chart's box, SVG units.
const HEIGHT: f64 = 300.0;

/// Left margin, SVG units.
const LEFT: f64 = 60.0;

/// Top margin, SVG units.
const TOP: f64 = 20.0;

/// Right margin with the legend, SVG units.
const RIGHT: f64 = 170.0;

/// Bottom margin, SVG units.
const BOTTOM: f64 = 50.0;

fn main() {
    // The default rig on level ground instead of the pyramids.
    let rig = load("pyramids", &Overrides::default()).expect("a built-in scene").scene;
    let vertices = vec![[-50.0, -50.0, 0.0], [50.0, -50.0, 0.0], [50.0, 50.0, 0.0], [-50.0, 50.0, 0.0]];
    let ground = vec![Material { name: "ground".into(), reflectivity: 0.25 }];
    let mesh =
        Mesh::new(DVec3::ZERO, vertices, vec![[0, 1, 2], [0, 2, 3]], vec![0; 2], ground).expect("a mesh");
    let mesh = Arc::new(mesh);
    let flux = |model: FluxModel| -> Vec<f64> {
        let scene =
            Scene::new(Arc::clone(&mesh), *rig.camera(), rig.beams().to_vec(), rig.atmosphere(), model)
                .expect("a scene");
        let output = Scanline::default().render(&scene, &Request::EVERYTHING);
        let flux = output.returns[0].flux.as_ref().expect("the renderer has flux");
        (0..flux.width()).map(|i| flux.at(i, flux.height() / 2)).collect()
    };
    let (radiometric, eq1) = (flux(FluxModel::Radiometric), flux(FluxModel::Eq1));
    // The ends of the stripe are outside the camera's view.
    let seen: Vec<usize> = (0..radiometric.len()).filter(|&i| radiometric[i] > 0.0).collect();
    let (radiometric, eq1): (Vec<f64>, Vec<f64>) = seen.iter().map(|&i| (radiometric[i], eq1[i])).unzip();
    let quotient: Vec<f64> = radiometric.iter().zip(&eq1).map(|(a, b)| b / a).collect();
    let beam = &rig.beams()[0].sensor;
    let angles: Vec<f64> = seen
        .iter()
        .map(|&i| {
            let direction = beam.direction(i as u32);
            libm::atan2(direction.x, direction.z).to_degrees()
        })
        .collect();
    println!(
        "{}",
        figure(
            &angles,
            &[
                ("radiometric", "#0072b2", &radiometric),
                ("eq1", "#d55e00", &eq1),
                ("eq1 / radiometric", "#555555", &quotient)
            ]
        )
    );
    let range = |values: &[f64]| {
        values.iter().fold([f64::INFINITY, 0.0_f64], |[low, high], v| [low.min(*v), high.max(*v)])
    };
    for (name, values) in
        [("radiometric, W", &radiometric), ("eq1, W/m", &eq1), ("eq1 / radiometric, 1/m", &quotient)]
    {
        let [low, high] = range(values);
        eprintln!("{name}: {low:e} to {high:e}, {:.4}-fold", high / low);
    }
}

/// The SVG: the curves over the angle in degrees, each divided by its maximum.
fn figure(angles: &[f64], curves: &[(&str, &str, &Vec<f64>)]) -> String {
    let (first, last) = (angles[0], angles[angles.len() - 1]);
    let x = |angle: f64| LEFT + WIDTH * (angle - first) / (last - first);
    let low = 0.3;
    let y = |share: f64| TOP + HEIGHT * (1.0 - (share - low) / (1.0 - low));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        LEFT + WIDTH + RIGHT,
        TOP + HEIGHT + BOTTOM
    );
    for tick in (-30..=30).step_by(10) {
        let at = x(f64::from(tick).clamp(first, last));
        svg += &format!(
            "<path d=\"M{at:.1} {TOP}V{:.1}\" stroke=\"#dddddd\"/><text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{tick}</text>\n",
            TOP + HEIGHT,
            TOP + HEIGHT + 18.0
        );
    }
    for tenth in 3..=10 {
        let at = y(f64::from(tenth) / 10.0);
        svg += &format!(
            "<path d=\"M{LEFT} {at:.1}H{:.1}\" stroke=\"#dddddd\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{:.1}</text>\n",
            LEFT + WIDTH,
            LEFT - 8.0,
            at + 4.0,
            f64::from(tenth) / 10.0
        );
    }
    svg += &format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">angle of the pencil to the beam's axis, degrees</text>\n",
        LEFT + WIDTH / 2.0,
        TOP + HEIGHT + 40.0
    );
    for (index, (name, colour, values)) in curves.iter().enumerate() {
        let max = values.iter().fold(0.0_f64, |max, value| max.max(*value));
        // Every fourth pencil gives a curve that is smooth enough.
        let points: Vec<String> = angles
            .iter()
            .zip(values.iter())
            .step_by(4)
            .map(|(angle, value)| format!("{:.1},{:.1}", x(*angle), y(value / max)))
            .collect();
        let line = TOP + 20.0 + 22.0 * index as f64;
        svg += &format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>\n\
             <path d=\"M{:.1} {line:.1}h18\" stroke=\"{colour}\" stroke-width=\"3\"/><text x=\"{:.1}\" y=\"{:.1}\">{name}</text>\n",
            points.join(" "),
            LEFT + WIDTH + 12.0,
            LEFT + WIDTH + 36.0,
            line + 4.0
        );
    }
    svg + "</svg>"
}
