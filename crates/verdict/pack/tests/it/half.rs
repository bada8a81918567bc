//! Candidates in half precision: judged by its last place, and never called exact.

use std::path::{Path, PathBuf};

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, Layer, LayerAttributes, SmallVec,
    WritableImage, f16,
};
use raypencil_files::{Limits, Storage, Values, read_npy};
use raypencil_judge::{Class, Quantity};
use raypencil_pack::{Checked, check_pack};
use raypencil_scene::{Image, Precision, Silent};

fn pack() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs/pyramids")
}

/// The exact ranges of the pack's camera.
fn exact_ranges() -> Image<f64> {
    let array = read_npy(pack().join("camera/range.T.npy"), &Limits::default()).expect("an array");
    let [Values::Reals(ranges)] = array.planes.as_slice() else { panic!("one plane of reals") };
    ranges.clone()
}

/// A folder with `mine/camera.exr`, which has the channels in half precision.
fn candidate(channels: &[(&str, &[f16])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir(folder.path().join("mine")).expect("a folder");
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels
        .iter()
        .map(|(name, cells)| AnyChannel::new(*name, FlatSamples::F16(cells.to_vec())))
        .collect();
    let (width, height) = (exact_ranges().width() as usize, exact_ranges().height() as usize);
    let channels = AnyChannels::sort(channels);
    let layer = Layer::new((width, height), LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    ExrImage::from_layer(layer).write().to_file(folder.path().join("mine/camera.exr")).expect("a file");
    folder
}

fn checked(folder: &tempfile::TempDir) -> Checked {
    check_pack(&pack(), &folder.path().join("mine"), None, &Silent).expect("a candidate that can be judged")
}

/// The exact ranges, each rounded once to half precision.
fn rounded() -> Vec<f16> {
    exact_ranges().cells().iter().map(|range| nearest(*range)).collect()
}

/// The nearest number of half precision. `f16::from_f64` may round twice, to single precision on the way.
fn nearest(number: f64) -> f16 {
    let near = f16::from_f64(number);
    if !number.is_finite() {
        return near;
    }
    let around = [-1, 0, 1].map(|step| f16::from_bits(near.to_bits().wrapping_add_signed(step)));
    let off = |half: &f16| (half.to_f64() - number).abs();
    around.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("three numbers")
}

#[test]
fn a_number_rounded_twice_is_off_for_double_precision_only() {
    // In `facets` the depth of pixel (60, 57), 2.6689454125 m, lies 1e-7 m above the middle of two numbers of half
    // precision. Rounded to single precision first, it is the middle, and is then rounded down, to the even one.
    let pack = pack().with_file_name("facets");
    let array = read_npy(pack.join("camera/depth.Z.npy"), &Limits::default()).expect("an array");
    let [Values::Reals(exact)] = array.planes.as_slice() else { panic!("one plane of reals") };
    let twice: Vec<f16> = exact.cells().iter().map(|depth| f16::from_f32(*depth as f32)).collect();
    let index = 60 + 57 * exact.width() as usize;
    assert_ne!(twice[index], nearest(exact.cells()[index]));
    let folder = candidate(&[("depth.Z", &twice)]);
    let mine = folder.path().join("mine");
    let as_double = check_pack(&pack, &mine, None, &Silent).expect("a candidate that can be judged");
    let defects = &as_double.check.sensors[0].defects;
    assert!(defects.iter().any(|defect| (defect.place.i, defect.place.j) == (60, 57)), "{defects:?}");
    let as_single = check_pack(&pack, &mine, Some(Precision::F32), &Silent);
    assert!(as_single.expect("a candidate that can be judged").check.passes());
}

#[test]
fn ranges_rounded_to_half_precision_agree_and_are_not_called_exact() {
    let found = checked(&candidate(&[("range.T", &rounded())]));
    assert!(found.check.passes(), "{}", found.document().screen());
    let ranges = &found.check.totals()[&Quantity::Range.into()];
    let ulps = ranges.worst_ulps.as_ref().expect("compared").value;
    // Rounded to nearest: at most half an ulp of half precision, and thousands of ranges come near it.
    assert!(ulps > 0.4 && ulps <= 0.5, "{ulps}");

    let screen = found.document().screen();
    assert!(screen.contains("rays agree to half precision"), "{screen}");
    assert!(screen.contains("Stored in half precision") && screen.contains("65504"), "{screen}");
    assert!(!screen.contains("exact"), "{screen}");
    let json: serde_json::Value = serde_json::from_str(&found.document().json()).expect("JSON");
    let range = &json["bundles"][0]["quantities"][2];
    assert_eq!((range["quantity"].as_str(), range["storage"].as_str()), (Some("range"), Some("half")));
    assert!(!json.to_string().contains("exact"), "{json}");
}

#[test]
fn an_error_beyond_half_an_ulp_of_half_precision_is_a_defect() {
    let exact = exact_ranges();
    let mut cells = rounded();
    // A range that its rounding hardly changes: the next number of half precision is more than 0.9 ulp from it.
    let off = |index: usize, half: f16| {
        let truth = exact.cells()[index];
        (half.to_f64() - truth).abs() / Storage::F16.ulp(truth)
    };
    let at =
        (0..cells.len()).find(|&index| exact.cells()[index].is_finite() && off(index, cells[index]) < 0.05);
    let at = at.expect("such a range");
    cells[at] = f16::from_bits(cells[at].to_bits() + 1);
    assert!(off(at, cells[at]) > 0.9 && off(at, cells[at]) < 1.1);
    let found = checked(&candidate(&[("range.T", &cells)]));
    assert_eq!(found.check.of(Class::Defect), 1);
    let listed = &found.check.sensors[0].listed[0];
    let place = (listed.place.i as usize) + (listed.place.j as usize) * exact.width() as usize;
    assert_eq!(place, at);
    assert!(!found.document().screen().contains("exact"), "{}", found.document().screen());
}

#[test]
fn indices_that_half_precision_cannot_tell_apart_are_refused() {
    // 2049 is stored as 2048. The same holds from 2048 on; below, every index is itself.
    let cells = |index: f64| vec![f16::from_f64(index); exact_ranges().cells().len()];
    assert_eq!(f16::from_f64(2049.0), f16::from_f64(2048.0));
    let folder = candidate(&[("face.I", &cells(2049.0))]);
    let error = check_pack(&pack(), &folder.path().join("mine"), None, &Silent).expect_err("no index");
    let message = error.to_string();
    assert!(message.contains("`face.I` at 0,0: 2048 in half precision") && message.contains("below 2048"));
    let told = checked(&candidate(&[("face.I", &cells(55.0))]));
    assert!(told.check.compared() > 0);
}
