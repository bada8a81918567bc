//! Rules of two mistakes together, and what a wrong pose is.

use super::*;
use crate::it::candidates::pyramids;

#[test]
fn two_wrong_rules_are_both_in_force_and_one_rule_is_not_wrong_twice() {
    let of = |mistake| Rules::of(mistake).expect("a mistake of rules");
    let contract = Rules::CONTRACT;
    let corner = Mistake::CornerRays { columns: 0.5, rows: -0.5 };
    let offset = Numbers { offset: [0.5, -0.5], ..Numbers::SCENE };
    let all = [
        (Mistake::BacksHit, Rules { hits_backs: true, ..contract }),
        (Mistake::NearPlaneIgnored, Rules { least: 0.0, ..contract }),
        (Mistake::MaximumRangeAsDepth, Rules { longest: Longest::Depth, ..contract }),
        (Mistake::EdgesOpen, Rules { edges_open: true, ..contract }),
        (corner, Rules { numbers: offset, ..contract }),
    ];
    for (mistake, rules) in all {
        assert_eq!(of(mistake), rules);
        // Beside each of the others, in both orders.
        assert_eq!((contract.and(rules), rules.and(contract)), (Some(rules), Some(rules)));
    }
    let every =
        Rules { hits_backs: true, least: 0.0, longest: Longest::Depth, edges_open: true, numbers: offset };
    let forward = all.iter().try_fold(contract, |rules, (_, other)| rules.and(*other));
    let backward = all.iter().rev().try_fold(contract, |rules, (_, other)| rules.and(*other));
    assert_eq!((forward, backward), (Some(every), Some(every)));
    for (one, other) in [
        (Mistake::NearPlaneIgnored, Mistake::NearLimit(1.5)),
        (Mistake::MaximumRangeAsDepth, Mistake::MaximumRangeIgnored),
        (corner, Mistake::CornerRays { columns: 0.5, rows: 0.5 }),
    ] {
        assert_eq!(of(one).and(of(other)), None, "{one} and {other}");
    }
}

#[test]
fn a_wrong_pose_turns_the_sensor_s_own_axes() {
    let scene = pyramids().scene;
    for sensor in [SensorId::Camera, SensorId::Beam(0)] {
        let own = match sensor {
            SensorId::Camera => scene.camera().scene_from_sensor,
            SensorId::Beam(beam) => scene.beams()[beam].scene_from_sensor,
        };
        // Four numbers (x, y, z, w) of the file that are read as (w, x, y, z): the first is the real part.
        let [x, y, z, w] = own.rotation.to_array();
        let read = DQuat::from_xyzw(y, z, w, x);
        let found = wrong_poses(scene, sensor);
        let rules = |mistake| found.iter().find(|(other, _)| *other == mistake).expect("a pose").1;
        for (mistake, rotation, position) in [
            (Mistake::QuaternionOrder, read, own.position),
            (Mistake::PoseInverted, own.rotation.inverse(), own.inverse().position),
        ] {
            let numbers = rules(mistake).numbers;
            for axis in DVec3::AXES {
                let turned = own.rotate(turned(numbers.turn, axis));
                assert!((turned - rotation * axis).length() < 1e-12, "{mistake} {sensor}");
            }
            assert!((own.position + numbers.shift - position).length() < 1e-12, "{mistake} {sensor}");
        }
    }
}
