//! Units against a second source: the decimals that PROJ 9.5.1 gives for EPSG v11.022, to the last digit of a double.

use super::*;

/// Codes and metres of one unit.
const DECIMALS: [(u16, f64); 48] = [
    (1025, 0.001),
    (1033, 0.01),
    (9001, 1.0),
    (9002, 0.3048),
    (9003, 0.304_800_609_601_219_24),
    (9005, 0.304_797_265_4),
    (9014, 1.8288),
    (9015, 1852.0),
    (9030, 1852.0),
    (9031, 1.000_013_596_5),
    (9033, 20.116_840_233_680_47),
    (9034, 0.201_168_402_336_804_7),
    (9035, 1_609.347_218_694_437_5),
    (9036, 1000.0),
    (9037, 0.914_391_796_2),
    (9038, 20.116_619_516_4),
    (9039, 0.201_166_195_164),
    (9040, 0.914_398_414_616_028_7),
    (9041, 0.304_799_471_538_676_2),
    (9042, 20.116_765_121_552_632),
    (9043, 0.201_167_651_215_526_3),
    (9050, 0.914_399_2),
    (9051, 0.304_799_733_333_333_3),
    (9052, 20.116_782_4),
    (9053, 0.201_167_824),
    (9060, 0.914_399_204_289_812_4),
    (9061, 0.304_799_734_763_270_77),
    (9062, 20.116_782_494_375_872),
    (9063, 0.201_167_824_943_758_7),
    (9070, 0.304_800_833_333_333_35),
    (9080, 0.304_799_510_248_146_94),
    (9081, 0.304_798_41),
    (9082, 0.304_799_6),
    (9083, 0.304_799_5),
    (9084, 0.914_398_530_744_440_8),
    (9085, 0.914_395_23),
    (9086, 0.914_398_8),
    (9087, 0.914_398_5),
    (9093, 1609.344),
    (9094, 0.304_799_710_181_508_8),
    (9095, 0.304_800_749_1),
    (9096, 0.9144),
    (9097, 20.1168),
    (9098, 0.201_168),
    (9099, 0.914_398),
    (9300, 0.304_799_333_333_333_37),
    (9301, 20.116_756),
    (9302, 0.201_167_56),
];

#[test]
fn every_unit_is_as_long_as_proj_says() {
    assert_eq!(UNITS.len(), DECIMALS.len());
    for (code, metres) in DECIMALS {
        let unit = LengthUnit::of_code(code).unwrap_or_else(|| panic!("{code}"));
        // The fraction is rounded once, the decimal too.
        assert!((unit.metres() - metres).abs() <= f64::EPSILON * metres, "{code}: {}", unit.metres());
        assert_eq!(LengthUnit::parse(&code.to_string()), Ok(unit));
        assert_eq!(LengthUnit::parse(&format!("EPSG:{code}")), Ok(unit));
    }
    for code in [0, 9000, 9004, 9006, 9013, 9101, 9102, 9201, 1026, 1027] {
        assert_eq!(LengthUnit::of_code(code), None, "{code}");
    }
}

#[test]
fn units_are_related_as_their_definitions_say() {
    let metres = |code: u16| LengthUnit::of_code(code).unwrap().metres();
    // A yard is three feet, a chain is 22 yards, a link its hundredth; a mile is 80 chains.
    for (yard, foot) in [
        (9096, 9002),
        (9037, 9005),
        (9040, 9041),
        (9050, 9051),
        (9060, 9061),
        (9084, 9080),
        (9085, 9081),
        (9086, 9082),
        (9087, 9083),
        (9099, 9300),
    ] {
        // Decimals of the Indian yards are rounded by their definers.
        assert!((metres(yard) / metres(foot) - 3.0).abs() < 1e-7, "{yard}");
    }
    for (chain, yard, link) in [
        (9097, 9096, 9098),
        (9038, 9037, 9039),
        (9042, 9040, 9043),
        (9052, 9050, 9053),
        (9062, 9060, 9063),
        (9301, 9099, 9302),
    ] {
        assert!((metres(chain) / metres(yard) - 22.0).abs() < 1e-7, "{chain}");
        assert!((metres(chain) / metres(link) - 100.0).abs() < 1e-12, "{chain}");
    }
    assert!((metres(9033) / metres(9003) - 66.0).abs() < 1e-13);
    assert!((metres(9034) / metres(9003) - 0.66).abs() < 1e-15);
    assert!((metres(9035) / metres(9003) - 5280.0).abs() < 1e-11);
    assert!((metres(9093) / metres(9002) - 5280.0).abs() < 1e-11);
    assert!((metres(9014) / metres(9002) - 6.0).abs() < 1e-14);
    // The metre of 39.37 inches (United States, 1893), and of 39.370147 British ones (Sears, 1922).
    assert!((12.0 / 39.37 - metres(9003)).abs() < 1e-16);
    assert!((36.0 / 39.370_147 - metres(9040)).abs() < 1e-15);
    assert!((36.0 / 39.370_113 - metres(9060)).abs() < 1e-15);
    assert!((36.0 / 39.370_142 - metres(9084)).abs() < 1e-15);
}

#[test]
fn words_mean_one_unit_or_none() {
    for (word, code) in [
        ("m", 9001),
        ("Metre", 9001),
        ("km", 9036),
        ("cm", 1033),
        ("mm", 1025),
        ("ft", 9002),
        ("foot", 9002),
        ("ftUS", 9003),
        ("us-ft", 9003),
        ("US survey foot", 9003),
        ("US_survey_foot", 9003),
        ("Foot_US", 9003),
        ("yd", 9096),
        ("mi", 9093),
        ("fathom", 9014),
    ] {
        assert_eq!(LengthUnit::parse(word).map(|unit| unit.code), Ok(Some(code)), "{word}");
    }
    for word in ["", "feet", "degree", "9102", "-ft", " -ft", "- ft", "70000", "EPSG:", "metre per second"] {
        let expected = LengthUnit::parse(word).unwrap_err();
        assert!(expected.starts_with("expected m, km"), "{word}: {expected}");
    }
    for (_, code) in WORDS {
        assert!(LengthUnit::of_code(code).is_some(), "{code}");
    }
}

#[test]
fn lengths_become_metres_and_depths_heights() {
    let us_foot = LengthUnit::parse("ftUS").unwrap();
    // 3937 feet are 1200 m, exactly; metres keep their bits.
    assert_eq!(us_foot.to_metres(3937.0), 1200.0);
    assert_eq!(METRE.to_metres(0.1).to_bits(), 0.1_f64.to_bits());
    assert_eq!(LengthUnit::parse("ft").unwrap().to_metres(1250.0), 381.0);
    assert_eq!(LengthUnit::of_size(7.5).to_metres(2.0), 15.0);
    assert_eq!(HeightUnit::parse(" -ft ").unwrap().to_height(1250.0), -381.0);
    assert_eq!(HeightUnit::parse("ft").unwrap().to_height(-1250.0), -381.0);
    assert!(HeightUnit::parse("--ft").unwrap_err().contains("a minus before it for depths"));
    // The two feet differ by two millionths: they are no rounding of each other.
    assert!(!us_foot.is_as_long_as(LengthUnit::parse("ft").unwrap()));
    assert!(us_foot.is_as_long_as(LengthUnit::of_size(0.304_800_609_601_2)));
}

#[test]
fn a_unit_is_shown_with_code_and_size() {
    let shown = |word: &str| LengthUnit::parse(word).unwrap().to_string();
    assert_eq!(shown("m"), "metre (EPSG:9001)");
    assert_eq!(shown("ftUS"), "US survey foot (EPSG:9003), 0.3048006096012192 m");
    assert_eq!(LengthUnit::of_size(7.5).to_string(), "unit of the file's own, 7.5 m");
}
