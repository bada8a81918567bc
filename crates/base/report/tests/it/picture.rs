//! Pictures of maps: colours, misses, reduction.

use raypencil_report::{ColourMap, Picture, Reduction, Scale};
use raypencil_scene::{Image, Maybe};

const ALL: Reduction = Reduction { columns: 1, rows: 1 };

/// Width, height and RGBA of each pixel, as any reader of PNG sees it.
fn decode(picture: &Picture) -> (u32, u32, Vec<[u8; 4]>) {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(&picture.png));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let pixels = pixels.chunks_exact(4).map(|pixel| pixel.try_into().unwrap()).collect();
    (info.width, info.height, pixels)
}

fn map(width: u32, height: u32, cells: &[Option<f64>]) -> Image<Maybe<f64>> {
    Image::from_cells(width, height, cells.iter().map(|&cell| cell.into()).collect())
}

#[test]
fn a_tiny_map_has_the_colours_of_viridis_and_a_transparent_miss() {
    let map = map(3, 2, &[Some(1.0), Some(2.0), None, Some(3.0), None, Some(1.0)]);
    let (width, height, pixels) = decode(&Picture::of_map(&map, Scale::linear(1.0, 3.0), ALL));
    assert_eq!((width, height), (3, 2));
    // The ends of viridis and its middle, as its authors publish them.
    assert_eq!(pixels[0], [0x44, 0x01, 0x54, 0xff]);
    assert_eq!(pixels[3], [0xfd, 0xe7, 0x25, 0xff]);
    let middle: [u8; 4] = [0x21, 0x91, 0x8c, 0xff];
    assert!(pixels[1].iter().zip(middle).all(|(&part, known)| part.abs_diff(known) <= 1), "{pixels:?}");
    assert_eq!(pixels[2][3], 0);
    assert_eq!(pixels[4][3], 0);
}

#[test]
fn a_cell_has_the_nearest_colour_of_its_bar() {
    // A picture has 253 colours: steps of 1/252 of the scale.
    let places: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
    let cells: Vec<Option<f64>> = places.iter().copied().map(Some).collect();
    let picture = Picture::of_map(&map(1001, 1, &cells), Scale::linear(0.0, 1.0), ALL);
    for (place, pixel) in places.into_iter().zip(decode(&picture).2) {
        let near = (0..=252).map(|k| f64::from(k) / 252.0).filter(|at| (at - place).abs() <= 0.5001 / 252.0);
        let colours: Vec<[u8; 3]> = near.map(|at| ColourMap::Sequential.at(at)).collect();
        assert!(colours.iter().any(|colour| *colour == pixel[..3]), "{place}: {pixel:?}, not of {colours:?}");
    }
}

#[test]
fn differences_are_blue_below_and_red_above_zero() {
    let map = map(4, 1, &[Some(-1.0), Some(0.0), Some(1.0), None]);
    let scale = Scale::symmetric([1.0]).unwrap();
    let picture = Picture::of_differences(&map, |i, _| i == 3, scale, ALL);
    let (_, _, pixels) = decode(&picture);
    let [below, zero, above, one_sided] = pixels[..] else { panic!("{pixels:?}") };
    assert!(below[2] > 2 * below[0], "{below:?}");
    assert!(above[0] > 2 * above[2], "{above:?}");
    assert!(zero[..3].iter().all(|&part| part > 0xe8), "{zero:?}");
    assert_eq!(one_sided, [0xff, 0x00, 0xe6, 0xff]);
}

#[test]
fn a_reduced_map_keeps_its_largest_difference() {
    let mut cells = vec![Some(0.0); 7 * 5];
    cells[3 * 7 + 5] = Some(-2.0);
    let scale = Scale::symmetric([2.0]).unwrap();
    let reduction = Reduction::to_fit(7, 5, 3);
    assert_eq!(reduction, Reduction { columns: 3, rows: 2 });
    let (width, height, pixels) =
        decode(&Picture::of_differences(&map(7, 5, &cells), |_, _| false, scale, reduction));
    assert_eq!((width, height), (3, 3));
    let coloured: Vec<usize> = (0..9).filter(|&pixel| pixels[pixel][0] < 0x80).collect();
    assert_eq!(coloured, [4]);
}

#[test]
fn a_reduced_map_shows_what_one_side_alone_hits_wherever_it_is_in_its_block() {
    let cells = vec![Some(1.0); 7 * 5];
    let (scale, reduction) = (Scale::symmetric([2.0]).unwrap(), Reduction::to_fit(7, 5, 3));
    for (i, j) in (0..5).flat_map(|j| (0..7).map(move |i| (i, j))) {
        let picture = Picture::of_differences(&map(7, 5, &cells), |x, y| (x, y) == (i, j), scale, reduction);
        let (_, _, pixels) = decode(&picture);
        let shown: Vec<usize> = (0..9).filter(|&pixel| pixels[pixel] == [0xff, 0x00, 0xe6, 0xff]).collect();
        assert_eq!(shown, [(i / 3 + 3 * (j / 2)) as usize], "{i},{j}");
    }
}

#[test]
fn the_gradient_runs_from_end_to_end() {
    let css = ColourMap::Sequential.css();
    assert!(css.starts_with("linear-gradient(to right,#440154,"), "{css}");
    assert!(css.ends_with(",#fde725)"), "{css}");
}
