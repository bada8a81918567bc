//! Pictures on one page: their size together.

use raypencil_report::{MAX_PICTURE_CELLS, MAX_PICTURE_SIDE, max_side_of_pictures};

#[test]
fn sides_are_halved_until_all_pictures_fit() {
    // 3 pictures of 1024 x 1024 cells are 3,145,728.
    assert_eq!(max_side_of_pictures(&[(1024, 1024)], 3), MAX_PICTURE_SIDE);
    const { assert!(4 * 1024 * 1024 > MAX_PICTURE_CELLS) };
    assert_eq!(max_side_of_pictures(&[(1024, 1024)], 4), 512);
    assert_eq!(max_side_of_pictures(&[(1024, 1024), (1024, 1024), (1024, 1024), (1024, 1024)], 1), 512);
    // Each of 2048 x 512 cells becomes 1024 x 512: 6 times 524,288 are 3,145,728.
    assert_eq!(max_side_of_pictures(&[(2048, 512)], 6), 1024);
}

#[test]
fn no_number_of_pictures_makes_them_smaller_than_32() {
    assert_eq!(max_side_of_pictures(&[(1024, 1024)], 1_000_000), 32);
    assert_eq!(max_side_of_pictures(&[], 3), MAX_PICTURE_SIDE);
}
