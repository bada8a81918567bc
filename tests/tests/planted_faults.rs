//! Does a comparison find what is wrong? Faults are planted in a naive third renderer, and each must show as
//! a defect against both renderers; without a fault the three agree.

use std::sync::Arc;

use glam::DVec3;
use proptest::prelude::*;
use raypencil::judge::{Class, SensorResult, Side, compare};
use raypencil::scanline::Scanline;
use raypencil::terrain::RandomGround;
use raypencil::tracer::Tracer;
use raypencil::{RenderOutput, Renderer, Request, Scene, SensorId};
use raypencil_tests::lattice as lattices;
use raypencil_tests::naive::{Fault, Naive};
use raypencil_tests::plants::geometry::{
    facets, far_ground, fine_wall, lattice, on_pyramids, plate_beside_rays, plate_turned_away, pyramids,
    ramp_through_spp, range_cut_wall, ridge, rig, screen_before_spp,
};

/// Everything a test needs to plant a fault: where, and which sensors it must show on. On the other sensors
/// it must not show, for there the renderer is right.
struct Plant {
    name: &'static str,
    scene: Scene,
    shows: Shows,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shows {
    CameraOnly,
    BeamsOnly,
    Everywhere,
}

impl Shows {
    fn on(self, sensor: SensorId) -> bool {
        match self {
            Self::CameraOnly => sensor == SensorId::Camera,
            Self::BeamsOnly => sensor != SensorId::Camera,
            Self::Everywhere => true,
        }
    }
}

/// A small scene on which a fault shows, and why it does.
fn plant(fault: Fault) -> Plant {
    use Shows::{BeamsOnly, CameraOnly, Everywhere};
    let (name, scene, shows) = match fault {
        // Rays move by half a cell or more, and everything is seen aslant: the sensors look down, the fans
        // spread, and the beams' rows start at different heights. So all ranges change.
        Fault::HalfCellShift | Fault::ColumnOffByOne | Fault::RowsBottomUp => {
            ("pyramids", pyramids(), Everywhere)
        }
        // Its pixels are 144 um x 180 um.
        Fault::PitchesSwapped => ("pyramids", pyramids(), CameraOnly),
        // Its principal point is (31.3, 24.8): rays move by a third and a fifth of a pixel.
        Fault::PrincipalPointRounded => ("pyramids", pyramids(), CameraOnly),
        // Its grid is 115 mm wide and 5 mm thick, 96 columns by 4 rows.
        Fault::FanAndThicknessSwapped | Fault::ColumnsCountedAsRows => ("pyramids", pyramids(), BeamsOnly),
        // Its fan is 60 degrees: 120 instead.
        Fault::GridOfWholeFan => ("pyramids", pyramids(), BeamsOnly),
        // Its row 0 keeps 1.9 mm above the plane of the normal axis; from the centre it would pass there at
        // the grid, 0.1 m away, and 30 times as high at 3 m.
        Fault::PencilsFromCentre => ("pyramids", pyramids(), BeamsOnly),
        // Its camera's axes are not the scene's.
        Fault::CameraPoseConjugated => ("pyramids", pyramids(), CameraOnly),
        // q.q = 9: directions come out nine times too long, so that t and the depth, t f_c, are a ninth, and
        // the SPP is nine times as far. The beams' rows start nine times as far apart.
        Fault::QuaternionTakenAsUnit => ("pyramids, long quaternions", on_pyramids(3.0), Everywhere),
        // Its origin is (1e6, -1e6, 0) m: the ground leaves the view.
        Fault::OriginTakenOffTwice => ("a ground 1400 km away", far_ground(), Everywhere),
        // 2^-24 of a distance of metres is 1e-7 m; the bound is some 1e-14 m.
        Fault::VerticesInSinglePrecision | Fault::DirectionsInSinglePrecision => {
            ("pyramids", pyramids(), Everywhere)
        }
        // The plate shows its back, behind which a ray must meet the wall.
        Fault::BackFacesKept => ("a plate turned away", plate_turned_away(), Everywhere),
        // In the lower right the ground, whose front the rays meet, would be missing.
        Fault::WindingOfOneQuadrant => ("pyramids", pyramids(), Everywhere),
        // The ramp has two corners beyond the SPP at 0.5 m and one before it, at 0.1 m.
        Fault::ClipCaseLost => ("a ramp through the SPP", ramp_through_spp(), Everywhere),
        // Every ray passes through a vertex, an edge or a diagonal of the wall. All numbers are dyadic, so
        // that side functions are exactly 0.
        Fault::EdgesExcluded => ("a wall whose edges the rays meet", lattice(), Everywhere),
        // Every ray passes within rounding of a vertex, an edge or a diagonal.
        Fault::EdgesReckonedApart => {
            ("a turned lattice whose edges the rays meet", lattices::turned(31), Everywhere)
        }
        // The rays of column 2 meet two slopes at once, 2 m away and 45 degrees to either side.
        Fault::TieOfTwoRecords | Fault::TiesCancel => ("a ridge that the rays meet", ridge(), Everywhere),
        // The rays of column 3 cross the plate's plane at x = 1/16 m, 2^-22 m beyond its right edge: that is
        // 2^-20 < 1e-6 of its width of 1/4 m. They must meet the wall.
        Fault::EdgesWidened => ("a plate beside the rays", plate_beside_rays(), Everywhere),
        // |n.q| = (1/128 m)^2 f, f = g = 1/128 m: 2^-21 m^3 < 1e-6 m^3.
        Fault::SmallDeterminantsDropped => ("a wall of fine faces", fine_wall(), Everywhere),
        // The screen is a plate at half the distance of the SPP.
        Fault::HitsBeforePlane => ("a plate before the SPP", screen_before_spp(), Everywhere),
        // The wall is 2 m deep everywhere, but its range 2 / cos exceeds 2.1 m beyond 18 degrees.
        Fault::MaxRangeLimitsDepth => ("a wall cut by the range", range_cut_wall(), Everywhere),
        // A ray on a pyramid goes on to the plane, whose faces come first in the file and lie farther away.
        Fault::FirstInOrderWins | Fault::FarthestWins => ("pyramids", pyramids(), Everywhere),
        // No ray of these sensors runs along the axis (R = depth only there), no face has the area 1/2 m^2, no
        // sensor's axes are the scene's.
        Fault::DepthForRange
        | Fault::RangeFromPlane
        | Fault::NormalNotNormalised
        | Fault::NormalInSensorFrame
        | Fault::IncidenceAgainstAxis => ("pyramids", pyramids(), Everywhere),
        of_light => panic!("{of_light:?} is planted elsewhere"),
    };
    Plant { name, scene, shows }
}

// Comparisons.

/// What both renderers make of a scene, to compare others with.
struct Judges<'a> {
    scene: &'a Scene,
    outputs: [(&'static str, RenderOutput); 2],
}

impl<'a> Judges<'a> {
    fn of(scene: &'a Scene) -> Self {
        let render = |renderer: &dyn Renderer| renderer.render(scene, &Request::MAPS);
        Self {
            scene,
            outputs: [("scanline", render(&Scanline::default())), ("tracer", render(&Tracer::new()))],
        }
    }

    /// The naive renderer compared with each of them.
    fn compare(&self, naive: Naive) -> [(&'static str, Vec<SensorResult>); 2] {
        let output = naive.render(self.scene, &Request::MAPS);
        let precision = naive.precision();
        [0, 1].map(|index| {
            let (name, judge) = &self.outputs[index];
            let a = Side { name, output: judge, precision, attributions: None };
            let b = Side { name: naive.name(), output: &output, precision, attributions: None };
            (*name, compare(self.scene, a, b))
        })
    }

    /// What is wrong with a naive renderer without a fault: nothing, unless a message says so.
    fn agree(&self) -> Result<(), String> {
        for (judge, sensors) in self.compare(Naive::default()) {
            for sensor in &sensors {
                let cells = self.scene.size(sensor.sensor).map_or(0, |(w, h)| u64::from(w) * u64::from(h));
                if sensor.compared() != cells || sensor.of(Class::Defect) != 0 {
                    return Err(format!(
                        "{} of {cells} compared with {judge}, {} defects, the first {:?}",
                        sensor.compared(),
                        sensor.of(Class::Defect),
                        sensor.defects.first()
                    ));
                }
            }
        }
        Ok(())
    }

    /// How many rays of each sensor hit.
    fn hits(&self) -> Vec<usize> {
        let (_, output) = &self.outputs[1];
        let ranges = output.maps().map(|map| map.range.as_ref().expect("ranges were asked for"));
        ranges.map(|range| range.cells().iter().filter(|cell| cell.get().is_some()).count()).collect()
    }
}

#[test]
fn every_planted_fault_is_found_where_it_is() {
    println!("{:<28} {:<34} {:<7} {:>8} {:>8}", "fault", "scene", "sensor", "scanline", "tracer");
    let mut wrong = Vec::new();
    for fault in Fault::ALL.iter().copied().filter(|fault| !fault.is_of_light()) {
        let Plant { name, scene, shows } = plant(fault);
        let judges = Judges::of(&scene);
        if let Err(message) = judges.agree() {
            wrong.push(format!("{name}, without a fault: {message}"));
        }
        let [(_, scanline), (_, tracer)] = judges.compare(Naive { fault: Some(fault) });
        for (scanline, tracer) in scanline.iter().zip(&tracer) {
            let sensor = scanline.sensor;
            let defects = [scanline, tracer].map(|comparison| comparison.of(Class::Defect));
            let [by_scanline, by_tracer] = defects;
            let fault = format!("{fault:?}");
            let row = sensor.to_string();
            println!("{fault:<28} {name:<34} {row:<7} {by_scanline:>8} {by_tracer:>8}");
            if defects.iter().any(|&count| (count > 0) != shows.on(sensor)) {
                wrong.push(format!("{fault} on {name}: {defects:?} defects on {sensor}, shows {shows:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn faults_cost_the_rays_that_arithmetic_says() {
    let cases = [
        // All rays pass through edges.
        (Fault::EdgesExcluded, 25, 25),
        // The column of five rays that meets the ridge.
        (Fault::TieOfTwoRecords, 5, 5),
        (Fault::TiesCancel, 5, 5),
        // All faces are too small.
        (Fault::SmallDeterminantsDropped, 225, 225),
        // Column 3, where |y| <= 1/8 m at z = 1 m: all five rows of the camera, 1/16 m apart, and three of the
        // beam, 1/8 m apart.
        (Fault::EdgesWidened, 5, 3),
        // Rays have slopes k/16 and l/16, k and l from -7 to 7 (a beam's l is 0). R > 2.1 m where
        // 4 (1 + (k^2 + l^2) / 256) > 4.41, k^2 + l^2 > 26.24. Of 15^2 lattice points 89 lie within the
        // circle of radius sqrt 26; and |k| > 5 in 4 columns of 15 pencils.
        (Fault::MaxRangeLimitsDepth, 225 - 89, 60),
    ];
    for (fault, camera, beam) in cases {
        let Plant { scene, .. } = plant(fault);
        for (judge, sensors) in Judges::of(&scene).compare(Naive { fault: Some(fault) }) {
            let defects: Vec<u64> = sensors.iter().map(|sensor| sensor.of(Class::Defect)).collect();
            assert_eq!(defects, [camera, beam], "{fault:?} against {judge}");
        }
    }
}

#[test]
fn without_a_fault_nothing_is_found_on_the_built_in_grounds() {
    for (name, scene) in [("pyramids", pyramids()), ("facets", facets())] {
        let judges = Judges::of(&scene);
        assert_eq!(judges.agree(), Ok(()), "{name}");
        // Not by seeing nothing: each sensor hits with half of its rays.
        let cells = scene.sensors().filter_map(|sensor| scene.size(sensor)).map(|(w, h)| (w * h) as usize);
        for (hits, cells) in judges.hits().into_iter().zip(cells) {
            assert!(2 * hits > cells, "{name}: {hits} of {cells} hit");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    // Grounds with slivers, copied faces, walls and overhangs; a rig that stands at most 0.8 m above or below
    // the ground, heads anywhere, and has quaternions that are no units.
    #[test]
    fn without_a_fault_nothing_is_found_on_random_grounds(
        seed in any::<u64>(),
        faces in 50usize..400,
        heading in -3.2..3.2,
        length in 0.5..2.0,
    ) {
        let mesh = RandomGround::nasty(seed, faces).build().into_mesh().expect("a mesh");
        let scene = rig(Arc::new(mesh), DVec3::ZERO, heading, length);
        let judges = Judges::of(&scene);
        prop_assert_eq!(judges.agree(), Ok(()));
        prop_assert!(judges.hits().iter().sum::<usize>() > 0);
    }
}
