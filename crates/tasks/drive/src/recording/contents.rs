//! What is recorded.

/// Parts of a recording beside the small ones, which are always written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RecordContents {
    /// Digital images as PNG of 16 bits.
    pub png: bool,
    /// Digital images as NPY.
    pub npy: bool,
    /// Edges of the stripes, and points.
    pub points: bool,
    /// Snapshots of the elevation map.
    pub maps: bool,
    /// All of it as a bag of ROS 2.
    pub mcap: bool,
}

/// Words of [`RecordContents::add`].
const WORDS: &str = "images, png, npy, points, poses, maps, mcap, all";

impl RecordContents {
    /// Adds what a word stands for. `poses` is always recorded.
    ///
    /// # Errors
    /// The words that are expected instead.
    ///
    /// ```
    /// use raypencil_drive::RecordContents;
    ///
    /// let mut contents = RecordContents::default();
    /// contents.add("images").unwrap();
    /// assert!(contents.png && contents.npy && !contents.points);
    /// assert_eq!(contents.add("film").unwrap_err(), "images, png, npy, points, poses, maps, mcap, all");
    /// ```
    pub fn add(&mut self, word: &str) -> Result<(), String> {
        match word {
            "images" => (self.png, self.npy) = (true, true),
            "png" => self.png = true,
            "npy" => self.npy = true,
            "points" => self.points = true,
            "poses" => {}
            "maps" => self.maps = true,
            "mcap" => self.mcap = true,
            "all" => *self = Self { png: true, npy: true, points: true, maps: true, mcap: true },
            _ => return Err(WORDS.into()),
        }
        Ok(())
    }
}
