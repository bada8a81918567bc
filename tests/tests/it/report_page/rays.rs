//! Rays that do not agree: each is in the table, leads to its pixel and to its words, and stands in the 3-D picture.

use std::collections::BTreeMap;

use raypencil::harness::{Contender, contender, validate};
use raypencil::judge::{Class, JudgeShare};
use raypencil::{Maybe, Place, Precision, RenderOutput, Renderer, Request, Scene, SensorId, Silent, Tracer};
use raypencil_tests::fixtures;

use super::browser::{Page, open};
use super::{Written, paper};

/// Number of rows of the table, without its head.
const ROWS: &str = "Number(document.querySelector('[data-ray-table]').getAttribute('aria-rowcount')) - 1";

/// Waits until the page has read its rays.
fn ready(page: &Page, rays: u64) {
    page.wait("!document.getElementById('explorer').hidden");
    page.wait(&format!("document.querySelector('[data-ray-table]') !== null && {ROWS} === {rays}"));
}

#[test]
fn filters_count_as_the_summary_does() {
    let written = paper();
    let counts = written.validation.counts();
    let differing = counts.compared - counts.agree;
    assert!(counts.approximation > 20 && counts.defects == 0, "{counts:?}");
    let Some(page) = open(&written.page(), "", (1280, 1000)) else { return };
    ready(&page, differing);
    // Causes: the cards, the chips and the rows that a chip leaves.
    let causes = written.validation.approximations();
    assert!(causes.len() > 1);
    for (index, (switches, tally)) in causes.iter().enumerate() {
        let card =
            format!("document.querySelector('[data-cause=\"{index}\"] [data-cause-rays]').textContent");
        assert!(page.text(&card).starts_with(&tally.rays.to_string()), "{switches}");
        let chip = format!("document.querySelector('[data-chip=\"cause-{index}\"]')");
        assert_eq!(page.number(&format!("Number({chip}.dataset.count)")), tally.rays as f64, "{switches}");
        page.ask(&format!("{chip}.click()"));
        page.wait(&format!("{ROWS} === {}", tally.rays));
        page.ask(&format!("document.querySelector('[data-chip=\"cause-{index}\"]').click()"));
        page.wait(&format!("{ROWS} === {differing}"));
    }
    // Sensors.
    let mut of_sensors: BTreeMap<usize, u64> = BTreeMap::new();
    for (index, sensor) in written.validation.pairs[0].sensors.iter().enumerate() {
        assert_eq!(sensor.differing.len() as u64, sensor.compared() - sensor.of(Class::Agree));
        of_sensors.insert(index, sensor.differing.len() as u64);
    }
    for (index, rays) in of_sensors.into_iter().filter(|(_, rays)| *rays > 0) {
        let chip = format!("document.querySelector('[data-chip=\"sensor-{index}\"]')");
        assert_eq!(page.number(&format!("Number({chip}.dataset.count)")), rays as f64, "sensor {index}");
    }
    page.assert_quiet();
}

#[test]
fn every_differing_ray_has_its_words() {
    let written = paper();
    let counts = written.validation.counts();
    let Some(page) = open(&written.page(), "", (1280, 1000)) else { return };
    ready(&page, counts.compared - counts.agree);
    // From ray to ray by the key `n`: each has a verdict, and the words of `probe` with its place in them.
    page.ask("document.querySelector('canvas[data-panel]').focus()");
    let total = (counts.compared - counts.agree).min(40);
    let mut seen = std::collections::BTreeSet::new();
    let mut of_flux = 0;
    for _ in 0..total {
        let before = page.ask("document.querySelector('[data-detail]')?.dataset.cell ?? null");
        let sensor_before = page.ask("document.querySelector('[data-detail]')?.dataset.sensor ?? null");
        page.press("n");
        page.wait(&format!(
            "(d => d && d.querySelector('[data-detail-verdict]') && \
             (d.dataset.cell !== {before} || d.dataset.sensor !== {sensor_before}))\
             (document.querySelector('[data-detail]'))"
        ));
        page.wait("document.querySelector('[data-detail-probe]') !== null");
        let text = page.text("document.querySelector('[data-detail]').textContent");
        let sensor = page.number("Number(document.querySelector('[data-detail]').dataset.sensor)") as usize;
        let cell = page.number("Number(document.querySelector('[data-detail]').dataset.cell)") as u32;
        let id = written.validation.subject.scene.sensors().nth(sensor).expect("a sensor");
        let (width, _) = written.validation.subject.scene.size(id).expect("its size");
        let place = Place { sensor: id, i: cell % width, j: cell / width };
        let command = raypencil::io::probe_command(&written.validation.subject, place);
        assert!(text.contains(&command), "{command} is not in {text}");
        assert!(text.contains("error of the paper"), "{text}");
        of_flux += usize::from(text.contains("What is not the same is the pixel flux: "));
        assert!(seen.insert((sensor, cell)), "{place} comes twice");
    }
    assert!(seen.len() > 20 && of_flux > 5, "{} rays, {of_flux} by their flux", seen.len());
    page.assert_quiet();
}

/// The tracer, wrong on one pixel: its range is a millimetre too long.
struct OneWrong(Tracer);

/// The wrong pixel.
const WRONG: Place = Place { sensor: SensorId::Camera, i: 20, j: 30 };

impl Renderer for OneWrong {
    fn name(&self) -> &str {
        "one-wrong"
    }

    fn precision(&self) -> Precision {
        self.0.precision()
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mut output = self.0.render(scene, request);
        if let Some(range) = output.camera.as_mut().and_then(|map| map.range.as_mut()) {
            let right = range.at(WRONG.i, WRONG.j).get().expect("a hit");
            range.set(WRONG.i, WRONG.j, Maybe::some(right + 1e-3));
        }
        output
    }
}

fn one_wrong() -> Written {
    let contenders = [contender("scanline").expect("a renderer"), Contender::from(OneWrong(Tracer::new()))];
    Written::new(validate(fixtures::subject(), &contenders, JudgeShare::Sample, &Silent))
}

#[test]
fn a_click_on_a_planted_defect_leads_to_its_pixel_and_its_words() {
    let written = one_wrong();
    assert_eq!(written.validation.counts().defects, 1);
    let Some(page) = open(&written.page(), "", (1280, 1000)) else { return };
    ready(&page, 1);
    page.click("[data-ray-table] [data-row=\"0\"]");
    page.wait("document.querySelector('[data-detail-verdict]') !== null");
    page.wait("document.querySelector('[data-readout-root]').dataset.state === 'ready'");
    assert_eq!(page.text("location.hash").split('/').nth(1), Some("20,30"));
    let read = |name: &str| {
        page.number(&format!("Number(document.querySelector('[data-readout=\"{name}\"]').dataset.value)"))
    };
    assert_eq!((read("i"), read("j"), read("class")), (20.0, 30.0, f64::from(Class::Defect as u8)));
    // The difference of the two f64 ranges is a millimetre, and billions of times its bound.
    assert!((read("difference") - 1e-3).abs() < 1e-6, "{}", read("difference"));
    assert!(read("share") > 1e6, "{}", read("share"));
    let words = page.text("document.querySelector('[data-detail]').textContent");
    for part in ["one-wrong", "raypencil probe pyramids --fan 60 --pixel 20,30", "camera (20, 30)"] {
        assert!(words.contains(part), "{part} is not in {words}");
    }
    page.assert_quiet();
}

#[test]
fn the_geometry_shows_the_hit_where_it_is() {
    let written = one_wrong();
    let Some(page) = open(&written.page(), "", (1280, 1000)) else { return };
    ready(&page, 1);
    page.click("[data-ray-table] [data-row=\"0\"]");
    page.wait("document.querySelector('[data-show-3d]') !== null");
    page.click("[data-show-3d]");
    page.wait("document.querySelector('.view3d')?.dataset.state === 'ready'");
    page.wait("document.querySelector('.view3d').dataset.ray === '0/1460'");
    // Seen exactly as by the camera, the hit of pixel (20, 30) lies on that pixel.
    page.ask("document.querySelector('button[data-view=\"camera\"]').click()");
    page.wait("document.querySelector('[data-geometry] [data-view]') !== null");
    let map = written.validation.rendered[0].output.map(SensorId::Camera).expect("the camera's map");
    let place = |i: u32, j: u32| {
        let [x, y, z] = map.hit(i, j).expect("a hit").point.to_array();
        let project = format!("document.querySelector('[data-geometry]').view3d.project([{x}, {y}, {z}])");
        page.wait(&format!("{project} !== null"));
        let place = page.ask(&project);
        [0, 1].map(|k| place[k].as_f64().expect("a place"))
    };
    std::thread::sleep(std::time::Duration::from_millis(800));
    // Two pixels tell the size of a pixel and the middle of the image; the hit lies where its pixel then is.
    let (one, other, hit) = (place(8, 38), place(44, 24), place(20, 30));
    let size = (other[0] - one[0]) / f64::from(44 - 8);
    let expected = [one[0] + f64::from(20 - 8) * size, one[1] - f64::from(38 - 30) * size];
    assert!(size > 5.0, "{size} px for a pixel of the camera");
    assert!((other[1] - (one[1] - f64::from(38 - 24) * size)).abs() < 2.0, "{one:?}, {other:?}, {size}");
    for k in 0..2 {
        assert!((hit[k] - expected[k]).abs() < 2.0, "{hit:?} for {expected:?}");
    }
    // The picture is not empty: something was drawn, and the caption says what.
    assert!(page.number("Number(document.querySelector('.view3d').dataset.frames)") > 0.0);
    let caption = page.text("document.querySelector('.view3d-caption').textContent");
    assert!(caption.contains("one-wrong"), "{caption}");
    page.assert_quiet();
}
