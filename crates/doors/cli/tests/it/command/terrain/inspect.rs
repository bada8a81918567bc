//! `terrain inspect`: faults, repairs, errors.

use std::fs;
use std::path::Path;

use raypencil::io::{load_mesh, write_glb};
use raypencil::{Material, Mesh};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::super::{assert_trouble, raypencil, screen, text};

/// A tetrahedron of 1 m with an inverted face 3, a duplicate of face 1, a face without area and an unused vertex.
fn faulty() -> Mesh {
    let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [5.0, 6.0, 7.0]];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 3, 2], [1, 3, 0], [2, 2, 0]];
    let kinds = ["sand", "rock"].map(|name| Material { name: name.into(), reflectivity: 0.25 }).to_vec();
    Mesh::new(Default::default(), vertices, faces, vec![0, 0, 0, 0, 1, 0], kinds).unwrap()
}

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a temporary folder");
    write_glb(folder.path().join("faulty.glb"), &faulty()).expect("a GLB");
    folder
}

fn inspected(folder: &Path, arguments: &[&str], code: i32) -> Value {
    let arguments = [&["terrain", "inspect", "--json"], arguments].concat();
    serde_json::from_str(&screen(folder, &arguments, code)).expect("JSON")
}

/// The lines that report a fault.
fn marked(screen: &str) -> Vec<String> {
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    screen.lines().filter(|line| line.starts_with('!')).map(words).collect()
}

#[test]
fn faults_are_reported_on_one_screen() {
    let folder = folder();
    let shown = screen(folder.path(), &["terrain", "inspect", "faulty.glb"], 1);
    assert_eq!(
        marked(&shown),
        [
            "! 1 vertices that no face uses",
            "! 1 faces without area: 1 repeat a vertex, 0 a place, 0 are lines",
            "! 1 copies of other faces, 1 of another material",
            "! 3 edges whose two faces contradict each other in winding",
            "! 1 faces the wrong way round",
        ],
        "{shown}"
    );
    for words in [
        "faulty.glb: 6 faces, 5 vertices",
        "from (0.000, 0.000, 0.000) to (1.000, 1.000, 1.000) m",
        "components: 1, 1 of them closed, which enclose 0.167 m3",
        "vertex 4 (5.000, 6.000, 7.000)",
        "face 3 (0.333, 0.333, 0.333)",
        "FAIL 5 of 10 checks found something. `--repair -o OUT.glb` repairs faults with only one repair.",
    ] {
        assert!(shown.contains(words), "`{words}` is not in:\n{shown}");
    }
    assert!(shown.lines().count() <= 40 && shown.lines().all(|line| line.chars().count() <= 100), "{shown}");
}

#[test]
fn json_has_every_number() {
    let folder = folder();
    let found = inspected(folder.path(), &["faulty.glb"], 1);
    assert_eq!(
        (&found["mesh"], &found["passes"], &found["kinds_wrong"]),
        (&json!("faulty.glb"), &json!(false), &json!(5))
    );
    assert_eq!(found["bounds_m"], json!([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]));
    assert_eq!(found["unused_vertices"]["examples"], json!([{"vertex": 4, "place_m": [5.0, 6.0, 7.0]}]));
    assert_eq!(found["inverted"]["examples"][0]["face"], 3);
    assert_eq!(found["duplicates"]["count"], 1);
    assert_eq!((&found["open_edges"]["count"], &found["repaired"]), (&json!(0), &Value::Null));
    // What a repair does, each by its own name.
    let repaired = &inspected(folder.path(), &["faulty.glb", "--repair", "-o", "sound.glb"], 0)["repaired"];
    let counts = [
        ("zero_area_faces", 1),
        ("duplicate_faces", 1),
        ("duplicates_of_other_material", 1),
        ("turned_faces", 1),
        ("welded_vertices", 0),
        ("unused_vertices", 1),
    ];
    for (key, count) in counts {
        assert_eq!(repaired[key], count, "{key}: {repaired}");
    }
    // Two faces are lines, and one has two corners at one place.
    let text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 0\nv 0 2 0\nf 1 2 4\nf 1 2 3\nf 1 4 6\nf 1 5 4\n";
    fs::write(folder.path().join("lines.obj"), text).unwrap();
    let kinds = inspected(folder.path(), &["lines.obj"], 1)["zero_area_kinds"].clone();
    assert_eq!(kinds, json!({ "repeated_vertex": 0, "coincident_vertices": 1, "collinear": 2 }));
}

#[test]
fn a_repaired_mesh_is_written_and_has_no_faults() {
    let folder = folder();
    let before = fs::read(folder.path().join("faulty.glb")).unwrap();
    let shown =
        screen(folder.path(), &["terrain", "inspect", "faulty.glb", "--repair", "-o", "sound.glb"], 0);
    for words in [
        "Repaired: faces without area dropped: 1, copies dropped: 1, faces turned: 1, vertices dropped: 1.",
        "Written: sound.glb: 4 faces, 4 vertices",
        "PASS 10 checks found nothing in the repaired mesh.",
    ] {
        assert!(shown.contains(words), "`{words}` is not in:\n{shown}");
    }
    let repaired = load_mesh(folder.path().join("sound.glb")).unwrap();
    assert_eq!(repaired.faces(), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    assert_eq!(repaired.vertices(), &faulty().vertices()[..4]);
    assert_eq!(repaired.face_materials(), [0; 4]);
    assert_eq!(fs::read(folder.path().join("faulty.glb")).unwrap(), before);

    let sound = screen(folder.path(), &["terrain", "inspect", "sound.glb"], 0);
    assert!(marked(&sound).is_empty() && sound.contains("PASS 10 checks found nothing."), "{sound}");
    let again = inspected(folder.path(), &["sound.glb", "--repair", "-o", "again.glb"], 0);
    for done in ["zero_area_faces", "duplicate_faces", "turned_faces", "welded_vertices", "unused_vertices"] {
        assert_eq!(again["repaired"][done], 0, "{done}");
    }
    assert_eq!(again["repaired"]["left"]["faces"], 4);
    // The files differ only in the source that their extras state.
    let mesh = |name: &str| load_mesh(folder.path().join(name)).unwrap();
    assert!(mesh("again.glb") == mesh("sound.glb"));
}

#[test]
fn the_terrain_of_any_scene_can_be_inspected() {
    let folder = folder();
    let facets = inspected(folder.path(), &["facets"], 0);
    assert_eq!(facets["passes"], true);
    // A nasty ground of 2000 faces: a 20th are duplicates, a 20th have no area, and a 50th as many vertices are unused.
    let scene = "version = 1\n[terrain]\ngenerate = { kind = \"nasty\", seed = 4, faces = 2000 }\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let nasty = inspected(folder.path(), &["scene.toml", "--repair", "-o", "mended.glb"], 1);
    assert_eq!(
        (&nasty["unused_vertices"]["count"], &nasty["duplicates"]["count"]),
        (&json!(40), &json!(100))
    );
    assert_eq!(nasty["zero_area"]["count"], 100);
    let shown = screen(folder.path(), &["terrain", "inspect", "scene.toml"], 1);
    assert_eq!(marked(&shown).len(), 4, "{shown}");
    assert!(shown.lines().count() <= 40 && shown.lines().all(|line| line.chars().count() <= 100), "{shown}");
    // Loose slivers have borders, which no repair closes.
    let left = &nasty["repaired"]["left"];
    assert_eq!((&left["kinds_wrong"], &left["duplicates"]["count"]), (&json!(1), &json!(0)));
    assert!(left["open_edges"]["excess_loops"].as_u64().unwrap() >= 90, "{left:#}");
    // The file may be the scene's terrain, so it is not overwritten.
    let arguments = ["terrain", "inspect", "scene.toml", "--repair", "-o", "mended.glb"];
    assert_trouble(&raypencil(folder.path(), &arguments), &["mended.glb: exists", "expected a new file"]);
}

#[test]
fn repair_does_not_change_what_rays_hit() {
    let folder = folder();
    let sensors = "version = 1\n\
        [camera]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 144\n\
        [[beam]]\ncolumns = 64\nrows = 4\n[terrain]\n";
    let write = |name: &str, terrain: &str| {
        fs::write(folder.path().join(name), format!("{sensors}{terrain}\n")).unwrap();
    };
    for seed in 1..4 {
        write("nasty.toml", &format!("generate = {{ kind = \"nasty\", seed = {seed}, faces = 3000 }}"));
        write("mended.toml", "file = \"mended.glb\"");
        let _ = fs::remove_file(folder.path().join("mended.glb"));
        let repair = ["terrain", "inspect", "nasty.toml", "--repair", "-o", "mended.glb"];
        screen(folder.path(), &repair, 1);
        for renderer in ["scanline", "tracer"] {
            for name in ["nasty", "mended"] {
                let scene = format!("{name}.toml");
                screen(folder.path(), &["render", &scene, "--with", renderer, "-o", name], 0);
            }
            // Equal to the last bit. Removed faces come last in this ground, so that faces keep their indices.
            let shown = screen(folder.path(), &["diff", "nasty", "mended"], 0);
            assert!(shown.contains("✓ 28 channels compared"), "{shown}");
        }
    }
}

#[test]
fn errors_are_one_clear_message() {
    let folder = folder();
    let inspect = |more: &[&str]| raypencil(folder.path(), &[&["terrain", "inspect"], more].concat());
    assert_trouble(&inspect(&["nowhere.glb"]), &["`nowhere.glb` does not exist"]);
    assert_trouble(&inspect(&["faulty.glb", "--repair"]), &["--output <OUT.glb>"]);
    assert_trouble(&inspect(&["faulty.glb", "-o", "x.glb"]), &["--repair"]);
    let own = ["--output ./faulty.glb: is the mesh to repair", "expected another file"];
    assert_trouble(&inspect(&["faulty.glb", "--repair", "-o", "./faulty.glb"]), &own);
    let kind = ["--output x.ply: is not a GLB file", "ends in .glb"];
    assert_trouble(&inspect(&["faulty.glb", "--repair", "-o", "x.ply"]), &kind);
    let far = "version = 1\n[terrain]\ngenerate = { kind = \"plain\", faces = 50, offset_m = [1e5, 0, 0] }\n\
        [vehicle]\nposition_m = [1e5, 0]\n";
    fs::write(folder.path().join("far.toml"), far).unwrap();
    // A terrain far from the origin is written and read back in place: nothing is left to repair.
    screen(folder.path(), &["terrain", "inspect", "far.toml", "--repair", "-o", "far.glb"], 0);
    let far = load_mesh(folder.path().join("far.glb")).unwrap();
    assert_eq!(far.origin().x, 1e5);
    // The output folder is a file.
    let no_folder = inspect(&["faulty.glb", "--repair", "-o", "faulty.glb/such.glb"]);
    assert_trouble(&no_folder, &["faulty.glb"]);
    assert!(text(&inspect(&["--help"]).stdout).contains("OUT.glb"));
}
