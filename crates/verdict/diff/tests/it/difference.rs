//! Thresholds by hand-derived numbers, sides that do not fit together, and the reports.

use std::collections::BTreeMap;
use std::path::PathBuf;

use raypencil_diff::{
    CellDifference, ChannelDifference, ChannelRuling, Difference, RuledCell, Rulings, Sides, Thresholds,
    diff, diff_document, write_diff,
};
use raypencil_files::{Channel, Channels, Storage, Values};
use raypencil_judge::Class;
use raypencil_scene::{Image, Place, SensorId, Silent};

/// A channel of one row of reals, as a file of this storage holds them.
fn reals(storage: Storage, cells: &[f64]) -> Channel {
    let values = Values::Reals(Image::from_cells(cells.len() as u32, 1, cells.to_vec()));
    Channel { file: PathBuf::from("f.exr"), name: "range.T".into(), storage, values }
}

/// A channel of one row of whole numbers.
fn wholes(cells: &[u32]) -> Channel {
    let values = Values::Wholes(Image::from_cells(cells.len() as u32, 1, cells.to_vec()));
    Channel { file: PathBuf::from("w.npy"), name: String::new(), storage: Storage::Whole, values }
}

/// A recording of channels by key.
fn recording(channels: impl IntoIterator<Item = (&'static str, Channel)>) -> Channels {
    let by_key = channels.into_iter().map(|(key, channel)| (key.to_string(), channel)).collect();
    Channels { by_key, ..Channels::default() }
}

/// The difference of one channel.
fn one(a: Channel, b: Channel, thresholds: &Thresholds) -> ChannelDifference {
    let difference = diff(&recording([("x", a)]), &recording([("x", b)]), thresholds).unwrap();
    difference.channels.into_iter().next().unwrap()
}

/// The difference of one channel in single precision.
fn singles(a: &[f64], b: &[f64], thresholds: &Thresholds) -> ChannelDifference {
    one(reals(Storage::F32, a), reals(Storage::F32, b), thresholds)
}

const NONE: Thresholds = Thresholds {
    fail: 0.0,
    fail_relative: 0.0,
    fail_ulp: 0.0,
    fail_percent: 0.0,
    hard_fail: None,
    shared_only: false,
};

#[test]
fn the_numbers_of_a_channel_are_those_by_hand() {
    // Differences 0, 0.5, 0.25, 0: mean 0.1875, mean square (0.25 + 0.0625) / 4 = 0.078125.
    let found = singles(&[1.0, 1.5, 4.25, -0.0], &[1.0, 2.0, 4.0, 0.0], &NONE);
    assert_eq!((found.cells(), found.unequal, found.differing, found.incomparable), (4, 2, 2, 0));
    assert_eq!((found.largest, found.mean), (Some(0.5), Some(0.1875)));
    assert_eq!(found.rms, Some(0.078_125_f64.sqrt()));
    assert_eq!(found.worst, Some(CellDifference { i: 1, j: 0, a: 1.5, b: 2.0 }));
    // At 2 an ulp of single precision is 2^-22, at 4 it is 2^-21: 0.5 is 2^21 ulp, 0.25 is 2^19.
    assert_eq!(found.largest_ulp, Some(2_097_152.0));
    assert_eq!(found.percent(), 50.0);
    assert!(found.fails);
}

#[test]
fn of_equal_differences_the_first_cell_is_shown() {
    let found = singles(&[1.0, 2.0, 5.0, 3.0], &[1.0, 2.5, 5.5, 2.5], &NONE);
    assert_eq!((found.largest, found.worst.map(|cell| cell.i)), (Some(0.5), Some(1)));
    let found = one(wholes(&[1, 2, 3]), wholes(&[1, 9, 9]), &NONE);
    assert_eq!(found.worst.map(|cell| cell.i), Some(1));
    let found = singles(&[1.0, f64::NAN, f64::NAN], &[1.0, 1.0, 2.0], &NONE);
    assert_eq!(found.worst.map(|cell| cell.i), Some(1));
}

#[test]
fn the_largest_difference_in_ulps_may_be_in_another_cell_than_the_largest() {
    // An ulp of single precision is 2^-23 at 1 and 2^-13 at 1024.
    let step = 1.0 / 8_388_608.0;
    for (a, b) in [
        ([1.0, 1024.0], [1.0 + 5.0 * step, 1025.0]),
        ([1024.0, 1.0], [1024.0 + 1024.0 * step, 1.0 + 3.0 * step]),
    ] {
        let found = singles(&a, &b, &NONE);
        let ulps: Vec<f64> =
            a.iter().zip(b).map(|(a, b)| (a - b).abs() / Storage::F32.ulp(a.abs().max(b.abs()))).collect();
        assert_eq!(found.largest_ulp, ulps.into_iter().reduce(f64::max));
    }
}

#[test]
fn cells_that_are_not_finite_have_no_part_in_the_means() {
    // Differences of 3 and 4, and two cells without a number.
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let found = singles(&[1.0, nan, 2.0, inf], &[4.0, nan, 6.0, inf], &NONE);
    assert_eq!((found.mean, found.rms), (Some(3.5), Some(12.5_f64.sqrt())));
    let found = singles(&[1.0, nan, 2.0, inf], &[4.0, 1.0, 6.0, 2.0], &NONE);
    assert_eq!((found.mean, found.rms), (Some(3.5), Some(12.5_f64.sqrt())));
}

#[test]
fn none_of_whole_numbers_is_nan_or_its_own_number_beside_reals() {
    let none = f64::from(u32::MAX);
    let (whole, real) =
        (wholes(&[u32::MAX, u32::MAX, u32::MAX, 5]), reals(Storage::F64, &[none, f64::NAN, 5.0, f64::NAN]));
    for [a, b] in [[&whole, &real], [&real, &whole]] {
        let found = one(a.clone(), b.clone(), &NONE);
        assert_eq!((found.unequal, found.incomparable), (2, 1));
    }
}

#[test]
fn allowed_differences_are_told_with_what_they_are_of() {
    let (a, b) =
        (recording([("x", reals(Storage::F32, &[1.0]))]), recording([("x", reals(Storage::F32, &[1.0]))]));
    let told = |thresholds: Thresholds| {
        let sides = Sides { names: ["a", "b"], channels: [&a, &b] };
        diff_document(&diff(&a, &b, &thresholds).unwrap(), &sides).remarks.remove(0)
    };
    assert_eq!(told(Thresholds { fail: 0.25, ..NONE }), "Allowed: 0.25 absolute.");
    assert_eq!(told(Thresholds { fail_relative: 0.125, ..NONE }), "Allowed: 0.125 relative.");
    assert_eq!(told(Thresholds { fail_ulp: 3.0, ..NONE }), "Allowed: 3 ulp.");
    let percent = Thresholds { fail_percent: 2.5, hard_fail: Some(0.5), ..NONE };
    assert_eq!(told(percent), "Allowed: no difference, beyond it 2.5 % of the cells, none by more than 0.5.");
}

#[test]
fn any_of_three_thresholds_lets_a_cell_pass() {
    // 8 and 8.5: 0.5 absolute, 0.5 / 8.5 relative, and an ulp at 8 is 2^-20: 2^19 ulp.
    let differing = |thresholds: Thresholds| singles(&[8.0], &[8.5], &thresholds).differing;
    assert_eq!(differing(NONE), 1);
    assert_eq!(differing(Thresholds { fail: 0.5, ..NONE }), 0);
    assert_eq!(differing(Thresholds { fail: 0.499, ..NONE }), 1);
    // 1 / 17 = 0.0588...
    assert_eq!(differing(Thresholds { fail_relative: 0.058_9, ..NONE }), 0);
    assert_eq!(differing(Thresholds { fail_relative: 0.058_8, ..NONE }), 1);
    assert_eq!(differing(Thresholds { fail_ulp: 524_288.0, ..NONE }), 0);
    assert_eq!(differing(Thresholds { fail_ulp: 524_287.0, ..NONE }), 1);
    let mixed = Thresholds { fail: 1e-9, fail_relative: 1e-9, fail_ulp: 524_288.0, ..NONE };
    assert_eq!(differing(mixed), 0);
}

#[test]
fn ulps_are_those_of_the_coarser_file() {
    // One step of single precision at 1: 2^-23, which is 2^29 steps of double precision.
    let step = 1.0 + 1.0 / 8_388_608.0;
    let ulps = |a, b| one(reals(a, &[1.0]), reals(b, &[step]), &NONE).largest_ulp.unwrap();
    assert_eq!(ulps(Storage::F32, Storage::F64), 1.0);
    assert_eq!(ulps(Storage::F64, Storage::F64), 536_870_912.0);
    // In half precision an ulp at 1 is 2^-10. Which side is the coarser one does not count.
    assert_eq!(ulps(Storage::F16, Storage::F64), 1.0 / 8192.0);
    for (fine, coarse) in
        [(Storage::F64, Storage::F32), (Storage::F32, Storage::F16), (Storage::F64, Storage::F16)]
    {
        assert_eq!(ulps(fine, coarse), ulps(coarse, fine), "{fine} {coarse}");
        assert_eq!(ulps(fine, coarse), ulps(coarse, coarse), "{fine} {coarse}");
    }
    let allowed = |a, b| one(reals(a, &[1.0]), reals(b, &[step]), &Thresholds { fail_ulp: 1.0, ..NONE });
    assert!(!allowed(Storage::F32, Storage::F64).fails);
    assert!(allowed(Storage::F64, Storage::F64).fails);
}

#[test]
fn nan_is_nan_and_nothing_else() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let all = Thresholds { fail: inf, fail_relative: inf, fail_ulp: inf, ..NONE };
    let same = singles(&[nan, inf, -inf, 0.0], &[nan, inf, -inf, -0.0], &NONE);
    assert_eq!((same.unequal, same.fails, same.worst), (0, false, None));
    // The statistics are those of the only finite number.
    assert_eq!((same.largest, same.mean), (Some(0.0), Some(0.0)));
    for (a, b) in [(nan, 1.0), (1.0, nan), (inf, 1.0), (inf, -inf), (nan, inf)] {
        let found = singles(&[1.0, a], &[1.5, b], &all);
        assert_eq!((found.unequal, found.differing, found.incomparable), (2, 1, 1), "{a} {b}");
        assert!(found.fails);
        // The incomparable cell is the worst one, before any finite difference.
        assert_eq!(found.worst.unwrap().i, 1);
        assert_eq!(found.largest, Some(0.5));
    }
    let nothing = singles(&[nan], &[1.0], &NONE);
    assert_eq!((nothing.largest, nothing.rms, nothing.largest_ulp), (None, None, None));
}

#[test]
fn a_share_of_cells_may_differ_but_none_beyond_the_hard_limit() {
    let (a, b) = ([0.0; 8], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 3.0]);
    let fails = |thresholds: Thresholds| singles(&a, &b, &thresholds).fails;
    // Two of eight cells are 25 percent.
    assert!(!fails(Thresholds { fail_percent: 25.0, ..NONE }));
    assert!(fails(Thresholds { fail_percent: 24.9, ..NONE }));
    let hard = |most| Thresholds { fail_percent: 25.0, hard_fail: Some(most), ..NONE };
    assert!(!fails(hard(3.0)));
    assert!(fails(hard(2.9)));
    // The hard limit holds for cells that another threshold allows, too.
    assert!(fails(Thresholds { fail: 5.0, hard_fail: Some(2.9), ..NONE }));
    let nan = singles(&[f64::NAN, 1.0], &[1.0; 2], &hard(1e300));
    assert_eq!((nan.beyond_hard, nan.fails), (1, true));
    // What has no size is one of the cells of the share, as a hit beside a silhouette is, and no more.
    let beside = |thresholds| singles(&[f64::NAN, 1.0, f64::INFINITY, 1.0], &[1.0; 4], &thresholds).fails;
    assert!(!beside(Thresholds { fail_percent: 50.0, ..NONE }));
    assert!(beside(Thresholds { fail_percent: 49.9, fail: f64::INFINITY, ..NONE }));
}

#[test]
fn wholes_are_equal_or_not() {
    let thresholds = Thresholds { fail: 100.0, fail_ulp: 100.0, hard_fail: Some(0.5), ..NONE };
    let found = one(wholes(&[1, 2, u32::MAX]), wholes(&[1, 3, u32::MAX]), &thresholds);
    assert_eq!((found.differing, found.largest, found.largest_ulp, found.rms), (1, None, None, None));
    assert_eq!(found.worst, Some(CellDifference { i: 1, j: 0, a: 2.0, b: 3.0 }));
    assert!(found.fails);
    // A share of the cells may differ, by any amount.
    let share = Thresholds { fail_percent: 34.0, ..thresholds };
    assert!(!one(wholes(&[1, 2, 7]), wholes(&[1, 3, 7]), &share).fails);
    // Compared with reals they are reals: truth values as bytes and as an EXR's floats.
    let found = one(wholes(&[0, 1]), reals(Storage::F32, &[0.0, 1.0]), &NONE);
    assert_eq!((found.unequal, found.storage), (0, Storage::F32));
}

#[test]
fn channels_on_one_side_fail_unless_only_shared_ones_count() {
    let cell = || reals(Storage::F32, &[1.0]);
    let a = recording([("a", cell()), ("x", cell())]);
    let b = recording([("b", cell()), ("c", cell()), ("x", cell())]);
    let found = diff(&a, &b, &NONE).unwrap();
    assert_eq!(found.only, [vec!["a".to_string()], vec!["b".to_string(), "c".to_string()]]);
    assert!(!found.passes() && found.failing().next().is_none());
    assert!(diff(&a, &b, &Thresholds { shared_only: true, ..NONE }).unwrap().passes());
    let nothing = diff(&recording([("a", cell())]), &recording([("b", cell())]), &NONE).unwrap_err();
    let expected =
        "no channel is in both: A has a, B has b; expected the same names, as of two folders or two files";
    assert_eq!(nothing.to_string(), expected);
}

#[test]
fn sizes_that_differ_name_both_files() {
    let error =
        diff(&recording([("x", reals(Storage::F32, &[1.0, 2.0]))]), &recording([("x", wholes(&[1]))]), &NONE);
    assert_eq!(
        error.unwrap_err().to_string(),
        "channel `x`: f.exr has 2 x 1 cells, w.npy has 1 x 1; expected the same size"
    );
}

#[test]
fn the_unit_is_what_either_file_says() {
    let mut a = recording([("camera/range.T", reals(Storage::F32, &[1.0]))]);
    let b = a.clone();
    assert_eq!(diff(&b, &a, &NONE).unwrap().channels[0].unit, "");
    let texts = BTreeMap::from([("unit".to_string(), "range, P: metre; N: 1".to_string())]);
    a.attributes.insert("f.exr".into(), texts);
    assert_eq!(diff(&b, &a, &NONE).unwrap().channels[0].unit, "m");
    assert_eq!(diff(&a, &b, &NONE).unwrap().channels[0].unit, "m");
}

#[test]
fn what_could_not_be_judged_is_left_to_the_thresholds() {
    let a = recording([("x", reals(Storage::F32, &[1.0]))]);
    let b = recording([("x", reals(Storage::F32, &[2.0]))]);
    let ruled = |thresholds: &Thresholds, classes: (Class, Class), not_judged: u64| {
        let ruling = ChannelRuling { by_class: [(classes, 1)].into(), not_judged, wrong: Vec::new() };
        let rulings = Rulings { channels: [("x".to_string(), ruling)].into(), not_ruled: Vec::new() };
        diff(&a, &b, thresholds).unwrap().with_rulings(rulings).passes()
    };
    let (fine, wide) = ((Class::Tie, Class::Rounding), Thresholds { fail: 1.0, ..NONE });
    // All are judged and right: the thresholds no longer count.
    assert!(ruled(&NONE, fine, 0) && ruled(&wide, fine, 0));
    assert!(!ruled(&NONE, fine, 1) && ruled(&wide, fine, 1));
    for wrong in
        [(Class::Defect, Class::Agree), (Class::Agree, Class::Defect), (Class::Agree, Class::Undecided)]
    {
        assert!(!ruled(&NONE, wrong, 0) && !ruled(&wide, wrong, 0), "{wrong:?}");
    }
    let hard = Thresholds { hard_fail: Some(0.5), ..wide };
    assert!(!ruled(&hard, fine, 0));
}

/// Two recordings: NaN against a number, whole numbers that differ, an equal channel, and a channel on either side
/// only. The names need escapes in HTML and XML.
fn two_recordings() -> [Channels; 2] {
    let a = recording([
        ("<b>", reals(Storage::F32, &[1.0, f64::NAN, 2.0])),
        ("face.I", wholes(&[1, 2, u32::MAX])),
        ("only-a", wholes(&[1])),
        ("same", wholes(&[1, 1, 1])),
    ]);
    let b = recording([
        ("<b>", reals(Storage::F32, &[1.0, 1.0, 2.5])),
        ("face.I", wholes(&[1, 3, u32::MAX])),
        ("only-b", wholes(&[1])),
        ("same", wholes(&[1, 1, 1])),
    ]);
    [a, b]
}

/// The rulings that a referee might give on [`two_recordings`].
fn rulings() -> Rulings {
    let wrong = RuledCell {
        place: Place { sensor: SensorId::Camera, i: 2, j: 0 },
        who: "B",
        what: "range 2.5 m; true 2 m".into(),
    };
    let by_class = BTreeMap::from([((Class::Agree, Class::Defect), 1), ((Class::Tie, Class::Agree), 3)]);
    let ruling = ChannelRuling { by_class, not_judged: 1, wrong: vec![wrong] };
    Rulings {
        channels: BTreeMap::from([("<b>".to_string(), ruling)]),
        not_ruled: vec!["face.I".into(), "rays/mast/t".into()],
    }
}

/// The text of an HTML page: without styles, pictures and tags, one line for each piece of text.
fn text_of_page(html: &str) -> String {
    let html = raypencil_explorer::without_explorer(html);
    let body = html.split_once("</style>").map_or(html.as_str(), |(_, body)| body);
    let pieces = body.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text.trim());
    pieces.filter(|text| !text.is_empty()).collect::<Vec<_>>().join("\n")
}

/// The screen of a terminal of 100 characters.
fn diff_screen(difference: &Difference, sides: &Sides) -> String {
    diff_document(difference, sides).screen_of_width(100)
}

/// The same for a file or another program.
fn diff_text(difference: &Difference, sides: &Sides) -> String {
    diff_document(difference, sides).screen()
}

/// Compares a report with its snapshot. The version is left out.
fn assert_report(name: &str, text: &str) {
    insta::with_settings!({ filters => vec![(r"raypencil \d+\.\d+\.\d+", "raypencil [version]")] }, {
        insta::assert_snapshot!(name, text);
    });
}

#[test]
fn screens_are_as_the_snapshots_show() {
    let [a, b] = two_recordings();
    let sides = Sides { names: ["left", "right"], channels: [&a, &b] };
    let difference = diff(&a, &b, &NONE).unwrap();
    assert_report("screen_of_a_failure", &diff_screen(&difference, &sides));
    assert_report("screen_with_rulings", &diff_screen(&difference.with_rulings(rulings()), &sides));
    let thresholds =
        Thresholds { fail_ulp: 4.0, fail_percent: 70.0, hard_fail: None, shared_only: true, ..NONE };
    let within = diff(&a, &b, &thresholds).unwrap();
    assert_report("screen_within_thresholds", &diff_screen(&within, &sides));
}

#[test]
fn a_screen_stays_one_screen() {
    let key = |k: u32| format!("a-folder-with-a-name/channel-{k:02}.and-a-name");
    let recording = |shift: f64| Channels {
        by_key: (0..60).map(|k| (key(k), reals(Storage::F64, &[f64::from(k) + shift / 3.0]))).collect(),
        ..Channels::default()
    };
    let (a, b) = (recording(-1e200), recording(1e-3));
    let difference = diff(&a, &b, &NONE).unwrap();
    let long = "x/".repeat(200);
    let sides = Sides { names: [&long, "b"], channels: [&a, &b] };
    let screen = diff_screen(&difference, &sides);
    assert!(screen.lines().count() <= 40, "{screen}");
    assert!(screen.lines().all(|line| line.chars().count() <= 100), "{screen}");
    // 60 channels differ, of which 12 are listed.
    assert!(screen.contains("and 48 channels that are not the same"), "{screen}");
    assert!(screen.contains("✗ 60 of 60 channels differ."), "{screen}");
    assert_report("screen_of_many_channels", &screen);
    let same = diff_screen(&diff(&a, &a, &NONE).unwrap(), &sides);
    assert!(same.contains("✓ 60 channels compared, the same in every cell."), "{same}");
    assert!(same.contains("Allowed: no difference."), "{same}");
    assert_report("screen_of_equal_recordings", &same);
}

#[test]
fn channels_on_one_side_are_named_in_full() {
    // Six keys of 60 characters need several lines of 100.
    let key = |k: u32| format!("only-here/{}{k}", "channel-".repeat(6));
    let cell = || reals(Storage::F32, &[1.0]);
    let shared = || ("x".to_string(), cell());
    let a = Channels {
        by_key: (0..6).map(|k| (key(k), cell())).chain([shared()]).collect(),
        ..Channels::default()
    };
    let b = Channels { by_key: [shared()].into(), ..Channels::default() };
    let sides = Sides { names: ["a", "b"], channels: [&a, &b] };
    for shared_only in [false, true] {
        let difference = diff(&a, &b, &Thresholds { shared_only, ..NONE }).unwrap();
        for (screen, most) in
            [(diff_screen(&difference, &sides), 100), (diff_text(&difference, &sides), usize::MAX)]
        {
            for k in 0..6 {
                assert!(screen.contains(&key(k)), "{screen}");
            }
            assert!(screen.contains(&format!("Only in A: {}", key(0))) && !screen.contains('…'), "{screen}");
            let words = screen.split_whitespace().collect::<Vec<_>>().join(" ");
            assert_eq!(words.contains("not counted: --shared-only)"), shared_only, "{screen}");
            assert!(screen.lines().all(|line| line.chars().count() <= most), "{screen}");
        }
    }
}

#[test]
fn a_text_that_is_not_for_a_terminal_is_not_cut() {
    let key = format!("a-folder/{}", "channel-".repeat(6));
    let recording = |value: f64| Channels {
        by_key: [(key.clone(), reals(Storage::F64, &[value]))].into(),
        ..Channels::default()
    };
    let (a, b) = (recording(1.0), recording(2.0));
    let long = "x/".repeat(200);
    let (difference, sides) =
        (diff(&a, &b, &NONE).unwrap(), Sides { names: [&long, "b"], channels: [&a, &b] });
    let whole = |text: &str| text.contains(&key) && text.contains(&long) && !text.contains('…');
    assert!(whole(&diff_text(&difference, &sides)));
    assert!(!whole(&diff_screen(&difference, &sides)));
}

#[test]
fn a_folder_is_complete_and_its_files_escape_names() {
    let [a, b] = two_recordings();
    let difference = diff(&a, &b, &NONE).unwrap().with_rulings(rulings());
    let sides = Sides { names: ["left & <right>", "b"], channels: [&a, &b] };
    let folder = tempfile::tempdir().unwrap();
    write_diff(&difference, &sides, folder.path(), &Silent).unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let html = read("report.html");
    assert!(html.contains("<h3>&#60;b&#62; "), "names are escaped");
    assert!(html.contains("left &#38; &#60;right&#62;"), "names of sides are escaped");
    // Three pictures of each of two channels.
    assert_eq!(html.matches("data:image/png;base64,").count(), 6);
    assert!(!html.contains("http://") && !html.contains("src=\"/"), "the page has no links");
    assert!(html.contains("NaN or infinite on one side") && html.contains("not the same"));
    assert_report("text_of_the_page", &text_of_page(&html));
    // Between backticks nothing is markup.
    assert!(read("summary.md").contains("* A: `left & <right>`"), "{}", read("summary.md"));
    let junit = read("junit.xml");
    // Three channels on both sides and one on each side only; the equal one does not fail.
    assert!(junit.contains("failures=\"4\"") && junit.contains("tests=\"5\""), "{junit}");
    assert_report("junit", &junit);
    let summary: serde_json::Value = serde_json::from_str(&read("summary.json")).unwrap();
    assert_eq!(summary["verdict"], "differs");
    let channel = &summary["channels"][0];
    assert_eq!((&channel["worst"]["a"], &channel["worst"]["b"]), (&"NaN".into(), &1.0.into()));
    assert_eq!(
        (&channel["differing"], &channel["incomparable"], &channel["largest"]),
        (&2.into(), &1.into(), &0.5.into())
    );
    assert_eq!(summary["channels"][1]["largest"], serde_json::Value::Null);
    let worst = &summary["channels"][1]["worst"];
    assert_eq!((&worst["column"], &worst["a"], &worst["b"]), (&1.into(), &2.0.into(), &3.0.into()));
    assert_eq!(
        (&summary["only_a"], &summary["only_b"]),
        (&serde_json::json!(["only-a"]), &serde_json::json!(["only-b"]))
    );
}
