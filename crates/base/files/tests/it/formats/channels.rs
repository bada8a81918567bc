//! Recordings: the files that are read, their keys, and files that contradict each other.

use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, Layer, LayerAttributes, SmallVec,
    WritableImage, f16,
};
use png::{BitDepth, ColorType};
use std::path::{Path, PathBuf};

use super::pictures::png;
use raypencil_files::{
    Channels, ExrMap, Limits, Raster, Storage, Values, add_ray_sets, has_ray_sets, read_channels, write_exr,
    write_npy, write_npy_numbers, write_pfm,
};
use raypencil_scene::Image;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// Path of a file, whose folder is created.
    fn path(&self, name: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        path
    }

    fn npy(&self, name: &str, cells: &[f64]) {
        let image = Image::from_cells(cells.len() as u32, 1, cells.to_vec());
        write_npy(self.path(name), &[&image]).unwrap();
    }

    fn wholes(&self, name: &str, cells: &[u32]) {
        let image = Image::from_cells(cells.len() as u32, 1, cells.to_vec());
        write_npy(self.path(name), &[&image]).unwrap();
    }

    fn pfm(&self, name: &str, cells: &[f32]) {
        let image = Image::from_cells(cells.len() as u32, 1, cells.to_vec());
        write_pfm(self.path(name), &[&image]).unwrap();
    }

    fn exr(&self, name: &str, channels: &[(&str, Raster)]) {
        let (width, height) = channels[0].1.size();
        let mut map = ExrMap::new(width, height);
        for (name, raster) in channels {
            map.insert(*name, raster.clone());
        }
        map.attributes.insert("unit".into(), "metre".into());
        write_exr(self.path(name), &map).unwrap();
    }

    fn read(&self) -> Result<Channels, String> {
        let start = format!("{}/", self.0.path().display());
        read_channels(self.0.path(), &Limits::default())
            .map_err(|error| error.to_string().replace(&start, ""))
    }
}

/// A picture of one pixel.
fn gray() -> Vec<u8> {
    png([1, 1], ColorType::Grayscale, BitDepth::Eight, &[7])
}

fn single(cells: &[f32]) -> Raster {
    Raster::F32(Image::from_cells(cells.len() as u32, 1, cells.to_vec()))
}

fn keys(channels: &Channels) -> Vec<&str> {
    channels.by_key.keys().map(String::as_str).collect()
}

fn cells(channels: &Channels, key: &str) -> Vec<f64> {
    let values = &channels.by_key[key].values;
    let (width, height) = values.size();
    (0..(width * height) as usize).map(|index| values.real(index)).collect()
}

#[test]
fn keys_follow_from_folders_files_channels_and_components() {
    let folder = Folder::new();
    folder.exr("camera.exr", &[("range.T", single(&[1.0])), ("face.I", Raster::U32(Image::filled(1, 1, 7)))]);
    folder.exr("a/b.exr", &[("c", single(&[2.0]))]);
    folder.npy("camera/depth.Z.npy", &[3.0]);
    folder.pfm("top.PFM", &[4.0]);
    folder.npy("a/deeper/x.npy", &[5.0]);
    std::fs::write(folder.path("notes.txt"), "not a map").unwrap();
    let planes: Vec<Image<f64>> = (0..4).map(|k| Image::filled(1, 1, f64::from(k))).collect();
    for count in 1..=4 {
        let planes: Vec<&Image<f64>> = planes.iter().take(count).collect();
        write_npy(folder.path(&format!("n/v{count}.npy")), &planes).unwrap();
    }
    let colour = Image::filled(1, 1, 9.0_f32);
    write_pfm(folder.path("n/P.pfm"), &[&colour, &colour, &colour]).unwrap();
    let read = folder.read().unwrap();
    let expected = [
        "a/b/c",
        "camera/depth.Z",
        "camera/face.I",
        "camera/range.T",
        "n/P.X",
        "n/P.Y",
        "n/P.Z",
        "n/v1",
        "n/v2.X",
        "n/v2.Y",
        "n/v3.X",
        "n/v3.Y",
        "n/v3.Z",
        "n/v4.0",
        "n/v4.1",
        "n/v4.2",
        "n/v4.3",
        "top",
    ];
    assert_eq!(keys(&read), expected);
    assert_eq!(cells(&read, "n/v3.Z"), [2.0]);
    assert_eq!(read.by_key["n/v3.Z"].name, "Z");
    assert_eq!(read.by_key["camera/face.I"].storage, Storage::Whole);
    assert_eq!(read.by_key["camera/face.I"].values, Values::Wholes(Image::filled(1, 1, 7)));
    assert_eq!((read.by_key["top"].storage, read.by_key["a/b/c"].storage), (Storage::F32, Storage::F32));
    let names: Vec<_> = read.files.iter().map(|file| file.strip_prefix(folder.0.path()).unwrap()).collect();
    let expected = [
        "a/b.exr",
        "camera.exr",
        "camera/depth.Z.npy",
        "n/P.pfm",
        "n/v1.npy",
        "n/v2.npy",
        "n/v3.npy",
        "n/v4.npy",
        "top.PFM",
    ];
    assert_eq!(names, expected.map(Path::new));
    assert_eq!(read.attributes.len(), 2);
    assert_eq!(read.attributes[&folder.path("camera.exr")]["unit"], "metre");
}

#[test]
fn a_file_alone_has_keys_without_a_folder() {
    let folder = Folder::new();
    folder.exr("x/camera.exr", &[("range.T", single(&[1.0]))]);
    folder.npy("x/range.T.npy", &[1.5]);
    let read = |name: &str| read_channels(folder.path(name), &Limits::default()).unwrap();
    assert_eq!(keys(&read("x/camera.exr")), ["range.T"]);
    assert_eq!(keys(&read("x/range.T.npy")), ["range.T"]);
    assert_eq!(read("x/range.T.npy").files, [folder.path("x/range.T.npy")]);
}

#[test]
fn halves_are_told_from_singles() {
    let folder = Folder::new();
    let channels = [
        AnyChannel::new("h", FlatSamples::F16(vec![f16::from_f64(0.1)])),
        AnyChannel::new("s", FlatSamples::F32(vec![0.1])),
    ];
    let channels = AnyChannels::sort(SmallVec::from_vec(channels.into()));
    let layer = Layer::new((1, 1), LayerAttributes::default(), Encoding::UNCOMPRESSED, channels);
    ExrImage::from_layer(layer).write().to_file(folder.path("m.exr")).unwrap();
    let read = folder.read().unwrap();
    assert_eq!((read.by_key["m/h"].storage, read.by_key["m/s"].storage), (Storage::F16, Storage::F32));
    // 0.1 in half precision is 1638 / 16384 = 0.0999755859375.
    assert_eq!(cells(&read, "m/h"), [0.099_975_585_937_5]);
    assert_eq!(cells(&read, "m/s"), [f64::from(0.1_f32)]);
}

#[test]
fn the_finest_of_several_stands_for_all() {
    let folder = Folder::new();
    let double = [1.0 / 3.0, f64::INFINITY, f64::NAN, -0.0, 1e-50];
    folder.npy("camera/range.T.npy", &double);
    let singles: Vec<f32> = double.iter().map(|&number| number as f32).collect();
    folder.exr("camera.exr", &[("range.T", single(&singles))]);
    folder.pfm("camera/range.T.pfm", &singles);
    // Truth values as bytes and as reals.
    folder.wholes("beam-0/visible.V.npy", &[0, 1]);
    folder.exr("beam-0.exr", &[("visible.V", single(&[0.0, 1.0]))]);
    let read = folder.read().unwrap();
    assert_eq!(keys(&read), ["beam-0/visible.V", "camera/range.T"]);
    let finest = &read.by_key["camera/range.T"];
    assert_eq!((finest.storage, &finest.file), (Storage::F64, &folder.path("camera/range.T.npy")));
    assert_eq!(read.by_key["beam-0/visible.V"].storage, Storage::Whole);
    let coarser: Vec<_> = read.coarser.iter().map(|(key, channel)| (key.as_str(), channel.storage)).collect();
    let single = Storage::F32;
    assert_eq!(
        coarser,
        [("beam-0/visible.V", single), ("camera/range.T", single), ("camera/range.T", single)]
    );
    // Equal storages are ordered by the parts of their paths.
    assert_eq!(read.coarser[1].1.file, folder.path("camera/range.T.pfm"));
}

#[test]
fn half_an_ulp_is_the_limit() {
    // Between 1 and 2 an ulp of single precision is 2^-23; half of it is 2^-24.
    let half = 1.0 / 16_777_216.0;
    for (double, fits) in [
        (1.5 + half, true),
        (1.5 - half, true),
        (1.5 + 1.25 * half, false),
        (1.5 - 1.25 * half, false),
        (f64::NAN, false),
        (f64::INFINITY, false),
    ] {
        let folder = Folder::new();
        folder.npy("camera/range.T.npy", &[0.0, double]);
        folder.exr("camera.exr", &[("range.T", single(&[0.0, 1.5]))]);
        let read = folder.read();
        assert_eq!(read.is_ok(), fits, "{double}");
        if let Err(message) = read {
            let start = "camera.exr: channel \"camera/range.T\", cell (1, 0): 1.5; expected ";
            assert!(message.starts_with(start), "{message}");
            assert!(message.ends_with(" to within half an ulp, as in camera/range.T.npy"), "{message}");
        }
    }
    for (one, other) in [(f32::INFINITY, f32::NEG_INFINITY), (f32::NAN, 1.0), (f32::INFINITY, 1.0)] {
        let folder = Folder::new();
        folder.pfm("a.pfm", &[one]);
        folder.npy("a.npy", &[other.into()]);
        assert!(folder.read().is_err(), "{one} {other}");
    }
}

#[test]
fn files_that_contradict_each_other_are_both_named() {
    let folder = Folder::new();
    folder.wholes("camera/face.I.npy", &[1, 2, 3]);
    folder.exr("camera.exr", &[("face.I", Raster::U32(Image::from_cells(3, 1, vec![1, 2, 4])))]);
    let message = folder.read().unwrap_err();
    assert_eq!(
        message,
        "camera.exr: channel \"camera/face.I\", cell (2, 0): 4; expected 3 to within half an ulp, as in camera/face.I.npy"
    );
    let folder = Folder::new();
    folder.npy("a.npy", &[1.0, 2.0]);
    folder.pfm("a.pfm", &[1.0]);
    assert_eq!(folder.read().unwrap_err(), "a.pfm: channel \"a\": 1 x 1 cells; expected 2 x 1 as in a.npy");
}

#[test]
fn paths_without_a_recording_are_refused() {
    let folder = Folder::new();
    let message = folder.read().unwrap_err();
    assert!(
        message.ends_with(
            "folder: no maps; expected at least one file that ends in .exr, .npy, .npz, .pfm, .png or .tif, here or one \
             folder below, or a .zarr store"
        ),
        "{message}"
    );
    let text = folder.path("notes.txt");
    std::fs::write(&text, "not a map").unwrap();
    assert!(folder.read().is_err());
    let refused = |path: &Path| read_channels(path, &Limits::default()).unwrap_err().to_string();
    let message = refused(&text);
    let expected = "expected a folder, or a file that ends in .exr, .npy, .npz, .pfm, .png or .tif";
    assert!(
        message.contains("notes.txt: recording: a file of an unknown kind") && message.ends_with(expected)
    );
    assert!(refused(&folder.path("none.exr")).contains("none.exr: cannot read: "));
    // A broken file is named. A folder with the name of a map is no map.
    std::fs::write(folder.path("b.npy"), "nothing").unwrap();
    assert!(folder.read().unwrap_err().starts_with("b.npy: first bytes: "));
    std::fs::remove_file(folder.path("b.npy")).unwrap();
    std::fs::create_dir(folder.path("c.exr")).unwrap();
    assert!(folder.read().unwrap_err().contains("no maps"));
}

#[test]
fn limits_hold_for_all_files_together() {
    let folder = Folder::new();
    for name in ["a.npy", "b.npy", "c.npy"] {
        folder.npy(name, &[1.0; 16_384]);
    }
    let read = |bytes| read_channels(folder.0.path(), &Limits { bytes, ..Limits::default() });
    // 128 KiB each.
    assert!(read(3 << 17).is_ok());
    let message = read((3 << 17) - 1).unwrap_err().to_string();
    assert!(message.contains("c.npy: ") && message.contains("131071 bytes"), "{message}");
}

#[test]
fn a_picture_beside_arrays_is_a_channel_only_by_the_name_of_a_map() {
    let folder = Folder::new();
    let picture = |name: &str| {
        std::fs::write(folder.path(name), gray()).unwrap();
    };
    // A folder of pictures alone is a recording.
    picture("photos/preview.png");
    assert_eq!(folder.read().unwrap().by_key.keys().collect::<Vec<_>>(), ["photos/preview"]);
    // Beside an array, in its own folder, a preview shows what the array says; a depth image is a map.
    folder.npy("camera/P.npy", &[1.0]);
    picture("camera/preview.png");
    picture("camera/depth.Z.png");
    let read = folder.read().unwrap();
    let keys: Vec<&String> = read.by_key.keys().collect();
    assert_eq!(keys, ["camera/P", "camera/depth.Z", "photos/preview"]);
    assert!(!read.files.iter().any(|file| file.ends_with("camera/preview.png")));
}

#[test]
fn truth_values_alone_are_answers_to_a_set_of_rays() {
    let folder = Folder::new();
    write_npy_numbers(folder.path("rays/mast/side.npy"), &[2, 2], &[1.0, 0.0, 0.0, 1.0]).unwrap();
    assert!(!has_ray_sets(folder.0.path()).unwrap());
    write_npy_numbers(folder.path("rays/mast/hit.npy"), &[2, 2], &[1.0, 0.0, 0.0, 1.0]).unwrap();
    assert!(has_ray_sets(folder.0.path()).unwrap());
}

#[test]
fn a_folder_that_is_a_set_of_rays_is_read_whatever_the_dimensions_of_its_arrays() {
    let folder = Folder::new();
    let array = |name: &str, shape: &[u64]| {
        let numbers: Vec<f64> = (0..shape.iter().product()).map(|k| f64::from(k as u32)).collect();
        write_npy_numbers(folder.path(name), shape, &numbers).unwrap();
    };
    array("t.npy", &[2, 4]);
    array("point.npy", &[2, 4, 3]);
    array("across.npy", &[2, 4, 2, 3]);
    array("all.t.npy", &[5]);
    // No face: by one program -1, by another 4294967295.
    write_npy_numbers(folder.path("face.npy"), &[2, 4], &[-1, 7, 7, 7, 7, 7, 7, 7_i32]).unwrap();
    std::fs::write(folder.path("top.png"), gray()).unwrap();
    let read = folder.read().unwrap();
    let size = |key: &str| read.by_key[key].values.size();
    assert_eq!(
        [size("t"), size("point.Z"), size("across.1.Y"), size("all.t")],
        [(4, 2), (4, 2), (4, 2), (5, 1)]
    );
    // Ray 3, second vector, second number: 6 * 3 + 3 + 1.
    assert_eq!(read.by_key["across.1.Y"].values.real(3), 22.0);
    assert_eq!(read.by_key["face"].values.real(0), 4294967295.0);
    assert_eq!(read.by_key.len(), 1 + 3 + 6 + 1 + 1, "{:?}", read.by_key.keys());
    // A flat set: one row of its rays.
    let flat = Folder::new();
    write_npy_numbers(flat.path("t.npy"), &[3], &[1.0, 2.0, 3.0]).unwrap();
    write_npy_numbers(flat.path("point.npy"), &[3, 3], &[0.5; 9]).unwrap();
    let read = flat.read().unwrap();
    assert_eq!([read.by_key["t"].values.size(), read.by_key["point.X"].values.size()], [(3, 1), (3, 1)]);
    // Arrays of no shape of the set are rasters as they stand: none is left out.
    write_npy_numbers(flat.path("range.npy"), &[2, 3, 4], &[0.25; 24]).unwrap();
    write_npy_numbers(flat.path("own.npy"), &[], &[7.0]).unwrap();
    let read = flat.read().unwrap();
    assert_eq!([read.by_key["range"].values.size(), read.by_key["own"].values.size()], [(4, 6), (1, 1)]);
}

#[test]
fn answers_to_sets_of_rays_alone_are_a_recording() {
    let folder = Folder::new();
    write_npy_numbers(folder.path("rays/mast/t.npy"), &[3], &[1.0, 2.0, 3.0]).unwrap();
    let mut read = folder.read().unwrap();
    assert!(read.by_key.is_empty());
    add_ray_sets(&mut read, folder.0.path(), &Limits::default()).unwrap();
    assert_eq!(read.by_key["rays/mast/t"].values.size(), (3, 1));
}
