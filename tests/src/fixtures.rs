//! Small validations: one that agrees, one with defects, one with approximations, one with a candidate, one in which
//! nothing is hit, and one with a single renderer.

use std::sync::Arc;

use glam::DVec3;
use raypencil::harness::{
    Candidate, Estimate, MonteCarloImage, RadianceMap, Validation, contender, validate,
};
use raypencil::io::Subject;
use raypencil::judge::{
    Class, Defect, DefectMargin, DifferingRay, JudgeShare, Largest, ListedDefect, Quantity, Recorded,
};
use raypencil::{
    Atmosphere, Beam, Camera, FluxModel, Image, Lens, Maybe, Mounted, Place, Pose, Precision, Profile, Scene,
    SensorId, Silent, Switches,
};

/// The pyramids with a small camera and one small beam.
pub fn subject() -> Subject {
    let mesh = Arc::new(raypencil::terrain::builtin("pyramids", 0.25).unwrap().into_mesh().unwrap());
    let mount = |height: f64, down: f64| {
        Pose::from_position(DVec3::new(0.3, 0.0, height))
            * Pose::from_axis_angle(DVec3::Y, down.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR
    };
    let camera = Mounted {
        scene_from_sensor: mount(1.5, 20.0),
        sensor: Camera {
            width: 48,
            height: 40,
            pixel_pitch: [200e-6; 2],
            focal_length: 8e-3,
            principal_point: [24.0, 20.0],
            aperture: 2e-3,
            lens: Lens::CLEAR,
            max_range: 20.0,
        },
    };
    let beam = Mounted {
        scene_from_sensor: mount(1.8, 31.0),
        sensor: Beam {
            columns: 64,
            rows: 4,
            thickness: 5e-3,
            grid_distance: 0.1,
            half_width: Beam::half_width_of(0.1, 60_f64.to_radians()),
            max_range: 20.0,
            power: 1.0,
            wavelength: 810e-9,
            profile: Profile::Paper,
        },
    };
    let air = Atmosphere { attenuation: 0.0 };
    Subject {
        scene: Scene::new(mesh, camera, vec![beam], air, FluxModel::Radiometric).unwrap(),
        name: "pyramids".into(),
        arguments: "pyramids --fan 60".into(),
        sha256: "0123456789abcdef".repeat(4),
        vehicle: Some(Pose::IDENTITY),
        file_facts: Default::default(),
    }
}

/// Both renderers, which agree.
pub fn agreeing() -> Validation {
    of(subject(), ["scanline", "tracer"])
}

/// Both renderers, which agree that nothing is hit: camera and beam are 500 m beside the ground of 40 m.
pub fn empty() -> Validation {
    let mut subject = subject();
    let scene = &subject.scene;
    let (mut camera, mut beam) = (*scene.camera(), scene.beams()[0]);
    for pose in [&mut camera.scene_from_sensor, &mut beam.scene_from_sensor] {
        pose.position.x += 500.0;
    }
    let mesh = Arc::clone(scene.mesh());
    subject.scene = Scene::new(mesh, camera, vec![beam], scene.atmosphere(), scene.flux_model()).unwrap();
    subject.vehicle = None;
    of(subject, ["scanline", "tracer"])
}

/// One renderer, so that nothing is compared.
pub fn lonely() -> Validation {
    of(subject(), ["tracer"])
}

/// The paper's algorithm against the tracer, with a sheet of 80 mm.
pub fn approximate() -> Validation {
    let mut subject = subject();
    let scene = &subject.scene;
    let mut beam = scene.beams()[0];
    beam.sensor.thickness = 0.08;
    let (mesh, camera) = (Arc::clone(scene.mesh()), *scene.camera());
    subject.scene = Scene::new(mesh, camera, vec![beam], scene.atmosphere(), scene.flux_model()).unwrap();
    of(subject, ["scanline-paper", "tracer"])
}

/// The ray that [`with_candidate`]'s candidate answers wrongly: it says that the camera does not see the point.
pub const MISS: Place = Place { sensor: SensorId::Beam(0), i: 30, j: 2 };

/// [`agreeing`] with a candidate of an odd name. It is right except on [`MISS`] and on the first hidden pencil, which
/// it says is visible. Its image is twice too bright, and it has radiance on all of the ground.
pub fn with_candidate() -> Validation {
    let mut validation = agreeing();
    let scene = &validation.subject.scene;
    let output = &validation.rendered[1].output;
    let mut recorded = Recorded::of_output("odd", scene, output, Precision::F64);
    let seen = recorded.answers.light[0].returns.visible.as_mut().unwrap();
    assert!(seen.at(MISS.i, MISS.j), "a pencil that is seen");
    seen.set(MISS.i, MISS.j, false);
    let lands = &output.returns[0].pixel.as_ref().unwrap();
    let (i, j) = (0..seen.height())
        .flat_map(|j| (0..seen.width()).map(move |i| (i, j)))
        .find(|&(i, j)| !seen.at(i, j) && (i, j) != (MISS.i, MISS.j) && lands.at(i, j).get().is_some())
        .expect("a pencil that is hidden");
    seen.set(i, j, true);
    // Its light is left out: flux would contradict the changed visibility.
    recorded.answers.light[0].returns.flux = None;
    recorded.answers.light[0].image = None;
    let camera = scene.camera().sensor;
    let twice = output.flux[0].cells().iter().map(|flux| 2.0 * flux).collect();
    let mean = Image::from_cells(camera.width, camera.height, twice);
    let error = Image::filled(camera.width, camera.height, 1e-12);
    let image = MonteCarloImage {
        integrator: "guess".into(),
        beam: 0,
        estimate: Estimate::of_independent_pixels(mean, error),
    };
    let radiance = RadianceMap {
        sensor: SensorId::Camera,
        beam: 0,
        image: Image::filled(camera.width, camera.height, 1.0),
    };
    let candidate = Candidate {
        name: "Odd <renderer> 1".into(),
        folder: "odd".into(),
        declared: Default::default(),
        recorded,
        images: vec![image],
        ray_sets: vec![],
        radiance: vec![radiance],
    };
    validation.evaluate(vec![candidate], &Silent);
    validation
}

fn of<const N: usize>(subject: Subject, names: [&str; N]) -> Validation {
    let contenders = names.map(|name| contender(name).unwrap());
    validate(subject, &contenders, JudgeShare::Sample, &Silent)
}

/// The defects of [`defective`]: a hit on one side only, and an error that is NaN.
pub const DEFECTS: [Place; 2] =
    [Place { sensor: SensorId::Beam(0), i: 7, j: 1 }, Place { sensor: SensorId::Beam(0), i: 9, j: 2 }];

/// [`agreeing`] with two defects in the beam. Their text contains markup that every report must escape.
pub fn defective() -> Validation {
    let mut validation = agreeing();
    let sensor = validation.pairs[0].sensors.last_mut().unwrap();
    sensor.by_class[Class::Agree as usize] -= 2;
    sensor.by_class[Class::Defect as usize] += 2;
    for quantity in [Quantity::Hit, Quantity::Range] {
        let tally = sensor.items.entry(quantity.into());
        tally.by_class[Class::Agree as usize] -= 1;
        tally.by_class[Class::Defect as usize] += 1;
        if quantity == Quantity::Range {
            tally.worst_error = Some(Largest { value: f64::INFINITY, place: DEFECTS[1], ruling: None });
            tally.worst_ratio = Some(Largest { value: f64::NAN, place: DEFECTS[1], ruling: None });
        }
    }
    let described = ["scanline: <no> & \"hit\"; tracer: face 3", "scanline: face 3; tracer: face 3"];
    for ((place, quantity), what) in DEFECTS.into_iter().zip([Quantity::Hit, Quantity::Range]).zip(described)
    {
        let (class, causes) = (Class::Defect, Switches::EXACT);
        sensor.differing.push(DifferingRay { i: place.i, j: place.j, class, item: quantity.into(), causes });
        sensor.defects.push(Defect { place, item: quantity.into(), what: what.into() });
        sensor.listed.push(ListedDefect {
            place,
            item: quantity.into(),
            said: vec![("scanline".into(), "<no> & \"hit\"".into())],
            truth: "face 3 at 4 m".into(),
            difference: None,
            difference_unit: "m",
            ratio: None,
            margin: Some(DefectMargin { of: "face", unit: "cells", lo: 0.25, hi: 0.375 }),
            what: what.into(),
        });
    }
    let map = validation.rendered[1].output.beams[0].range.as_mut().unwrap();
    let image: &mut Image<Maybe<f64>> = map;
    image.set(7, 1, Maybe::NONE);
    validation
}
