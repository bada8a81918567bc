//! The functions of the script by numbers. Its modules alone are in the page, read from their files: no report, and so no scene
//! whose two sides happen to look alike.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::browser::{Page, open};

/// The folder of the modules.
fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/verdict/explorer/script")
}

/// Appends a module, behind all that it imports, as the build puts them together: one scope without `import` and `export`.
fn add(module: &Path, seen: &mut BTreeSet<PathBuf>, text: &mut String) {
    if !seen.insert(module.to_path_buf()) {
        return;
    }
    let own = std::fs::read_to_string(script().join(module)).expect("a module");
    for line in own.lines() {
        if let Some((_, from)) = line.strip_prefix("import ").and_then(|line| line.split_once(" from '")) {
            let mut path = module.parent().expect("a folder").to_path_buf();
            for part in Path::new(from.trim_end_matches("';")).components() {
                match part {
                    Component::ParentDir => _ = path.pop(),
                    Component::CurDir => {}
                    part => path.push(part),
                }
            }
            add(&path, seen, text);
        }
    }
    let lines = own.lines().filter(|line| !line.starts_with("import "));
    lines.for_each(|line| *text += &format!("{}\n", line.strip_prefix("export ").unwrap_or(line)));
}

/// A page with these modules, whose names the window has. `None`, and words on the terminal, without a browser.
fn functions(modules: &[&str], names: &[&str]) -> Option<(TempDir, Page)> {
    let (mut seen, mut text) = (BTreeSet::new(), String::new());
    modules.iter().for_each(|module| add(Path::new(module), &mut seen, &mut text));
    let names = names.join(", ");
    // The arrays of the tests' models are numbers, which need no unpacking.
    let page = format!(
        "<!doctype html><meta charset=\"utf-8\"><link rel=\"icon\" href=\"data:,\"><title>functions</title>\n\
         <script type=\"module\">\n{text}\nconst plainArrays = {{ decode: async (numbers) => numbers }};\n\
         Object.assign(window, {{ {names}, plainArrays }});\n</script>\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("page.html"), page).expect("a page");
    let page = open(&folder.path().join("page.html"), "", (800, 600))?;
    page.wait("window.plainArrays !== undefined");
    Some((folder, page))
}

/// Asks for each expression, and compares it with what is expected.
fn assert_all(page: &Page, all: &[(&str, Value)]) {
    for (expression, expected) in all {
        assert_eq!(&page.ask(expression), expected, "{expression}");
    }
}

#[test]
fn numbers_have_their_units_and_their_digits() {
    let names = ["withUnit", "signedWithUnit", "plain", "shortestSingle", "singleSteps", "doubleUlp"];
    let more = ["cellWords", "counted", "boundOfCode", "axisWords", "lengthInWords", "rangeInWords"];
    let modules = ["data/numbers.js", "data/common_rasters.js", "panel/axis_words.js", "view3d/words.js"];
    let Some((_folder, page)) = functions(&modules, &[&names[..], &more].concat()) else { return };
    assert_all(
        &page,
        &[
            ("withUnit(12.3456, 'm')", json!("12.35 m")),
            ("withUnit(0.0123456, 'm')", json!("12.35 mm")),
            ("withUnit(1.25e-5, 'm')", json!("12.5 µm")),
            ("withUnit(2.5e-9, 'm')", json!("2.5 nm")),
            // Below nanometres, and above metres: no prefix.
            ("withUnit(2.5e-13, 'm')", json!("2.5e-13 m")),
            ("withUnit(12345.6, 'm')", json!("12350 m")),
            ("withUnit(0.0025, 'W')", json!("2.5 mW")),
            ("withUnit(4.5e-14, 'W')", json!("45 fW")),
            ("withUnit(0.0025, 'cells')", json!("0.0025 cells")),
            // What is rounded up to the next unit is told in it.
            ("withUnit(0.99996, 'm')", json!("1 m")),
            ("signedWithUnit(0.002, 'm')", json!("+2 mm")),
            ("signedWithUnit(-0.002, 'm')", json!("−2 mm")),
            ("plain(NaN, 3)", json!("no number")),
            ("plain(-Infinity, 3)", json!("−∞")),
            ("shortestSingle(Math.fround(0.1))", json!("0.1")),
            ("shortestSingle(Math.fround(16777217))", json!("16777216")),
            ("singleSteps(1, Math.fround(1 + 2 ** -23))", json!(1)),
            ("singleSteps(Math.fround(1 + 2 ** -23), 1)", json!(-1)),
            ("singleSteps(-(2 ** -149), 2 ** -149)", json!(2)),
            ("doubleUlp(1) * 2 ** 52", json!(1)),
            ("doubleUlp(-3) * 2 ** 51", json!(1)),
            ("counted(1, 'ray')", json!("1 ray")),
            ("counted(1234567, 'ray')", json!("1,234,567 rays")),
            // The format of pages: 2^((code - 1) / 4 - 60) m, and none for 0.
            ("boundOfCode(1) * 2 ** 60", json!(1)),
            ("boundOfCode(241)", json!(1)),
            ("boundOfCode(245)", json!(2)),
            ("Number.isNaN(boundOfCode(0))", json!(true)),
            ("axisWords({ turns: true, unit: '°' }, 350)", json!("−10°")),
            ("axisWords({ turns: false, unit: 'm' }, 350)", json!("350 m")),
            ("lengthInWords(0.0015)", json!("1.5 mm")),
            ("lengthInWords(1500)", json!("1.5 km")),
            ("rangeInWords(Infinity)", json!("no range")),
            ("cellWords(0.12346, 6)", json!("0.1235")),
            ("cellWords(-12.3456, 6)", json!("−12.35")),
        ],
    );
    page.assert_quiet();
}

/// A model of a camera of 3 x 2 cells and a beam of 2 x 1, and three sides. The pair of sides 0 and 1 is compared, and that of 2
/// and 0; each cell has its own numbers.
const MODEL: &str = "(() => {
  const of = (type) => (...numbers) => type.from(numbers);
  const [f32, u32, u8, i32] = [Float32Array, Uint32Array, Uint8Array, Int32Array].map(of);
  const side = (range, flux, face) => ({ channels: {
    'range.T': { stored: f32(...range) }, 'face.I': { stored: u32(...face) },
    'flux.beam0': { stored: f32(...flux) }, 'flux.beam1': { stored: f32(...flux.map((one) => 10 * one)) },
  } });
  const none = 4294967295;
  return {
    version: 1, kind: 'test', title: 'a test', probe: 'raypencil probe x', flux_unit: 'W',
    sides: [{ name: 'one', kind: 'renderer' }, { name: 'two, too', kind: 'renderer' }, { name: 'three', kind: 'candidate' }],
    classes: ['agree', 'tie', 'rounding', 'approximation', 'undecided', 'defect'],
    quantities: [{ name: 'range', unit: 'm' }, { name: 'face', unit: '' }],
    causes: [{ switches: ['facing'] }, { switches: ['corner', 'edges'] }],
    sensors: [
      {
        name: 'camera', kind: 'camera', width: 3, height: 2,
        sides: [
          side([1, 2, 4, 8, Infinity, -Infinity], [1, 2, 3, 4, 5, 6], [7, 8, 9, 10, none, none]),
          side([1, 2.5, 4, Infinity, Infinity, 32], [1, 2, 3, 4, 5, 7], [7, 9, 9, none, none, 12]),
          side([3, 2, 4, 8, Infinity, -Infinity], [1, 2, 3, 4, 5, 6], [6, 8, 9, 10, none, none]),
        ],
        pairs: [
          { a: 0, b: 1, class: u8(0, 5, 2, 3, 0, 4), cause: u8(255, 255, 255, 1, 255, 255),
            quantity: u8(255, 0, 1, 0, 255, 0), range_ulps: i32(0, 2147483647, 3, 0, 0, 0),
            range_bound: u8(0, 241, 245, 249, 0, 0) },
          { a: 2, b: 0, class: u8(1, 0, 0, 0, 0, 0), cause: u8(255, 255, 255, 255, 255, 255),
            quantity: u8(0, 255, 255, 255, 255, 255), range_ulps: null, range_bound: null },
        ],
        margins: { cells: u32(1, 4), face: f32(0.25, 0.5), surface: f32(0.75, 1), visibility: null, landing: null },
      },
      {
        name: 'beam-3', kind: 'beam', beam: 3, width: 2, height: 1,
        sides: [
          { channels: { 'range.T': { stored: f32(1, 2) }, 'flux.V': { stored: f32(5, 6) } } },
          { channels: { 'range.T': { stored: f32(1, 3) }, 'flux.V': { stored: f32(5, 9) } } },
          null,
        ],
        pairs: [{ a: 0, b: 1, class: u8(0, 5), cause: u8(255, 255), quantity: u8(255, 1), range_ulps: null, range_bound: null }],
        margins: null,
      },
    ],
  };
})()";

#[test]
fn differences_have_their_sign_whichever_side_is_a() {
    let modules = ["data/difference.js", "data/page_data.js", "data/cell_reading.js"];
    let names = [
        "differenceRaster",
        "differenceOf",
        "channelOf",
        "PageData",
        "readCell",
        "shareOfBound",
        "placeOfCell",
    ];
    let Some((_folder, page)) = functions(&modules, &names) else { return };
    page.run(&format!("window.model = {MODEL}; window.data = new PageData(model, plainArrays);"));
    // JSON has no infinity and no NaN: both as texts.
    page.run(
        "window.told = (numbers) => [...numbers].map((one) => Number.isFinite(one) ? one : String(one))",
    );
    let raster = |a: u32, b: u32, channel: &str| {
        page.ask(&format!("differenceRaster(data, 0, {a}, {b}, channelOf(model, '{channel}')).then(told)"))
    };
    // In f64 the ranges of cell 2 differ by 3 steps, which are 3 * 2^-50 at 4 m; those of cell 1 by more than are counted.
    let steps = 3.0 / (1_u64 << 50) as f64;
    assert_eq!(raster(0, 1, "range.T"), json!([0, 0.5, steps, "Infinity", "NaN", "Infinity"]));
    assert_eq!(raster(1, 0, "range.T"), json!([0, -0.5, -steps, "Infinity", "NaN", "Infinity"]));
    // Sides that nobody compared.
    assert_eq!(raster(1, 2, "range.T"), json!([2, -0.5, 0, "Infinity", "NaN", "Infinity"]));
    // Light of both beams.
    assert_eq!(raster(0, 1, "flux.V"), json!([0, 0, 0, 0, 0, 11]));
    assert_eq!(raster(0, 1, "flux.beam1"), json!([0, 0, 0, 0, 0, 10]));
    // Names: the same, another one, on one side only, on neither.
    assert_eq!(raster(0, 1, "face.I"), json!([0, 1, 0, 2, 255, 2]));
    // Normals: a right angle in degrees.
    page.run(
        "for (const [index, normal] of [[0, [0, 0, 1]], [1, [0, 1, 0]]]) { \
         normal.forEach((one, axis) => { model.sensors[0].sides[index].channels['N.' + 'XYZ'[axis]] = \
         { stored: Float32Array.from({ length: 6 }, () => one) }; }); }",
    );
    assert_eq!(raster(0, 1, "N.RGB"), json!([90, 90, 90, 90, 90, 90]));

    let cell = |a: u32, b: u32, cell: u32, key: &str| {
        page.ask(&format!(
            "readCell(data, 0, {a}, {b}, channelOf(model, 'range.T'), {cell}).then((found) => told([{key}]))"
        ))
    };
    let keys = "found.a, found.b, found.difference, found.doubleSteps, found.bound, found.faceA, found.faceB, found.code, \
                found.quantity, shareOfBound(found)";
    let share = steps / 2.0;
    assert_eq!(cell(0, 1, 2, keys), json!([4, 4, steps, 3, 2, 9, 9, 2, 1, share]));
    assert_eq!(cell(1, 0, 2, keys), json!([4, 4, -steps, -3, 2, 9, 9, 2, 1, share]));
    // So many steps that they are not counted: the recorded numbers tell the difference.
    assert_eq!(
        cell(0, 1, 1, "found.difference, Number(found.isSaturated), shareOfBound(found)"),
        json!([0.5, 1, 0.5])
    );
    assert_eq!(cell(0, 1, 3, "found.cause, found.code"), json!([1, 3]));
    assert_eq!(cell(0, 1, 1, "found.margins.face, found.margins.surface"), json!([0.25, 0.75]));
    assert_eq!(cell(0, 1, 4, "found.margins.face, found.margins.visibility"), json!([0.5, "NaN"]));
    assert_eq!(cell(0, 1, 2, "found.margins === null"), json!(["true"]));

    let common = |pair: [u32; 2], channel: &str| {
        page.ask(&format!("data.common(0, {}, {}, '{channel}').then(told)", pair[0], pair[1]))
    };
    assert_eq!(common([1, 0], "class"), json!([0, 5, 2, 3, 0, 4]));
    assert_eq!(common([0, 2], "class"), json!([1, 0, 0, 0, 0, 0]));
    assert_eq!(common([0, 1], "cause"), json!([255, 255, 255, 1, 255, 255]));
    assert_eq!(common([0, 1], "margin.surface"), json!(["NaN", 0.75, "NaN", "NaN", 1, "NaN"]));
    let shares = common([0, 1], "share");
    // In single precision; the third cell has 3 steps of a bound of 2 m.
    assert_eq!(shares[2].as_f64().map(|share| share as f32), Some(share as f32), "{shares}");
    assert_eq!(shares[3], 0, "{shares}");
    assert_all(
        &page,
        &[
            ("placeOfCell([2, 5, 9], 9)", json!(2)),
            ("placeOfCell([2, 5, 9], 2)", json!(0)),
            ("placeOfCell([2, 5, 9], 6)", json!(-1)),
            ("String(differenceOf(-Infinity, -Infinity, null))", json!("NaN")),
            ("String(differenceOf(-Infinity, Infinity, null))", json!("Infinity")),
            ("String(differenceOf(4294967295, 3, null))", json!("Infinity")),
        ],
    );
    page.assert_quiet();
}

#[test]
fn rays_are_listed_counted_sorted_and_exported_as_they_are() {
    let modules =
        ["rays/csv.js", "rays/list.js", "data/page_data.js", "data/page_hash.js", "rays/probe_text.js"];
    let names = [
        "raysAsCsv",
        "RayList",
        "PageData",
        "hashOfCell",
        "choiceOfHash",
        "probeBlocks",
        "commandOf",
        "codeName",
    ];
    let Some((_folder, page)) = functions(&modules, &names) else { return };
    page.run(&format!(
        "window.model = {MODEL}; window.rays = new RayList(new PageData(model, plainArrays)); \
         window.ready = rays.gather().then(() => rays.measure())"
    ));
    assert_eq!(page.ask("ready.then(() => rays.count)"), json!(6));
    let csv = page.text("raysAsCsv(model, rays)");
    let rows: Vec<&str> = csv.lines().collect();
    assert_eq!(
        rows,
        [
            "sensor,i,j,a,b,class,quantity,cause,range_b_minus_a_m,flux_b_minus_a_W,command",
            "camera,1,0,one,\"two, too\",defect,range,,0.5,0,\"raypencil probe x --pixel 1,0\"",
            "camera,2,0,one,\"two, too\",rounding,face,,2.6645352591003757e-15,0,\"raypencil probe x --pixel 2,0\"",
            "camera,0,1,one,\"two, too\",approximation,range,corner + edges,inf,0,\"raypencil probe x --pixel 0,1\"",
            "camera,2,1,one,\"two, too\",undecided,range,,inf,11,\"raypencil probe x --pixel 2,1\"",
            "camera,0,0,three,one,tie,range,,-2,0,\"raypencil probe x --pixel 0,0\"",
            "beam-3,1,0,one,\"two, too\",defect,face,,1,3,\"raypencil probe x --beam 3 --pencil 1,0\"",
        ]
    );
    // Chips: the rays that each would leave, under the choice of the others.
    let counts = |facet: &str| page.ask(&format!("[...rays.counts('{facet}')]"));
    assert_eq!(counts("class"), json!([[1, 1], [2, 1], [3, 1], [4, 1], [5, 2]]));
    assert_eq!(counts("sensor"), json!([[0, 5], [1, 1]]));
    assert_eq!(counts("pair"), json!([[0, 5], [1, 1]]));
    page.run("rays.chosen.class.add(5); rays.update()");
    assert_eq!(counts("sensor"), json!([[0, 1], [1, 1]]));
    assert_eq!(counts("class"), json!([[1, 1], [2, 1], [3, 1], [4, 1], [5, 2]]));
    assert_eq!(page.ask("[...rays.shown]"), json!([0, 5]));
    // By size; equal ones by their places, and those without a number last.
    page.run("rays.chosen.class.clear(); rays.order = 'range'; rays.isDescending = true; rays.update()");
    assert_eq!(page.ask("[...rays.shown]"), json!([2, 3, 4, 5, 0, 1]));
    page.run("rays.isDescending = false; rays.update()");
    assert_eq!(page.ask("[...rays.shown]"), json!([1, 0, 5, 4, 2, 3]));
    assert_eq!(
        page.ask("((marks) => [[...marks.cells], [...marks.codes]])(rays.marksOn(0, 0, 2))"),
        json!([[0], [1]])
    );
    assert_eq!(page.ask("rays.placeOf(0, 2, 1, 0)"), json!(0));
    assert_all(
        &page,
        &[
            ("hashOfCell(model, 0, 5)", json!("#camera/2,1")),
            (
                "choiceOfHash(model, '#camera/2,1/range.T/diff/two%2C%20too~one')",
                json!({ "sensor": 0, "cell": 5, "channel": "range.T", "mode": "difference", "a": 1, "b": 0 }),
            ),
            // One column and one row too many.
            ("choiceOfHash(model, '#camera/3,1')", Value::Null),
            ("choiceOfHash(model, '#camera/2,2')", Value::Null),
            ("codeName(model, rays, 'pair', 1)", json!("three, one")),
            (
                "probeBlocks('camera\\n  ray x\\n    a 1\\n  exactly: face 2\\n    b 2\\n  again: raypencil probe y\\n')",
                json!([{ "title": "ray x", "lines": ["a 1"] }, { "title": "exactly: face 2", "lines": ["b 2"] }]),
            ),
            ("commandOf('camera\\n  again: raypencil probe y\\n')", json!("raypencil probe y")),
        ],
    );
    page.assert_quiet();
}

#[test]
fn scales_arrays_and_drives_keep_their_numbers() {
    let modules = [
        "data/limits.js",
        "data/container.js",
        "drive/sectors.js",
        "drive/replay.js",
        "drive/ground.js",
        "view3d/vector.js",
    ];
    let names = [
        "statisticsOf",
        "scaleOfValues",
        "scaleOfDifferences",
        "placeOn",
        "ticksOf",
        "interleavedPlanes",
        "sumUp",
        "flipBits",
        "turnBetween",
        "sectorAt",
        "degreesOf",
        "halfWidth",
        "MapReplay",
        "DriveGround",
        "vecTurn",
        "vecTurnBack",
        "vecCross",
    ];
    let Some((_folder, page)) = functions(&modules, &names) else { return };
    let plain = "{ isRobust: false, isLog: null, exposure: 0 }";
    page.run(&format!(
        "window.plain = {plain}; window.robust = {{ ...plain, isRobust: true }}; \
         window.many = statisticsOf(Float32Array.from({{ length: 1001 }}, (_, k) => k === 1000 ? 1e6 : k + 1)); \
         window.few = statisticsOf([2, NaN, -3, Infinity, 0, -Infinity])"
    ));
    assert_all(
        &page,
        &[
            ("[few.count, few.lowest, few.highest, few.largest]", json!([3, -3, 2, 3])),
            ("[few.isOneSided, few.isTooNear, few.isMissing]", json!([true, true, true])),
            ("[...few.sample]", json!([-3, 0, 2])),
            ("[...few.sizes]", json!([2, 3])),
            ("statisticsOf([1, 7, 4294967295], 4294967295).highest", json!(7)),
            ("((scale) => [scale.low, scale.high])(scaleOfValues([few], plain, false))", json!([-3, 2])),
            // Both sides have one scale.
            (
                "((scale) => [scale.low, scale.high])(scaleOfValues([few, statisticsOf([9])], plain, false))",
                json!([-3, 9]),
            ),
            // From the first hundredth to the last: one outlier is beyond the end.
            (
                "((scale) => [scale.low, scale.high, scale.isClipped])(scaleOfValues([many], robust, false))",
                json!([11, 991, true]),
            ),
            (
                "((scale) => [scale.low, scale.high, scale.spread])(scaleOfDifferences(few, plain))",
                json!([-3, 3, "signed"]),
            ),
            ("placeOn({ spread: 'linear', low: 2, high: 6 })(3)", json!(0.25)),
            ("placeOn({ spread: 'log', low: 1, high: 16 })(2).toFixed(9)", json!("0.250000000")),
            ("Math.abs(placeOn({ spread: 'signed-log', floor: 1, high: 3 })(-3)) < 1e-9", json!(true)),
            (
                "ticksOf({ spread: 'linear', low: 0, high: 10 }, 'm', 6).map((tick) => tick.label)",
                json!(["0 m", "2 m", "4 m", "6 m", "8 m", "10 m"]),
            ),
            (
                "ticksOf({ spread: 'log', low: 1, high: 1000 }, 'W', 4).map((tick) => tick.label)",
                json!(["1 W", "10 W", "100 W", "1 kW"]),
            ),
            // Bytes of two and four: the lowest plane first; running sums wrap around.
            (
                "[...new Uint32Array(interleavedPlanes(Uint8Array.of(1, 5, 2, 6, 3, 7, 4, 8), 4).buffer)]",
                json!([0x0403_0201, 0x0807_0605]),
            ),
            (
                "[...new Uint16Array(interleavedPlanes(Uint8Array.of(1, 2, 3, 4), 2).buffer)]",
                json!([0x0301, 0x0402]),
            ),
            (
                "((bytes) => { sumUp(bytes, 1); return [...bytes]; })(Uint8Array.of(250, 10, 255))",
                json!([250, 4, 3]),
            ),
            (
                "((bytes) => { flipBits(bytes, Uint8Array.of(1, 3)); return [...bytes]; })(Uint8Array.of(3, 3))",
                json!([2, 0]),
            ),
            ("(turnBetween(3, -3) - (2 * Math.PI - 6)).toFixed(12)", json!("0.000000000000")),
            ("degreesOf({ direction: -Math.PI / 2 })", json!("−90.0")),
            // A quarter turn about z, and back; x cross y is z.
            ("vecTurn([0, 0, 1, 1], [1, 2, 3]).map((one) => one + 0)", json!([-2, 1, 3])),
            ("vecTurnBack([0, 0, 1, 1], [-2, 1, 3]).map((one) => one + 0)", json!([1, 2, 3])),
            ("vecCross([1, 0, 0], [0, 1, 0])", json!([0, 0, 1])),
        ],
    );
    // Three sectors of a tenth of a radian about (1, 2).
    page.run(
        "window.map = { centre: [1, 2], sectors: [-0.1, 0, 0.1].map((direction, k) => ({ direction, radius: 1 + k })) }; \
         window.at = (direction, radius) => sectorAt(map, 1 + radius * Math.cos(direction), 2 + radius * Math.sin(direction))",
    );
    assert_all(
        &page,
        &[
            ("[at(-0.1, 0.5), at(0.02, 0.5), at(0.13, 2.9)]", json!([0, 1, 2])),
            // Beyond the end of a sector, and beside the last one.
            ("[at(-0.1, 1.1), at(-0.1, 1.3), at(0.2, 1)]", json!([0, -1, -1])),
            ("halfWidth(map.sectors, 2).toFixed(6)", json!("0.050000")),
        ],
    );
    // A map of three frames: cell (-1, 64) becomes known in the first, another height in the third.
    page.run(
        "window.replay = new MapReplay({ i: Int32Array.of(-1, 5, -1), j: Int32Array.of(64, 0, 64), \
         elevation: Float32Array.of(1.5, 2.5, 3.5), source: Uint8Array.of(1, 2, 3), first: Uint32Array.of(0, 1, 2, 3), count: 3, \
         mapOrigin: [10, 20], spacing: 0.5 }); \
         window.cell = (frame, i, j) => { replay.goTo(frame); const slot = replay.slotOf(i, j); \
         return slot < 0 ? null : [replay.elevation[slot], replay.source[slot], replay.since[slot], replay.cellOfSlot(slot)]; }",
    );
    assert_all(
        &page,
        &[
            ("cell(2, -1, 64)", json!([3.5, 3, 2, [-1, 64]])),
            ("cell(1, -1, 64)", json!([1.5, 1, 0, [-1, 64]])),
            ("cell(1, 5, 0)", json!([2.5, 2, 1, [5, 0]])),
            ("cell(0, 5, 0)[1]", json!(0)),
            ("cell(2, -1, 64)[0]", json!(3.5)),
            ("cell(2, 500, 0)", Value::Null),
            ("replay.known.map((counts) => [...counts])", json!([[1, 1, 0], [0, 1, 1], [0, 0, 1]])),
            ("replay.placeOf(-1, 64)", json!([9.5, 52])),
            ("replay.cellAt(9.6, 52.2)", json!([-1, 64])),
            ("replay.extent()", json!({ "left": -1, "bottom": 0, "right": 5, "top": 64 })),
            (
                "[...replay.slotsIn(-1, 64, 2, 1, 1)].map((slot) => slot < 0 ? null : replay.elevation[slot])",
                json!([3.5, null]),
            ),
        ],
    );
    // Two faces that look up, one above the other, and one that looks down over both.
    page.run(
        "window.ground = new DriveGround(Float32Array.of(0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 1, 4, 0, 1, 0, 4, 2, 0, 0, 9, 4, 0, 9, \
         0, 4, 9), Uint32Array.of(0, 1, 2, 3, 4, 5, 6, 8, 7))",
    );
    assert_all(
        &page,
        &[
            ("ground.heightAt(1, 1)", json!(1.25)),
            ("Number.isNaN(ground.heightAt(3, 3))", json!(true)),
            ("Number.isNaN(ground.heightAt(-1, 1))", json!(true)),
            // From above the face that looks down is met first; from below the lowest one.
            ("ground.rayHit([1, 1, 10], [0, 0, -1], 100)", json!(1)),
            ("ground.rayHit([1, 1, -1], [0, 0, 0.5], 100)", json!(2)),
            ("ground.rayHit([9, 9, 10], [0, 0, -1], 100)", json!(100)),
        ],
    );
    page.assert_quiet();
}
