//! Arrays come back as they were put in, by a reader written from the format's words.

use super::*;

/// Undoes deflate and the steps of a reference.
fn read(scripts: &str, reference: &Value) -> Vec<u32> {
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
