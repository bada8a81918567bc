//! Several channels under one key: the finest stands for all, if rounding it can give the others.

use crate::channels::channel::Channel;
use crate::error::{Fault, FileError};
use crate::values::Values;

/// The finest of `channels`, of which there is at least one, and the others.
///
/// # Errors
/// Names the two files that contradict each other, and the first cell in which they do.
pub(super) fn merge(key: &str, mut channels: Vec<Channel>) -> Result<(Channel, Vec<Channel>), FileError> {
    // Whole numbers are exact, so they count as the finest. Equal storages are ordered by their files.
    channels.sort_by(|a, b| b.storage.cmp(&a.storage).then_with(|| a.file.cmp(&b.file)));
    let mut channels = channels.into_iter();
    let finest = channels.next().expect("a key has at least one channel");
    let coarser: Vec<Channel> = channels.collect();
    for other in &coarser {
        check_agreement(key, &finest, other)?;
    }
    Ok((finest, coarser))
}

/// Whether "none" of a channel of whole numbers stands beside a NaN.
fn is_nothing(a: &Values, b: &Values, index: usize) -> bool {
    match (a, b) {
        (Values::Wholes(whole), Values::Reals(real)) | (Values::Reals(real), Values::Wholes(whole)) => {
            whole.cells()[index] == u32::MAX && real.cells()[index].is_nan()
        }
        _ => false,
    }
}

/// Refuses `other` if rounding `finest` to its storage cannot give it.
fn check_agreement(key: &str, finest: &Channel, other: &Channel) -> Result<(), FileError> {
    let (size, others) = (finest.values.size(), other.values.size());
    if size != others {
        let found = format!("{} x {} cells", others.0, others.1);
        let expected = format!("{} x {} as in {}", size.0, size.1, finest.file.display());
        return Err(FileError::recording(
            &other.file,
            Fault::new(format!("channel {key:?}"), found, expected),
        ));
    }
    let (width, height) = (size.0 as usize, size.1 as usize);
    let fits = |index: usize| {
        let (fine, coarse) = (finest.values.real(index), other.values.real(index));
        // Equal infinities compare equal. Different whole numbers differ by at least 1, which is their ulp.
        fine == coarse
            || is_nothing(&finest.values, &other.values, index)
            || fine.is_nan() && coarse.is_nan()
            || (fine - coarse).abs() <= 0.5 * other.storage.ulp(coarse)
    };
    match (0..width * height).find(|&index| !fits(index)) {
        None => Ok(()),
        Some(index) => {
            let place = format!("channel {key:?}, cell ({}, {})", index % width, index / width);
            let (fine, coarse) = (finest.values.real(index), other.values.real(index));
            let expected = format!("{fine} to within half an ulp, as in {}", finest.file.display());
            Err(FileError::recording(&other.file, Fault::new(place, coarse.to_string(), expected)))
        }
    }
}
