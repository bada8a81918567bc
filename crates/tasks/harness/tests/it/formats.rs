//! Maps in every format hold the numbers of the rendering, bit for bit where they are doubles.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use raypencil_files::{Limits, Raster, read_exr, read_npy_numbers};
use raypencil_harness::{MapFormat, contender, write_maps_as};
use raypencil_scene::{RenderOutput, Request, Sampling};
use raypencil_scene_io::Subject;
use raypencil_tests::fixtures::subject;

fn rendered() -> (Subject, RenderOutput) {
    let subject = subject();
    let output = contender("tracer").unwrap().renderer.render(&subject.scene, &Request::EVERYTHING);
    (subject, output)
}

fn written(format: MapFormat, folder: &Path) -> (Subject, RenderOutput) {
    let (subject, output) = rendered();
    let files = write_maps_as(format, &output, "tracer", &subject, Sampling::Centres, folder).unwrap();
    assert!(!files.is_empty() && files.iter().all(|file| file.exists()), "{files:?}");
    (subject, output)
}

/// What the camera and the first beam must say, by name: a few quantities of each kind, as bits or integers.
fn expected(output: &RenderOutput) -> BTreeMap<String, Vec<u64>> {
    let mut all = BTreeMap::new();
    let camera = output.camera.as_ref().unwrap();
    let range = camera.range.as_ref().unwrap().cells();
    all.insert(
        "camera/range.T".into(),
        range.iter().map(|x| x.get().unwrap_or(f64::INFINITY).to_bits()).collect(),
    );
    let points = camera.point.as_ref().unwrap().cells().iter();
    let point = points.flat_map(|x| x.get().map_or([f64::NAN; 3], |x| x.to_array()));
    all.insert("camera/P".into(), point.map(f64::to_bits).collect());
    let faces = camera.face.as_ref().unwrap().cells();
    all.insert(
        "camera/face.I".into(),
        faces.iter().map(|x| x.get().map_or(u64::from(u32::MAX), |x| x.0.into())).collect(),
    );
    all.insert("camera/flux.beam0".into(), output.flux[0].cells().iter().map(|x| x.to_bits()).collect());
    let visible = output.returns[0].visible.as_ref().unwrap().cells();
    all.insert("beam-0/visible.V".into(), visible.iter().map(|&x| x.into()).collect());
    let pixel = output.returns[0].pixel.as_ref().unwrap().cells();
    all.insert(
        "beam-0/pixel.J".into(),
        pixel.iter().map(|x| x.get().map_or(u64::from(u32::MAX), |x| x.j.into())).collect(),
    );
    assert!(range.iter().any(|x| x.get().is_some()) && visible.contains(&true));
    all
}

/// Numbers of `width` bytes each.
fn numbers(bytes: &[u8], width: usize) -> Vec<u64> {
    let number = |chunk: &[u8]| {
        let mut all = [0; 8];
        all[..width].copy_from_slice(chunk);
        u64::from_le_bytes(all)
    };
    bytes.chunks_exact(width).map(number).collect()
}

fn width_of(name: &str) -> usize {
    match name.rsplit('.').next() {
        Some("I" | "J") => 4,
        Some("V") if name.contains("visible") => 1,
        _ => 8,
    }
}

#[test]
fn npy_files_are_the_doubles() {
    let folder = tempfile::tempdir().unwrap();
    let (_, output) = written(MapFormat::Npy, folder.path());
    for (name, expected) in expected(&output) {
        let file = folder.path().join(format!("{name}.npy"));
        let bytes = fs::read(&file).unwrap();
        let width = width_of(&name);
        assert_eq!(numbers(&bytes[bytes.len() - width * expected.len()..], width), expected, "{name}");
        // Its header says how many there are.
        if width != 1 {
            let read = read_npy_numbers(&file, &Limits::default()).unwrap();
            assert_eq!(read.shape.iter().product::<u64>(), expected.len() as u64, "{name}");
        }
    }
}

#[test]
fn npz_archives_hold_the_npy_files() {
    let (npy, npz) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    written(MapFormat::Npy, npy.path());
    written(MapFormat::Npz, npz.path());
    let mut count = 0;
    for sensor in ["camera", "beam-0"] {
        let mut archive =
            zip::ZipArchive::new(fs::File::open(npz.path().join(format!("{sensor}.npz"))).unwrap()).unwrap();
        for index in 0..archive.len() {
            let mut entry = archive.by_index(index).unwrap();
            let name = entry.name().unwrap().into_owned();
            let mut bytes = Vec::new();
            std::io::Read::read_to_end(&mut entry, &mut bytes).unwrap();
            assert_eq!(bytes, fs::read(npy.path().join(sensor).join(&name)).unwrap(), "{name}");
            count += 1;
        }
        assert_eq!(archive.len(), fs::read_dir(npy.path().join(sensor)).unwrap().count());
    }
    assert!(count > 15, "{count}");
    // Twice the same bytes.
    let again = tempfile::tempdir().unwrap();
    written(MapFormat::Npz, again.path());
    assert_eq!(
        fs::read(npz.path().join("camera.npz")).unwrap(),
        fs::read(again.path().join("camera.npz")).unwrap()
    );
}

#[test]
fn a_zarr_store_has_the_numbers_their_shapes_and_their_units() {
    let folder = tempfile::tempdir().unwrap();
    let (_, output) = written(MapFormat::Zarr, folder.path());
    let store = folder.path().join("maps.zarr");
    let json = |path: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(store.join(path)).unwrap()).unwrap()
    };
    assert_eq!(json("zarr.json")["attributes"]["renderer"], "tracer");
    assert_eq!(json("camera/zarr.json")["node_type"], "group");
    for (name, expected) in expected(&output) {
        let array = json(&format!("{name}/zarr.json"));
        let width = width_of(&name);
        let kind = match width {
            1 => "uint8",
            4 => "uint32",
            _ => "float64",
        };
        assert_eq!(array["data_type"], kind, "{name}");
        let shape: Vec<u64> =
            array["shape"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
        assert_eq!(shape.iter().product::<u64>(), expected.len() as u64);
        assert_eq!(array["chunk_grid"]["configuration"]["chunk_shape"], array["shape"]);
        let chunk = if shape.len() == 3 { "c/0/0/0" } else { "c/0/0" };
        let bytes = fs::read(store.join(&name).join(chunk)).unwrap();
        assert_eq!(numbers(&bytes, width), expected, "{name}");
        let units = array["attributes"]["units"].as_str().unwrap();
        let wanted = match name.as_str() {
            "camera/range.T" | "camera/P" => "m",
            "camera/flux.beam0" => "W",
            _ => "1",
        };
        assert_eq!(units, wanted, "{name}");
        assert_eq!(array["dimension_names"][0], "row");
    }
}

#[test]
fn single_exrs_have_one_quantity_each_in_the_channels_that_viewers_show() {
    let folder = tempfile::tempdir().unwrap();
    let (subject, output) = written(MapFormat::ExrEach, folder.path());
    let read = |name: &str| read_exr(folder.path().join(name), &Limits::default()).unwrap();
    let range = read("camera/range.T.exr");
    assert_eq!(range.channels.keys().collect::<Vec<_>>(), ["Y"]);
    let Raster::F32(found) = &range.channels["Y"] else { panic!("floats") };
    let camera = output.camera.as_ref().unwrap();
    for (found, range) in found.cells().iter().zip(camera.range.as_ref().unwrap().cells()) {
        assert_eq!(*found, range.get().map_or(f32::INFINITY, |range| range as f32));
    }
    let normal = read("camera/N.exr");
    assert_eq!(normal.channels.keys().collect::<Vec<_>>(), ["B", "G", "R"]);
    let Raster::F32(up) = &normal.channels["B"] else { panic!("floats") };
    for (found, normal) in up.cells().iter().zip(camera.normal.as_ref().unwrap().cells()) {
        assert_eq!(found.to_bits(), normal.get().map_or(f32::NAN, |normal| normal.z as f32).to_bits());
    }
    let faces = read("camera/face.I.exr");
    let Raster::F32(found) = &faces.channels["Y"] else { panic!("floats") };
    for (found, face) in found.cells().iter().zip(camera.face.as_ref().unwrap().cells()) {
        assert_eq!(found.to_bits(), face.get().map_or(f32::NAN, |face| face.0 as f32).to_bits());
    }
    assert_eq!(range.attributes["unit"], "m");
    assert_eq!(range.attributes["sceneSha256"], raypencil_scene_io::scene_sha256(&subject.scene));
}
