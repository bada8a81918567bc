//! PNG and TIFF as numbers: those of the file, and refusals where they would be others.

use std::io::Cursor;
use std::path::Path;

use png::{BitDepth, ColorType};
use raypencil_files::{Array, Limits, Storage, Values, png_from_bytes, tiff_from_bytes};
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;

pub(super) fn png([width, height]: [u32; 2], colour: ColorType, depth: BitDepth, bytes: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    if colour == ColorType::Indexed {
        encoder.set_palette(vec![1, 2, 3, 40, 50, 60]);
    }
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
    file
}

fn planes(array: Array) -> Vec<Vec<f64>> {
    let cells = |values: &Values| {
        let (width, height) = values.size();
        (0..(width * height) as usize).map(|index| values.real(index)).collect()
    };
    array.planes.iter().map(cells).collect()
}

fn read_png(bytes: &[u8]) -> Result<Array, String> {
    png_from_bytes(bytes, Path::new("d.png"), &Limits::default()).map_err(|error| error.to_string())
}

fn read_tiff(bytes: &[u8]) -> Result<Array, String> {
    tiff_from_bytes(bytes, Path::new("d.tif"), &Limits::default()).map_err(|error| error.to_string())
}

#[test]
fn samples_of_png_are_the_numbers_of_the_file() {
    let read =
        |size, colour, depth, bytes: &[u8]| planes(read_png(&png(size, colour, depth, bytes)).unwrap());
    // Most significant byte first: 0x0102 = 258.
    let sixteen = read([2, 1], ColorType::Grayscale, BitDepth::Sixteen, &[1, 2, 255, 255]);
    assert_eq!(sixteen, [[258.0, 65535.0]]);
    assert_eq!(read([1, 2], ColorType::Grayscale, BitDepth::Eight, &[7, 9]), [[7.0, 9.0]]);
    // Two bits from the top: 0b00_01_10_11, and the next row begins with a byte of its own. They are not stretched to 255.
    let two = read([5, 2], ColorType::Grayscale, BitDepth::Two, &[0b0001_1011, 0b0100_0000, 0xff, 0xff]);
    assert_eq!(two, [[0.0, 1.0, 2.0, 3.0, 1.0, 3.0, 3.0, 3.0, 3.0, 3.0]]);
    let rgb = read([2, 1], ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6]);
    assert_eq!(rgb, [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]);
    let indexed = read([2, 1], ColorType::Indexed, BitDepth::One, &[0b0100_0000]);
    assert_eq!(indexed, [[1.0, 40.0], [2.0, 50.0], [3.0, 60.0]]);
    let outside = png([2, 1], ColorType::Indexed, BitDepth::Eight, &[0, 2]);
    let expected = "d.png: pixel (1, 0): colour 2; expected one of the 2 of the palette";
    assert_eq!(read_png(&outside).unwrap_err(), expected);
}

#[test]
fn damaged_png_is_refused() {
    let good = png([2, 1], ColorType::Grayscale, BitDepth::Sixteen, &[1, 2, 3, 4]);
    assert!(read_png(b"not a picture").unwrap_err().starts_with("d.png: header: "));
    assert!(read_png(&good[..good.len() - 20]).unwrap_err().contains("a PNG file that is complete"));
    // A header that claims 2^31 - 1 columns: its check sum is another one, and the size is refused first or by that.
    let mut large = good.clone();
    large[16..20].copy_from_slice(&0x7fff_ffff_u32.to_be_bytes());
    assert!(read_png(&large).is_err());
    let few = Limits { bytes: 8, ..Limits::default() };
    let error = png_from_bytes(&good, Path::new("d.png"), &few).unwrap_err().to_string();
    assert!(error.contains("size: 2 x 1 cells of 1 components"), "{error}");
    // Two doubles are sixteen bytes.
    let enough = Limits { bytes: 16, ..Limits::default() };
    assert!(png_from_bytes(&good, Path::new("d.png"), &Limits { bytes: 15, ..enough }).is_err());
    assert!(png_from_bytes(&good, Path::new("d.png"), &enough).is_ok());
}

fn tiff<C: colortype::ColorType>(images: &[&[C::Inner]], tags: &[(Tag, u16)]) -> Vec<u8>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    for cells in images {
        let samples = C::SAMPLE_FORMAT.len();
        let mut image = encoder.new_image::<C>((cells.len() / samples) as u32, 1).unwrap();
        for (tag, value) in tags {
            image.encoder().write_tag(*tag, *value).unwrap();
        }
        image.write_data(cells).unwrap();
    }
    file.into_inner()
}

/// One pixel, whose red, green and blue lie in a strip each.
fn in_planes() -> Vec<u8> {
    // Tag, type (3: two bytes, 4: four), number of values, and the value or its place: behind these ten tags.
    let data = 8 + 2 + 12 * 10 + 4;
    let tags: [[u32; 4]; 10] = [
        [256, 3, 1, 1],
        [257, 3, 1, 1],
        [258, 3, 3, data],
        [259, 3, 1, 1],
        [262, 3, 1, 2],
        [273, 4, 3, data + 6],
        [277, 3, 1, 3],
        [278, 3, 1, 1],
        [279, 4, 3, data + 18],
        [284, 3, 1, 2],
    ];
    let mut file = b"II*\0\x08\0\0\0\x0a\0".to_vec();
    for [tag, kind, count, value] in tags {
        file.extend([tag as u16, kind as u16].map(u16::to_le_bytes).as_flattened());
        file.extend([count, value].map(u32::to_le_bytes).as_flattened());
    }
    file.extend([0; 4]);
    file.extend([8_u16; 3].map(u16::to_le_bytes).as_flattened());
    let strips = data + 30;
    file.extend([strips, strips + 1, strips + 2, 1, 1, 1].map(u32::to_le_bytes).as_flattened());
    file.extend([1, 2, 3]);
    file
}

#[test]
fn samples_of_tiff_are_the_numbers_of_the_file() {
    let sixteen = read_tiff(&tiff::<colortype::Gray16>(&[&[1500, 0, 65535]], &[])).unwrap();
    assert_eq!(sixteen.storage, Storage::Whole);
    assert_eq!(planes(sixteen), [[1500.0, 0.0, 65535.0]]);
    let reals = read_tiff(&tiff::<colortype::Gray32Float>(&[&[0.1, f32::INFINITY]], &[])).unwrap();
    assert_eq!(reals.storage, Storage::F32);
    assert_eq!(planes(reals), [[f64::from(0.1_f32), f64::INFINITY]]);
    let doubles = read_tiff(&tiff::<colortype::Gray64Float>(&[&[0.1, -2.0]], &[])).unwrap();
    assert_eq!((doubles.storage, planes(doubles)), (Storage::F64, vec![vec![0.1, -2.0]]));
    let rgb = read_tiff(&tiff::<colortype::RGB8>(&[&[1, 2, 3, 4, 5, 6]], &[])).unwrap();
    assert_eq!(planes(rgb), [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]);
    // -1 is "none"; other negative numbers have no meaning.
    let signed = read_tiff(&tiff::<colortype::GrayI16>(&[&[-1, 3]], &[])).unwrap();
    assert_eq!(planes(signed), [[4_294_967_295.0, 3.0]]);
    let error = read_tiff(&tiff::<colortype::GrayI16>(&[&[3, -2]], &[])).unwrap_err();
    assert_eq!(error, "d.tif: pixel (1, 0): -2; expected 0 to 4294967295, or -1 for none");
}

#[test]
fn tiff_that_could_be_misread_is_refused() {
    let two = tiff::<colortype::Gray16>(&[&[1], &[2]], &[]);
    assert_eq!(
        read_tiff(&two).unwrap_err(),
        "d.tif: second image: a page of its own; expected one image a file"
    );
    let overview = tiff::<colortype::Gray16>(&[&[1], &[2]], &[(Tag::NewSubfileType, 1)]);
    assert_eq!(planes(read_tiff(&overview).unwrap()), [[1.0]]);
    let mask = tiff::<colortype::Gray16>(&[&[1], &[2]], &[(Tag::NewSubfileType, 4)]);
    assert_eq!(planes(read_tiff(&mask).unwrap()), [[1.0]]);
    // A page of several is none of these.
    let page = tiff::<colortype::Gray16>(&[&[1], &[2]], &[(Tag::NewSubfileType, 2)]);
    assert!(read_tiff(&page).unwrap_err().contains("second image: a page of its own"));
    let white = tiff::<colortype::Gray16>(&[&[1]], &[(Tag::PhotometricInterpretation, 0)]);
    let expected = "d.tif: PhotometricInterpretation: 0, where 0 is white; expected 1, where 0 is black";
    assert_eq!(read_tiff(&white).unwrap_err(), expected);
    // Samples that lie in planes, one after the other; a single one does so however it is called.
    let apart = in_planes();
    let expected = "d.tif: PlanarConfiguration: 2; expected 1: the samples of a pixel side by side";
    assert_eq!(read_tiff(&apart).unwrap_err(), expected);
    let alone = tiff::<colortype::Gray8>(&[&[7]], &[(Tag::PlanarConfiguration, 2)]);
    assert_eq!(planes(read_tiff(&alone).unwrap()), [[7.0]]);
    let turned = tiff::<colortype::Gray16>(&[&[1]], &[(Tag::Orientation, 3)]);
    let expected = "d.tif: Orientation: 3; expected 1: row 0 on top, column 0 at the left";
    assert_eq!(read_tiff(&turned).unwrap_err(), expected);
    assert!(read_tiff(b"II*\0").unwrap_err().starts_with("d.tif: header: "));
    let good = tiff::<colortype::Gray16>(&[&[1, 2, 3]], &[]);
    assert!(read_tiff(&good[..good.len() - 4]).is_err());
}
