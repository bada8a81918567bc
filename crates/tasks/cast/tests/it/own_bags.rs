//! The bags that this crate writes of a scan, held to the pack of the same scan: each form passes, and a changed number is told.

use std::path::{Path, PathBuf};

use raypencil_cast::{BagFields, BagForm, CloudFrame, Questions, RayPackChecked, cast, write_scan_bag};
use raypencil_rosbag::{BagWriter, Clock, CloudChoice, PointCloud2, Stamp, Topic, read_point_cloud};
use raypencil_scene::{NamedRaySet, Sides, Silent};

use super::cloud_trial::{Trial, bend, expect, head, of_frame, room, set_of, still};

/// A bag of the set of a pack.
fn bag_of(trial: &Trial, fields: BagFields, is_dense: bool) -> PathBuf {
    let answers = cast(&room(), trial.set.set.rays(), Sides::Both, Questions::default(), &Silent);
    let bag = trial.folder.path().join("rosbag");
    let _ = std::fs::remove_dir_all(&bag);
    write_scan_bag(&bag, &answers, &trial.set, BagForm { fields, is_dense }, [0.0; 3]).expect("a bag");
    bag.join("rosbag_0.mcap")
}

fn check(trial: &Trial, bag: &Path) -> RayPackChecked {
    trial.check(bag, of_frame(CloudFrame::Sensor)).expect("a check")
}

/// Writes the cloud of a bag once more, changed, in a bag whose first message is recorded at a time.
fn rewritten(trial: &Trial, bag: &Path, begin_ns: u64, change: impl Fn(&mut PointCloud2)) -> PathBuf {
    let bytes = std::fs::read(bag).expect("a bag");
    let read = read_point_cloud(&bytes[..], bytes.len() as u64, &CloudChoice::default()).expect("a cloud");
    let mut cloud = read.cloud;
    change(&mut cloud);
    let folder = trial.folder.path().join("changed");
    let mut writer = BagWriter::create(&folder).expect("a bag");
    let at = Stamp::from_nanoseconds;
    writer.write(&Topic::new("/clock"), at(begin_ns), &Clock::default()).expect("a message");
    writer.write(&Topic::new("/points"), at(begin_ns + 200_000_000), &cloud).expect("a message");
    writer.finish().expect("a bag");
    folder.join("changed_0.mcap")
}

/// A head of four channels in a mixed order, which fires from a time on.
fn firing_from(start_s: f64) -> NamedRaySet {
    let mut four = head();
    four.channels.truncate(4);
    let rays = still().place(four.rays("rays").expect("rays").starting_at(start_s), "rays").expect("a pose");
    NamedRaySet::new("head", rays, Sides::Both).expect("a set")
}

/// The channels of these heads are in a mixed order: their numbers are not those of their rings.
#[test]
fn every_form_of_bag_passes_the_check_of_its_own_scan() {
    let sets = [set_of(&head(), &still()), set_of(&head(), &bend())].into_iter();
    for set in sets.chain([0.0, 0.25, 5.0].map(firing_from)) {
        let trial = Trial::of(set);
        for fields in BagFields::ALL {
            for is_dense in [false, true] {
                let checked = check(&trial, &bag_of(&trial, fields, is_dense));
                let shown = checked.document().screen();
                assert!(checked.passes() && checked.comparison.met > 100, "{fields:?} {shown}");
                let of_sensor = checked.cloud.expect("a cloud");
                let by = if fields == BagFields::Livox { "by channel and time" } else { "by ring and time" };
                assert_eq!((of_sensor.assigned, of_sensor.wrong_keys.len()), (by, 0));
            }
        }
    }
}

/// Livox tells its times by the clock of the bag, and not from the first ray on.
#[test]
fn only_a_bag_that_begins_at_one_second_is_later_than_its_set() {
    let trial = Trial::new(&head(), &still());
    let bag = bag_of(&trial, BagFields::Livox, true);
    let same = rewritten(&trial, &bag, 1_000_000_000, |_| {});
    assert!(check(&trial, &same).passes());
    let elsewhere = rewritten(&trial, &bag, 999_999_999, |_| {});
    expect(&check(&trial, &elsewhere), "if the times of the points are 1 s too late");
    // Times that are late beside the stamp of their own cloud are late in any bag.
    let late = rewritten(&trial, &bag, 1_000_000_000, |cloud| {
        let step = cloud.point_step as usize;
        for point in cloud.data.0.chunks_exact_mut(step) {
            let time = f64::from_le_bytes(point[18..].try_into().expect("eight bytes"));
            point[18..].copy_from_slice(&(time + 0.125e9).to_le_bytes());
        }
    });
    expect(&check(&trial, &late), "if the times of the points are 0.125 s too late");
}

/// Numbers by elevation are no numbers of lasers.
#[test]
fn lines_that_count_elevations_are_told() {
    let trial = Trial::new(&head(), &still());
    let bag = bag_of(&trial, BagFields::Livox, true);
    let elevations = trial.set.elevations_deg.clone().expect("a head");
    for (words, is_from_above) in [("from below", false), ("from above", true)] {
        let ranked = rewritten(&trial, &bag, 1_000_000_000, |cloud| {
            let step = cloud.point_step as usize;
            for point in cloud.data.0.chunks_exact_mut(step) {
                let own = elevations[usize::from(point[17])];
                let is_before = |other: &&f64| if is_from_above { **other > own } else { **other < own };
                point[17] = elevations.iter().filter(is_before).count() as u8;
            }
        });
        let told =
            format!("the numbers of channels count elevations {words}: they are in the order of the manual");
        expect(&check(&trial, &ranked), &told);
    }
}
