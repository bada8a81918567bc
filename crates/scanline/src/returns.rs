//! Steps 3 to 5 for all beams: the returns of their pencils, and their flux on the camera's image. (§3, §5, §6)

use std::time::Instant;

use raypencil_scene::{FaceId, FluxModel, Image, Maybe, Return, Returns, Scene, Stage};

use crate::bins::Bins;
use crate::cylindrical::Cylindrical;
use crate::flux::{Flux, PixelTables};
use crate::occluders::{Facing, Occluders};
use crate::perspective::Perspective;
use crate::points::{self, Pixels, StripePoint};
use crate::raster::Transformation;
use crate::shares::Shares;
use crate::tables::CameraTables;
use crate::{Fidelity, Options, occlusion, printed_occlusion};

/// What is kept between frames.
pub(crate) struct Tables<'a> {
    pub(crate) camera: &'a CameraTables,
    pub(crate) shares: &'a [Shares],
    /// For equation (1).
    pub(crate) pixels: Option<&'a PixelTables>,
}

impl Tables<'_> {
    /// Whether a scene wants the tables of pixels.
    pub(crate) fn want_pixels(scene: &Scene) -> bool {
        scene.flux_model() == FluxModel::Eq1
    }
}

/// Returns and flux images of all beams, in the scene's order. `hits` is the faces that each beam's pencils hit.
pub(crate) fn of_beams(
    scene: &Scene,
    options: Options,
    tables: &Tables<'_>,
    hits: &[Image<Maybe<FaceId>>],
    stages: &mut Vec<Stage>,
) -> (Vec<Returns>, Vec<Image<f64>>) {
    // Step 3: where the reflected pencils land.
    let start = Instant::now();
    let camera = Perspective::new(scene.camera(), tables.camera);
    let pixels = Pixels::of(&scene.camera().sensor);
    let points_of = |(beam, hits)| {
        let cylindrical = Cylindrical::new(beam, options.switches);
        points::of_beam(scene.mesh(), &cylindrical, &camera, pixels, hits)
    };
    let stripes: Vec<_> = scene.beams().iter().zip(hits).map(points_of).collect();
    stages.push(Stage { name: "landing".into(), time: start.elapsed() });

    // Step 5, before step 4: what is hidden delivers nothing.
    let start = Instant::now();
    let visible = visible(scene, options, &camera, pixels, &stripes);
    stages.push(Stage { name: "occlusion".into(), time: start.elapsed() });

    // Step 4.
    let start = Instant::now();
    let mut visible = visible.into_iter();
    let mut all = (Vec::new(), Vec::new());
    for ((beam, points), shares) in scene.beams().iter().zip(&stripes).zip(tables.shares) {
        let (columns, rows) = (beam.sensor.columns, beam.sensor.rows);
        let flux = Flux::new(scene, &beam.sensor, tables.pixels);
        let mut returns = Returns::empty(columns, rows);
        let camera = &scene.camera().sensor;
        let mut image = Image::filled(camera.width, camera.height, 0.0);
        // Pencil by pencil, row by row: a pixel's sum is always taken in the same order.
        let mut points = points.iter();
        for j in 0..rows {
            for i in 0..columns {
                let visible = visible.next().unwrap_or(false);
                let Some(point) = points.next().and_then(Option::as_ref) else { continue };
                let pixel = point.landing.map(|landing| landing.pixel);
                let delivered = match pixel {
                    Some(pixel) if visible => {
                        let material = scene.mesh().face_materials()[point.face.0 as usize];
                        let reflectivity = scene.mesh().materials()[material as usize].reflectivity;
                        let share = shares.of_column[i as usize];
                        let delivered = flux.of(share, reflectivity, point, pixel);
                        image.set(pixel.i, pixel.j, image.at(pixel.i, pixel.j) + delivered);
                        delivered
                    }
                    _ => 0.0,
                };
                let back = Return {
                    visible,
                    pixel,
                    depth: point.depth,
                    cos_off_axis: point.cos_off_axis,
                    cos_view: point.cos_view,
                    flux: delivered,
                };
                returns.put(i, j, &back);
            }
        }
        all.0.push(returns);
        all.1.push(image);
    }
    stages.push(Stage { name: "flux".into(), time: start.elapsed() });
    all
}

/// Whether the camera sees each pencil's point, of all beams one after the other.
fn visible(
    scene: &Scene,
    options: Options,
    camera: &Perspective<'_>,
    pixels: Pixels,
    stripes: &[Vec<Option<StripePoint>>],
) -> Vec<bool> {
    let switches = options.switches;
    let bins = Bins::of(pixels, stripes.iter().flatten().map(Option::as_ref));
    let extent = match switches.extent {
        Fidelity::Exact => f64::INFINITY,
        Fidelity::Paper => {
            printed_occlusion::upper_extent(camera.sensor_from_scene(), scene.beams(), stripes)
        }
    };
    let occluders = Occluders::new(scene.mesh(), camera, Facing::by(switches), extent);
    let hidden = match switches.place {
        Fidelity::Exact => occlusion::hidden(&occluders, &bins, options.skip_unseen),
        Fidelity::Paper => printed_occlusion::hidden_at_centres(&occluders, &bins, options.skip_unseen),
    };
    let mut visible = vec![false; stripes.iter().map(Vec::len).sum()];
    for (point, hidden) in bins.points().iter().zip(hidden) {
        visible[point.index as usize] = !hidden;
    }
    visible
}
