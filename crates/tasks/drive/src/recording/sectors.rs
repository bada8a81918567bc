//! Sectors of the obstacle maps with the reason of each, and vectors of the navigator maps.

use std::path::Path;

use raypencil_files::{FileError, GrowingFile};
use raypencil_rover::{DriveFrame, MissingReason, SectorEnd, TraversabilityTest, VehiclePart};

use crate::labels::label_word;
use crate::sector_truth::{JudgedSector, Judgement};
use crate::true_rules::rule_word;

/// The two files, as they grow.
#[derive(Debug)]
pub(super) struct SectorFiles {
    sectors: GrowingFile,
    vectors: GrowingFile,
}

impl SectorFiles {
    pub(super) fn create(folder: &Path) -> Result<Self, FileError> {
        let mut sectors = GrowingFile::create(folder.join("sectors.csv"))?;
        sectors.add(
            "frame,sector,direction_rad,radius_m,x_m,y_m,label,reason,part,missing_x_m,missing_y_m,true_radius_m,judgement,true_rule\n",
        )?;
        let mut vectors = GrowingFile::create(folder.join("vectors.csv"))?;
        vectors.add("frame,from_x_m,from_y_m,to_x_m,to_y_m,label\n")?;
        Ok(Self { sectors, vectors })
    }

    /// `judged` has the sectors of the frame against the truth, or is empty.
    pub(super) fn add(&mut self, frame: &DriveFrame, judged: &[JudgedSector]) -> Result<(), FileError> {
        let Some((map, vectors)) = &frame.obstacles else { return Ok(()) };
        let index = frame.index;
        for (sector, end) in map.sectors.iter().enumerate() {
            let SectorEnd { direction, radius, point, label, .. } = *end;
            let (x, y, label, reason) = (point.x, point.y, label_word(label), reason(end));
            let truth = judged.get(sector).map_or_else(|| ",,".into(), truth);
            let line = format!("{index},{sector},{direction},{radius},{x},{y},{label},{reason},{truth}\n");
            self.sectors.add(line)?;
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

/// The first radius at which the vehicle truly cannot stand, what the sector is worth, and the rule that stops the vehicle: three
/// fields of the table.
fn truth(judged: &JudgedSector) -> String {
    let radius = judged.true_radius.map_or(String::new(), |radius| radius.to_string());
    let judgement = match judged.judgement {
        Judgement::Found => "found",
        Judgement::Passed => "passed",
        Judgement::False => "false",
        Judgement::Unknown => "unknown",
        Judgement::Clear => "clear",
        Judgement::OffGround => "off_ground",
    };
    format!("{radius},{judgement},{}", judged.true_rule.map_or("", rule_word))
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
