//! Channels that are declared to be maps, parts of OpenEXR files, and whole numbers with a unit.

use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, SmallVec, Text, WritableImage,
};
use std::path::PathBuf;

use raypencil_files::{
    Channels, Declared, DeclaredChannel, ExrMap, Limits, Raster, Storage, read_channels_as, write_exr,
    write_npy,
};
use raypencil_scene::Image;

/// Name, view, number of columns, and channels with the number of all their cells.
type Part<'a> = (&'a str, &'a str, usize, &'a [(&'a str, f32)]);

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        path
    }

    /// An EXR of one row of two cells for each channel: its number and that plus 1/2.
    fn exr(&self, name: &str, channels: &[(&str, f32)]) {
        let mut map = ExrMap::new(2, 1);
        for (name, number) in channels {
            map.insert(*name, Raster::F32(Image::from_cells(2, 1, vec![*number, number + 0.5])));
        }
        write_exr(self.path(name), &map).unwrap();
    }

    /// An EXR of several parts: their names, views, numbers of columns, and channels.
    fn parts(&self, name: &str, parts: &[Part<'_>]) {
        let layer = |(name, view, width, channels): &Part<'_>| {
            let channel = |(name, number): &(&str, f32)| {
                AnyChannel::new(*name, FlatSamples::F32(vec![*number; *width]))
            };
            let channels = AnyChannels::sort(channels.iter().map(channel).collect::<SmallVec<_>>());
            let view_name = (!view.is_empty()).then(|| Text::from(*view));
            let attributes = LayerAttributes { view_name, ..LayerAttributes::named(*name) };
            Layer::new((*width, 1), attributes, Encoding::SMALL_LOSSLESS, channels)
        };
        let layers: SmallVec<[_; 2]> = parts.iter().map(layer).collect();
        let attributes = ImageAttributes::new(IntegerBounds::from_dimensions((parts[0].2, 1)));
        ExrImage::from_layers(attributes, layers).write().to_file(self.path(name)).unwrap();
    }

    fn wholes(&self, name: &str, cells: &[u32]) {
        let image = Image::from_cells(cells.len() as u32, 1, cells.to_vec());
        write_npy(self.path(name), &[&image]).unwrap();
    }

    fn read(&self, declared: &Declared) -> Result<Channels, String> {
        let start = format!("{}", self.0.path().display());
        read_channels_as(self.0.path(), &Limits::default(), declared, None)
            .map_err(|error| error.to_string().replace(&format!("{start}/"), "").replace(&start, "."))
    }

    fn keys(&self, declared: &[&str]) -> Result<Vec<(String, f64)>, String> {
        let read = self.read(&channels(declared))?;
        Ok(read.by_key.iter().map(|(key, channel)| (key.clone(), channel.values.real(0))).collect())
    }
}

fn channels(declared: &[&str]) -> Declared {
    let channels = declared.iter().map(|text| text.parse::<DeclaredChannel>().unwrap()).collect();
    Declared { channels, ..Declared::default() }
}

fn pairs<const N: usize>(pairs: [(&str, f64); N]) -> Vec<(String, f64)> {
    pairs.map(|(key, number)| (key.to_string(), number)).to_vec()
}

#[test]
fn a_layered_channel_becomes_the_map_that_it_is_declared_to_be() {
    let folder = Folder::new();
    folder.exr("camera.exr", &[("ViewLayer.Depth.Z", 1.0), ("ViewLayer.Normal.X", 2.0)]);
    folder.exr("beam-0.exr", &[("ViewLayer.Depth.Z", 3.0)]);
    let normal = ("camera/ViewLayer.Normal.X", 2.0);
    // In each folder that has it; with the folder, in that one.
    let found = folder.keys(&["depth.Z=ViewLayer.Depth.Z"]).unwrap();
    assert_eq!(found, pairs([("beam-0/depth.Z", 3.0), normal, ("camera/depth.Z", 1.0)]));
    let found = folder.keys(&["camera/depth.Z=ViewLayer.Depth.Z"]).unwrap();
    assert_eq!(found, pairs([("beam-0/ViewLayer.Depth.Z", 3.0), normal, ("camera/depth.Z", 1.0)]));
    // Of another file, by its path.
    let found = folder.keys(&["camera/range.T=beam-0/ViewLayer.Depth.Z"]).unwrap();
    assert_eq!(found, pairs([("camera/ViewLayer.Depth.Z", 1.0), normal, ("camera/range.T", 3.0)]));
}

#[test]
fn two_maps_may_change_their_names() {
    let folder = Folder::new();
    folder.exr("camera.exr", &[("range.T", 1.0), ("depth.Z", 2.0)]);
    let found = folder.keys(&["range.T=depth.Z", "depth.Z=range.T"]).unwrap();
    assert_eq!(found, pairs([("camera/depth.Z", 1.0), ("camera/range.T", 2.0)]));
    // One alone makes two channels of one map.
    let error = folder.keys(&["range.T=depth.Z"]).unwrap_err();
    let expected = ".: channel \"depth.Z\", declared to be range.T: its file has a channel of that name, range.T; expected \
                    another map for one of them";
    assert_eq!(error, expected);
}

#[test]
fn a_file_of_one_quantity_has_the_key_of_its_name() {
    let folder = Folder::new();
    folder.exr("camera/depth.Z.exr", &[("Y", 1.0)]);
    folder.exr("camera/P.exr", &[("R", 2.0), ("G", 3.0), ("B", 4.0)]);
    folder.exr("camera/N.exr", &[("R", 5.0), ("G", 6.0), ("B", 7.0), ("A", 1.0)]);
    folder.exr("top.exr", &[("Y", 8.0)]);
    let expected = pairs([
        ("camera/N/A", 1.0),
        ("camera/N/B", 7.0),
        ("camera/N/G", 6.0),
        ("camera/N/R", 5.0),
        ("camera/P.X", 2.0),
        ("camera/P.Y", 3.0),
        ("camera/P.Z", 4.0),
        ("camera/depth.Z", 1.0),
        ("top/Y", 8.0),
    ]);
    assert_eq!(folder.keys(&[]).unwrap(), expected);
    // By their names in the file, too; with the file's name, where several have that name.
    let found = folder.keys(&["range.T=Y", "beam-0/range.T=top/Y"]).unwrap_err();
    assert!(
        found.contains("declared to be top/range.T as well; expected one map for each channel"),
        "{found}"
    );
    let found = folder.keys(&["camera/range.T=Y", "depth.Z=P/R", "N.X=N/R"]).unwrap();
    for expected in
        pairs([("camera/range.T", 1.0), ("camera/depth.Z", 2.0), ("camera/N.X", 5.0), ("top/Y", 8.0)])
    {
        assert!(found.contains(&expected), "{expected:?} in {found:?}");
    }
    let error = folder.keys(&["camera/depth.Z=R"]).unwrap_err();
    let expected = ".: channel \"R\", declared to be camera/depth.Z: 2 channels of that name; expected one of camera/N/R, \
                    camera/P/R";
    assert_eq!(error, expected);
}

#[test]
fn parts_have_names_of_their_own() {
    let folder = Folder::new();
    folder.parts(
        "camera.exr",
        &[
            ("ViewLayer.Depth", "", 2, &[("Z", 1.0)]),
            ("range", "", 2, &[("range.T", 2.0)]),
            ("Normal", "", 2, &[("X", 3.0), ("Y", 4.0), ("Z", 5.0)]),
        ],
    );
    let expected = pairs([
        ("camera/Normal/Z", 5.0),
        ("camera/ViewLayer.Depth/Z", 1.0),
        ("camera/X", 3.0),
        ("camera/Y", 4.0),
        ("camera/range.T", 2.0),
    ]);
    assert_eq!(folder.keys(&[]).unwrap(), expected);
    for name in ["ViewLayer.Depth/Z", "ViewLayer.Depth.Z", "camera/ViewLayer.Depth/Z"] {
        let found = folder.keys(&[&format!("depth.Z={name}")]).unwrap();
        assert!(found.contains(&("camera/depth.Z".to_string(), 1.0)), "{name}: {found:?}");
    }
    let error = folder.keys(&["depth.Z=Z"]).unwrap_err();
    assert!(
        error.ends_with("2 channels of that name; expected one of camera/ViewLayer.Depth/Z, camera/Normal/Z"),
        "{error}"
    );
}

#[test]
fn parts_of_two_views_are_not_mixed() {
    let folder = Folder::new();
    folder
        .parts("camera.exr", &[("l", "left", 2, &[("range.T", 1.0)]), ("r", "right", 2, &[("face.I", 2.0)])]);
    assert_eq!(folder.keys(&[]).unwrap(), pairs([("camera/l/range.T", 1.0), ("camera/r/face.I", 2.0)]));
    assert!(folder.keys(&["range.T=l/range.T"]).unwrap().contains(&("camera/range.T".to_string(), 1.0)));
}

#[test]
fn what_is_declared_and_not_so_is_refused_with_what_is_there() {
    let folder = Folder::new();
    folder.exr("camera.exr", &[("ViewLayer.Depth.Z", 1.0), ("Y", 2.0)]);
    folder.wholes("camera/index.npy", &[1, 2]);
    let refused = |declared: &[&str]| folder.keys(declared).unwrap_err();
    assert_eq!(
        refused(&["depth.Z=Depth.Z"]),
        ".: channel \"Depth.Z\", declared to be depth.Z: not there; expected one of camera.exr (2 x 1): ViewLayer.Depth.Z \
         (single), Y (single); camera/index.npy (2 x 1): index (whole numbers)"
    );
    assert!(
        refused(&["depth.Z=Y", "range.T=Y"])
            .contains("declared to be camera/depth.Z as well; expected one map")
    );
    assert!(
        refused(&["depth.Z=Y", "depth.Z=index"])
            .contains("camera/depth.Z is declared twice; expected one channel")
    );
    assert!(refused(&["depth.Z=Y", "camera/depth.Z=index"]).contains("camera/depth.Z is declared twice"));
    for text in ["depth.Z", "=Y", "depth.Z=", "a/b/c=Y", "/depth.Z=Y", "depth.Z=//"] {
        assert!(text.parse::<DeclaredChannel>().is_err(), "{text}");
    }
    // Of two recordings that are compared, one may lack it.
    let absent = Declared { may_be_absent: true, ..channels(&["depth.Z=Depth.Z", "range.T=Y"]) };
    let read = folder.read(&absent).unwrap();
    assert_eq!(read.used.maps.iter().collect::<Vec<_>>(), ["range.T"]);
}

#[test]
fn whole_numbers_count_a_unit_and_0_is_no_reading() {
    let folder = Folder::new();
    folder.wholes("camera/depth.Z.npy", &[1500, 0, u32::MAX, 65535]);
    folder.wholes("camera/face.I.npy", &[1, 0, u32::MAX, 3]);
    let scale = Declared { scale: Some(0.001), miss: Some(65535.0), ..Declared::default() };
    let read = folder.read(&scale).unwrap();
    let cells = |key: &str| (0..4).map(|index| read.by_key[key].values.real(index)).collect::<Vec<_>>();
    assert_eq!(cells("camera/depth.Z"), [1.5, f64::INFINITY, f64::INFINITY, f64::INFINITY]);
    assert_eq!(read.by_key["camera/depth.Z"].storage.to_string(), "steps of 0.001 m");
    // Each length of a depth image counts it.
    let others = Folder::new();
    for name in ["range.T", "view.Z"] {
        others.wholes(&format!("camera/{name}.npy"), &[2500]);
    }
    let of_others = others.read(&scale).unwrap();
    let lengths = ["camera/range.T", "camera/view.Z"].map(|key| of_others.by_key[key].values.real(0));
    assert_eq!(lengths, [2.5, 2.5]);
    // Indices count nothing.
    assert_eq!(cells("camera/face.I"), [1.0, 0.0, 4_294_967_295.0, 3.0]);
    assert_eq!(read.by_key["camera/face.I"].storage, Storage::Whole);
    // Beside the same in single precision: to within half a step.
    let path = folder.path("camera.exr");
    let singles = |first: f32| {
        let mut map = ExrMap::new(4, 1);
        let nothing = f32::INFINITY;
        map.insert("depth.Z", Raster::F32(Image::from_cells(4, 1, vec![first, nothing, nothing, nothing])));
        write_exr(&path, &map).unwrap();
    };
    singles(1.500_4);
    assert_eq!(folder.read(&scale).unwrap().by_key["camera/depth.Z"].storage, Storage::F32);
    singles(1.500_6);
    assert!(
        folder
            .read(&scale)
            .unwrap_err()
            .contains("camera/depth.Z.npy: channel \"camera/depth.Z\", cell (0, 0): 1.5")
    );
}

#[test]
fn a_scale_that_concerns_nothing_is_refused() {
    let folder = Folder::new();
    folder.exr("camera.exr", &[("depth.Z", 1.0)]);
    let scale = |scale| folder.read(&Declared { scale: Some(scale), ..Declared::default() }).unwrap_err();
    assert_eq!(
        scale(0.001),
        ".: scale 0.001: no map that it concerns in camera.exr (2 x 1): camera/depth.Z (single); expected a map of whole \
         numbers called range.T, depth.Z or view.Z, by its file or as declared"
    );
    assert!(scale(0.0).contains("scale 0: no length of a unit"));
}

#[test]
fn pictures_for_people_are_passed_over_where_maps_are_asked_for() {
    let folder = Folder::new();
    folder.wholes("camera/face.I.npy", &[1, 2]);
    let picture = |name: &str, bytes: &[u8]| std::fs::write(folder.path(name), bytes).unwrap();
    picture("camera/preview.png", b"not even a picture");
    let read = |declared: &Declared, names: Option<&[String]>| {
        let read = read_channels_as(folder.0.path(), &Limits::default(), declared, names);
        read.map(|channels| channels.by_key.len()).map_err(|error| error.to_string())
    };
    let names = ["depth.Z".to_string()];
    assert_eq!(read(&Declared::default(), Some(&names)), Ok(1));
    // Where no scene says which maps there are, one beside arrays is passed over as well, and one by itself is not.
    assert_eq!(read(&Declared::default(), None), Ok(1));
    picture("photos/preview.png", b"not even a picture");
    assert!(read(&Declared::default(), None).unwrap_err().contains("photos/preview.png: header"));
    assert!(read(&channels(&["depth.Z=preview"]), Some(&names)).unwrap_err().contains("preview.png: header"));
    picture("camera/depth.Z.png", b"not even a picture");
    assert!(read(&Declared::default(), Some(&names)).unwrap_err().contains("depth.Z.png: header"));
}

#[test]
fn what_concerned_nothing_is_left_out_of_what_was_declared() {
    let folder = Folder::new();
    folder.exr("camera.exr", &[("depth.Z", 1.0)]);
    let declared = Declared {
        channels: ["depth.Z=depth.Z", "range.T=nowhere"].map(|one| one.parse().unwrap()).to_vec(),
        scale: Some(0.001),
        may_be_absent: true,
        ..Declared::default()
    };
    let read = folder.read(&declared).unwrap();
    let used = declared.used(&read.used);
    let maps: Vec<&str> = used.channels.iter().map(|one| one.map.as_str()).collect();
    assert_eq!((maps, used.scale), (vec!["depth.Z"], None));
}
