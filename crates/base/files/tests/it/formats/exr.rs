//! OpenEXR: written files are read back, with the documented names and conventions; malformed ones are refused.

use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, IntegerBounds,
    Layer, LayerAttributes, LineOrder, SmallVec, Vec2, WritableImage, f16,
};
use glam::DVec3;
use std::path::{Path, PathBuf};

use raypencil_files::{
    Attributes, ExrMap, Limits, Raster, read_channels, read_exr, read_exr_parts, write_exr,
};
use raypencil_scene::{FaceId, Hit, Image, Maybe, Quantities, SensorId, SensorMap};

const WIDTH: u32 = 37;

const HEIGHT: u32 = 20;

/// A cell without a value, where no length is missing.
const NO_VALUE: f32 = f32::from_bits(0x7fc0_0000);

/// A map with a miss in every third cell, and numbers that f32 cannot hold.
fn map(sensor: SensorId, quantities: Quantities) -> SensorMap {
    let mut map = SensorMap::empty(sensor, WIDTH, HEIGHT, quantities);
    for mut row in map.rows_mut() {
        for i in 0..WIDTH {
            let cell = row.j * WIDTH + i;
            let value = 1.0 + f64::from(cell) / 7.0;
            let point = DVec3::new(value, -value / 3.0, 1.0 / value);
            let hit = Hit {
                face: FaceId(cell * 5),
                range: value,
                point,
                normal: point / point.length(),
                depth: value / 1.1,
                cos_incidence: 1.0 / value,
            };
            if !cell.is_multiple_of(3) {
                row.put(i, &hit);
            }
        }
    }
    map
}

fn attributes() -> Attributes {
    Attributes {
        renderer: "tracer".into(),
        scene_sha256: "0123abcd".into(),
        extra: vec![("note".into(), "caf\u{e9}".into())],
    }
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

fn refusal(path: &Path, limits: &Limits) -> String {
    let error = read_exr(path, limits).expect_err("a refusal").to_string();
    assert!(error.starts_with(&path.display().to_string()), "{error}");
    error[path.display().to_string().len() + 2..].to_string()
}

#[test]
fn a_map_comes_back_rounded_to_single_precision() {
    let folder = Folder::new();
    for (sensor, name) in [(SensorId::Camera, "camera.exr"), (SensorId::Beam(1), "beam-1.exr")] {
        let map = map(sensor, Quantities::ALL);
        let path = folder.path(name);
        write_exr(&path, &ExrMap::from_sensor_map(&map, &attributes())).unwrap();
        let back = read_exr(&path, &Limits::of_size(WIDTH, HEIGHT)).unwrap();
        assert_eq!((back.width, back.height), (WIDTH, HEIGHT));
        assert_eq!(back.attributes["sensor"], sensor.to_string());
        for j in 0..HEIGHT {
            for i in 0..WIDTH {
                let is = |name: &str, value: Option<f64>, no_hit: f32| {
                    let found = back.channels[name].as_f32().unwrap().at(i, j);
                    let expected = value.map_or(no_hit, |value| value as f32);
                    assert_eq!(found.to_bits(), expected.to_bits(), "{name} at {i}, {j}");
                };
                let at = |image: &Option<Image<Maybe<f64>>>| image.as_ref().unwrap().at(i, j).get();
                is("range.T", at(&map.range), f32::INFINITY);
                is("depth.Z", at(&map.depth), f32::INFINITY);
                is("incidence.V", at(&map.cos_incidence), NO_VALUE);
                let at = |image: &Option<Image<Maybe<DVec3>>>| image.as_ref().unwrap().at(i, j).get();
                for (of, vector) in [("P", at(&map.point)), ("N", at(&map.normal))] {
                    is(&format!("{of}.X"), vector.map(|v| v.x), NO_VALUE);
                    is(&format!("{of}.Y"), vector.map(|v| v.y), NO_VALUE);
                    is(&format!("{of}.Z"), vector.map(|v| v.z), NO_VALUE);
                }
                let face = map.face.as_ref().unwrap().at(i, j).get();
                let found = back.channels["face.I"].as_u32().unwrap().at(i, j);
                assert_eq!(found, face.map_or(u32::MAX, |face| face.0));
            }
        }
    }
}

#[test]
fn names_types_and_no_hit_values_are_those_of_the_documentation() {
    let folder = Folder::new();
    let path = folder.path("camera.exr");
    write_exr(&path, &ExrMap::from_sensor_map(&map(SensorId::Camera, Quantities::ALL), &attributes()))
        .unwrap();
    let read = read_exr(&path, &Limits::default()).unwrap();
    let names: Vec<_> = read.channels.keys().map(String::as_str).collect();
    let expected = ["N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "depth.Z", "face.I", "incidence.V", "range.T"];
    assert_eq!(names, expected);
    // Cell (0, 0) has no hit, cell (1, 0) has.
    for (name, raster) in &read.channels {
        match raster {
            Raster::U32(image) => {
                assert_eq!((name.as_str(), image.at(0, 0), image.at(1, 0)), ("face.I", u32::MAX, 5))
            }
            Raster::F32(image) if name == "range.T" || name == "depth.Z" => {
                assert_eq!(image.at(0, 0), f32::INFINITY)
            }
            Raster::F32(image) => assert_eq!(image.at(0, 0).to_bits(), NO_VALUE.to_bits(), "{name}"),
        }
    }
    for (name, value) in [
        ("renderer", "tracer"),
        ("sceneSha256", "0123abcd"),
        ("sensor", "camera"),
        ("note", "caf\u{e9}"),
        ("frame", "scene: z up, global minus the scene origin"),
        ("raypencilVersion", env!("CARGO_PKG_VERSION")),
    ] {
        assert_eq!(read.attributes[name], value);
    }
    assert!(
        read.attributes["pixelRule"].contains("pixel (i, j)") && read.attributes["unit"].contains("metre")
    );

    // Only the quantities of the map are written.
    let plain =
        |quantities| ExrMap::from_sensor_map(&map(SensorId::Camera, quantities), &Attributes::default());
    write_exr(&path, &plain(Quantities::RANGE_MAP)).unwrap();
    let read = read_exr(&path, &Limits::default()).unwrap();
    assert_eq!(read.channels.keys().collect::<Vec<_>>(), ["face.I", "range.T"]);
    let nothing = Quantities { range: false, face: false, ..Quantities::RANGE_MAP };
    let error = write_exr(&path, &plain(nothing)).unwrap_err();
    assert!(error.to_string().ends_with("camera.exr: channels: none; expected at least one"), "{error}");
}

#[test]
fn the_same_map_is_the_same_bytes() {
    let folder = Folder::new();
    let map = map(SensorId::Beam(0), Quantities::ALL);
    let write = |name: &str| {
        write_exr(folder.path(name), &ExrMap::from_sensor_map(&map, &attributes())).unwrap();
        std::fs::read(folder.path(name)).unwrap()
    };
    let first = write("a.exr");
    for _ in 0..4 {
        assert_eq!(write("b.exr"), first);
    }
    // Scan lines in increasing order, ZIP of 16 lines (3), attributes in the order of their names.
    let at = |text: &[u8]| first.windows(text.len()).position(|window| window == text).unwrap();
    assert_eq!(first[at(b"lineOrder\0lineOrder\0\x01\0\0\0") + 24], 0);
    assert_eq!(first[at(b"compression\0compression\0\x01\0\0\0") + 28], 3);
    assert!(at(b"frame\0string") < at(b"noHit\0string") && at(b"noHit\0string") < at(b"unit\0string"));
}

#[test]
fn any_channels_come_back() {
    let folder = Folder::new();
    let mut map = ExrMap::new(3, 2);
    let reals =
        Image::from_cells(3, 2, vec![1.5, -0.0, f32::MIN_POSITIVE / 2.0, f32::NAN, f32::NEG_INFINITY, 7.0]);
    map.insert("flux.beam0", Raster::F32(reals));
    map.insert("pixel.I", Raster::U32(Image::from_cells(3, 2, vec![0, 1, 2, 3, u32::MAX, 5])));
    map.attributes.insert("who".into(), "someone".into());
    let path = folder.path("any.exr");
    write_exr(&path, &map).unwrap();
    let read = read_exr(&path, &Limits::default()).unwrap();
    let bits = |map: &ExrMap| {
        map.channels["flux.beam0"].as_f32().unwrap().cells().iter().map(|c| c.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(bits(&read), bits(&map));
    assert_eq!(
        read.channels["pixel.I"].as_u32().unwrap().cells(),
        map.channels["pixel.I"].as_u32().unwrap().cells()
    );
    assert_eq!(read.attributes, map.attributes);
    map.attributes.insert("who".into(), "\u{1f600}".into());
    let error = write_exr(&path, &map).unwrap_err().to_string();
    assert!(
        error.ends_with("attribute \"who\": a name or text for no file; expected Latin-1 characters"),
        "{error}"
    );
}

const COMPRESSIONS: &[Compression] =
    &[Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16, Compression::PIZ];

/// A file such as another program might write.
fn foreign(path: &Path, encoding: Encoding, attributes: LayerAttributes, names: &[&str]) {
    let count = (WIDTH * HEIGHT) as usize;
    let channels = names.iter().map(|&name| {
        let samples = match name {
            "half" => FlatSamples::F16((0..count).map(|cell| f16::from_f32(cell as f32 / 8.0)).collect()),
            "face.I" | "whole" => FlatSamples::U32((0..count as u32).collect()),
            _ => FlatSamples::F32((0..count).map(|cell| cell as f32).collect()),
        };
        AnyChannel::new(name, samples)
    });
    let channels = AnyChannels::sort(channels.collect::<SmallVec<_>>());
    let size = (WIDTH as usize, HEIGHT as usize);
    ExrImage::from_layer(Layer::new(size, attributes, encoding, channels)).write().to_file(path).unwrap();
}

#[test]
fn files_of_other_programs_are_read() {
    let folder = Folder::new();
    let path = folder.path("foreign.exr");
    for &compression in COMPRESSIONS {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 8))] {
            let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
            foreign(&path, encoding, LayerAttributes::default(), &["half", "range.T", "whole"]);
            let read = read_exr(&path, &Limits::of_size(WIDTH, HEIGHT)).unwrap();
            // Halves are widened exactly: 3 + 2 * 37 is cell 77, an eighth of which a half can hold.
            assert_eq!(read.channels["half"].as_f32().unwrap().at(3, 2), 77.0 / 8.0);
            assert_eq!(read.channels["range.T"].as_f32().unwrap().at(3, 2), 77.0, "{compression:?}");
            assert_eq!(read.channels["whole"].as_u32().unwrap().at(3, 2), 77);
        }
    }
}

#[test]
fn lossy_files_are_refused() {
    let folder = Folder::new();
    let path = folder.path("lossy.exr");
    for (compression, name) in [
        (Compression::PXR24, "pxr24"),
        (Compression::B44, "b44"),
        (Compression::B44A, "b44a"),
        (Compression::DWAA(None), "dwaa"),
        (Compression::DWAB(None), "dwab"),
    ] {
        let encoding = Encoding { compression, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
        foreign(&path, encoding, LayerAttributes::default(), &["range.T"]);
        let error = refusal(&path, &Limits::default());
        let expected =
            format!("header: {name} compression; expected none, RLE, ZIPS, ZIP or PIZ, which keep every bit");
        assert_eq!(error, expected);
    }
}

#[test]
fn sizes_windows_and_parts_that_do_not_fit_are_refused() {
    let folder = Folder::new();
    let path = folder.path("file.exr");
    let zip = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    foreign(&path, zip, LayerAttributes::default(), &["range.T"]);
    assert_eq!(refusal(&path, &Limits::of_size(37, 21)), "data window: 37 x 20 cells; expected 37 x 21");
    let few = Limits { cells: 700, ..Limits::default() };
    assert_eq!(refusal(&path, &few), "data window: 37 x 20 cells; expected 1 to 700 cells");
    let small = Limits { bytes: 2959, ..Limits::default() };
    assert_eq!(refusal(&path, &small), "channels: 2960 bytes; expected at most 2959");
    let enough = Limits { bytes: 2960, ..Limits::default() };
    assert!(read_exr(&path, &enough).is_ok());

    // A crop: the data window is shifted against the display window.
    let shifted = LayerAttributes { layer_position: Vec2(2, 0), ..LayerAttributes::default() };
    let count = (WIDTH * HEIGHT) as usize;
    let channel = || AnyChannel::new("range.T", FlatSamples::F32(vec![1.0; count]));
    let layer = |attributes: LayerAttributes| {
        Layer::new(
            (37, 20),
            attributes,
            zip,
            AnyChannels::sort(std::iter::once(channel()).collect::<SmallVec<_>>()),
        )
    };
    let mut image = ExrImage::from_layer(layer(shifted));
    image.attributes.display_window = IntegerBounds::from_dimensions((37, 20));
    image.write().to_file(&path).unwrap();
    let expected = "data window: 37 x 20 at (2, 0); expected the display window, 37 x 20 at (0, 0)";
    assert_eq!(refusal(&path, &Limits::default()), expected);

    let layers: SmallVec<[_; 2]> =
        ["left", "right"].into_iter().map(|name| layer(LayerAttributes::named(name))).collect();
    let attributes = ::exr::prelude::ImageAttributes::new(IntegerBounds::from_dimensions((37, 20)));
    ExrImage::from_layers(attributes, layers).write().to_file(&path).unwrap();
    let expected = "header: 2 parts; expected one part";
    assert_eq!(refusal(&path, &Limits::default()), expected);
    // Limits hold for all parts together.
    let parts = |bytes: u64| read_exr_parts(&path, &Limits { bytes, ..Limits::default() });
    assert_eq!(parts(5920).unwrap().len(), 2);
    let error = parts(5919).unwrap_err().to_string();
    assert!(error.ends_with("channels: 5920 bytes; expected at most 5919"), "{error}");
}

/// A small file, as its path and its bytes.
fn small(folder: &Folder) -> (PathBuf, Vec<u8>) {
    let path = folder.path("small.exr");
    let mut map = ExrMap::new(8, 8);
    map.insert("range.T", Raster::F32(Image::filled(8, 8, 1.25)));
    write_exr(&path, &map).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    (path, bytes)
}

fn find(bytes: &[u8], text: &[u8]) -> usize {
    bytes.windows(text.len()).position(|window| window == text).unwrap() + text.len()
}

#[test]
fn a_huge_window_in_a_small_file_is_refused_before_memory_is_asked_for() {
    let folder = Folder::new();
    let (path, good) = small(&folder);
    assert!(good.len() < 1000);
    let windows = |width: i32, height: i32| {
        let mut bytes = good.clone();
        for name in [&b"dataWindow\0box2i\0\x10\0\0\0"[..], b"displayWindow\0box2i\0\x10\0\0\0"] {
            let at = find(&bytes, name);
            bytes[at + 8..at + 12].copy_from_slice(&(width - 1).to_le_bytes());
            bytes[at + 12..at + 16].copy_from_slice(&(height - 1).to_le_bytes());
        }
        let at = find(&bytes, b"chunkCount\0int\0\x04\0\0\0");
        bytes[at..at + 4].copy_from_slice(&((height + 15) / 16).to_le_bytes());
        std::fs::write(&path, bytes).unwrap();
    };
    windows(i32::MAX / 2, i32::MAX / 2);
    let error = refusal(&path, &Limits::default());
    assert!(error.contains("data window") || error.contains("header"), "{error}");
    windows(60_000, 60_000);
    assert_eq!(
        refusal(&path, &Limits::default()),
        "data window: 60000 x 60000 cells; expected 1 to 67108864 cells"
    );
    // Within the limit, but not within 300 bytes: 2^26 cells of 4 bytes in 512 blocks of 16 lines.
    windows(8192, 8192);
    let length = good.len();
    let expected = format!(
        "data window: 8192 x 8192 cells of 4 bytes in a file of {length} bytes; expected a size that the file can hold (is it cut off?)"
    );
    assert_eq!(refusal(&path, &Limits::default()), expected);
    windows(-5, 8);
    assert!(read_exr(&path, &Limits::default()).is_err());
}

#[test]
fn cut_and_changed_files_are_refused() {
    let folder = Folder::new();
    let (path, good) = small(&folder);
    for end in 0..good.len() {
        std::fs::write(&path, &good[..end]).unwrap();
        let error = refusal(&path, &Limits::default());
        assert!(error.contains("expected"), "{end}: {error}");
    }
    std::fs::write(&path, b"not an image at all").unwrap();
    let expected = "header: invalid: file identifier missing; expected an OpenEXR file that is complete";
    assert_eq!(refusal(&path, &Limits::default()), expected);
    // A channel of an unknown type (3).
    let mut bytes = good.clone();
    let at = find(&bytes, b"range.T\0");
    bytes[at] = 3;
    std::fs::write(&path, &bytes).unwrap();
    assert_eq!(
        refusal(&path, &Limits::default()),
        "header: invalid: pixel type attribute value; expected an OpenEXR file that is complete"
    );
    // A window that ends before it starts, along one axis and along the other.
    let window = find(&good, b"dataWindow\0box2i\0") + 4;
    for (start, found) in [(0, "from (9, 0) to (7, 7)"), (4, "from (0, 9) to (7, 7)")] {
        let mut bytes = good.clone();
        bytes[window + start..window + start + 4].copy_from_slice(&9_i32.to_le_bytes());
        std::fs::write(&path, &bytes).unwrap();
        let error = refusal(&path, &Limits::default());
        assert!(error.starts_with(&format!("dataWindow: {found}")), "{error}");
        assert!(error.ends_with("expected an end after its start"), "{error}");
    }
    // A channel that is sampled every second cell.
    bytes[at] = 2;
    bytes[at + 8] = 2;
    std::fs::write(&path, &bytes).unwrap();
    let error = refusal(&path, &Limits::default());
    assert_eq!(
        error,
        "header: not supported: channel subsampling not supported yet; expected an OpenEXR file that is complete"
    );
    assert!(
        read_exr(folder.path("none.exr"), &Limits::default())
            .unwrap_err()
            .to_string()
            .contains("none.exr: cannot read")
    );
    let error = read_exr(folder.0.path(), &Limits::default()).unwrap_err().to_string();
    assert!(error.ends_with("cannot read: not a regular file"), "{error}");
}

/// Of two attributes of one name some programs take the first, and others the last.
#[test]
fn an_attribute_that_is_there_twice_is_refused() {
    let folder = Folder::new();
    let (path, good) = small(&folder);
    let with = |attributes: &[&[u8]]| {
        // Behind the magic number and the version.
        std::fs::write(&path, [&good[..8], &attributes.concat(), &good[8..]].concat()).unwrap();
        refusal(&path, &Limits::default())
    };
    let [metres, others]: [&[u8]; 2] = [b"unit\0string\0\x01\0\0\0m", b"unit\0string\0\x02\0\0\0mm"];
    assert_eq!(with(&[metres, others]), "header: attribute \"unit\" twice; expected each attribute once");
    assert!(!with(&[metres]).contains("twice"));
}

#[test]
fn a_map_that_says_it_is_of_another_sensor_is_refused() {
    let folder = Folder::new();
    let file = |name: &str, sensor: &str| {
        let path = folder.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let mut map = ExrMap::new(2, 1);
        map.insert("range.T", Raster::F32(Image::filled(2, 1, 1.25)));
        map.attributes.insert("sensor".into(), sensor.into());
        write_exr(&path, &map).unwrap();
        let read = read_channels(folder.0.path(), &Limits::default()).map(|read| read.by_key.len());
        std::fs::remove_file(&path).unwrap();
        read.map_err(|error| error.to_string())
    };
    for (name, sensor) in
        [("camera.exr", "beam-0"), ("beam-0.exr", "beam-1"), ("beam-0/range.T.exr", "camera")]
    {
        let message = file(name, sensor).unwrap_err();
        let called = &name[..6];
        let expected =
            format!("{name}: attribute sensor: {sensor}; expected {called}, as the file is called");
        assert!(message.ends_with(&expected), "{message}");
    }
    // The same one, and names that say nothing of a sensor.
    for (name, sensor) in [("camera.exr", "camera"), ("mine.exr", "camera"), ("camera.exr", "Nikon D850")] {
        assert_eq!(file(name, sensor), Ok(1), "{name}");
    }
}

/// Two blocks of one place leave another place without numbers.
#[test]
fn blocks_that_stand_for_one_place_twice_are_refused() {
    let folder = Folder::new();
    let path = folder.path("twice.exr");
    // Line 3 says that it is line 2, and the second tile that it is the first.
    let cases = [
        (vec![3, 4 * WIDTH as i32], 2_i32, Blocks::ScanLines, "block 3: of line 2"),
        (vec![1, 0, 0, 0, 16 * 8 * 4], 0, Blocks::Tiles(Vec2(16, 8)), "block 1: of tile 0, 0, level 0, 0"),
    ];
    for (header, place, blocks, found) in cases {
        let encoding =
            Encoding { compression: Compression::Uncompressed, blocks, line_order: LineOrder::Increasing };
        foreign(&path, encoding, LayerAttributes::default(), &["range.T"]);
        let mut bytes = std::fs::read(&path).unwrap();
        let header: Vec<u8> = header.into_iter().flat_map(i32::to_le_bytes).collect();
        let start = find(&bytes, &header) - header.len();
        bytes[start..start + 4].copy_from_slice(&place.to_le_bytes());
        std::fs::write(&path, bytes).unwrap();
        let expected = format!("pixels, {found}; expected each part of the image once");
        assert_eq!(refusal(&path, &Limits::default()), expected);
    }
}

mod any_bytes {
    use super::*;
    use proptest::prelude::*;

    /// A file of each compression and kind of block that is read.
    fn kinds() -> &'static [Vec<u8>] {
        static KINDS: std::sync::LazyLock<Vec<Vec<u8>>> = std::sync::LazyLock::new(|| {
            let folder = Folder::new();
            let path = folder.path("kind.exr");
            let blocks = [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 8))];
            let kinds =
                COMPRESSIONS.iter().flat_map(|&compression| blocks.map(|blocks| (compression, blocks)));
            let write = |(compression, blocks)| {
                let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
                foreign(&path, encoding, LayerAttributes::default(), &["half", "range.T", "whole"]);
                std::fs::read(&path).unwrap()
            };
            kinds.map(write).collect()
        });
        &KINDS
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn changed_bytes_never_panic(
            changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
            in_header in any::<bool>(),
            kind in any::<prop::sample::Index>(),
        ) {
            let mut bytes = kind.get(kinds()).clone();
            // Half of the changes hit the 500 bytes or so of the header.
            let end = if in_header { 500 } else { bytes.len() };
            for (at, byte) in changes {
                bytes[at.index(end)] = byte;
            }
            let folder = Folder::new();
            let path = folder.path("changed.exr");
            std::fs::write(&path, bytes).unwrap();
            let _ = read_exr(&path, &Limits::default());
        }
    }
}
