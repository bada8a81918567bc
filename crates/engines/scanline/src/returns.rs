//! Steps 3 to 5 for all beams: the returns of their pencils, and their flux on the camera's image. (§3, §5, §6)

use std::time::Instant;

use raypencil_scene::{FaceId, FluxModel, Image, Maybe, Return, Returns, Scene, Stage};

use crate::bins::Bins;
use crate::clusters::Clusters;
use crate::cylindrical::Cylindrical;
use crate::flux::{BeamFlux, PixelTables};
use crate::occluders::{Facing, Occluders};
use crate::options::ScanlineOptions;
use crate::perspective::Perspective;
use crate::points::{self, PixelGrid, StripePoint};
use crate::shares::ColumnShares;
use crate::tables::CameraTables;
use crate::transformation::Transformation;
use crate::{Fidelity, occlusion, printed_occlusion};

/// The tables that are cached between frames.
pub(crate) struct ReturnTables<'a> {
    pub(crate) camera: &'a CameraTables,
    pub(crate) shares: &'a [ColumnShares],
    /// For equation (1) alone.
    pub(crate) pixels: Option<&'a PixelTables>,
}

/// Whether the flux of a scene needs [`PixelTables`].
pub(crate) fn needs_pixel_tables(scene: &Scene) -> bool {
    scene.flux_model() == FluxModel::Eq1
}

/// Returns and flux images of all beams, in the scene's order. `hits` are the faces that each beam's pencils hit.
pub(crate) fn render(
    scene: &Scene,
    options: ScanlineOptions,
    tables: &ReturnTables<'_>,
    clusters: &Clusters,
    hits: &[Image<Maybe<FaceId>>],
    stages: &mut Vec<Stage>,
) -> (Vec<Returns>, Vec<Image<f64>>) {
    // Step 3: the points on the camera's image.
    let start = Instant::now();
    let camera = Perspective::new(scene.camera(), tables.camera);
    let pixels = PixelGrid::new(&scene.camera().sensor);
    let points_of_beam = |(beam, hits)| {
        let cylindrical = Cylindrical::new(beam, options.switches);
        points::stripe_points(scene.mesh(), &cylindrical, &camera, pixels, hits)
    };
    let stripes: Vec<_> = scene.beams().iter().zip(hits).map(points_of_beam).collect();
    stages.push(Stage { name: "landing".into(), time: start.elapsed() });

    // Step 5 comes before step 4: hidden points deliver no flux.
    let start = Instant::now();
    let visible = visible_points(scene, clusters, options, &camera, pixels, &stripes);
    stages.push(Stage { name: "occlusion".into(), time: start.elapsed() });

    // Step 4: the flux.
    let start = Instant::now();
    let mut visible = visible.into_iter();
    let (mut all_returns, mut all_images) = (Vec::new(), Vec::new());
    for ((beam, points), shares) in scene.beams().iter().zip(&stripes).zip(tables.shares) {
        let (columns, rows) = (beam.sensor.columns, beam.sensor.rows);
        let beam_flux = BeamFlux::new(scene, &beam.sensor, tables.pixels);
        let mut returns = Returns::empty(columns, rows);
        let camera = &scene.camera().sensor;
        let mut image = Image::filled(camera.width, camera.height, 0.0);
        // Row by row on one thread: the additions of each pixel's sum have one order.
        let mut points = points.iter();
        for j in 0..rows {
            for i in 0..columns {
                let visible = visible.next().unwrap_or(false);
                let Some(point) = points.next().and_then(Option::as_ref) else { continue };
                let pixel = point.image.map(|image| image.pixel);
                let flux = match pixel {
                    Some(pixel) if visible => {
                        let material = scene.mesh().face_materials()[point.face.0 as usize];
                        let reflectivity = scene.mesh().materials()[material as usize].reflectivity;
                        let power = shares.watts[i as usize];
                        let flux = beam_flux.flux(power, reflectivity, point, pixel);
                        image.set(pixel.i, pixel.j, image.at(pixel.i, pixel.j) + flux);
                        flux
                    }
                    _ => 0.0,
                };
                let pencil_return = Return {
                    visible,
                    pixel,
                    depth: point.depth,
                    cos_off_axis: point.cos_phi,
                    cos_view: point.cos_theta,
                    flux,
                };
                returns.put(i, j, &pencil_return);
            }
        }
        all_returns.push(returns);
        all_images.push(image);
    }
    stages.push(Stage { name: "flux".into(), time: start.elapsed() });
    (all_returns, all_images)
}

/// Whether the camera sees the point of each pencil; all beams, one after the other.
fn visible_points(
    scene: &Scene,
    clusters: &Clusters,
    options: ScanlineOptions,
    camera: &Perspective<'_>,
    pixels: PixelGrid,
    stripes: &[Vec<Option<StripePoint>>],
) -> Vec<bool> {
    let switches = options.switches;
    let bins = Bins::new(pixels, stripes.iter().flatten().map(Option::as_ref));
    let extent = match switches.extent {
        Fidelity::Exact => f64::INFINITY,
        Fidelity::Paper => {
            printed_occlusion::upper_extent(camera.sensor_from_scene(), scene.beams(), stripes)
        }
    };
    let occluders = Occluders::new(scene.mesh(), clusters, camera, Facing::from_switches(switches), extent);
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
