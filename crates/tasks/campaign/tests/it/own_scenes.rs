//! Campaigns over scenes of one's own: which files are scenes, what tells two folders apart, and the commands that show a ray again.

use std::path::Path;

use raypencil_campaign::{
    Campaign, Merged, OwnScenes, PartName, PartRecord, TerrainRecord, WrongRay, campaign_document,
};
use raypencil_judge::Quantity;
use serde_json::Value;

const FACET: &str = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";

fn write(folder: &Path, files: &[(&str, &str)]) {
    std::fs::create_dir_all(folder).unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).unwrap());
}

fn names(scenes: &OwnScenes) -> Vec<&str> {
    (0..scenes.len() as u64).map(|terrain| scenes.name(terrain)).collect()
}

#[test]
fn files_are_scenes_by_their_endings_in_letters_of_either_case() {
    let folder = tempfile::tempdir().unwrap();
    let (scenes, rig) = (folder.path().join("scenes"), folder.path().join("rig.toml"));
    write(&scenes, &[("b.stl", FACET), ("A.STL", FACET), ("c.toml", "version = 1\n"), ("notes.txt", "")]);
    write(folder.path(), &[("rig.toml", "version = 1\n")]);
    std::fs::create_dir(scenes.join("d.stl")).unwrap();
    let own = OwnScenes::read(&scenes, None).unwrap();
    assert_eq!(names(&own), ["A.STL", "b.stl", "c.toml"]);
    // Under a rig terrains alone.
    let under = OwnScenes::read(&scenes, Some(&rig)).unwrap();
    assert_eq!(names(&under), ["A.STL", "b.stl"]);
    // The same files elsewhere are the same scenes; another rig makes others, and none others again.
    let elsewhere = folder.path().join("elsewhere");
    write(&elsewhere, &[("b.stl", FACET), ("A.STL", FACET), ("c.toml", "version = 1\n")]);
    assert_eq!(OwnScenes::read(&elsewhere, None).unwrap(), own);
    assert_eq!(OwnScenes::read(&elsewhere, Some(&rig)).unwrap(), under);
    write(folder.path(), &[("rig.toml", "version = 1\ncamera = { width_px = 9 }\n")]);
    assert_ne!(OwnScenes::read(&elsewhere, Some(&rig)).unwrap(), under);
}

/// A campaign over scenes of a folder in which each scene has a wrong ray.
fn merged(scenes: OwnScenes) -> Merged {
    let part = |part: PartName| PartRecord {
        part,
        compared: 10,
        hits: 5,
        by_class: [9, 0, 0, 0, 0, 1],
        not_compared: 0,
        judged: 10,
        quantities: Vec::new(),
        wrong: vec![WrongRay {
            sensor: "camera".into(),
            i: 3,
            j: 1,
            quantity: Quantity::Face,
            what: "face 1 and face 2".into(),
        }],
        reasons: Vec::new(),
        candidate: None,
        failed: None,
    };
    let record = |terrain: u64| TerrainRecord {
        terrain,
        faces: 1,
        parts: [PartName::Own, PartName::Paper, PartName::Aimed].map(part).to_vec(),
    };
    let campaign = Campaign::new(7, 1).over(scenes);
    let terrains = (0..campaign.terrains).map(record).collect();
    Merged { campaign, terrains }
}

#[test]
fn commands_that_show_a_ray_again_name_the_scenes_and_their_rig() {
    let folder = tempfile::tempdir().unwrap();
    let (scenes, rig) = (folder.path().join("scenes"), folder.path().join("rig.toml"));
    write(&scenes, &[("a.stl", FACET), ("b.tif", "II*"), ("c.TIFF", "II*")]);
    write(folder.path(), &[("rig.toml", "version = 1\n")]);
    let all = merged(OwnScenes::read(&scenes, Some(&rig)).unwrap());
    let document = campaign_document(&all, |_| false);
    let options = format!("--scenes {} --rig {}", scenes.display(), rig.display());
    let data: Value = serde_json::from_str(&document.json()).unwrap();
    let replay = |at: usize| data["first_wrong"][at]["replay"].as_str().unwrap().to_string();
    let placed = |key: &str, name: &str| {
        let file = scenes.join(name);
        format!("raypencil probe {} --set terrain.{key}={} --pixel 3,1", rig.display(), file.display())
    };
    // Three scenes of each terrain. Elevation models have a key of their own, in letters of either case.
    assert_eq!(replay(0), placed("file", "a.stl"));
    assert_eq!(replay(3), placed("dem", "b.tif"));
    assert_eq!(replay(6), placed("dem", "c.TIFF"));
    let aimed = format!(
        "raypencil campaign replay {options} --seed 7 --terrain 1 --part aimed -o DIR, then raypencil probe DIR/scene.toml --pixel 3,1"
    );
    assert_eq!(replay(5), aimed);
    // So does the command beside the hardest terrains: without them it would be a random terrain of the seed.
    let page = document.page().unwrap();
    let again = format!("raypencil campaign replay {options} --seed 7 --terrain 0 --part own -o DIR</code>");
    assert!(page.contains(&again), "{page}");
    assert!(page.contains("3 terrains of one's own: a.stl, b.tif, c.TIFF, 3 faces in all"), "{page}");
}
