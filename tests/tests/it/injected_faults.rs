//! Faults injected into the naive renderer: a comparison with either renderer must report each as a defect. Without a
//! fault the three renderers agree.

use std::sync::Arc;

use glam::DVec3;
use proptest::prelude::*;
use raypencil::judge::{Class, SensorResult, Side, compare};
use raypencil::pack::with_bench;
use raypencil::scanline::Scanline;
use raypencil::terrain::RandomGround;
use raypencil::tracer::Tracer;
use raypencil::{RenderOutput, Renderer, Request, Scene, SensorId};
use raypencil_tests::injected_faults::geometry::{
    facets, far_ground, fine_wall, lattice, on_pyramids, plate_beside_rays, plate_turned_away, pyramids,
    ramp_through_spp, range_cut_wall, ridge, screen_before_spp, small_rig,
};
use raypencil_tests::lattice as lattices;
use raypencil_tests::naive::{Fault, Naive};

/// A scene that reveals a fault, and the sensors with defects. On the other sensors the faulty renderer is correct, so
/// that no defect may be reported.
struct Injection {
    name: &'static str,
    scene: Scene,
    defects_on: Sensors,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sensors {
    Camera,
    Beams,
    All,
    /// The beams of these indices.
    Of(&'static [usize]),
}

impl Sensors {
    fn contains(self, sensor: SensorId) -> bool {
        match self {
            Self::Camera => sensor == SensorId::Camera,
            Self::Beams => sensor != SensorId::Camera,
            Self::All => true,
            Self::Of(beams) => matches!(sensor, SensorId::Beam(index) if beams.contains(&index)),
        }
    }
}

/// A small scene that reveals a fault. The comments say why it does.
fn injection(fault: Fault) -> Injection {
    use Sensors::{All, Beams, Camera, Of};
    // The pyramids have two beams. Behind them come a backward one, the level bench, the one turned by a right angle,
    // and the turned one.
    let bench = || with_bench(&pyramids()).expect("a scene");
    let (name, scene, defects_on) = match fault {
        // Rays move by half a cell or more, and all rays are oblique to the ground: the sensors look down, the fans
        // spread, and the beams' rows start at different heights. So all ranges change.
        Fault::HalfCellShift | Fault::ColumnOffByOne | Fault::ColumnsReversed | Fault::RowsBottomUp => {
            ("pyramids", pyramids(), All)
        }
        // Its 96 columns are 1/96 of the grid apart: 1/95 instead.
        Fault::GridToTheEdges => ("pyramids", pyramids(), Beams),
        // Three rays of the level bench meet a plate on the SPP, three end at the maximum range, and five run through lines.
        Fault::PlaneExcluded | Fault::MaxRangeExcluded | Fault::ZeroAreaHit => ("a bench", bench(), Of(&[3])),
        // The benches have rows of rays through vertices, and through edges of all kinds.
        Fault::VerticesExcluded | Fault::EdgesOpenOnOneSide => ("a bench", bench(), Of(&[3, 4, 5])),
        // Its pixels are 144 um x 180 um.
        Fault::PitchesSwapped => ("pyramids", pyramids(), Camera),
        // Its principal point is (31.3, 24.8): rays move by a third and a fifth of a pixel.
        Fault::PrincipalPointRounded => ("pyramids", pyramids(), Camera),
        // Its grid is 115 mm wide and 5 mm thick, 96 columns by 4 rows.
        Fault::FanAndThicknessSwapped | Fault::ColumnsCountedAsRows => ("pyramids", pyramids(), Beams),
        // Its fan is 60 degrees: 120 instead.
        Fault::GridOfWholeFan => ("pyramids", pyramids(), Beams),
        // Row 0 stays 1.9 mm above the plane of the normal axis. From the centre it would have this height at the
        // grid, 0.1 m away, and 30 times this height at 3 m.
        Fault::PencilsFromCentre => ("pyramids", pyramids(), Beams),
        // Its camera's axes are not the scene's.
        Fault::CameraPoseConjugated => ("pyramids", pyramids(), Camera),
        // q.q = 9: directions are nine times too long, so that t and the depth, t f_c, are a ninth, and the SPP is
        // nine times as far. The beams' rows start nine times as far apart.
        Fault::QuaternionTakenAsUnit => ("pyramids, long quaternions", on_pyramids(3.0), All),
        // Its origin is (1e6, -1e6, 0) m: the ground leaves the view.
        Fault::OriginTakenOffTwice => ("a ground 1400 km away", far_ground(), All),
        // 2^-24 of a distance of metres is 1e-7 m; the bound is about 1e-14 m.
        Fault::VerticesInSinglePrecision | Fault::DirectionsInSinglePrecision => {
            ("pyramids", pyramids(), All)
        }
        // The plate shows its back: a ray must meet the wall behind it.
        Fault::BackFacesHit => ("a plate that shows its back to the rays", plate_turned_away(), All),
        // In the lower right quadrant the rays meet the front of the ground, which the fault rejects.
        Fault::WindingOfOneQuadrant => ("pyramids", pyramids(), All),
        // The ramp has two corners beyond the SPP at 0.5 m and one before it, at 0.1 m.
        Fault::ClipCaseLost => ("a ramp through the SPP", ramp_through_spp(), All),
        // Every ray passes through a vertex, an edge or a diagonal of the wall. All numbers are dyadic, so that the
        // side functions are exactly 0.
        Fault::EdgesExcluded => ("a wall with rays through its edges", lattice(), All),
        // Every ray passes within rounding of a vertex, an edge or a diagonal.
        Fault::EdgesComputedApart => {
            ("a rotated lattice with rays through its edges", lattices::turned(31), All)
        }
        // The rays of column 2 meet both slopes at the same point, at a depth of 2 m.
        Fault::TieOfTwoRecords | Fault::TiesCancel => ("a ridge with rays through it", ridge(), All),
        // The rays of column 3 cross the plate's plane at x = 1/16 m, 2^-22 m beyond its right edge: that is
        // 2^-20 < 1e-6 of its width of 1/4 m. They must meet the wall.
        Fault::EdgesWidened => ("a plate beside the rays", plate_beside_rays(), All),
        // |n.q| = (1/128 m)^2 f, f = g = 1/128 m: 2^-21 m^3 < 1e-6 m^3.
        Fault::SmallDeterminantsDropped => ("a wall of fine faces", fine_wall(), All),
        // The screen is a plate at half the distance of the SPP.
        Fault::HitsBeforePlane => ("a plate before the SPP", screen_before_spp(), All),
        // The wall is 2 m deep everywhere, but its range 2 / cos exceeds 2.1 m beyond 18 degrees.
        Fault::MaxRangeLimitsDepth | Fault::MaxRangeIgnored => {
            ("a wall beyond the maximum range in part", range_cut_wall(), All)
        }
        // A ray on a pyramid goes on to the plane, whose faces come first in the file and lie farther away.
        Fault::FirstInOrderWins | Fault::FarthestWins => ("pyramids", pyramids(), All),
        // No ray of these sensors runs along the axis (R = depth only there), no face has the area 1/2 m^2, no
        // sensor's axes are the scene's.
        Fault::DepthForRange
        | Fault::RangeFromPlane
        | Fault::TForRange
        | Fault::RangeForDepth
        | Fault::PointInSensorFrame
        | Fault::NormalReversed
        | Fault::NormalNotNormalised
        | Fault::NormalInSensorFrame
        | Fault::IncidenceAgainstAxis => ("pyramids", pyramids(), All),
        of_light => panic!("{of_light:?} is injected by the tests of light"),
    };
    Injection { name, scene, defects_on }
}

// Comparisons.

/// The outputs of both renderers for a scene, to compare the naive renderer with.
struct References<'a> {
    scene: &'a Scene,
    outputs: [(&'static str, RenderOutput); 2],
}

impl<'a> References<'a> {
    fn of(scene: &'a Scene) -> Self {
        let render = |renderer: &dyn Renderer| renderer.render(scene, &Request::MAPS);
        Self {
            scene,
            outputs: [("scanline", render(&Scanline::default())), ("tracer", render(&Tracer::new()))],
        }
    }

    /// The naive renderer compared with each reference.
    fn compare(&self, naive: Naive) -> [(&'static str, Vec<SensorResult>); 2] {
        let output = naive.render(self.scene, &Request::MAPS);
        let precision = naive.precision();
        [0, 1].map(|index| {
            let (name, reference) = &self.outputs[index];
            let a = Side { name, output: reference, precision, attributions: None };
            let b = Side { name: naive.name(), output: &output, precision, attributions: None };
            (*name, compare(self.scene, a, b))
        })
    }

    /// Compares the naive renderer without a fault. The error describes the first disagreement.
    fn agree(&self) -> Result<(), String> {
        for (reference, sensors) in self.compare(Naive::default()) {
            for sensor in &sensors {
                let cells = self.scene.size(sensor.sensor).map_or(0, |(w, h)| u64::from(w) * u64::from(h));
                if sensor.compared() != cells || sensor.of(Class::Defect) != 0 {
                    return Err(format!(
                        "{} of {cells} compared with {reference}, {} defects, the first {:?}",
                        sensor.compared(),
                        sensor.of(Class::Defect),
                        sensor.defects.first()
                    ));
                }
            }
        }
        Ok(())
    }

    /// The number of hits of each sensor.
    fn hits(&self) -> Vec<usize> {
        let (_, output) = &self.outputs[1];
        let ranges = output.maps().map(|map| map.range.as_ref().expect("ranges were asked for"));
        ranges.map(|range| range.cells().iter().filter(|cell| cell.get().is_some()).count()).collect()
    }
}

#[test]
fn every_injected_fault_is_found_where_it_is() {
    println!("{:<28} {:<46} {:<7} {:>8} {:>8}", "fault", "scene", "sensor", "scanline", "tracer");
    let mut wrong = Vec::new();
    for fault in Fault::ALL.iter().copied().filter(|fault| !fault.is_of_light()) {
        let Injection { name, scene, defects_on } = injection(fault);
        let references = References::of(&scene);
        if let Err(message) = references.agree() {
            wrong.push(format!("{name}, without a fault: {message}"));
        }
        let [(_, scanline), (_, tracer)] = references.compare(Naive { fault: Some(fault) });
        for (scanline, tracer) in scanline.iter().zip(&tracer) {
            let sensor = scanline.sensor;
            let defects = [scanline, tracer].map(|comparison| comparison.of(Class::Defect));
            let [by_scanline, by_tracer] = defects;
            let fault = format!("{fault:?}");
            let row = sensor.to_string();
            println!("{fault:<28} {name:<46} {row:<7} {by_scanline:>8} {by_tracer:>8}");
            if defects.iter().any(|&count| (count > 0) != defects_on.contains(sensor)) {
                wrong.push(format!(
                    "{fault} on {name}: {defects:?} defects on {sensor}, expected on {defects_on:?}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn faults_change_exactly_the_derived_number_of_rays() {
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
        let Injection { scene, .. } = injection(fault);
        for (reference, sensors) in References::of(&scene).compare(Naive { fault: Some(fault) }) {
            let defects: Vec<u64> = sensors.iter().map(|sensor| sensor.of(Class::Defect)).collect();
            assert_eq!(defects, [camera, beam], "{fault:?} against {reference}");
        }
    }
}

#[test]
fn without_a_fault_nothing_is_found_on_the_built_in_grounds() {
    for (name, scene) in [("pyramids", pyramids()), ("facets", facets())] {
        let references = References::of(&scene);
        assert_eq!(references.agree(), Ok(()), "{name}");
        // The maps are not empty: more than half of the rays of each sensor hit.
        let cells = scene.sensors().filter_map(|sensor| scene.size(sensor)).map(|(w, h)| (w * h) as usize);
        for (hits, cells) in references.hits().into_iter().zip(cells) {
            assert!(2 * hits > cells, "{name}: {hits} of {cells} hit");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    // Grounds with slivers, copied faces, walls and overhangs. The rig stands at most 0.8 m above or below the ground,
    // with any heading, and with quaternions that are not units.
    #[test]
    fn without_a_fault_nothing_is_found_on_random_grounds(
        seed in any::<u64>(),
        faces in 50usize..400,
        heading in -3.2..3.2,
        length in 0.5..2.0,
    ) {
        let mesh = RandomGround::nasty(seed, faces).build().into_mesh().expect("a mesh");
        let scene = small_rig(Arc::new(mesh), DVec3::ZERO, heading, length);
        let references = References::of(&scene);
        prop_assert_eq!(references.agree(), Ok(()));
        prop_assert!(references.hits().iter().sum::<usize>() > 0);
    }
}
