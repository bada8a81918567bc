//! `campaign`: shards, interruptions, damaged files.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use tempfile::TempDir;

use crate::{assert_trouble, command, raypencil, screen};

/// The words of a command line without quotes.
fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

#[track_caller]
fn passes(folder: &Path, line: &str) -> String {
    screen(folder, &words(line), 0)
}

#[track_caller]
fn is_trouble(folder: &Path, line: &str, expected: &[&str]) {
    assert_trouble(&raypencil(folder, &words(line)), expected);
}

fn summary(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name).join("summary.json")).expect("a summary")
}

#[test]
fn shards_in_any_order_are_the_whole_campaign() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let screen = passes(folder, "campaign --terrains 4 --seed 11 -o whole");
    assert!(
        screen.contains("4 terrains of seed 11")
            && screen.contains("\nseed 11")
            && screen.contains("no defect, none undecided"),
        "{screen}"
    );
    let whole = summary(folder, "whole");
    let json: serde_json::Value = serde_json::from_str(&whole).unwrap();
    assert_eq!(json["all"]["classes"]["defects"], 0);
    // Every kind of scene has rays, and the aimed ones are difficult: some tie.
    for part in ["own", "paper", "aimed", "lattice"] {
        assert!(json["parts"][part]["compared"].as_u64().unwrap() > 1000, "{part}");
    }
    assert!(json["parts"]["aimed"]["classes"]["tie"].as_u64().unwrap() > 0);

    passes(folder, "campaign --terrains 4 --seed 11 --shard 2/2 -o b");
    is_trouble(folder, "campaign merge b", &["no shard 1 of 2", "all of them"]);
    passes(folder, "campaign --terrains 4 --seed 11 --shard 1/2 -o a");
    passes(folder, "campaign merge b a -o merged");
    assert_eq!(summary(folder, "merged"), whole);
    passes(folder, "campaign merge a b -o merged");
    assert_eq!(summary(folder, "merged"), whole);

    // The same shard twice, one of another campaign, one that was changed.
    is_trouble(folder, "campaign merge a b a", &["shard 1 of 2 again", "each shard once"]);
    passes(folder, "campaign --terrains 4 --seed 12 --shard 1/2 -o foreign");
    is_trouble(folder, "campaign merge foreign b", &["seed 11", "seed 12"]);
    is_trouble(folder, "campaign --terrains 4 --seed 12 -o a", &["seed 11", "a folder of its own"]);
    let file = folder.join("a/shard-1-of-2.json");
    let clean = fs::read_to_string(&file).unwrap();
    fs::write(&file, clean.replacen("\"compared\":", "\"compared\":1", 1)).unwrap();
    is_trouble(folder, "campaign merge a b", &["shard-1-of-2.json", "digest"]);
    fs::write(&file, &clean[..clean.len() / 2]).unwrap();
    is_trouble(folder, "campaign merge a b", &["shard-1-of-2.json"]);
    is_trouble(folder, "campaign merge whole/terrains", &["no result in"]);
    is_trouble(folder, "campaign --shard 3/2", &["such as 2/4"]);
}

#[test]
fn an_interrupted_campaign_is_resumed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let line = "campaign --terrains 5 --seed 3 -o broken";
    let mut child =
        command(folder, &words(line)).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    // Killed, as by kill -9, once the first records exist.
    let records = || fs::read_dir(folder.join("broken/terrains")).map_or(0, Iterator::count);
    while records() < 2 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let kept: Vec<_> =
        fs::read_dir(folder.join("broken/terrains")).unwrap().map(|one| one.unwrap().path()).collect();
    // A record that the interruption damaged is computed again.
    if let Some(last) = kept.iter().filter(|path| path.extension().is_some_and(|end| end == "json")).max() {
        let text = fs::read_to_string(last).unwrap();
        fs::write(last, &text[..text.len() - 9]).unwrap();
    }
    passes(folder, line);
    passes(folder, "campaign --terrains 5 --seed 3 -o straight");
    assert_eq!(summary(folder, "broken"), summary(folder, "straight"));
    // A finished campaign is not run again and gives the same summary.
    passes(folder, line);
    assert_eq!(summary(folder, "broken"), summary(folder, "straight"));
}

#[test]
fn a_scene_of_a_campaign_can_be_replayed() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    for part in ["own", "aimed", "lattice"] {
        passes(folder, &format!("campaign replay --seed 11 --terrain 2 --part {part} -o replay"));
        passes(folder, "validate replay/scene.toml -o out");
    }
}
