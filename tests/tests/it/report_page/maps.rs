//! Maps: the numbers under the pointer are those of the EXR files.

use raypencil::io::{ExrMap, Limits, Raster, read_exr};

use super::browser::{Page, open};
use super::pyramids;

/// A canvas of a panel as a JavaScript expression.
fn canvas(sensor: &str) -> String {
    format!("document.querySelector('canvas[data-panel=\"{sensor}\"]')")
}

/// What the read-out has under a name.
fn value(page: &Page, name: &str) -> String {
    page.text(&format!("document.querySelector('[data-readout=\"{name}\"]').dataset.value"))
}

/// Random numbers from 0 to 1, the same at every run (splitmix64).
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The recorded number of a cell, as bits.
fn recorded(map: &ExrMap, channel: &str, i: u32, j: u32) -> u32 {
    match &map.channels[channel] {
        Raster::F32(image) => image.at(i, j).to_bits(),
        Raster::U32(image) => image.at(i, j),
    }
}

#[test]
fn the_pointer_reads_the_numbers_of_the_files_at_any_zoom() {
    let written = pyramids();
    let Some(page) = open(&written.page(), "", (1280, 1000)) else { return };
    page.wait("!document.getElementById('explorer').hidden");
    let exr = |side: &str| {
        let path = written.folder.path().join(side).join("camera.exr");
        read_exr(path, &Limits::default()).expect("a map")
    };
    let maps = ["scanline", "tracer"].map(exr);
    let mut next = random(1990);
    page.ask(&format!("{}.scrollIntoView({{block: 'center'}})", canvas("camera")));
    let (mut hits, mut misses) = (0, 0);
    // At the whole image, at a part of it, and with some cells of a few dozen pixels.
    for (zoom, steps) in [0, 4, 6].into_iter().enumerate() {
        for _ in 0..steps {
            page.ask("document.querySelector('[data-act=\"zoom-in\"]').click()");
        }
        for channel in ["range.T", "depth.Z", "P.X", "incidence.V", "face.I"] {
            page.ask(&format!(
                "(menu => {{ menu.value = '{channel}'; menu.dispatchEvent(new Event('change', {{bubbles: true}})); }})\
                 (document.querySelector('[data-choose=\"channel\"]'))"
            ));
            let box_of = format!(
                "(r => [r.left, r.top, r.width, r.height])({}.getBoundingClientRect())",
                canvas("camera")
            );
            // A picture that is turned, or off by a cell, shows at every place that has a hit.
            for _ in 0..4 {
                let (across, down) = (next(), next());
                // Under load the page may still move below the pointer: a hand would point again, at where the picture is then.
                let point = |_| {
                    let rectangle = page.ask(&box_of);
                    let [left, top, width, height] =
                        [0, 1, 2, 3].map(|k| rectangle[k].as_f64().expect("a length"));
                    // The picture is right of its axis of 40 pixels, and above one of 20.
                    let (x, y) = (left + 44.0 + (width - 52.0) * across, top + 6.0 + (height - 30.0) * down);
                    let before = page.ask("document.querySelector('[data-readout-root]').dataset.cell ?? ''");
                    page.point_at(x, y);
                    let read = read_after_pointing(&page, channel, before.as_str().unwrap_or_default())?;
                    Some((read, x - left, width))
                };
                let found = (0..3).find_map(point);
                let (read, x, width) = found.unwrap_or_else(|| panic!("{channel}: nothing is read out"));
                if zoom == 0 {
                    // 256 cells fill the picture's width, and so its height.
                    let cells = 256.0 / (width - 44.0).floor();
                    let expected = (x - 40.0) * cells;
                    assert!((f64::from(read.i) - expected).abs() <= cells + 1.0, "{} for {expected}", read.i);
                }
                for (shown, map) in read.values.iter().zip(&maps) {
                    let file = recorded(map, channel, read.i, read.j);
                    let seen = bits(shown, channel);
                    let both_nan =
                        channel != "face.I" && f32::from_bits(file).is_nan() && f32::from_bits(seen).is_nan();
                    assert!(
                        file == seen || both_nan,
                        "{channel} at {},{}, zoom {zoom}: the file has the bits {file:x}, the page {shown}",
                        read.i,
                        read.j
                    );
                }
                let is_hit = recorded(&maps[0], "face.I", read.i, read.j) != u32::MAX;
                *(if is_hit { &mut hits } else { &mut misses }) += 1;
            }
        }
    }
    assert_eq!(hits + misses, 60);
    assert!(hits > 30 && misses > 2, "{hits} cells with a hit, {misses} without");
    page.assert_quiet();
}

/// What the read-out says of the cell under the pointer.
struct Read {
    i: u32,
    j: u32,
    /// Numbers of both sides, as text.
    values: [String; 2],
}

/// Waits for the read-out of this channel and of another cell than `before`, and reads it, all in one question. (The
/// pointer may come to the same cell again: after half a second that is what happened.) `None` after ten seconds.
fn read_after_pointing(page: &Page, channel: &str, before: &str) -> Option<Read> {
    let found = page.ask(&format!(
        "(async () => {{ for (let tries = 0; tries < 500; tries += 1) {{ \
         await new Promise(done => setTimeout(done, 20)); \
         const root = document.querySelector('[data-readout-root]'); \
         const value = name => document.querySelector(`[data-readout=\"${{name}}\"]`)?.dataset.value; \
         const isNew = root.dataset.cell !== '{before}' || tries > 25; \
         if (root.dataset.state === 'ready' && root.dataset.channel === '{channel}' && value('a') && isNew) {{ \
         return [value('i'), value('j'), value('a'), value('b')]; }} }} return []; }})()"
    ));
    let text = |k: usize| found[k].as_str().map(String::from);
    let number = |k: usize| text(k).map(|text| text.parse().expect("the number of a cell"));
    Some(Read { i: number(0)?, j: number(1)?, values: [text(2)?, text(3)?] })
}

/// The bits of a number that the page shows.
fn bits(shown: &str, channel: &str) -> u32 {
    if channel == "face.I" {
        return shown.parse().unwrap_or_else(|_| panic!("{channel} is {shown}"));
    }
    match shown {
        "Infinity" => f32::INFINITY.to_bits(),
        "NaN" => f32::NAN.to_bits(),
        text => text.parse::<f32>().unwrap_or_else(|_| panic!("{channel} is {text}")).to_bits(),
    }
}

#[test]
fn a_link_leads_to_its_cell_and_the_page_follows() {
    let written = pyramids();
    let Some(page) = open(&written.page(), "#camera/103,175", (1280, 1000)) else { return };
    page.wait("document.querySelector('[data-readout-root]')?.dataset.state === 'ready'");
    assert_eq!((value(&page, "i").as_str(), value(&page, "j").as_str()), ("103", "175"));
    assert_eq!(value(&page, "class"), "0");
    // Another cell by the address; and by the field beside the read-out, which the address follows.
    page.ask("location.hash = '#beam-1/17,3/flux.V/diff'");
    page.wait("document.querySelector('[data-readout=\"i\"]').dataset.value === '17'");
    page.wait("document.querySelector('[data-readout-root]').dataset.channel === 'flux.V'");
    page.wait("document.querySelector('[data-mode=\"difference\"]').getAttribute('aria-pressed') === 'true'");
    page.ask("document.querySelector('[data-goto]').focus()");
    page.ask("document.querySelector('[data-goto]').value = '18,4'");
    page.press("Enter");
    page.wait("location.hash.startsWith('#beam-1/18,4')");
    page.assert_quiet();
}

#[test]
fn names_stay_text() {
    let mut written = raypencil_tests::fixtures::agreeing();
    written.subject.name = "<script>document.title = 'owned'</script><img src=x onerror=alert(1)>".into();
    written.rendered[0].name = "scan<b>line</b>".into();
    let html = written.document_with_pictures().and_then(|document| document.page()).expect("a page");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("report.html");
    std::fs::write(&file, html).expect("a file");
    let Some(page) = open(&file, "", (1280, 1000)) else { return };
    page.wait("!document.getElementById('explorer').hidden");
    page.wait("document.querySelector('[data-choose=\"a\"]').textContent.includes('scan<b>line</b>')");
    assert!(page.text("document.title").contains("<script>document.title"));
    assert_eq!(page.number("document.querySelectorAll('main img[onerror], #explorer b b').length"), 0.0);
    page.assert_quiet();
}
