use super::*;

/// An image of 8 columns and 40 rows. `of_column` gives the upper and lower edges of each column's stripes, in rows
/// from the top. A pixel is 5 plus 95 times its lit share.
fn stripes(of_column: impl Fn(u32) -> Vec<(f64, f64)>) -> Image<f64> {
    let mut image = Image::filled(8, 40, 5.0);
    for i in 0..8 {
        for (upper, lower) in of_column(i) {
            for j in 0..40 {
                let (top, bottom) = (f64::from(j), f64::from(j + 1));
                let share = (bottom.min(lower) - top.max(upper)).max(0.0);
                image.set(i, j, image.at(i, j) + 95.0 * share);
            }
        }
    }
    image
}

#[test]
fn whole_pixels_by_threshold() {
    // In column 2, rows 10 to 12 are fully lit, and row 13 by a tenth (14.5). Column 5 is one row lower.
    let image = stripes(|i| match i {
        2 => vec![(10.0, 13.1)],
        5 => vec![(11.0, 14.1)],
        _ => vec![],
    });
    let edges = Extraction::thresholding(50.0).edges(&image);
    let expected = [EdgePoint { i: 2, j: 12, row: 12.5 }, EdgePoint { i: 5, j: 13, row: 13.5 }];
    assert_eq!(edges, expected);
    // The same for a digital image.
    let digital = Image::from_cells(8, 40, image.cells().iter().map(|&value| value as u16).collect());
    assert_eq!(Extraction::thresholding(50.0).edges(&digital), expected);
}

#[test]
fn a_pixel_at_the_threshold_is_lit() {
    // Rows 3 and 4 have the value of the threshold, row 5 is just below it: row 4 is the last lit one.
    let image = Image::from_cells(1, 8, vec![0.0, 0.0, 0.0, 50.0, 50.0, 49.0, 0.0, 0.0]);
    let edges = Extraction::thresholding(50.0).edges(&image);
    assert_eq!(edges, [EdgePoint { i: 0, j: 4, row: 4.5 }]);
}

#[test]
fn edges_are_in_row_major_order_and_runs_are_separate() {
    // Two runs in column 1, and one in column 0 at rows between them.
    let image = stripes(|i| match i {
        0 => vec![(15.0, 17.0)],
        1 => vec![(10.0, 12.0), (20.0, 21.0)],
        _ => vec![],
    });
    let places = |edges: &[EdgePoint]| edges.iter().map(|edge| (edge.j, edge.i)).collect::<Vec<_>>();
    let extraction = Extraction::thresholding(50.0);
    assert_eq!(places(&extraction.edges(&image)), [(11, 1), (16, 0), (20, 1)]);
    // A run of one row is no stripe if two rows are required.
    assert_eq!(places(&Extraction { least_rows: 2, ..extraction }.edges(&image)), [(11, 1), (16, 0)]);
}

#[test]
fn wide_images_are_read_in_strips() {
    // A stripe that descends by one row per column, over three strips; the last one is narrower.
    let width = 2 * COLUMNS_PER_STRIP as u32 + 5;
    let mut image = Image::filled(width, width + 3, 0_u16);
    (0..width).for_each(|i| image.set(i, i + 1, 9));
    let edges = Extraction::thresholding(5.0).edges(&image);
    assert_eq!(edges.len(), width as usize);
    assert!(edges.iter().zip(0..).all(|(edge, i)| (edge.i, edge.j) == (i, i + 1)));
    assert!(Extraction::thresholding(5.0).edges(&Image::<u16>::from_cells(0, 0, vec![])).is_empty());
}

#[test]
fn a_run_that_the_border_cuts_off_has_no_lower_edge() {
    let image = stripes(|i| if i == 3 { vec![(37.0, 40.0)] } else { vec![(0.0, 2.0)] });
    let edges = Extraction::thresholding(50.0).edges(&image);
    assert_eq!(edges.len(), 7);
    assert!(edges.iter().all(|edge| edge.i != 3 && edge.j == 1));
}

#[test]
fn sub_pixel_edges_and_centroids() {
    // A stripe from 10 to 13 + f, with the threshold half way between dark and light. The crossing is exact for f = 0,
    // 1/2 and 1. Otherwise its error is at most |1/2 + 1/(2 (1 - f)) - 1 - f|: 0.086 at f = 0.29 (1 - sqrt(1/2)).
    let extraction = Extraction { place: StripeLocation::SubPixel, ..Extraction::thresholding(52.5) };
    for share in [0.0, 0.1, 0.29, 0.45, 0.5, 0.6, 0.75, 0.95] {
        let image = stripes(|_| vec![(10.0, 13.0 + share)]);
        for edge in extraction.edges(&image) {
            assert!((edge.row - 13.0 - share).abs() < 0.0858, "{} for {share}", edge.row - 13.0);
        }
    }
    let exact = extraction.edges(&stripes(|_| vec![(10.0, 13.5)]));
    assert!((exact[0].row - 13.5).abs() < 1e-12);
    // Lit from 10 to 13: the centroid is the middle, 11.5.
    let centroid = Extraction { place: StripeLocation::Centroid, ..extraction };
    let edge = centroid.edges(&stripes(|_| vec![(10.0, 13.0)]))[0];
    assert_eq!((edge.j, edge.row), (11, 11.5));
}

#[test]
fn edges_by_gradient_do_not_need_a_level() {
    // A stripe of 20 and one of 100 in the same image, on a dark value that grows with the row: no single threshold is
    // good for both. The lower edges are between rows 12 and 13.
    let mut image = Image::filled(2, 30, 0.0);
    for (i, light) in [(0, 20.0), (1, 100.0)] {
        for j in 0..30 {
            let lit = if (10..13).contains(&j) { light } else { 0.0 };
            image.set(i, j, lit + 2.0 * f64::from(j));
        }
    }
    let extraction =
        Extraction { detection: Detection::Gradient(8.0), place: StripeLocation::Pixel, least_rows: 1 };
    let rows: Vec<u32> = extraction.edges(&image).iter().map(|edge| edge.j).collect();
    assert_eq!(rows, [12, 12]);
    // The differences are symmetric around the border 13: the vertex is there.
    let fine = Extraction { place: StripeLocation::SubPixel, ..extraction }.edges(&image);
    assert!(fine.iter().all(|edge| (edge.row - 13.0).abs() < 1e-12));
}

#[test]
fn an_edge_by_gradient_is_the_vertex_of_a_parabola() {
    // Differences 100, 0, -20, -70, -10: the steepest is between rows 3 and 4. The parabola 55 x^2 + 5 x - 70 goes through
    // the last three at x = -1, 0 and 1; its vertex is at -5 / 110.
    let image = Image::from_cells(1, 6, vec![0.0, 100.0, 100.0, 80.0, 10.0, 0.0]);
    let extraction =
        Extraction { detection: Detection::Gradient(8.0), place: StripeLocation::SubPixel, least_rows: 1 };
    let edges = extraction.edges(&image);
    assert_eq!((edges.len(), edges[0].j), (1, 3));
    assert!((edges[0].row - (4.0 - 1.0 / 22.0)).abs() < 1e-15, "{}", edges[0].row);
}

#[test]
fn a_second_fall_without_a_rise_begins_below_the_first() {
    // Differences 100, -40, -5, -55: a rise above row 1, falls below rows 1 and 3. The runs are 1..=1 and 2..=3. The
    // centroid of the second is (60 * 2.5 + 55 * 3.5) / 115.
    let image = Image::from_cells(1, 5, vec![0.0, 100.0, 60.0, 55.0, 0.0]);
    let extraction =
        Extraction { detection: Detection::Gradient(8.0), place: StripeLocation::Centroid, least_rows: 1 };
    let edges = extraction.edges(&image);
    let expected = [EdgePoint { i: 0, j: 1, row: 1.5 }, EdgePoint { i: 0, j: 2, row: 342.5 / 115.0 }];
    assert_eq!(edges, expected);
    // The runs have one row and two rows. The second does not have three.
    let rows = |least_rows| Extraction { least_rows, ..extraction }.edges(&image).len();
    assert_eq!((rows(2), rows(3)), (1, 0));
    // Without a rise the first run begins at the border: differences -40, -5, -55, runs 0..=0 and 1..=2.
    let cut_off = Image::from_cells(1, 4, vec![100.0, 60.0, 55.0, 0.0]);
    let rows: Vec<f64> = extraction.edges(&cut_off).iter().map(|edge| edge.row).collect();
    assert_eq!(rows, [0.5, 227.5 / 115.0]);
}

#[test]
fn otsu_needs_no_level() {
    let image = stripes(|i| vec![(10.0 + f64::from(i), 13.0 + f64::from(i))]);
    let extraction = Extraction { detection: Detection::Otsu, ..Extraction::thresholding(0.0) };
    assert_eq!(extraction.edges(&image), Extraction::thresholding(52.5).edges(&image));
    // An image of one value holds no stripe.
    assert!(extraction.edges(&Image::filled(4, 4, 7.0)).is_empty());
}

#[test]
fn an_extraction_is_checked() {
    assert!(Extraction::thresholding(f64::NAN).validate("stripes").is_err());
    assert!(Extraction::thresholding(1.0).validate("stripes").is_ok());
}

#[test]
fn a_share_is_one_of_the_brightest_pixel() {
    // The brightest pixel has 8e-9 W: a quarter of it is 2e-9 W. The sum of all would be far more.
    let mut image = Image::filled(6, 8, 1e-9);
    for (i, watts) in [(0, 8e-9), (1, 2e-9), (2, 1.9e-9), (3, 3e-9)] {
        image.set(i, 4, watts);
    }
    let extraction = Extraction { detection: Detection::Share(0.25), ..Extraction::thresholding(0.0) };
    let columns: Vec<u32> = extraction.edges(&image).iter().map(|edge| edge.i).collect();
    assert_eq!(columns, [0, 1, 3]);
    // A dark image has no stripes.
    assert!(extraction.edges(&Image::filled(6, 8, 0.0)).is_empty());
}

#[test]
fn a_centroid_of_one_row_says_no_more_than_its_pixel() {
    let pixel = (1.0_f64 / 12.0).sqrt();
    // One lit row; two, of which the lower one is brighter.
    let mut image = Image::filled(2, 8, 0.0);
    image.set(0, 3, 700.0);
    image.set(1, 3, 100.0);
    image.set(1, 4, 300.0);
    let extraction = Extraction { place: StripeLocation::Centroid, ..Extraction::thresholding(50.0) };
    let edges = extraction.edges(&image);
    assert_eq!(edges.iter().map(|edge| edge.row).collect::<Vec<_>>(), [3.5, 4.25]);
    let errors = |place: StripeLocation| edges.iter().map(|edge| place.row_error(edge)).collect::<Vec<_>>();
    assert_eq!(errors(StripeLocation::Centroid), [pixel, 0.1]);
    assert_eq!(errors(StripeLocation::SubPixel), [0.1, 0.1]);
    assert_eq!(errors(StripeLocation::Pixel), [pixel, pixel]);
}
