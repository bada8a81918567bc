//! The reference packs of `data/packs`: the same bytes for any number of threads and any build, small, and passed by
//! every renderer.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use raypencil::harness::{contender, write_maps};
use raypencil::io::{Overrides, Subject, load};
use raypencil::judge::{Class, Quantity};
use raypencil::pack::{
    BENCH_BEAMS, Checked, Manifest, PUBLISHED, PackLabel, PublishedPack, benched, check_pack, write_pack,
};
use raypencil::{Precision, Request, Sampling, SensorId, Silent};

/// Version of the packs.
const VERSION: &str = "2.0.0";

const PACKS: [&str; 3] = ["pyramids", "facets", "hard"];

fn data(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(path)
}

/// The scene from which a pack of `data/packs` is made.
fn subject(pack: &str) -> Subject {
    let file = data(&format!("scenes/packs/{pack}.toml"));
    let loaded = load(&file.to_string_lossy(), &Overrides::default()).expect("a scene of this repository");
    let arguments = loaded.name.clone();
    benched(loaded.into_subject(arguments)).expect("room for a bench")
}

/// Every file below a folder, by its relative path.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.insert(name, fs::read(&path).expect("a file"));
        }
    }
    found
}

#[test]
fn a_pack_is_the_same_bytes_for_any_number_of_threads_and_in_any_build() {
    // The smallest is enough to compare numbers of threads; .ci/same_bits.sh writes all three again.
    let pack = "hard";
    let committed = files(&data(&format!("packs/{pack}")));
    let subject = subject(pack);
    let label = PackLabel { version: Some(VERSION.into()), licence: Some("CC0-1.0".into()) };
    for threads in [1, 3] {
        let folder = tempfile::tempdir().expect("a folder");
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| write_pack(&subject, None, &label, folder.path(), &Silent)).expect("a pack");
        let made = files(folder.path());
        assert_eq!(made.keys().collect::<Vec<_>>(), committed.keys().collect::<Vec<_>>());
        for (name, bytes) in &made {
            assert!(*bytes == committed[name], "{pack}/{name} differs on {threads} threads");
        }
    }
}

#[test]
fn the_published_digests_are_those_of_the_packs() {
    let listed = fs::read_to_string(data("packs/SHA256SUMS")).expect("the list");
    let mut names = Vec::new();
    for line in listed.lines() {
        let (digest, name) = line.split_once("  ").expect("a digest and a file");
        let (_, found) = raypencil::io::file_sha256_hex(&data(&format!("packs/{name}"))).expect("a file");
        assert_eq!(found, digest, "{name}");
        names.push(name.to_string());
    }
    let of_packs = PACKS.iter().map(|pack| format!("{pack}/manifest.json"));
    let of_input = files(&data("packs/input")).into_keys().map(|name| format!("input/{name}"));
    let mut expected: Vec<String> = of_packs.chain(of_input).collect();
    names.sort();
    expected.sort();
    assert_eq!(names, expected);
    // Those before them are known, too.
    let present: Vec<PublishedPack> = PUBLISHED.into_iter().filter(|one| one.version == VERSION).collect();
    for published in &present {
        let line = format!("{}  {}/manifest.json", published.sha256, published.name);
        assert!(listed.lines().any(|other| other == line), "{line}");
        let manifest = Manifest::read_verified(data(&format!("packs/{}", published.name))).expect("a pack");
        assert_eq!(manifest.version.as_deref(), Some(published.version));
        assert_eq!(manifest.licence.as_deref(), Some("CC0-1.0"));
        assert_eq!(manifest.scene.name, published.name);
    }
    assert_eq!(present.iter().map(|published| published.name).collect::<Vec<_>>(), PACKS);
}

#[test]
fn packs_are_small() {
    for pack in PACKS {
        let bytes: usize = files(&data(&format!("packs/{pack}"))).values().map(Vec::len).sum();
        assert!(bytes < 4_000_000, "{pack}: {bytes} bytes");
    }
}

/// Renders the scene file of a pack, and checks the recording against the pack.
fn judged(pack: &str, renderer: &str) -> Checked {
    let pack = data(&format!("packs/{pack}"));
    let scene_file = pack.join("scene.toml");
    let loaded = load(&scene_file.to_string_lossy(), &Overrides::default()).expect("the pack's scene");
    let subject = loaded.into_subject(String::new());
    let contender = contender(renderer).expect("a renderer of the workspace");
    let output = contender.renderer.render(&subject.scene, &Request::EVERYTHING);
    let folder = tempfile::tempdir().expect("a folder");
    write_maps(&output, renderer, &subject, Sampling::Centres, folder.path()).expect("maps");
    check_pack(&pack, folder.path(), Some(Precision::F64), &Silent).expect("a candidate as it should be")
}

#[test]
fn every_renderer_passes_with_all_its_quantities_compared() {
    for pack in PACKS {
        for renderer in ["scanline", "tracer", "referee"] {
            let Checked { check, recorded, .. } = judged(pack, renderer);
            assert!(check.passes(), "{pack} by {renderer}: {:?}", check.sensors[0].defects.first());
            let manifest = Manifest::read_verified(data(&format!("packs/{pack}"))).expect("a pack");
            let rays = manifest.sensors.iter().map(|sensor| u64::from(sensor.columns * sensor.rows));
            assert_eq!(check.compared(), rays.sum::<u64>());
            let beams = manifest.sensors.len() - 1;
            assert_eq!(beams, 2 + BENCH_BEAMS);
            assert_eq!(recorded.unknown, [""; 0]);
            let totals = check.totals();
            for quantity in Quantity::ALL {
                let own = totals.iter().filter(|(item, _)| item.quantity == quantity && !item.is_other_model);
                let own: Vec<_> = own.collect();
                // The flux on the image is counted for each beam.
                assert_eq!(own.len(), if quantity == Quantity::PixelFlux { beams } else { 1 });
                for (_, tally) in own {
                    assert!(tally.compared() > 400, "{pack} by {renderer}: {quantity} is hardly compared");
                    assert_eq!(tally.not_compared, 0, "{pack} by {renderer}: {quantity}");
                }
            }
            for result in &check.sensors {
                // Storage in single precision gives half an ulp, and the arithmetic a little more. The beams that bite meet faces at
                // cosines down to 1e-8: a few roundings of 2^-53 are some 1e-8 of such a value, which is an ulp of single precision or two.
                let own = result.items.iter().filter(|(item, _)| !item.is_other_model);
                for (item, tally) in own {
                    // The flux of one beam on the camera's image, or any quantity of the beam itself.
                    let beam = match result.sensor {
                        SensorId::Beam(beam) => Some(beam),
                        SensorId::Camera => item.beam.map(|beam| beam as usize),
                    };
                    let most = if beam.is_some_and(|beam| beam + 3 >= beams) { 3.0 } else { 0.51 };
                    if let Some(ulps) = &tally.worst_ulps {
                        assert!(ulps.value < most, "{pack} by {renderer}: {}, {ulps:?}", item.quantity);
                    }
                }
            }
        }
    }
}
#[test]
fn a_candidate_with_the_papers_approximations_fails() {
    // `facets` has sheets of 20 mm and rocks that hide stripes: the paper's visibility is wrong there.
    let Checked { check, .. } = judged("facets", "scanline-paper");
    assert!(!check.passes());
    assert!(check.of(Class::Defect) > 0 && check.of(Class::Defect) < check.compared() / 10);
    assert!(check.sensors.iter().any(|sensor| !sensor.defects.is_empty()));
}
