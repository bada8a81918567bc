//! Units of maps and heights, by codes, keys, names and options.

use super::write::{Double, Short, Text, Tiff};
use super::{assert_names, read, read_with, refusal};
use raypencil_mesh_io::{Dem, DemOptions, HeightUnit, LengthUnit, UnitSource};

/// Keys of a file, with numbers and texts.
enum Value {
    Number(u16),
    Name(&'static str),
    Size(f64),
}

use Value::{Name, Number, Size};

/// The plain file with these geo keys. GDAL writes each text with a bar behind it.
fn file(keys: &[(u16, Value)]) -> Tiff {
    let mut numbers = vec![1, 1, 1, keys.len() as u16];
    let (mut texts, mut sizes) = (String::new(), vec![0.5]);
    for (key, value) in keys {
        match value {
            Number(number) => numbers.extend([*key, 0, 1, *number]),
            Name(name) => {
                numbers.extend([*key, 34737, name.len() as u16 + 1, texts.len() as u16]);
                texts += &format!("{name}|");
            }
            Size(size) => {
                numbers.extend([*key, 34736, 1, sizes.len() as u16]);
                sizes.push(*size);
            }
        }
    }
    Tiff::plain().tag(34735, Short(numbers)).tag(34736, Double(sizes)).tag(34737, Text(texts.leak()))
}

/// The plain file has posts at x = 10.25, 10.75 ..., y = 0, 2, 4, of heights 200.5, 201.5 ... in the south.
fn assert_scaled(dem: &Dem, map: f64, heights: f64) {
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-15 * b.abs();
    assert!(
        close(dem.posts.corner.x, 10.25 * map) && close(dem.posts.corner.y, 0.0),
        "{:?}",
        dem.posts.corner
    );
    assert!(close(dem.posts.spacing.x, 0.5 * map) && close(dem.posts.spacing.y, 2.0 * map));
    assert!(close(dem.posts.heights[0], 200.5 * heights), "{}", dem.posts.heights[0]);
    assert!(close(dem.posts.heights[11], 3.5 * heights), "{}", dem.posts.heights[11]);
}

const FT: f64 = 0.3048;

const FT_US: f64 = 1200.0 / 3937.0;

#[test]
fn map_and_heights_have_a_unit_each() {
    for (keys, map, heights) in [
        // New Mexico Central and NAVD88 in US feet, as GDAL writes a compound system.
        (vec![(1024, Number(1)), (3072, Number(6529)), (4096, Number(6360))], FT_US, FT_US),
        // UTM and NAVD88 in US feet: metres by feet.
        (vec![(1024, Number(1)), (3072, Number(26915)), (4096, Number(6360))], 1.0, FT_US),
        (vec![(1024, Number(1)), (3072, Number(6344)), (4096, Number(8228))], 1.0, FT),
        // Feet by metres: California zone 5 and NAVD88.
        (
            vec![(1024, Number(1)), (3072, Number(2229)), (3076, Number(9003)), (4096, Number(5703))],
            FT_US,
            1.0,
        ),
        // Arizona East, international feet, with the key of GeoTIFF 1.0 for heights.
        (vec![(3072, Number(2222)), (4099, Number(9001))], FT, 1.0),
        // The same codes in a system of the file's own.
        (
            vec![(3072, Number(32767)), (3076, Number(9002)), (4096, Number(32767)), (4099, Number(9003))],
            FT,
            FT_US,
        ),
        (vec![(3072, Number(32767)), (3076, Number(9001)), (4099, Number(9002))], 1.0, FT),
        // A unit of the file's own, 7.5 m, with metres above it.
        (
            vec![(3072, Number(32767)), (3076, Number(32767)), (3077, Size(7.5)), (4099, Number(9001))],
            7.5,
            1.0,
        ),
        // A system that the table does not know, whose unit the file states.
        (vec![(1024, Number(1)), (3072, Number(1500)), (3076, Number(9002)), (4099, Number(9002))], FT, FT),
        // A datum by a number of GeoTIFF 1.0, whose unit a key states.
        (vec![(3072, Number(32615)), (4096, Number(5103)), (4099, Number(9003))], 1.0, FT_US),
        // ETRS89 / UTM zone 32N and DHHN92: a compound code in the key of the map.
        (vec![(3072, Number(5555))], 1.0, 1.0),
        // India zone 0, yards.
        (vec![(3072, Number(24370)), (4099, Number(9080))], 36e6 / 39_370_142.0, 12e6 / 39_370_142.0),
    ] {
        let dem = read(&file(&keys), None).unwrap_or_else(|error| panic!("{error}"));
        assert_scaled(&dem, map, heights);
    }
}

#[test]
fn every_code_of_a_unit_scales() {
    for code in (9001..=9099).chain([1025, 1033, 9300, 9301, 9302]) {
        let Ok(unit) = LengthUnit::parse(&code.to_string()) else { continue };
        let keys = [(3072, Number(32767)), (3076, Number(code)), (4099, Number(code))];
        let dem = read(&file(&keys), None).unwrap_or_else(|error| panic!("{error}"));
        assert_scaled(&dem, unit.metres(), unit.metres());
        assert_eq!((dem.map.unit.unit, dem.map.source), (unit, UnitSource::Key));
    }
}

#[test]
fn what_is_in_metres_is_read_as_it_is() {
    let mars = "Mars (2015) - Sphere / Ocentric / Equirectangular, clon = 0";
    for (keys, source) in [
        (vec![], UnitSource::Default),
        (vec![(1024, Number(1))], UnitSource::Default),
        (vec![(1024, Number(1)), (3072, Number(32767))], UnitSource::Default),
        (
            vec![
                (1024, Number(1)),
                (1026, Name("WGS 84 / UTM zone 32N")),
                (3072, Number(32632)),
                (3076, Number(9001)),
            ],
            UnitSource::System,
        ),
        (vec![(3072, Number(32733))], UnitSource::System),
        (vec![(3072, Number(26915))], UnitSource::System),
        (vec![(3072, Number(25832))], UnitSource::System),
        // Mars, and a local system, as GDAL writes them.
        (
            vec![
                (1024, Number(1)),
                (1026, Name(mars)),
                (2048, Number(32767)),
                (2049, Name("GCS Name = Mars (2015) - Sphere / Ocentric|Datum = Mars (2015) - Sphere")),
                (2050, Number(32767)),
                (3072, Number(32767)),
                (3074, Number(32767)),
                (3075, Number(17)),
                (3076, Number(9001)),
            ],
            UnitSource::Key,
        ),
        (vec![(1026, Name("yard")), (3076, Number(9001))], UnitSource::Key),
        // A projection of the file's own, without a code.
        (vec![(1024, Number(1)), (2048, Number(4326)), (3075, Number(17))], UnitSource::Default),
    ] {
        let dem = read(&file(&keys), None).unwrap_or_else(|error| panic!("{error}"));
        assert_scaled(&dem, 1.0, 1.0);
        assert_eq!(dem.map.source, source);
        // Their bits do not change.
        assert_eq!(dem.posts, read(&Tiff::plain(), None).unwrap().posts);
    }
}

#[test]
fn names_and_codes_are_kept() {
    let keys = [
        (1026, Name("NAD83 / UTM zone 15N + NAVD88 height (ftUS)")),
        (3072, Number(26915)),
        (4096, Number(6360)),
    ];
    let dem = read(&file(&keys), None).unwrap();
    assert_eq!((dem.map.name.as_deref(), dem.map.code), (Some("NAD83 / UTM zone 15N"), Some(26915)));
    assert_eq!((dem.heights.name.as_deref(), dem.heights.code), (Some("NAVD88 height (ftUS)"), Some(6360)));
    // Without a text the name of a vertical system is that of EPSG.
    let dem = read(&file(&[(3072, Number(32632)), (4096, Number(3855))]), None).unwrap();
    assert_eq!((dem.map.name, dem.heights.name.as_deref()), (None, Some("EGM2008 height")));
    assert_eq!(dem.heights.source, UnitSource::System);
}

#[test]
fn depths_become_heights() {
    for (keys, metres) in [
        (vec![(3072, Number(32632)), (4096, Number(5715))], 1.0),
        (vec![(3072, Number(26915)), (4096, Number(6358))], FT_US),
    ] {
        let dem = read(&file(&keys), None).unwrap();
        assert_scaled(&dem, 1.0, -metres);
        assert!(dem.heights.unit.is_depth);
        // The caller may say that they are heights.
        let heights = DemOptions { z_unit: Some(HeightUnit::parse("m").unwrap()), ..Default::default() };
        assert_scaled(&read_with(&file(&keys), &heights).unwrap(), 1.0, 1.0);
    }
    let depths = DemOptions { z_unit: Some(HeightUnit::parse("-fathom").unwrap()), ..Default::default() };
    let dem = read_with(&Tiff::plain(), &depths).unwrap();
    assert_scaled(&dem, 1.0, -1.8288);
    assert_eq!(dem.heights.source, UnitSource::Option);
}

#[test]
fn the_unit_of_a_band_is_that_of_heights() {
    let item = |unit: &str| -> &'static str {
        format!("<GDALMetadata>\n  <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{unit}</Item>\n</GDALMetadata>\n").leak()
    };
    for (unit, metres) in
        [("ft", FT), ("US survey foot", FT_US), ("m", 1.0), ("Metre", 1.0), ("", 1.0), ("us-ft", FT_US)]
    {
        let dem = read(&Tiff::plain().tag(42112, Text(item(unit))), None).unwrap();
        assert_scaled(&dem, 1.0, metres);
    }
    let both = file(&[(3072, Number(32632)), (4096, Number(5703))]).tag(42112, Text(item("ft")));
    assert_names(
        &refusal(&both, None),
        &[
            "key 4099 VerticalUnitsGeoKey: two units: metre (EPSG:9001) by key 4096 VerticalCSTypeGeoKey 5703, foot (EPSG:9002)",
            "42112",
            "`--z-unit`",
        ],
    );
}

#[test]
fn what_is_not_known_is_refused_with_the_remedy() {
    let map = "`--unit` with the unit of the map (`dem_unit` of a scene file)";
    let heights = "`--z-unit` with the unit of the heights (`dem_z_unit` of a scene file";
    for (keys, words) in [
        (vec![(3072, Number(1500))], ["key 3072 ProjectedCSTypeGeoKey: 1500, whose unit is not known", map]),
        (vec![(3072, Number(4326))], ["key 3072 ProjectedCSTypeGeoKey: 4326, whose unit is not known", map]),
        (vec![(3072, Number(2048))], ["2048, whose axes point west or south", "gdalwarp -t_srs"]),
        (vec![(3072, Number(2229)), (3076, Number(9001))], ["two units: US survey foot (EPSG:9003)", map]),
        (
            vec![(3072, Number(2229))],
            ["key 4099 VerticalUnitsGeoKey: missing, while the map is in another unit", heights],
        ),
        (
            vec![(3072, Number(32632)), (4096, Number(1234))],
            ["key 4096 VerticalCSTypeGeoKey: 1234, whose unit and direction", heights],
        ),
        (
            vec![(3072, Number(32632)), (4096, Number(5030))],
            ["missing, while key 4096 VerticalCSTypeGeoKey is 5030", heights],
        ),
        (
            vec![(3072, Number(32632)), (4096, Number(5703)), (4099, Number(9003))],
            ["two units: metre (EPSG:9001)", heights],
        ),
        (vec![(3076, Number(9010))], ["key 3076 ProjLinearUnitsGeoKey: 9010, a unit of GeoTIFF 1.0", map]),
        (vec![(3076, Number(9102))], ["9102, which is no unit of length", map]),
        (vec![(3076, Number(32767))], ["a unit of the file's own, without its size", map]),
        (vec![(3076, Number(32767)), (3077, Size(-1.0))], ["a unit of -1 m", map]),
        (vec![(4099, Number(32767))], ["key 4099 VerticalUnitsGeoKey: a unit of the file's own", heights]),
        (
            vec![(2052, Number(9003))],
            ["missing, while key 2052 GeogLinearUnitsGeoKey is US survey foot", map],
        ),
        (vec![(2048, Number(4326))], ["missing, while key 2048 GeographicTypeGeoKey is 4326", "degrees"]),
        // A map without a projection is none; the key is there, and is not told as missing.
        (
            vec![(1024, Number(1)), (2048, Number(4326))],
            [
                "GTModelTypeGeoKey: 1, without a projection, while key 2048 GeographicTypeGeoKey is 4326",
                "degrees",
            ],
        ),
        (
            vec![(1024, Number(32767)), (2048, Number(4326))],
            [
                "GTModelTypeGeoKey: 32767, of another kind, while key 2048 GeographicTypeGeoKey is 4326",
                "degrees",
            ],
        ),
        (
            vec![(1026, Name("Texas South Central (ftUS)")), (3072, Number(32767))],
            ["no unit, while the name \"Texas South Central (ftUS)\" says \"ftUS\"", map],
        ),
        (vec![(3073, Name("StatePlane_Texas_Feet")), (3076, Number(9001))], ["metres by key 3076", map]),
        (
            vec![(1026, Name("A + NAVD88 height (ft)"))],
            ["no unit, while the name \"NAVD88 height (ft)\" says \"ft\"", heights],
        ),
        (
            vec![(4097, Name("Lake depth"))],
            ["key 4097 VerticalCitationGeoKey: \"Lake depth\" without a code", heights],
        ),
    ] {
        let message = refusal(&file(&keys), None);
        assert_names(&message, &words);
        assert_names(&message, &["dem.tif: tag 34735 GeoKeyDirectoryTag, key ", "; expected "]);
        // With the caller's word they are read.
        let options = DemOptions {
            unit: LengthUnit::parse("ft").ok(),
            z_unit: HeightUnit::parse("ftUS").ok(),
            ..Default::default()
        };
        assert_scaled(&read_with(&file(&keys), &options).unwrap(), FT, FT_US);
    }
    // Degrees stay degrees, whatever the caller says.
    let degrees = file(&[(1024, Number(2)), (2048, Number(4326))]);
    let options = DemOptions { unit: LengthUnit::parse("m").ok(), ..Default::default() };
    assert_names(&read_with(&degrees, &options).unwrap_err().to_string(), &["not degrees"]);
}

#[test]
fn limits_are_in_metres() {
    // 1e7 m are 32.8 million feet; 20 million of them are a height.
    let high = |unit: &str| {
        let z_unit = HeightUnit::parse(unit).ok();
        let tiff = Tiff::plain().with(|column, row| 2e7 + (column + row) as f64 * 16.0);
        read_with(&tiff, &DemOptions { z_unit, ..Default::default() })
    };
    assert!(high("ft").is_ok());
    assert_names(&high("m").unwrap_err().to_string(), &["pixel (0, 0)", "within 1e7 m"]);
    // A window is given in metres of the map.
    let options = DemOptions {
        window: Some([10.25 * FT, 0.0, 0.5 * FT + 1e-9, 2.0 * FT + 1e-9]),
        unit: LengthUnit::parse("ft").ok(),
        z_unit: HeightUnit::parse("m").ok(),
        ..Default::default()
    };
    let part = read_with(&Tiff::plain(), &options).unwrap().posts;
    assert_eq!((part.columns, part.rows, part.heights[0]), (2, 2, 200.5));
}
