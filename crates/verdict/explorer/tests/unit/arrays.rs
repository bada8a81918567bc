//! Arrays come back as they were put in, by a reader written from the format's words.

use super::*;
use crate::{DifferingCell, RasterChannel, RasterGroup, RasterPage, SideKind};
use raypencil_judge::Class;

/// Undoes deflate and the steps of a reference.
pub(crate) fn read(scripts: &str, reference: &Value) -> Vec<u32> {
    let id = format!("id=\"array-{}\">", reference["array"]);
    let text = scripts.split(&id).nth(1).expect("the array").split('<').next().expect("its text");
    let bytes = STANDARD.decode(text).expect("base64");
    let bytes = miniz_oxide::inflate::decompress_to_vec(&bytes).expect("deflate");
    let count = reference["count"].as_u64().expect("a count") as usize;
    let (size, mask) = match reference["type"].as_str().expect("a type") {
        "u8" => (1, 0xff),
        "u16" => (2, 0xffff),
        _ => (4, u32::MAX),
    };
    assert_eq!(bytes.len(), count * size);
    let steps = reference["steps"].as_array().expect("steps");
    let mut numbers: Vec<u32> = if steps.first() == Some(&json!("planes")) {
        (0..count)
            .map(|k| (0..size).map(|plane| u32::from(bytes[plane * count + k]) << (8 * plane)).sum())
            .collect()
    } else {
        assert_eq!(size, 1);
        bytes.iter().map(|byte| u32::from(*byte)).collect()
    };
    for step in steps.iter().skip(1) {
        if let Some(other) = step.get("xor") {
            for (mine, theirs) in numbers.iter_mut().zip(read(scripts, other)) {
                *mine ^= theirs;
            }
        } else {
            assert_eq!(step, "delta");
            let mut sum = 0_u32;
            for number in &mut numbers {
                sum = sum.wrapping_add(*number) & mask;
                *number = sum;
            }
        }
    }
    numbers
}

#[test]
fn every_kind_comes_back() {
    let whole = [0, 1, u32::MAX, 7, 7, 0x0123_4567];
    let signed = [0, -1, i32::MIN, i32::MAX, 5, -5];
    let reals = [0.0_f32, -0.0, 1.5, f32::NAN, f32::INFINITY, f32::MIN_POSITIVE];
    let small = [0_u16, 65535, 1, 256, 255, 0];
    for change in [Change::None, Change::Delta] {
        let mut arrays = Arrays::default();
        let of_u32 = arrays.u32(&whole, change).reference;
        let of_i32 = arrays.i32(&signed, change).reference;
        let of_f32 = arrays.f32(&reals, change).reference;
        let of_u16 = arrays.u16(&small, change).reference;
        let of_u8 = arrays.u8(&[3, 0, 255]);
        let scripts = arrays.scripts();
        assert_eq!(read(&scripts, &of_u32), whole);
        assert_eq!(read(&scripts, &of_i32), signed.map(i32::cast_unsigned));
        assert_eq!(read(&scripts, &of_f32), reals.map(f32::to_bits));
        assert_eq!(read(&scripts, &of_u16), small.map(u32::from));
        assert_eq!(read(&scripts, &of_u8), [3, 0, 255]);
    }
}

#[test]
fn what_is_the_same_beside_another_takes_hardly_any_bytes() {
    // Numbers in which deflate finds nothing.
    let mixed = |k: u32| {
        let k = (k ^ (k >> 16)).wrapping_mul(0x7feb_352d);
        let k = (k ^ (k >> 15)).wrapping_mul(0x846c_a68b);
        k ^ (k >> 16)
    };
    let numbers: Vec<u32> = (0..100_000_u32).map(mixed).collect();
    let mut arrays = Arrays::default();
    let first = arrays.u32(&numbers, Change::Delta);
    let alone = arrays.scripts().len();
    let mut others = numbers.clone();
    others[77] = 0;
    let second = arrays.u32_beside(&others, &first);
    let third = arrays.u32_beside(&numbers, &second);
    let scripts = arrays.scripts();
    assert!(alone > 100_000 && scripts.len() - alone < 4000, "{alone} and {}", scripts.len());
    assert_eq!(read(&scripts, &second.reference), others);
    // Of what is beside something else in turn.
    assert_eq!(read(&scripts, &third.reference), numbers);
}

/// The model of a page.
fn model_of(html: &str) -> Value {
    let (_, rest) = html.split_once("id=\"page-model\">").expect("a model");
    serde_json::from_str(rest.split_once("</script>").expect("its end").0).expect("JSON")
}

#[test]
fn a_page_of_two_sides_and_two_groups_keeps_every_cell_where_it_was() {
    let nan = f32::NAN;
    let reals = [
        [vec![1.0, 2.0, nan, 4.0, 5.0, 6.0], vec![1.0, 2.5, 3.0, nan, 5.0, -6.0]],
        [vec![7.0, 8.0], vec![9.0, 8.0]],
    ];
    let wholes = [
        [vec![1, 2, u32::MAX, 4, 5, 6], vec![1, 3, u32::MAX, 7, 5, 6]],
        [vec![0, u32::MAX], vec![u32::MAX, 0]],
    ];
    let sizes = [(3, 2), (1, 2)];
    let differing = |cell, channel, class| DifferingCell { cell, channel, class };
    let of_groups = [
        vec![differing(1, 0, Class::Defect), differing(3, 1, Class::Rounding)],
        vec![differing(0, 1, Class::Tie), differing(1, 2, Class::Defect)],
    ];
    let names = [["range.T", "face.I", "one side"], ["depth.Z", "pixel.I", "other side"]];
    let described = [vec![(3, "of the first".to_string())], vec![(1, "of the second".to_string())]];
    let groups: Vec<RasterGroup> = (0..2)
        .map(|k: usize| RasterGroup {
            name: ["camera", "beam-0"][k].into(),
            size: sizes[k],
            axes: None,
            channels: vec![
                (names[k][0].into(), "m".into(), RasterChannel::Reals(reals[k].clone().map(Some).into())),
                (
                    names[k][1].into(),
                    String::new(),
                    RasterChannel::Wholes(wholes[k].clone().map(Some).into()),
                ),
                (names[k][2].into(), "s".into(), RasterChannel::Reals(vec![None, Some(reals[k][0].clone())])),
            ],
            differing: of_groups[k].clone(),
            described: described[k].clone(),
        })
        .collect();
    let sides = [("mine", SideKind::Candidate), ("yours", SideKind::Candidate)];
    let page = RasterPage {
        kind: "diff",
        title: "mine and yours",
        sides: &sides,
        classes: ["equal", "tie", "rounding", "approximation", "undecided", "differs"],
        groups: &groups,
        described_words: "",
        solid: None,
    };
    let html = page.html();
    let model = model_of(&html);
    for k in 0..2 {
        let sensor = &model["sensors"][k];
        for side in 0..2 {
            let stored = |channel: &str| read(&html, &sensor["sides"][side]["channels"][channel]["stored"]);
            assert_eq!(stored(names[k][0]), reals[k][side].iter().map(|x| x.to_bits()).collect::<Vec<_>>());
            assert_eq!(stored(names[k][1]), wholes[k][side]);
        }
        assert!(sensor["sides"][0]["channels"][names[k][2]].is_null());
        let yours = read(&html, &sensor["sides"][1]["channels"][names[k][2]]["stored"]);
        assert_eq!(yours, reals[k][0].iter().map(|x| x.to_bits()).collect::<Vec<_>>());
        let [classes, quantities] = ["class", "quantity"].map(|of| read(&html, &sensor["pairs"][0][of]));
        for (cell, (class, quantity)) in classes.iter().zip(&quantities).enumerate() {
            let known = of_groups[k].iter().find(|one| one.cell as usize == cell);
            assert_eq!(*class, known.map_or(Class::Agree, |one| one.class) as u32, "{k} {cell}");
            let name = model["quantities"].get(*quantity as usize).map(|one| one["name"].clone());
            let channel = known.map(|one| Value::from(groups[k].channels[one.channel].0.as_str()));
            assert_eq!(name, channel, "{k} {cell}");
        }
        // The quantities of a group are its own, with their units.
        let differs = known_quantity(&model, &quantities, of_groups[k][0].cell);
        assert_eq!(differs, groups[k].channels[of_groups[k][0].channel].1.as_str());
    }
    let told: Vec<u8> = read(&html, &model["rays"]).into_iter().map(|byte| byte as u8).collect();
    let told: Value = serde_json::from_slice(&told).expect("JSON");
    let places: Vec<_> = told
        .as_array()
        .expect("a list")
        .iter()
        .map(|one| (one["sensor"].as_u64(), one["cell"].as_u64(), one["text"].as_str()))
        .collect();
    assert_eq!(places, [(Some(0), Some(3), Some("of the first")), (Some(1), Some(1), Some("of the second"))]);
}

#[test]
fn each_margin_of_a_page_has_its_own_numbers() {
    let margins = crate::RayMargins {
        cells: vec![1, 3, 700],
        face: vec![0.125, 0.25, 0.5],
        surface: vec![0.75, 1.0, 0.625],
        visibility: vec![0.0625, f32::NAN, 0.375],
        landing: vec![f32::NAN, 0.875, 0.3125],
    };
    let mut arrays = Arrays::default();
    let model = margins.model(&mut arrays);
    let scripts = arrays.scripts();
    assert_eq!(read(&scripts, &model["cells"]), margins.cells);
    for (name, values) in [
        ("face", &margins.face),
        ("surface", &margins.surface),
        ("visibility", &margins.visibility),
        ("landing", &margins.landing),
    ] {
        let bits: Vec<u32> = values.iter().map(|value| value.to_bits()).collect();
        assert_eq!(read(&scripts, &model[name]), bits, "{name}");
    }
}

/// The unit of the quantity in which a cell differs.
fn known_quantity(model: &Value, quantities: &[u32], cell: u32) -> String {
    let index = quantities[cell as usize] as usize;
    model["quantities"][index]["unit"].as_str().expect("a unit").to_string()
}
