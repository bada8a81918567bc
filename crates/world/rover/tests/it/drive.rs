//! Whole drives with the images of a simple renderer for a few triangles.

use super::common;

use std::sync::Arc;

use common::{extruded, first_hit, from_vehicle, rig, seen_at};
use glam::{DVec2, DVec3};
use raypencil_rover::{
    BeamEdge, CameraImage, Detection, Drive, DriveFrame, DrivePlan, EdgePoint, ElevationMap, ElevationSource,
    Exposure, ExposureMode, Extraction, Inconsistency, Label, LocalMapper, LocalisationErrors,
    LocalisationReading, MapRules, MapSize, MapUpdate, MissionStart, OnVehicle, PositionFixes, Rig, Route,
    ScanReason, ScanRule, StartRule, StripeExtractor, StripeLocation, StripePoint, Stripes, Sweep,
};
use raypencil_scene::{Image, Mesh, Pose, Precision, RenderOutput, Renderer, Request, Scene, SceneError};

/// A renderer that puts one watt into a pixel for every pencil that the pixel sees.
struct StandIn;

impl Renderer for StandIn {
    fn name(&self) -> &str {
        "stand-in"
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        assert!(request.returns && !request.camera && !request.beams);
        // The vehicle frame is taken to be the scene frame.
        let rig = Rig::from_scene(scene, Pose::IDENTITY);
        let faces = from_vehicle(scene.mesh(), Pose::from_position(scene.mesh().origin()));
        let flux = rig.beams.iter().map(|beam| {
            let OnVehicle { vehicle_from_sensor, sensor } = beam;
            let camera = rig.camera.sensor;
            let mut image = Image::filled(camera.width, camera.height, 0.0);
            for j in 0..sensor.rows {
                let origin = *vehicle_from_sensor * sensor.origin(j);
                for i in 0..sensor.columns {
                    let direction = vehicle_from_sensor.rotate(sensor.direction(i));
                    let Some(point) = first_hit(&faces, origin, direction) else { continue };
                    let Some((u, v)) = seen_at(&rig, &faces, point) else { continue };
                    image.set(u as u32, v as u32, image.at(u as u32, v as u32) + 1.0);
                }
            }
            image
        });
        let flux = flux.collect();
        RenderOutput { camera: None, beams: Vec::new(), returns: Vec::new(), flux, stages: Vec::new() }
    }
}

/// A drive of 1.5 m straight ahead at 0.3 m/s, with coarse beams and a coarse sweep.
fn plan() -> DrivePlan {
    let route = Route::through(DVec2::ZERO, vec![DVec2::new(1.5, 0.0)]);
    let plan = DrivePlan::new(rig(96, 4), route, Extraction::thresholding(0.5));
    DrivePlan { sweep: Sweep { steps: 51, ..Sweep::default() }, ..plan }
}

fn drive(plan: DrivePlan, mesh: &Arc<Mesh>) -> (Drive, Vec<DriveFrame>) {
    let mut drive = Drive::new(plan, Arc::clone(mesh)).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = drive.step(&StandIn, &mut |_, image| CameraImage::Flux(image)).unwrap() {
        frames.push(frame);
    }
    (drive, frames)
}

#[test]
fn a_cell_of_the_map_is_at_most_as_wide_as_the_vehicle() {
    let with = |spacing| DrivePlan { map: MapSize { spacing, points: 201 }, ..plan() }.validate("drive");
    let width = plan().vehicle.width();
    assert_eq!(with(width), Ok(()));
    assert_eq!(with(width.next_up()).map_err(|error| error.field), Err("drive.map.spacing".to_string()));
}

#[test]
fn a_drive_towards_a_wall() {
    // Level ground that is 0.5 m higher from x = 5 on.
    let mesh = extruded(&[(-20.0, 0.0), (5.0, 0.0), (5.0, 0.5), (20.0, 0.5)]);
    // Stripes without holes: with fewer pencils cells at the wall's foot are not measured, and what may stand there ends
    // the sector unknown a step before the wall.
    let extraction = Extraction { place: StripeLocation::Centroid, ..plan().extraction };
    // After 1.5 m the rear wheels of the imaginary vehicle still stand where no stripe came. The start is level.
    let map_rules = MapRules { start: StartRule::Circle, ..MapRules::MENDED };
    let plan = DrivePlan { rig: rig(256, 2), extraction, map_rules, sweep: Sweep::default(), ..plan() };
    let (drive, frames) = drive(plan, &mesh);
    // 5 s at 10 frames per second, both ends included.
    assert_eq!(frames.len(), 51);
    assert_eq!(frames[0].scan, Some(ScanReason::Start));
    assert!(frames[1..].iter().all(|frame| frame.scan.is_none() && frame.points > 100));
    // The vehicle's elevation comes from the map. A pixel's footprint at the stripes is 4 to 6 cm.
    let mapper = drive.mapper().unwrap();
    assert!((mapper.pose().position - DVec3::new(1.5, 0.0, 0.0)).length() < 0.06, "{:?}", mapper.pose());
    // 95 % (tuned) of the measured points are within 5 cm of the ground.
    let (mut close, mut all) = (0, 0);
    for point in mapper.map().points() {
        if mapper.map().source(point) == ElevationSource::Measured {
            let (x, z) = (mapper.map().place(point).x, mapper.map().elevation(point).unwrap());
            // Points on the wall, and those of a pixel across its edge, have elevations between both levels.
            if (x - 5.0).abs() > 0.16 {
                all += 1;
                close += usize::from((z - if x > 5.0 { 0.5 } else { 0.0 }).abs() < 0.05);
            }
        }
    }
    assert!(all > 1000 && close * 20 > all * 19, "{close} of {all}");
    // The last obstacle map and its vectors mark the wall straight ahead, 3.5 m away.
    let maps: Vec<_> = frames.iter().filter_map(|frame| frame.obstacles.as_ref()).collect();
    assert_eq!(maps.len(), 6);
    let (obstacles, vectors) = maps[5];
    let ahead = obstacles.sectors[15];
    assert_eq!(ahead.label, Label::Obstacle);
    // The front wheels' rims touch the wall's edge 0.35 m ahead of their axle: 0.5 m over 1.2 + 0.35 m is a slope of 0.32,
    // more than 0.29. So the first obstacle is where the axle is at 4.65 m; steps are 0.1 m, cells as well.
    assert!((ahead.point.x - 4.65).abs() < 0.21, "{ahead:?}");
    assert_eq!(vectors[15].label, Label::Obstacle);
}

#[test]
fn one_exposure_of_both_beams_gives_the_same_map_of_level_ground() {
    let mesh = extruded(&[(-20.0, 0.0), (20.0, 0.0)]);
    // With fine beams a column of the image holds both stripes.
    let route = Route::through(DVec2::ZERO, vec![DVec2::new(0.1, 0.0)]);
    let short = || DrivePlan { route: route.clone(), rig: rig(1024, 2), ..plan() };
    let (in_turn, frames) = drive(short(), &mesh);
    let (together, others) = drive(DrivePlan { exposures: ExposureMode::Together, ..short() }, &mesh);
    assert_eq!(frames.len(), others.len());
    // With both beams lit, what either of them may have lit is left out: there are no new points.
    assert!(
        others.iter().zip(&frames).all(|(other, frame)| other.points <= frame.points && other.points > 50)
    );
    let [a, b] = [in_turn.mapper().unwrap().map(), together.mapper().unwrap().map()];
    let common = a.points().filter(|&point| b.source(point) == ElevationSource::Measured);
    for point in common {
        assert!((a.elevation(point).unwrap() - b.elevation(point).unwrap()).abs() < 0.06);
    }
}

#[test]
fn errors_of_the_sensors_call_for_a_scan() {
    // Noise of 1 degree in pitch moves a stripe 5 m away up and down by 9 cm. With a threshold of 5 cm, the
    // inconsistency triggers a scan.
    let mesh = extruded(&[(-20.0, 0.0), (20.0, 0.0)]);
    let errors = LocalisationErrors {
        attitude_noise: 1.0_f64.to_radians(),
        fixes: Some(PositionFixes { every_frames: 10, noise: 0.01 }),
        ..LocalisationErrors::default()
    };
    let scans = Some(ScanRule { inconsistency: Some(0.05), ..ScanRule::default() });
    let short = DrivePlan {
        route: Route::through(DVec2::ZERO, vec![DVec2::new(0.6, 0.0)]),
        sweep: Sweep { steps: 5, ..Sweep::default() },
        scans,
        ..plan()
    };
    let noisy = DrivePlan { errors, seed: 3, ..short.clone() };
    let (_, frames) = drive(noisy.clone(), &mesh);
    let because = |frames: &[DriveFrame]| {
        frames.iter().filter(|frame| frame.scan == Some(ScanReason::Inconsistency)).count()
    };
    assert!(because(&frames) > 0);
    // The same seed gives the same drive, another seed another.
    let (_, again) = drive(noisy.clone(), &mesh);
    assert_eq!(frames, again);
    let (_, other) = drive(DrivePlan { seed: 4, ..noisy }, &mesh);
    assert_ne!(frames, other);
    let (_, calm) = drive(short, &mesh);
    assert_eq!(because(&calm), 0);
}

#[test]
fn images_may_be_developed() {
    // Steps 6 to 8 as a digitisation: 20 numbers per watt, at most 60, and a bias of 12. Otsu's method finds the light.
    let mesh = extruded(&[(-20.0, 0.0), (20.0, 0.0)]);
    let plan = DrivePlan {
        extraction: Extraction { detection: Detection::Otsu, place: StripeLocation::Pixel, least_rows: 1 },
        scans: None,
        route: Route::through(DVec2::ZERO, vec![DVec2::new(0.03, 0.0)]),
        ..plan()
    };
    let mut drive = Drive::new(plan, mesh).unwrap();
    let mut seen = Vec::new();
    let mut develop = |exposure: Exposure, mut image: Image<f64>| {
        seen.push((exposure.frame, exposure.step, exposure.beam));
        for value in image.cells_mut() {
            *value = (*value * 20.0).min(60.0).round() + 12.0;
        }
        CameraImage::Flux(image)
    };
    let frame = drive.step(&StandIn, &mut develop).unwrap().unwrap();
    assert!(frame.points > 100);
    assert_eq!(seen, [(0, None, Some(0)), (0, None, Some(1))]);
}

#[test]
fn a_plan_that_cannot_be_driven_is_refused_by_its_field() {
    let mesh = extruded(&[(-20.0, 0.0), (20.0, 0.0)]);
    let refused = |plan: DrivePlan| Drive::new(plan, Arc::clone(&mesh)).unwrap_err().to_string();
    let route = Route { frame_rate: 0.0, ..plan().route };
    assert!(refused(DrivePlan { route, ..plan() }).starts_with("drive.route.frame_rate is 0"));
    let never = DrivePlan { obstacles_every: 0, ..plan() };
    assert!(refused(never.clone()).starts_with("drive.obstacles_every is 0"), "{}", refused(never));
}

#[test]
fn a_start_off_the_ground_and_a_route_off_it_are_refused() {
    let mesh = extruded(&[(-20.0, 0.0), (2.0, 0.0)]);
    let nowhere = DrivePlan { route: Route::through(DVec2::new(5.0, 0.0), vec![]), ..plan() };
    let message = Drive::new(nowhere, Arc::clone(&mesh)).unwrap_err().to_string();
    assert!(message.contains("drive.route.start"), "{message}");
    let off = DrivePlan {
        route: Route { speed: 3.0, ..Route::through(DVec2::ZERO, vec![DVec2::new(6.0, 0.0)]) },
        scans: None,
        ..plan()
    };
    // The front hubs are 0.6 m before the centre, and their rims reach 0.35 m back: a part of a wheel has ground below it
    // up to x = 2 - 0.6 + 0.35 = 1.75 m. At 3 m/s and ten frames a second the first frame beyond is at 1.8 m.
    let message = Drive::new(off, Arc::clone(&mesh)).unwrap_err().to_string();
    let expected =
        "drive.route is off the ground after 1.80 m, at (1.80, 0.00) m: expected ground under every wheel";
    assert!(message.starts_with(expected), "{message}");
}

/// Extraction that sees only what lies to the right of the middle of the image.
#[derive(Debug)]
struct RightHalf(Extraction);

impl StripeExtractor for RightHalf {
    fn stripes(&self, exposure: Exposure, image: &CameraImage) -> Result<Stripes, SceneError> {
        let (Some(beam), CameraImage::Flux(image)) = (exposure.beam, image) else {
            return Err(SceneError::new("exposures", "together", "in turn"));
        };
        let edges = self.0.edges(image).into_iter().filter(|edge| 2 * edge.i > image.width());
        let edges = edges.map(|edge| BeamEdge { beam, edge });
        Ok(Stripes { edges: edges.collect(), columns_left_out: 0 })
    }
}

/// Mapping that enters points where they are, with the vehicle at the elevation that it was given at the start.
#[derive(Debug)]
struct Level {
    map: ElevationMap,
    elevation: f64,
    pose: Pose,
}

impl Level {
    fn enter(&mut self, sensed: &LocalisationReading, points: Vec<StripePoint>) -> MapUpdate {
        self.pose = sensed.attitude.at(sensed.position.extend(self.elevation));
        let moved = self.map.recentre(sensed.position);
        for StripePoint { point, standard_error, .. } in points {
            self.map.set_measured(self.pose * point, standard_error);
        }
        let inconsistency = Inconsistency::default();
        MapUpdate { elevation_read: false, elevation_error: 0.0, moved, inconsistency }
    }
}

impl LocalMapper for Level {
    fn frame(&mut self, sensed: &LocalisationReading, points: Vec<StripePoint>) -> MapUpdate {
        // A point is seen from the camera and lit from a beam: it lies in the lower edge plane of the beam at that very
        // place, half a thickness below its middle.
        let Rig { camera, beams } = rig(96, 4);
        for StripePoint { point, seen_from, .. } in &points {
            let [seen, lit] = seen_from.expect("a stripe is seen from somewhere");
            assert_eq!(seen, camera.vehicle_from_sensor.position);
            let is_at = |beam: &&OnVehicle<_>| beam.vehicle_from_sensor.position == lit;
            let beam = beams.iter().find(is_at).expect("a beam of the rig");
            let in_beam = beam.vehicle_from_sensor.inverse() * *point;
            assert!((in_beam.y - 0.5 * beam.sensor.thickness).abs() < 1e-9, "{point} is lit from {lit}");
        }
        self.enter(sensed, points)
    }

    fn scan(&mut self, sensed: &LocalisationReading, points: Vec<StripePoint>, clear_map: bool) -> MapUpdate {
        if clear_map {
            self.map.clear();
        }
        self.enter(sensed, points)
    }

    fn map(&self) -> &ElevationMap {
        &self.map
    }

    fn pose(&self) -> Pose {
        self.pose
    }
}

#[test]
fn ones_own_extraction_and_map_take_the_place_of_the_rovers() {
    let mesh = extruded(&[(-20.0, 0.0), (5.0, 0.0), (5.0, 0.5), (20.0, 0.5)]);
    let start = || Drive::new(plan(), Arc::clone(&mesh)).unwrap();
    let end = |mut drive: Drive| -> Result<(ElevationMap, Vec<DriveFrame>), SceneError> {
        let mut frames = Vec::new();
        while let Some(frame) = drive.step(&StandIn, &mut |_, image| CameraImage::Flux(image))? {
            frames.push(frame);
        }
        Ok((drive.mapper().unwrap().map().clone(), frames))
    };
    let (own, frames) = end(start()).unwrap();
    let right = Arc::new(RightHalf(plan().extraction));
    let (half, half_frames) = end(start().with_extractor(right.clone())).unwrap();
    // Image columns go to the right: nothing is measured to the left of the vehicle, which drives along x.
    let measured = |map: &ElevationMap, left: bool| {
        let is_measured = |point| map.source(point) == ElevationSource::Measured;
        map.points().filter(|&point| is_measured(point) && (map.place(point).y > 0.1) == left).count()
    };
    assert!(measured(&own, true) > 100 && measured(&half, false) > 100);
    assert_eq!(measured(&half, true), 0);
    assert!(half_frames.iter().zip(&frames).all(|(half, own)| half.points < own.points && half.points > 0));
    assert!(half_frames.iter().all(|frame| frame.edges.len() >= frame.points));

    let level = |start: &MissionStart| -> Box<dyn LocalMapper> {
        let map = ElevationMap::new(start.size, start.sensed.position);
        Box::new(Level { map, elevation: start.elevation, pose: Pose::IDENTITY })
    };
    let (mapped, frames) = end(start().with_mapping(level)).unwrap();
    // No cell is a guess, and the obstacle maps are made of this map.
    assert!(mapped.points().all(|point| mapped.source(point) != ElevationSource::Extrapolated));
    assert!(measured(&mapped, true) > 100 && mapped != own);
    assert!(frames.iter().any(|frame| frame.obstacles.is_some()));

    // What an extractor refuses, and a beam that is not there, end the drive.
    let together = DrivePlan { exposures: ExposureMode::Together, ..plan() };
    let refused = end(Drive::new(together, Arc::clone(&mesh)).unwrap().with_extractor(right)).unwrap_err();
    assert!(refused.to_string().contains("in turn"), "{refused}");
    let refused = end(start().with_extractor(Arc::new(Beam7))).unwrap_err();
    assert!(refused.to_string().contains("beam of an edge is 7"), "{refused}");
}

/// Extraction that names a beam that no rig here has.
#[derive(Debug)]
struct Beam7;

impl StripeExtractor for Beam7 {
    fn stripes(&self, _: Exposure, _: &CameraImage) -> Result<Stripes, SceneError> {
        let edge = EdgePoint { i: 1, j: 1, row: 1.5 };
        Ok(Stripes { edges: vec![BeamEdge { beam: 7, edge }], columns_left_out: 0 })
    }
}
