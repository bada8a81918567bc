//! Sectors of the obstacle maps with the reason of each, and vectors of the navigator maps.

use std::path::Path;

use raypencil_files::{FileError, GrowingFile};
use raypencil_rover::{DriveFrame, MissingReason, SectorEnd, TraversabilityTest, VehiclePart};

use crate::labels::label_word;

/// The two files, as they grow.
#[derive(Debug)]
pub(super) struct SectorFiles {
    sectors: GrowingFile,
    vectors: GrowingFile,
}

impl SectorFiles {
    pub(super) fn create(folder: &Path) -> Result<Self, FileError> {
        let mut sectors = GrowingFile::create(folder.join("sectors.csv"))?;
        sectors
            .add("frame,sector,direction_rad,radius_m,x_m,y_m,label,reason,part,missing_x_m,missing_y_m\n")?;
        let mut vectors = GrowingFile::create(folder.join("vectors.csv"))?;
        vectors.add("frame,from_x_m,from_y_m,to_x_m,to_y_m,label\n")?;
        Ok(Self { sectors, vectors })
    }

    pub(super) fn add(&mut self, frame: &DriveFrame) -> Result<(), FileError> {
        let Some((map, vectors)) = &frame.obstacles else { return Ok(()) };
        let index = frame.index;
        for (sector, end) in map.sectors.iter().enumerate() {
            let SectorEnd { direction, radius, point, label, .. } = *end;
            let (x, y, label, reason) = (point.x, point.y, label_word(label), reason(end));
            self.sectors.add(format!("{index},{sector},{direction},{radius},{x},{y},{label},{reason}\n"))?;
        }
        for vector in vectors {
            let (from, to, label) = (vector.from, vector.to, label_word(vector.label));
            self.vectors.add(format!("{index},{},{},{},{},{label}\n", from.x, from.y, to.x, to.y))?;
        }
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), FileError> {
        self.sectors.finish()?;
        self.vectors.finish().map(drop)
    }
}

/// Why testing stopped: four fields of the table.
fn reason(end: &SectorEnd) -> String {
    if let Some(test) = end.failed {
        let word = match test {
            TraversabilityTest::Front => "front",
            TraversabilityTest::Rear => "rear",
            TraversabilityTest::Length => "length",
            TraversabilityTest::Closer => "closer",
            TraversabilityTest::Belly => "belly",
        };
        return format!("{word},,,");
    }
    let Some(missing) = end.missing else { return ",,,".into() };
    let reason = match missing.reason {
        MissingReason::NotMeasured => "not_measured",
        MissingReason::BeyondMap => "beyond_map",
        MissingReason::MayHide => "may_hide",
        MissingReason::NearLimit => "near_limit",
    };
    let part = match missing.part {
        VehiclePart::FrontWheel => "front_wheel",
        VehiclePart::RearWheel => "rear_wheel",
        VehiclePart::CentreLine => "centre_line",
        VehiclePart::Belly => "belly",
    };
    format!("{reason},{part},{},{}", missing.place.x, missing.place.y)
}
