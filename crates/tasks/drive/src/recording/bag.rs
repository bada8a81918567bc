//! Recording as a bag of ROS 2: which topics a drive has, and in which frames of reference.

use std::path::Path;

use raypencil_files::FileError;
use raypencil_rosbag::{BagWriter, Header, Stamp, TfMessage, Topic};
use raypencil_rover::{CameraImage, DriveFrame, ElevationMap, Exposure};
use raypencil_scene::Pose;

use crate::job::DriveJob;
use crate::maps::obstacle_grid::occupancy_grid;
use crate::recording::ros::{camera_info, cloud, image, occupancy, odometry, transform};

/// Frames of reference. `map` is the true global frame. The vehicle believes to be in the same: `odom` lies on it, and
/// the vehicle's error is that between `base_link` and `base_link_true`.
const MAP: &str = "map";
const ODOM: &str = "odom";
const BELIEVED: &str = "base_link";
const TRUTH: &str = "base_link_true";

/// Bag as it grows.
#[derive(Debug)]
pub(super) struct DriveBag {
    bag: BagWriter,
    /// True and believed pose in the frame before.
    before: Option<[Pose; 2]>,
    /// Time of all scans so far, and of one in the frame before, seconds.
    paused: [f64; 2],
    /// Time of the last message.
    last: Stamp,
}

/// Time of a frame or an exposure, given in seconds after the first frame. CHOICE: a drive begins at 1 s, because the time 0
/// means "no time" in ROS.
fn stamp(seconds: f64) -> Stamp {
    Stamp::from_nanoseconds(((1.0 + seconds) * 1e9).round() as u64)
}

/// Frame of reference of the camera, panned in a position of a scan or as it is mounted.
fn camera_frame(step: Option<u32>) -> String {
    step.map_or("camera_optical".into(), |step| format!("camera_optical_scan{step:03}"))
}

impl DriveBag {
    /// Begins a bag with the fixed frames of reference.
    pub(super) fn create(folder: &Path, job: &DriveJob) -> Result<Self, FileError> {
        let mut bag = BagWriter::create(&folder.join("rosbag"))?;
        let at = stamp(0.0);
        let rig = &job.plan.rig;
        let mut transforms = vec![transform(MAP, ODOM, at, &Pose::IDENTITY)];
        transforms.push(transform(BELIEVED, &camera_frame(None), at, &rig.camera.vehicle_from_sensor));
        for (index, beam) in rig.beams.iter().enumerate() {
            let name = format!("beam{index}_optical");
            transforms.push(transform(BELIEVED, &name, at, &beam.vehicle_from_sensor));
        }
        if job.plan.scans.is_some() {
            // The angles are the same in every scan.
            for (step, pan) in (0..).zip(job.plan.sweep.pans()) {
                let camera = rig.panned(pan).camera.vehicle_from_sensor;
                transforms.push(transform(BELIEVED, &camera_frame(Some(step)), at, &camera));
            }
        }
        bag.write(&Topic::latched("/tf_static"), at, &TfMessage { transforms })?;
        Ok(Self { bag, before: None, paused: [0.0; 2], last: at })
    }

    pub(super) fn image(
        &mut self,
        job: &DriveJob,
        exposure: &Exposure,
        taken: &CameraImage,
    ) -> Result<(), FileError> {
        let after = match exposure.step {
            None => job.plan.times.lit(exposure.beam.unwrap_or(0)),
            Some(step) => f64::from(step) * job.plan.sweep.step_time,
        };
        let at = stamp(exposure.frame as f64 / job.plan.route.frame_rate + self.paused[0] + after);
        self.last = at;
        let header = Header { stamp: at, frame_id: camera_frame(exposure.step) };
        let scan = if exposure.step.is_some() { "/scan" } else { "" };
        let lit = exposure.beam.map_or("all".into(), |beam| format!("beam{beam}"));
        let topic = |name: &str| Topic::new(format!("/camera{scan}/{lit}/{name}"));
        let info = camera_info(header.clone(), &job.plan.rig.camera.sensor);
        self.bag.write(&topic("image_raw"), at, &image(header, taken, job.subtract_unlit))?;
        self.bag.write(&topic("camera_info"), at, &info)
    }

    /// Takes a frame and the map after it.
    pub(super) fn frame(
        &mut self,
        job: &DriveJob,
        frame: &DriveFrame,
        map: &ElevationMap,
    ) -> Result<(), FileError> {
        let begin = stamp(frame.time);
        // Images that were taken after the beginning of the frame are in the bag already: no message is before another.
        let at = begin.max(self.last);
        let header = |name: &str| Header { stamp: begin, frame_id: name.into() };
        let (truth, believed) = (frame.stance.pose(), frame.believed);
        let transforms =
            vec![transform(MAP, TRUTH, begin, &truth), transform(ODOM, BELIEVED, begin, &believed)];
        self.bag.write(&Topic::new("/tf"), at, &TfMessage { transforms })?;
        let elapsed = 1.0 / job.plan.route.frame_rate + self.paused[1];
        self.paused[1] = frame.scan.map_or(0.0, |_| job.plan.sweep.duration());
        self.paused[0] += self.paused[1];
        // What the vehicle knows of its errors: nothing of x and y.
        let (z, turn) = (frame.update.elevation_error, job.plan.errors.attitude_noise);
        let known = [0.0, 0.0, z * z, turn * turn, turn * turn, turn * turn];
        let [true_before, before] = match &self.before {
            Some([truth, believed]) => [Some(truth), Some(believed)],
            None => [None, None],
        };
        let truly = odometry(header(MAP), TRUTH, &truth, true_before, elapsed, [0.0; 6]);
        let as_believed = odometry(header(ODOM), BELIEVED, &believed, before, elapsed, known);
        self.bag.write(&Topic::new("/ground_truth/odometry"), at, &truly)?;
        self.bag.write(&Topic::new("/odometry"), at, &as_believed)?;
        self.before = Some([truth, believed]);
        self.bag.write(&Topic::new("/points"), at, &cloud(header(BELIEVED), &frame.measured))?;
        let Some((obstacles, _)) = &frame.obstacles else { return Ok(()) };
        let grid = occupancy_grid(map, obstacles, &job.plan.grid, &job.plan.vehicle, &believed);
        self.bag.write(&Topic::new("/obstacle_map"), at, &occupancy(header(ODOM), &grid))
    }

    /// Puts the bag in its place, with the recording's `setup.json` in it.
    pub(super) fn finish(mut self, setup: &str) -> Result<(), FileError> {
        self.bag.attach("setup.json", "application/json", stamp(0.0), setup.as_bytes())?;
        self.bag.finish()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/bag.rs"]
mod tests;
