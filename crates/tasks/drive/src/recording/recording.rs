//! All files of a recording, in one folder.

use std::path::{Path, PathBuf};

use raypencil_files::{
    FileError, FolderError, OutputFolder, begin_output_folder, create_folder, write_atomically,
};
use raypencil_rover::{CameraImage, DriveFrame, ElevationMap, Exposure};

use crate::job::DriveJob;
use crate::recording::bag::DriveBag;
use crate::recording::contents::RecordContents;
use crate::recording::images::write_image;
use crate::recording::maps::MapFiles;
use crate::recording::points::PointFiles;
use crate::recording::poses::PoseFiles;
use crate::recording::sectors::SectorFiles;
use crate::recording::setup::setup_json;
use crate::sector_truth::JudgedSector;

/// Name of the folder in the folder of a drive.
const FOLDER: &str = "recording";

/// File that is written last: a folder that has it is complete.
const LAST: &str = "setup.json";

/// Recording in progress. Images are written as they are taken, and nothing grows in memory.
#[derive(Debug)]
pub(crate) struct Recording {
    folder: PathBuf,
    contents: RecordContents,
    poses: PoseFiles,
    sectors: SectorFiles,
    points: Option<PointFiles>,
    maps: Option<MapFiles>,
    bag: Option<DriveBag>,
    start_elevation: Option<f64>,
    /// First failure to write an image. The camera's pipeline has no way to report it.
    failure: Option<FileError>,
    /// The recording's own list: a drive without a list of its own has one.
    output: OutputFolder,
}

impl Recording {
    /// Begins a recording in the folder `recording` of a drive's folder, which loses its mark of completeness, as the recording
    /// does. What an earlier recording has made there is removed, and with the run `output` of the drive's folder what an earlier
    /// drive has made in that, too.
    ///
    /// # Errors
    /// The folder or file that could not be made, and the reason.
    pub(crate) fn begin(
        drive: &Path,
        job: &DriveJob,
        contents: RecordContents,
        of_drive: Option<&OutputFolder>,
    ) -> Result<Self, FolderError> {
        begin_output_folder(drive, "summary.json")?;
        let folder = drive.join(FOLDER);
        let output = OutputFolder::begin(&folder)?;
        begin_output_folder(&folder, LAST)?;
        // A drive takes minutes. Stopped on the way, it would leave maps of another drive beside its own poses.
        of_drive.map_or(Ok(()), OutputFolder::clear_earlier)?;
        output.clear_earlier()?;
        if contents.png || contents.npy {
            create_folder(&folder.join("images"))?;
        }
        if contents.maps {
            create_folder(&folder.join("maps"))?;
        }
        Ok(Self {
            poses: PoseFiles::create(&folder)?,
            sectors: SectorFiles::create(&folder)?,
            points: contents.points.then(|| PointFiles::create(&folder)).transpose()?,
            maps: contents.maps.then(|| MapFiles::create(&folder)).transpose()?,
            bag: contents.mcap.then(|| DriveBag::create(&folder, job)).transpose()?,
            folder,
            contents,
            start_elevation: None,
            failure: None,
            output,
        })
    }

    /// Takes an image. A failure is reported by the next [`Recording::frame`].
    pub(crate) fn image(&mut self, job: &DriveJob, exposure: &Exposure, image: &CameraImage) {
        let is_wanted = self.contents.png || self.contents.npy;
        if is_wanted && self.failure.is_none() {
            let folder = self.folder.join("images");
            self.failure = write_image(&folder, self.contents, exposure, image, job.subtract_unlit).err();
        }
        if let (Some(bag), None) = (&mut self.bag, &self.failure) {
            self.failure = bag.image(job, exposure, image).err();
        }
    }

    /// Takes a frame, its sectors against the truth, and the map after it.
    pub(crate) fn frame(
        &mut self,
        job: &DriveJob,
        frame: &DriveFrame,
        judged: &[JudgedSector],
        map: &ElevationMap,
    ) -> Result<(), FileError> {
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        self.start_elevation.get_or_insert(frame.stance.position.z);
        self.poses.add(frame)?;
        self.sectors.add(frame, judged)?;
        if let Some(points) = &mut self.points {
            points.add(frame)?;
        }
        if let Some(bag) = &mut self.bag {
            bag.frame(job, frame, map)?;
        }
        match &mut self.maps {
            Some(maps) if frame.obstacles.is_some() => maps.add(frame.index, map),
            _ => Ok(()),
        }
    }

    /// Puts all files in their places.
    pub(crate) fn finish(self, job: &DriveJob) -> Result<(), FolderError> {
        self.poses.finish()?;
        self.sectors.finish()?;
        self.points.map_or(Ok(()), PointFiles::finish)?;
        self.maps.map_or(Ok(()), MapFiles::finish)?;
        let setup = setup_json(job, self.start_elevation.unwrap_or(0.0));
        self.bag.map_or(Ok(()), |bag| bag.finish(&setup))?;
        write_atomically(self.folder.join(LAST), |file| file.write_all(setup.as_bytes()))?;
        self.output.finish()
    }
}

#[cfg(test)]
#[path = "../../tests/unit/recording.rs"]
mod tests;
