//! Malformed point clouds, PCD and PLY, beside a good pack of four rays.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use raypencil::cast::{CastSource, write_scan_pack};
use raypencil::pattern::{Channel, Spinning};
use raypencil::{NamedRaySet, Sides, Silent, Triangles};

use super::case::{Case, Item};

const RUN_PCD: &str = "check pack my.pcd -o out";
const RUN_PLY: &str = "check pack my.ply -o out";

/// The files of the pack of a scan: two firing sequences of two channels that look down on a triangle.
fn pack() -> &'static [(String, Vec<u8>)] {
    static FILES: OnceLock<Vec<(String, Vec<u8>)>> = OnceLock::new();
    FILES.get_or_init(|| {
        let head = Spinning {
            channels: vec![Channel::at_elevation(-90.0), Channel::at_elevation(-80.0)],
            azimuth_start_deg: 0.0,
            azimuth_step_deg: 90.0,
            steps: 2,
            period_s: 0.05,
            min_range_m: 0.0,
            max_range_m: f64::INFINITY,
        };
        let mesh =
            Triangles::new(vec![[-9.0, -9.0, -1.0], [9.0, -9.0, -1.0], [0.0, 9.0, -1.0]], vec![[0, 1, 2]])
                .expect("a triangle");
        let set = NamedRaySet::new("down", head.rays("head").expect("a head"), Sides::Both).expect("a set");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let source = CastSource { mesh: "triangle".into(), rays: "head".into(), ..CastSource::default() };
        write_scan_pack(folder.path(), (&mesh, &set, Sides::Both), &source, &Silent).expect("a pack");
        let file = |path: &Path| {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            (format!("pack/{name}"), fs::read(path).expect("a file of the pack"))
        };
        let mut files: Vec<_> = fs::read_dir(folder.path())
            .expect("the pack")
            .map(|entry| file(&entry.expect("an entry").path()))
            .collect();
        files.sort();
        files
    })
}

fn with_pack(case: Case) -> Case {
    pack().iter().fold(case, |case, (path, bytes)| case.file(path, bytes.clone()))
}

/// A PCD header of four points with these lines in place of the good ones.
fn pcd(changes: &[(&str, &str)], body: &[u8]) -> Vec<u8> {
    let lines = [
        ("VERSION", "0.7"),
        ("FIELDS", "x y z"),
        ("SIZE", "4 4 4"),
        ("TYPE", "F F F"),
        ("COUNT", "1 1 1"),
        ("WIDTH", "2"),
        ("HEIGHT", "2"),
        ("POINTS", "4"),
        ("DATA", "ascii"),
    ];
    let mut text = String::new();
    for (key, value) in lines {
        let value = changes.iter().find(|(changed, _)| *changed == key).map_or(value, |(_, value)| value);
        if !value.is_empty() {
            text += &format!("{key} {value}\n");
        }
    }
    [text.as_bytes(), body].concat()
}

const ROWS: &[u8] = b"0 0 -1\n0 0 -1\n0.2 0 -1\n0 0.2 -1\n";

pub(super) fn cases() -> Vec<Case> {
    let of_pcd = |name: &str, what, bytes: Vec<u8>, place: &str| {
        with_pack(Case::of_file(&format!("pcd-{name}"), what, RUN_PCD, "my.pcd", bytes, place))
    };
    let changed = |name: &str, what, changes: &[(&str, &str)], place: &str| {
        of_pcd(name, what, pcd(changes, ROWS), place)
    };
    let of_ply = |name: &str, what, text: &str, place: &str| {
        with_pack(Case::of_file(&format!("cloud-ply-{name}"), what, RUN_PLY, "my.ply", text.into(), place))
    };
    let packed = |packed: u32, length: u32, bytes: &[u8]| {
        let body = [&packed.to_le_bytes()[..], &length.to_le_bytes(), bytes].concat();
        pcd(&[("DATA", "binary_compressed")], &body)
    };
    let reals = [0.0_f32; 12].map(f32::to_le_bytes).concat();
    let many = "x ".repeat(200_000);
    let head = "ply\nformat ascii 1.0\n";
    vec![
        of_pcd("empty", "an empty file", Vec::new(), "a point cloud in PCD or PLY"),
        of_pcd("words", "plain text of another kind", b"hello\n".to_vec(), "a point cloud in PCD or PLY"),
        of_pcd(
            "header-only",
            "a header that does not end",
            b"VERSION 0.7\nFIELDS x y z\n".to_vec(),
            "line 3",
        ),
        of_pcd(
            "long-line",
            "a header of one line of a megabyte",
            [b"# ".as_slice(), &[b'a'; 1 << 20]].concat(),
            "line 1",
        ),
        changed("no-fields", "no names of fields", &[("FIELDS", "")], "no FIELDS"),
        changed("no-x", "no x", &[("FIELDS", "a y z")], "no x"),
        changed(
            "z-twice",
            "two fields of one name",
            &[("FIELDS", "x y z z"), ("SIZE", "4 4 4 4"), ("TYPE", "F F F F"), ("COUNT", "1 1 1 1")],
            "a second one",
        ),
        changed("fields", "two hundred thousand fields", &[("FIELDS", &many)], "FIELDS"),
        changed("sizes", "two sizes of three fields", &[("SIZE", "4 4")], "SIZE"),
        changed("size", "a number of three bytes", &[("SIZE", "4 4 3")], "field `z`"),
        changed("type", "a type of no letter that is known", &[("TYPE", "F F Q")], "field `z`"),
        changed(
            "count",
            "a field of four thousand million numbers",
            &[("COUNT", "1 1 4294967296")],
            "my.pcd",
        ),
        changed("width", "a negative width", &[("WIDTH", "-2")], "line 6"),
        changed(
            "product",
            "points that are not width times height",
            &[("POINTS", "5")],
            "WIDTH times HEIGHT",
        ),
        changed(
            "overflow",
            "a product of width and height beyond 64 bits",
            &[("WIDTH", "4294967296"), ("HEIGHT", "4294967296"), ("POINTS", "0")],
            "WIDTH times HEIGHT",
        ),
        changed("data", "an encoding that is not known", &[("DATA", "zip")], "line 9"),
        changed("key", "a key that is not known", &[("VERSION", "0.7\nLIDAR 3")], "LIDAR"),
        of_pcd(
            "claim",
            "two hundred thousand points that are not there",
            pcd(&[("WIDTH", "100000"), ("POINTS", "200000"), ("DATA", "binary")], &reals),
            "is the file cut off?",
        ),
        // Nothing of it is read: the memory is asked for before.
        of_pcd(
            "large-claim",
            "four million million points that are not there",
            pcd(&[("WIDTH", "2000000000000"), ("POINTS", "4000000000000"), ("DATA", "binary")], &reals),
            "",
        )
        .says(&["4,000,000,000,000 points take about"]),
        of_pcd(
            "cut",
            "binary points without the last byte",
            pcd(&[("DATA", "binary")], &reals[..47]),
            "is the file cut off?",
        ),
        of_pcd("few-rows", "a row less than points", pcd(&[], &ROWS[..20]), "my.pcd"),
        of_pcd(
            "more-rows",
            "a row more than points",
            pcd(&[], &[ROWS, b"1 2 3\n"].concat()),
            "a line after the last point",
        ),
        of_pcd("short-row", "a row of two numbers", pcd(&[], b"0 0\n0 0 -1\n0 0 -1\n0 0 -1\n"), "2 numbers"),
        of_pcd("word", "a word for a number", pcd(&[], b"0 0 one\n0 0 -1\n0 0 -1\n0 0 -1\n"), "\"one\""),
        of_pcd(
            "no-sizes",
            "compressed points without their sizes",
            pcd(&[("DATA", "binary_compressed")], b"abc"),
            "two sizes",
        ),
        of_pcd("expand", "a compressed size of four gigabytes", packed(4, u32::MAX, b"abcd"), "uncompressed"),
        of_pcd(
            "packed-cut",
            "compressed points that are cut off",
            packed(1000, 48, b"abcd"),
            "1000 compressed bytes",
        ),
        of_pcd(
            "reference",
            "a reference before the first byte",
            packed(4, 48, &[0xe0, 0xff, 0xff, 0xff]),
            "my.pcd",
        ),
        with_pack(
            Case::new("pcd-folder", "a folder in place of the file", RUN_PCD, &["my.pcd"])
                .item("my.pcd", Item::Folder),
        ),
        with_pack(
            Case::new("pcd-pipe", "a pipe in place of the file", RUN_PCD, &["my.pcd"])
                .item("my.pcd", Item::Pipe),
        ),
        with_pack(Case::new("pcd-missing", "no file", RUN_PCD, &["my.pcd"])),
        with_pack(
            Case::new("pcd-hole", "a file of a million million bytes", RUN_PCD, &["my.pcd"])
                .item("my.pcd", Item::Hole(pcd(&[("DATA", "binary")], &reals), 1 << 40)),
        ),
        of_ply(
            "no-points",
            "no element of points",
            &format!("{head}element face 1\nproperty float x\nend_header\n1\n"),
            "my.ply",
        ),
        of_ply(
            "no-z",
            "points without z",
            &format!("{head}element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n"),
            "no z",
        ),
        of_ply(
            "claim",
            "two hundred thousand points that are not there",
            &format!(
                "{head}element vertex 200000\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n"
            ),
            "my.ply",
        ),
    ]
}
