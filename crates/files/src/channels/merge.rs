//! Several channels under one key: the finest stands for all, if the others are what is left of it after rounding.

use crate::channels::{Channel, unfit};
use crate::error::{Fault, FileError};

/// The finest channel and the others, in the order of their files. There is at least one.
pub(super) fn merge(key: &str, mut channels: Vec<Channel>) -> Result<(Channel, Vec<Channel>), FileError> {
    // Whole numbers are exact, so none is finer; of equals the first file's comes first.
    channels.sort_by(|a, b| b.storage.cmp(&a.storage).then_with(|| a.file.cmp(&b.file)));
    let mut channels = channels.into_iter();
    let finest = channels.next().expect("a key stands for what was read under it");
    let coarser: Vec<Channel> = channels.collect();
    for other in &coarser {
        agree(key, &finest, other)?;
    }
    Ok((finest, coarser))
}

/// Refuses two channels of which one cannot be the other after rounding.
fn agree(key: &str, finest: &Channel, other: &Channel) -> Result<(), FileError> {
    let (size, others) = (finest.values.size(), other.values.size());
    if size != others {
        let found = format!("{} x {} cells", others.0, others.1);
        let expected = format!("{} x {} as in {}", size.0, size.1, finest.file.display());
        return Err(unfit(&other.file, Fault::new(format!("channel {key:?}"), found, expected)));
    }
    let (width, height) = (size.0 as usize, size.1 as usize);
    let fits = |index: usize| {
        let (fine, coarse) = (finest.values.real(index), other.values.real(index));
        // Equal infinities are equal; a difference of wholes is at least an ulp of 1.
        fine == coarse
            || fine.is_nan() && coarse.is_nan()
            || (fine - coarse).abs() <= 0.5 * other.storage.ulp(coarse)
    };
    match (0..width * height).find(|&index| !fits(index)) {
        None => Ok(()),
        Some(index) => {
            let place = format!("channel {key:?}, cell ({}, {})", index % width, index / width);
            let (fine, coarse) = (finest.values.real(index), other.values.real(index));
            let expected = format!("{fine} to within half an ulp, as in {}", finest.file.display());
            Err(unfit(&other.file, Fault::new(place, coarse.to_string(), expected)))
        }
    }
}
