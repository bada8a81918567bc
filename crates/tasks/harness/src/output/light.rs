//! The light of the beams, for the page: the flux on the camera's image, and the flux of the pencils along a stripe.

use askama::Template;
use raypencil_report::{ColourMap, Picture, Reduction, Scale, Tick, number, quantity};
use raypencil_scene::{FluxModel, Image, Maybe};

use crate::validation::Validation;

/// One renderer's image of the light of all beams.
struct FluxImage {
    title: String,
    alt: String,
    source: String,
    width: u32,
    height: u32,
    note: String,
}

/// The colour scale that all images share.
struct FluxScale {
    gradient: String,
    ticks: Vec<Tick>,
    label: String,
}

/// Flux of the pencils in a beam's middle row, column by column, with a curve for each renderer.
struct StripeChart {
    title: String,
    /// Ticks of the columns and of the flux, at positions from 0 to 1; those of the flux go upwards.
    columns: Vec<Tick>,
    values: Vec<Tick>,
    curves: Vec<Curve>,
    unit: &'static str,
}

/// One renderer's curve in a [`StripeChart`], in a box of 1000 by 240 units.
struct Curve {
    name: String,
    colour: &'static str,
    width: f64,
    points: String,
}

/// The page's section about light.
#[derive(Template)]
#[template(path = "light.html")]
struct Light {
    images: Vec<FluxImage>,
    scale: Option<FluxScale>,
    stripes: Vec<StripeChart>,
}

/// Width and height of a chart's box, SVG units.
const CHART_SIZE: [f64; 2] = [1000.0, 240.0];

/// Colour and width of each renderer's curve. Later curves are thinner, so that the curves below stay visible.
const CURVE_STYLES: [(&str, f64); 4] =
    [("#e69f00", 6.0), ("#0072b2", 2.5), ("#009e73", 1.2), ("#cc79a7", 0.8)];

/// The light of a validation as HTML; empty if no renderer computed flux.
///
/// # Errors
/// An error of the template.
pub(super) fn light_section(validation: &Validation, max_columns: u32) -> Result<String, askama::Error> {
    let light = light(validation, max_columns);
    if light.images.is_empty() { Ok(String::new()) } else { light.render() }
}

fn light(validation: &Validation, max_columns: u32) -> Light {
    let scene = &validation.subject.scene;
    let unit = match scene.flux_model() {
        FluxModel::Radiometric => "W",
        FluxModel::Eq1 => "W/m",
    };
    // The sum over all beams; a pixel with zero flux is drawn as unlit.
    let sums: Vec<(&str, Image<Maybe<f64>>, f64)> = validation
        .rendered
        .iter()
        .filter(|rendered| !rendered.output.flux.is_empty())
        .map(|rendered| {
            let camera = &scene.camera().sensor;
            let cells = camera.width as usize * camera.height as usize;
            let mut sum = vec![0.0_f64; cells];
            for image in &rendered.output.flux {
                for (sum, flux) in sum.iter_mut().zip(image.cells()) {
                    *sum += flux;
                }
            }
            let total = sum.iter().sum();
            let cells = sum.into_iter().map(|flux| Some(flux).filter(|flux| *flux > 0.0).into()).collect();
            (rendered.name.as_str(), Image::from_cells(camera.width, camera.height, cells), total)
        })
        .collect();
    let brightest =
        sums.iter().flat_map(|(_, image, _)| image.cells()).filter_map(|cell| cell.get()).fold(0.0, f64::max);
    let scale = Scale::linear(0.0, brightest);
    let images = sums
        .iter()
        .map(|(name, image, total)| {
            let picture = Picture::of_light(
                image,
                scale,
                Reduction::to_fit(image.width(), image.height(), max_columns),
            );
            let lit = image.cells().iter().filter(|cell| cell.get().is_some()).count();
            FluxImage {
                title: (*name).to_string(),
                alt: format!("Flux of all beams on the camera's image by {name}"),
                source: picture.data_uri(),
                width: picture.width,
                height: picture.height,
                note: format!("{} in {lit} pixels", quantity(*total, unit)),
            }
        })
        .collect();
    Light {
        images,
        scale: (brightest > 0.0).then(|| FluxScale {
            gradient: ColourMap::Sequential.css(),
            ticks: scale.ticks(4),
            label: format!("flux, {unit} per pixel; black: no light"),
        }),
        stripes: (0..scene.beams().len()).filter_map(|beam| stripe(validation, beam, unit)).collect(),
    }
}

/// The chart of one beam's middle row; `None` if no pencil has flux.
fn stripe(validation: &Validation, beam: usize, unit: &'static str) -> Option<StripeChart> {
    let sensor = &validation.subject.scene.beams()[beam].sensor;
    let (columns, row) = (sensor.columns, sensor.rows / 2);
    let lines: Vec<(&str, Vec<f64>)> = validation
        .rendered
        .iter()
        .filter_map(|rendered| {
            let flux = rendered.output.returns.get(beam)?.flux.as_ref()?;
            Some((rendered.name.as_str(), (0..columns).map(|i| flux.at(i, row)).collect()))
        })
        .collect();
    let most = lines.iter().flat_map(|(_, line)| line).fold(0.0, |most: f64, flux| most.max(*flux));
    if !(most > 0.0) {
        return None;
    }
    // A little room above, so that the line is not cut at the top.
    let scale = Scale::linear(0.0, 1.05 * most);
    let [width, height] = CHART_SIZE;
    let curve = |(index, (name, line)): (usize, &(&str, Vec<f64>))| {
        let (colour, stroke) = CURVE_STYLES[index.min(CURVE_STYLES.len() - 1)];
        let points = line.iter().enumerate().map(|(i, flux)| {
            let x = width * (i as f64 + 0.5) / f64::from(columns);
            format!("{x:.1},{:.1}", height * (1.0 - scale.fraction(*flux)))
        });
        Curve {
            name: (*name).to_string(),
            colour,
            width: stroke,
            points: points.collect::<Vec<_>>().join(" "),
        }
    };
    Some(StripeChart {
        title: format!("beam-{beam}, row {row}: at most {} {unit}", number(most)),
        columns: Scale::linear(-0.5, f64::from(columns) - 0.5).ticks(8.min(columns)),
        values: scale.ticks(4),
        curves: lines.iter().enumerate().map(curve).collect(),
        unit,
    })
}
