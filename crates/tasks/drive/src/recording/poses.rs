//! True, believed and sensed poses of the vehicle, a line for each frame.

use std::path::Path;

use raypencil_files::{FileError, GrowingFile};
use raypencil_rover::{DriveFrame, ScanReason};
use raypencil_scene::Pose;

/// First line of `poses.csv`.
const HEADER: &str = "frame,time_s,driven_m,true_x_m,true_y_m,true_z_m,true_qx,true_qy,true_qz,true_qw,believed_x_m,\
                      believed_y_m,believed_z_m,believed_qx,believed_qy,believed_qz,believed_qw,sensed_x_m,sensed_y_m,\
                      sensed_heading_rad,sensed_pitch_down_rad,sensed_roll_right_rad,proximity_m,scan,elevation_read,\
                      elevation_error_m,moved_i,moved_j,inconsistency_points,inconsistency_mean_m,\
                      inconsistency_largest_m,edges,points,columns_left_out\n";

/// The three files, as they grow.
#[derive(Debug)]
pub(super) struct PoseFiles {
    table: GrowingFile,
    truth: GrowingFile,
    believed: GrowingFile,
}

impl PoseFiles {
    pub(super) fn create(folder: &Path) -> Result<Self, FileError> {
        let mut table = GrowingFile::create(folder.join("poses.csv"))?;
        table.add(HEADER)?;
        Ok(Self {
            table,
            truth: GrowingFile::create(folder.join("poses-true.tum"))?,
            believed: GrowingFile::create(folder.join("poses-believed.tum"))?,
        })
    }

    pub(super) fn add(&mut self, frame: &DriveFrame) -> Result<(), FileError> {
        let time = frame.time;
        let (truth, believed) = (numbers(&frame.stance.pose()), numbers(&frame.believed));
        let sensed = &frame.sensed;
        let angles = sensed.attitude;
        let mut fields = vec![frame.index.to_string(), time.to_string(), frame.place.driven.to_string()];
        fields.extend(truth.iter().chain(&believed).map(f64::to_string));
        let readings =
            [sensed.position.x, sensed.position.y, angles.heading, angles.pitch_down, angles.roll_right];
        fields.extend(readings.map(|number| number.to_string()));
        fields.push(sensed.proximity.map_or(String::new(), |distance| distance.to_string()));
        fields.push(frame.scan.map_or("", reason_word).into());
        let update = &frame.update;
        fields.push(update.elevation_read.to_string());
        fields.push(update.elevation_error.to_string());
        fields.extend([update.moved.0, update.moved.1].map(|steps| steps.to_string()));
        fields.push(update.inconsistency.count.to_string());
        fields.extend([update.inconsistency.mean, update.inconsistency.largest].map(|m| m.to_string()));
        fields.extend([frame.edges.len(), frame.points, frame.columns_left_out].map(|n| n.to_string()));
        self.table.add(fields.join(",") + "\n")?;
        for (file, pose) in [(&mut self.truth, truth), (&mut self.believed, believed)] {
            let words: Vec<String> = pose.iter().map(f64::to_string).collect();
            file.add(format!("{time} {}\n", words.join(" ")))?;
        }
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), FileError> {
        let Self { table, truth, believed } = self;
        [table, truth, believed].into_iter().try_for_each(|file| file.finish().map(drop))
    }
}

/// Position and unit quaternion: x, y, z, qx, qy, qz, qw.
pub(super) fn numbers(pose: &Pose) -> [f64; 7] {
    let ([x, y, z], [qx, qy, qz, qw]) = (pose.position.to_array(), pose.rotation.normalize().to_array());
    [x, y, z, qx, qy, qz, qw]
}

fn reason_word(reason: ScanReason) -> &'static str {
    match reason {
        ScanReason::Start => "start",
        ScanReason::Distance => "distance",
        ScanReason::Inconsistency => "inconsistency",
    }
}
