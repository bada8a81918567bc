//! The page of a cast: a ray that another program gets wrong is found, and numbers are those of the arrays.

use raypencil::Silent;
use raypencil::cast::{
    Answers, CastPage, ComparedHits, PageScan, Questions, RayArray, Stated, cast, compare, write_cast_page,
};
use raypencil::pattern::{Mounting, Spinning};
use raypencil::{CastRay, NamedRaySet, Pose, Precision, Sides, Triangles};
use tempfile::TempDir;

use super::browser::open;

/// Columns of the rays.
const WIDTH: usize = 12;

/// The ray that the other program gets wrong.
const WRONG: usize = 5 * WIDTH + 7;

/// A square of two faces, 10 m wide, and 12 x 9 parallel rays from above of which some pass it.
fn question() -> (Triangles, RayArray) {
    let corners = vec![[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 2.0], [0.0, 10.0, 2.0]];
    let mesh = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    let ray = |k: usize| {
        let (i, j) = ((k % WIDTH) as f64, (k / WIDTH) as f64);
        CastRay::new([i + 0.25, j + 0.5, 7.0].into(), [0.0, 0.0, -2.0].into())
    };
    (mesh, RayArray { shape: vec![9, WIDTH as u64], rays: (0..9 * WIDTH).map(ray).collect() })
}

fn answered() -> (Triangles, RayArray, Answers) {
    let (mesh, rays) = question();
    let answers = cast(&mesh, &rays.rays, Sides::Both, Questions::default(), &Silent);
    (mesh, rays, answers)
}

/// The page of a program whose range is a millimetre too long on one ray.
pub fn with_one_wrong() -> TempDir {
    let (mesh, rays, answers) = answered();
    let mut stated = Stated::of(&answers);
    for lengths in [&mut stated.t, &mut stated.range] {
        lengths.as_mut().expect("they are given")[WRONG] += 1e-3;
    }
    let comparison = compare(&mesh, &rays.rays, Sides::Both, &stated, Precision::F64, &Silent);
    assert_eq!(comparison.counts().wrong, 1);
    let ray_command = |index: usize| format!("the command of ray {index}");
    let page = CastPage {
        title: "rays on a square",
        facts: &[("mesh", "a square".into())],
        shape: &rays.shape,
        rays: &rays.rays,
        answers: &answers,
        mesh: Some(&mesh),
        set: None,
        scan: None,
        has_arrays: true,
        compared: Some(ComparedHits {
            name: "one-wrong",
            stated: &stated,
            comparison: &comparison,
            ray_command: &ray_command,
        }),
    };
    let folder = tempfile::tempdir().expect("a folder");
    write_cast_page(folder.path(), &page).expect("a page");
    folder
}

#[test]
fn a_wrong_ray_leads_to_its_words_and_cells_show_their_numbers() {
    let folder = with_one_wrong();
    let Some(page) = open(&folder.path().join("report.html"), "", (1280, 1000)) else { return };
    page.wait("document.querySelectorAll('[data-ray-table] [data-row]').length === 1");
    page.click("[data-ray-table] [data-row=\"0\"]");
    page.wait("document.querySelector('[data-detail-probe]') !== null");
    let words = page.text("document.querySelector('[data-detail]').textContent");
    for part in ["ray 67", "one-wrong", "the command of ray 67", "No rounding explains"] {
        assert!(words.contains(part), "{part} is not in {words}");
    }
    // Column 7 and row 5 of the rays' own array.
    assert_eq!(page.text("location.hash").split('/').nth(1), Some("7,5"));
    // Every fifth cell, both sides: the number of the answers, in single precision.
    let (_, _, answers) = answered();
    let (mut hits, mut misses) = (0, 0);
    for k in (0..answers.first.len()).step_by(5) {
        let (i, j) = (k % WIDTH, k / WIDTH);
        page.ask(&format!("(() => {{ location.hash = '#rays/{i},{j}/range.T'; }})()"));
        page.wait(&format!(
            "document.querySelector('[data-readout=\"i\"]')?.dataset.value === '{i}' && \
             document.querySelector('[data-readout=\"j\"]').dataset.value === '{j}' && \
             document.querySelector('[data-readout-root]').dataset.state === 'ready'"
        ));
        let shown = ["a", "b"].map(|side| {
            page.text(&format!("document.querySelector('[data-readout=\"{side}\"]').dataset.value"))
        });
        let expected = answers.first[k].hit().map_or(f32::INFINITY, |hit| hit.range as f32);
        for text in &shown {
            let number = if text == "Infinity" { f32::INFINITY } else { text.parse().expect("a number") };
            assert_eq!(number, expected, "{i},{j}: {shown:?}");
        }
        *(if expected.is_finite() { &mut hits } else { &mut misses }) += 1;
    }
    assert!(hits > 10 && misses > 1, "{hits} hits, {misses} misses");
    page.assert_quiet();
}

#[test]
fn answers_alone_have_one_side() {
    let (mesh, rays, answers) = answered();
    let page = CastPage {
        title: "rays on a square",
        facts: &[],
        shape: &rays.shape,
        rays: &rays.rays,
        answers: &answers,
        mesh: Some(&mesh),
        set: None,
        scan: None,
        has_arrays: true,
        compared: None,
    };
    let folder = tempfile::tempdir().expect("a folder");
    write_cast_page(folder.path(), &page).expect("a page");
    let Some(page) = open(&folder.path().join("report.html"), "#rays/3,2/face.I", (1280, 1000)) else {
        return;
    };
    page.wait("document.querySelector('[data-readout-root]')?.dataset.state === 'ready'");
    let face = answers.first[2 * WIDTH + 3].hit().expect("a hit").face.0.to_string();
    assert_eq!(page.text("document.querySelector('[data-readout=\"a\"]').dataset.value"), face);
    assert_eq!(
        page.number("document.querySelectorAll('[data-choose=\"b\"], [data-mode=\"b\"]').length"),
        0.0
    );
    page.assert_quiet();
}

#[test]
fn what_is_too_near_is_told_from_a_miss() {
    let (mesh, mut rays) = question();
    // The first ray meets the square at t = 3.45: a sensor that is blind before t = 4 finds it too near.
    rays.rays[0].t_blind = 4.0;
    let answers = cast(&mesh, &rays.rays, Sides::Both, Questions::default(), &Silent);
    assert_eq!(answers.too_near(), 1);
    let page = CastPage {
        title: "rays on a square",
        facts: &[],
        shape: &rays.shape,
        rays: &rays.rays,
        answers: &answers,
        mesh: Some(&mesh),
        set: None,
        scan: None,
        has_arrays: true,
        compared: None,
    };
    let folder = tempfile::tempdir().expect("a folder");
    write_cast_page(folder.path(), &page).expect("a page");
    let Some(page) = open(&folder.path().join("report.html"), "#rays/0,0/range.T", (1280, 1000)) else {
        return;
    };
    page.wait("document.querySelector('[data-readout-root]')?.dataset.state === 'ready'");
    assert_eq!(page.text("document.querySelector('[data-readout=\"a\"]').textContent"), "too near");
    assert_eq!(page.text("document.querySelector('[data-readout=\"a\"]').dataset.value"), "-Infinity");
    assert!(page.text("document.body.textContent").contains("1 too near"));
    page.assert_quiet();
}

#[test]
fn a_scan_has_its_angles_and_its_points_in_3d() {
    // A VLP-16 over the middle of a floor. The other program lost one point, and has no faces.
    let corners = vec![[-20.0, -20.0, 0.0], [20.0, -20.0, 0.0], [20.0, 20.0, 0.0], [-20.0, 20.0, 0.0]];
    let floor = Triangles::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    let pattern = Spinning::preset("vlp-16").expect("a preset").rays("vlp16").expect("rays");
    let mount = Mounting::Fixed(Pose::from_position([0.0, 0.0, 1.2].into()));
    let pattern = mount.place(pattern, "vlp16").expect("a pattern");
    let set = NamedRaySet::new("vlp16", pattern, Sides::Both).expect("a set");
    let rays = set.set.rays();
    let answers = cast(&floor, rays, Sides::Both, Questions::default(), &Silent);
    // Firing sequence 500, channel 0, which looks 15 degrees down: the lowest row, 15.
    let lost = 500 * 16;
    let exact = Stated::of(&answers);
    let mut stated = Stated { point: exact.point, t: exact.t, ..Stated::default() };
    stated.t.as_mut().expect("given")[lost] = f64::NAN;
    stated.point.as_mut().expect("given")[lost] = [f64::NAN; 3].into();
    let comparison = compare(&floor, rays, Sides::Both, &stated, Precision::F64, &Silent);
    assert_eq!(comparison.counts().wrong, 1);
    let page = CastPage {
        title: "a scan",
        facts: &[],
        shape: &set.shape,
        rays,
        answers: &answers,
        mesh: Some(&floor),
        set: None,
        scan: Some(PageScan::of(&set)),
        has_arrays: true,
        compared: Some(ComparedHits {
            name: "other",
            stated: &stated,
            comparison: &comparison,
            ray_command: &|index| index.to_string(),
        }),
    };
    let folder = tempfile::tempdir().expect("a folder");
    write_cast_page(folder.path(), &page).expect("a page");
    let opened = open(&folder.path().join("report.html"), "#vlp16/500,15/range.T/diff", (1280, 2600));
    let Some(page) = opened else { return };
    page.wait("document.querySelector('[data-readout-root]')?.dataset.state === 'ready'");
    // 500 steps of -0.1990656 degrees.
    let direction = page.text("document.querySelector('[data-readout=\"direction\"]').textContent");
    assert_eq!(direction, "azimuth \u{2212}99.5328°, elevation \u{2212}15°");
    let difference = page.text("document.querySelector('[data-readout=\"difference\"]').textContent");
    assert_eq!(difference, "none: A has a hit, B has none");
    // Rows are so high that they are seen: 16 of them on a picture of a page's width.
    let [high, wide] = ["Height", "Width"]
        .map(|side| page.number(&format!("document.querySelector('[data-panel=\"vlp16\"]').client{side}")));
    assert!(high > 16.0 * 12.0 && wide > 900.0, "{wide} x {high}");
    page.wait("document.querySelector('[data-cloud-3d]').dataset.state === 'ready'");
    let points = || page.number("Number(document.querySelector('[data-cloud-3d]').dataset.points)") as usize;
    assert_eq!(points(), answers.counts().0);
    // Those of the other program, which has one less.
    page.click("[data-mode=\"b\"]");
    page.wait(&format!(
        "document.querySelector('[data-cloud-3d]').dataset.points === '{}'",
        answers.counts().0 - 1
    ));
    page.assert_quiet();
}
