//! The tables of codes, by what is known of some of them from elsewhere, and by their number.

use super::*;

/// Codes, and the EPSG codes of the units in which their surveys map.
const MAPS: [(u16, u16); 24] = [
    (6529, 9003),  // NAD83(2011) / New Mexico Central (ftUS)
    (2229, 9003),  // NAD83 / California zone 5 (ftUS)
    (2222, 9002),  // NAD83 / Arizona East (ft)
    (26746, 9003), // NAD27 / California zone VI
    (2263, 9003),  // NAD83 / New York Long Island (ftUS)
    (3857, 9001),  // WGS 84 / Pseudo-Mercator
    (27700, 9001), // OSGB36 / British National Grid
    (2056, 9001),  // CH1903+ / LV95
    (28992, 9001), // Amersfoort / RD New
    (2193, 9001),  // NZGD2000 / New Zealand Transverse Mercator
    (24370, 9084), // Kalianpur 1880 / India zone 0
    (2136, 9094),  // Accra / Ghana National Grid
    (2314, 9005),  // Trinidad 1903 / Trinidad Grid
    (29872, 9041), // Timbalai 1948 / RSO Borneo (ftSe)
    (29371, 9031), // Schwarzeck / Lo22/11
    (2066, 9039),  // Mount Dillon / Tobago Grid
    (3140, 9098),  // Viti Levu 1912 / Viti Levu Grid
    (32766, 9001), // WGS 84 / TM 36 SE
    (3035, 9001),  // ETRS89-extended / LAEA Europe
    (5070, 9001),  // NAD83 / Conus Albers
    (3031, 9001),  // WGS 84 / Antarctic Polar Stereographic
    (3413, 9001),  // WGS 84 / NSIDC Sea Ice Polar Stereographic North
    (32104, 9001), // NAD83 / Nebraska
    (2953, 9001),  // NAD83(CSRS) / New Brunswick Stereographic
];

#[test]
fn maps_have_the_units_of_the_registry() {
    for (code, unit) in MAPS {
        assert_eq!(projected(code).and_then(|unit| unit.code), Some(unit), "{code}");
    }
    // The zones of UTM, by rule: WGS 84, WGS 72, NAD83, NAD27, ETRS89, SIRGAS 2000, GDA94.
    for zones in [
        32601..=32660,
        32701..=32760,
        32201..=32260,
        26901..=26923,
        26703..=26722,
        25828..=25838,
        31978..=31985,
        28348..=28358,
    ] {
        for code in zones {
            assert_eq!(projected(code).and_then(|unit| unit.code), Some(9001), "{code}");
        }
    }
    // No projected systems: geographic, vertical, compound, unassigned, user-defined.
    for code in [0, 4326, 4269, 5703, 7405, 1, 1999, 32767, 65535] {
        assert_eq!(projected(code), None, "{code}");
    }
    let count: usize = UNITS
        .iter()
        .flat_map(|(_, runs)| runs.chunks_exact(2))
        .map(|run| usize::from(run[1] - run[0]) + 1)
        .sum();
    // All 5,636 of EPSG v11.022 but the one that 16 bits do not hold.
    assert_eq!(count, 5635);
    let in_feet = |unit: u16| UNITS.iter().find(|(code, _)| *code == unit).map(|(_, runs)| runs.len() / 2);
    assert!(in_feet(9003).is_some_and(|runs| runs > 300) && in_feet(9002).is_some_and(|runs| runs > 50));
}

#[test]
fn every_unit_of_the_tables_is_known_and_no_code_has_two() {
    let mut all: Vec<[u16; 2]> = Vec::new();
    for (unit, runs) in UNITS {
        assert!(LengthUnit::of_code(*unit).is_some(), "{unit}");
        all.extend(runs.chunks_exact(2).map(|run| [run[0], run[1]]));
    }
    all.sort_unstable();
    for pair in all.windows(2) {
        assert!(pair[0][1] < pair[1][0], "{pair:?}");
    }
    assert!(REVERSED.chunks_exact(2).all(|run| projected(run[0]).is_some() && projected(run[1]).is_some()));
    for &(code, unit, ..) in VERTICAL {
        assert!(LengthUnit::of_code(unit).is_some() && projected(code).is_none(), "{code}");
    }
    for parts in COMPOUND.chunks_exact(3) {
        assert!(projected(parts[1]).is_some(), "{parts:?}");
        assert!(vertical(parts[2]).is_some() && projected(parts[0]).is_none(), "{parts:?}");
    }
}

#[test]
fn vertical_systems_have_units_and_directions() {
    for (code, unit, is_depth, name) in [
        (5703, 9001, false, "NAVD88 height"),
        (6360, 9003, false, "NAVD88 height (ftUS)"),
        (8228, 9002, false, "NAVD88 height (ft)"),
        (5702, 9003, false, "NGVD29 height (ftUS)"),
        (3855, 9001, false, "EGM2008 height"),
        (5773, 9001, false, "EGM96 height"),
        (5715, 9001, true, "MSL depth"),
        (6358, 9003, true, "NAVD88 depth (ftUS)"),
        (8051, 9002, true, "MSL depth (ft)"),
        (5614, 9002, true, "KOC WD depth (ft)"),
        (5754, 9095, false, "Poolbeg height (ft(Br36))"),
    ] {
        let unit = HeightUnit { unit: LengthUnit::of_code(unit).unwrap(), is_depth };
        assert_eq!(vertical(code), Some(Vertical { unit: Some(unit), name }), "{code}");
    }
    // Names say what the table says.
    for (_, unit, is_depth, name) in VERTICAL {
        assert_eq!(name.contains("depth"), *is_depth && !name.contains("wellbore"), "{name}");
        assert_eq!(name.contains("(ft"), [9002, 9003, 9095].contains(unit), "{name}");
    }
    assert_eq!(VERTICAL.len(), 291);
    assert_eq!(vertical(5030).map(|vertical| vertical.unit), Some(None));
    for code in [0, 32767, 32632, 4326] {
        assert_eq!(vertical(code), None, "{code}");
    }
    // ETRS89 / UTM zone 32N + DHHN92 height.
    assert_eq!(compound(5555), Some([25832, 5783]));
    assert_eq!(compound(25832), None);
}

#[test]
fn axes_to_the_west_or_south_are_known() {
    // Hartebeesthoek94 / Lo19, S-JTSK / Krovak, ETRS89 / Faroe Lambert.
    for code in [2048, 5513, 3145] {
        assert!(is_reversed(code), "{code}");
    }
    // S-JTSK / Krovak East North, and UTM.
    for code in [5514, 32632] {
        assert!(!is_reversed(code), "{code}");
    }
}
