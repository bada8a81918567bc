//! What the fields of the channel and of the time say, each by itself, of points that were laid on their rays without them.

use raypencil_mesh_io::Cloud;

use super::assign::{Asked, Assigned};
use super::keys::Keys;

/// What each of the fields says of the rays of points.
#[derive(Debug, Default)]
pub(super) struct EachKey {
    /// Indices of the rays whose points have a channel or a time that is not theirs.
    pub(super) wrong: Vec<usize>,
    /// Names of the fields that were compared.
    pub(super) compared: Vec<String>,
}

impl Asked<'_> {
    /// Compares the channel of each point with that of its ray, and its time, as far as the file has them and the pack knows them. A time may
    /// be off by a quarter of the time to the channel's next firing, as where it tells the ray.
    pub(super) fn each_key(
        &self,
        cloud: &Cloud,
        (found, is_point): (&Assigned, &[bool]),
        keys: Keys,
    ) -> EachKey {
        let laid = || {
            let point_of = found.point_of.iter().enumerate();
            point_of.filter_map(|(ray, point)| Some((ray, point.filter(|&point| is_point[point])?)))
        };
        let mut is_wrong = vec![false; found.point_of.len()];
        let mut compared = Vec::new();
        let channels = self.channels().unwrap_or(1);
        if let Some((Some(column), _)) = self.channel_field(cloud) {
            let has_rows = self.has_rows_as_rings(cloud);
            let channel_of = match has_rows {
                true => (0..found.point_of.len() / self.places / channels).collect(),
                false => self.channel_of_number(keys),
            };
            let channel_of_beam = |beam: usize| if has_rows { beam / channels } else { beam % channels };
            for (ray, point) in laid() {
                let channel = keys.channel(column, point, &channel_of);
                is_wrong[ray] |= channel != Some(channel_of_beam(ray / self.places));
            }
            compared.push(column.name.clone());
        }
        if let Some((name, seconds)) = self.stated_times(cloud, keys.clock)
            && let Some(fired) = self.fired(keys.clock)
        {
            for (ray, point) in laid() {
                let beam = ray / self.places;
                let off = (seconds(point) - fired.times[beam]).abs();
                // A time that is no number is no time of the ray.
                is_wrong[ray] |= off.is_nan() || off > fired.channels[beam % channels].tolerance();
            }
            compared.push(name.into());
        }
        let wrong = (0..is_wrong.len()).filter(|&ray| is_wrong[ray]).collect();
        EachKey { wrong, compared }
    }
}
