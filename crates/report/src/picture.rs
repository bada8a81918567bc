//! Maps as pictures: colour maps, downsampling, PNG.
//!
//! A picture is indexed: 253 colours of a map, one for a hit on one side only, and a transparent one for no
//! hit, through which the page's hatch shows.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use colorous::Gradient;

use crate::scale::Scale;
use raypencil_scene::{Image, Maybe};

/// Colours of a colour map; odd, so that the middle of a symmetric scale has a colour of its own.
const COLOURS: u8 = 253;

/// The index of a cell that only one side hits.
const ONE_SIDED: u8 = 254;

/// The index of a cell without a hit; transparent.
const NO_HIT: u8 = 255;

/// The colour of [`ONE_SIDED`]: in neither colour map.
const ONE_SIDED_COLOUR: [u8; 3] = [0xff, 0x00, 0xe6];

/// A perceptual colour map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourMap {
    /// For ranges: viridis, dark near by and bright far away.
    Sequential,
    /// For signed differences: blue below zero, near white at zero, red above.
    Diverging,
}

impl ColourMap {
    /// The colour at a place from 0 to 1.
    pub fn at(self, place: f64) -> [u8; 3] {
        const SEQUENTIAL: Gradient = colorous::VIRIDIS;
        const DIVERGING: Gradient = colorous::RED_BLUE;
        let colour = match self {
            Self::Sequential => SEQUENTIAL.eval_continuous(place),
            Self::Diverging => DIVERGING.eval_continuous(1.0 - place),
        };
        [colour.r, colour.g, colour.b]
    }

    /// The whole map as a CSS gradient from left to right.
    pub fn css(self) -> String {
        const STOPS: u32 = 32;
        let stops: Vec<String> = (0..=STOPS)
            .map(|stop| {
                let [r, g, b] = self.at(f64::from(stop) / f64::from(STOPS));
                format!("#{r:02x}{g:02x}{b:02x}")
            })
            .collect();
        format!("linear-gradient(to right,{})", stops.join(","))
    }
}

/// How many columns and rows of a map become one of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reduction {
    pub columns: u32,
    pub rows: u32,
}

impl Reduction {
    /// The least that brings a map of this size below `most` columns and rows.
    pub fn to_fit(width: u32, height: u32, most: u32) -> Self {
        Self { columns: width.div_ceil(most), rows: height.div_ceil(most) }
    }
}

/// One map, drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub png: Vec<u8>,
}

impl Picture {
    /// A range map: of each block of cells the middle one.
    pub fn of_map(map: &Image<Maybe<f64>>, scale: Scale, reduction: Reduction) -> Self {
        let Reduction { columns, rows } = reduction;
        Self::draw(map.width(), map.height(), reduction, ColourMap::Sequential, |i, j| {
            let (i, j) = ((i + columns / 2).min(map.width() - 1), (j + rows / 2).min(map.height() - 1));
            map.at(i, j).get().map_or(NO_HIT, |value| index(scale.fraction(value)))
        })
    }

    /// A map of light: of each block of cells the brightest, so that no lit cell is lost.
    pub fn of_light(map: &Image<Maybe<f64>>, scale: Scale, reduction: Reduction) -> Self {
        let (width, height) = (map.width(), map.height());
        Self::draw(width, height, reduction, ColourMap::Sequential, |left, top| {
            let rows = top..(top + reduction.rows).min(height);
            let cells = rows.flat_map(|j| (left..(left + reduction.columns).min(width)).map(move |i| (i, j)));
            let brightest = cells.filter_map(|(i, j)| map.at(i, j).get()).reduce(f64::max);
            brightest.map_or(NO_HIT, |value| index(scale.fraction(value)))
        })
    }

    /// A map of differences: of each block the cell that differs most, so that no difference is lost. A hit
    /// on one side only differs more than any value.
    pub fn of_differences(
        differences: &Image<Maybe<f64>>,
        one_sided: impl Fn(u32, u32) -> bool,
        scale: Scale,
        reduction: Reduction,
    ) -> Self {
        Self::farthest(differences, one_sided, scale, reduction, ColourMap::Diverging)
    }

    /// A map of absolute differences, as [`Picture::of_differences`].
    pub fn of_errors(
        errors: &Image<Maybe<f64>>,
        one_sided: impl Fn(u32, u32) -> bool,
        scale: Scale,
        reduction: Reduction,
    ) -> Self {
        Self::farthest(errors, one_sided, scale, reduction, ColourMap::Sequential)
    }

    /// Of each block the value that is farthest from zero.
    fn farthest(
        values: &Image<Maybe<f64>>,
        one_sided: impl Fn(u32, u32) -> bool,
        scale: Scale,
        reduction: Reduction,
        colours: ColourMap,
    ) -> Self {
        let (width, height) = (values.width(), values.height());
        Self::draw(width, height, reduction, colours, |left, top| {
            let mut worst: Option<f64> = None;
            for j in top..(top + reduction.rows).min(height) {
                for i in left..(left + reduction.columns).min(width) {
                    if one_sided(i, j) {
                        return ONE_SIDED;
                    }
                    if let Some(value) = values.at(i, j).get()
                        && worst.is_none_or(|worst| value.abs() > worst.abs())
                    {
                        worst = Some(value);
                    }
                }
            }
            worst.map_or(NO_HIT, |value| index(scale.fraction(value)))
        })
    }

    /// Asks for the index of each block, by its top left cell.
    fn draw(
        width: u32,
        height: u32,
        Reduction { columns, rows }: Reduction,
        colours: ColourMap,
        index: impl Fn(u32, u32) -> u8,
    ) -> Self {
        let (drawn_width, drawn_height) = (width.div_ceil(columns), height.div_ceil(rows));
        let cells: Vec<u8> = (0..drawn_height)
            .flat_map(|j| (0..drawn_width).map(move |i| (i, j)))
            .map(|(i, j)| index(i * columns, j * rows))
            .collect();
        let png = encode(drawn_width, drawn_height, &cells, colours);
        Self { width: drawn_width, height: drawn_height, png }
    }

    /// The picture as an address that holds it.
    pub fn data_uri(&self) -> String {
        format!("data:image/png;base64,{}", STANDARD.encode(&self.png))
    }
}

/// The colour index of a place from 0 to 1.
fn index(place: f64) -> u8 {
    (place * f64::from(COLOURS - 1)).round() as u8
}

/// An indexed PNG. Encoding into memory cannot fail once sizes match.
fn encode(width: u32, height: u32, cells: &[u8], colours: ColourMap) -> Vec<u8> {
    let mut palette = Vec::with_capacity(3 * 256);
    for colour in 0..COLOURS {
        palette.extend(colours.at(f64::from(colour) / f64::from(COLOURS - 1)));
    }
    palette.extend([0; 3]);
    palette.extend(ONE_SIDED_COLOUR);
    palette.extend([0x80; 3]);
    let mut opacity = vec![0xff; 256];
    opacity[usize::from(NO_HIT)] = 0;

    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_trns(opacity);
    encoder.set_compression(png::Compression::High);
    // Indices are no brightnesses: differences between neighbours compress no better than they do.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header().expect("a picture of at least one cell");
    writer.write_image_data(cells).expect("as many cells as the picture has");
    writer.finish().expect("writing to memory");
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn the_gradient_runs_from_end_to_end() {
        let css = ColourMap::Sequential.css();
        assert!(css.starts_with("linear-gradient(to right,#440154,"), "{css}");
        assert!(css.ends_with(",#fde725)"), "{css}");
    }
}
