//! The keyboard alone reaches everything, and a page says by name what each of its controls is.

use super::browser::open;
use super::paper;

/// Elements that a keyboard should reach, as a JavaScript expression. Of radio buttons of one name one is reached.
const FOCUSABLE: &str = "[...document.querySelectorAll('#explorer button, #explorer select, #explorer input, \
    #explorer [tabindex=\"0\"], #explorer summary, #explorer a[href]')].filter(e => !e.disabled && \
    e.tabIndex >= 0 && e.getClientRects().length > 0 && getComputedStyle(e).visibility !== 'hidden')";

#[test]
fn the_keyboard_alone_reaches_everything() {
    let written = paper();
    let Some(page) = open(&written.page(), "", (1280, 1000)) else { return };
    page.wait("!document.getElementById('explorer').hidden");
    page.wait("document.querySelectorAll('[data-ray-table] [data-row]').length > 5");
    page.wait("document.querySelector('[data-cause]') !== null");
    // Marks each element that gets the focus while Tab is pressed from the page's beginning on.
    page.ask("document.addEventListener('focusin', e => { e.target.dataset.wasReached = '1'; })");
    let count = page.number(&format!("{FOCUSABLE}.length"));
    assert!(count > 20.0, "{count}");
    page.ask("document.activeElement.blur()");
    for _ in 0..(count as usize + 40) {
        page.press("Tab");
    }
    let missed = page
        .ask(&format!("{FOCUSABLE}.filter(e => !e.dataset.wasReached).map(e => e.outerHTML.slice(0, 160))"));
    assert_eq!(missed.as_array().map(Vec::len), Some(0), "{missed:#}");

    // Keys as other viewers have them.
    page.ask("document.querySelector('canvas[data-panel]').focus()");
    let pressed = |mode: &str| {
        format!("document.querySelector('[data-mode=\"{mode}\"]').getAttribute('aria-pressed') === 'true'")
    };
    for (key, mode) in
        [("2", "b"), ("3", "difference"), ("4", "slider"), ("5", "blend"), ("1", "a"), ("f", "flip")]
    {
        page.press(key);
        page.wait(&pressed(mode));
    }
    page.press("1");
    let channel = "document.querySelector('[data-choose=\"channel\"]').value";
    let before = page.text(channel);
    page.press("]");
    page.wait(&format!("{channel} !== '{before}'"));
    page.press("[");
    page.wait(&format!("{channel} === '{before}'"));
    page.press("?");
    page.wait("document.querySelector('dialog[open]') !== null");
    page.press("Escape");
    page.wait("document.querySelector('dialog[open]') === null");
    page.assert_quiet();
}

#[test]
fn every_control_has_a_name_and_nothing_overflows() {
    let written = paper();
    for (width, height) in [(1280, 1000), (390, 844)] {
        let Some(page) = open(&written.page(), "", (width, height)) else { return };
        page.wait("!document.getElementById('explorer').hidden");
        page.wait("document.querySelectorAll('[data-ray-table] [data-row]').length > 5");
        let nameless = page.ask(&format!(
            "{FOCUSABLE}.filter(e => !(e.getAttribute('aria-label') || e.getAttribute('aria-labelledby') || \
             e.title || e.textContent.trim() || e.labels?.length || e.placeholder)).map(e => e.outerHTML.slice(0, 160))"
        ));
        assert_eq!(nameless.as_array().map(Vec::len), Some(0), "{nameless:#}");
        // The page itself does not scroll sideways, and no text of a tile leaves it.
        let wide = page.number("document.documentElement.scrollWidth - document.documentElement.clientWidth");
        assert!(wide <= 0.0, "{wide} px too wide at {width} px");
        let over = page.ask(
            "[...document.querySelectorAll('.tile')].filter(t => t.scrollWidth > t.clientWidth).map(t => t.textContent)",
        );
        assert_eq!(over.as_array().map(Vec::len), Some(0), "{over:#} at {width} px");
        page.assert_quiet();
    }
}
