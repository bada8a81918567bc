//! Files of a campaign that are damaged, foreign, or made to do harm.

use super::*;
use crate::merge::merge;
use crate::record::{
    MAX_DESCRIBED_RAYS, PartName, PartRecord, QuantityRecord, ReasonRecord, WorstRecord, WrongRay,
};
use raypencil_judge::{Class, Quantity};
use tempfile::TempDir;

const COMMIT: Option<&str> = Some("0123abc");

fn campaign() -> Campaign {
    Campaign::new(5, 4).of_commit(COMMIT)
}

/// What this program makes.
fn this() -> Made {
    Made { program: program_sha256().to_string(), left: Vec::new() }
}

/// A record whose numbers fit together.
fn record(terrain: u64) -> TerrainRecord {
    let part = |part: PartName| PartRecord {
        part,
        compared: 60,
        hits: 30,
        by_class: [50, 3, 2, 3, 1, 1],
        not_compared: 4,
        judged: 10,
        quantities: vec![QuantityRecord {
            quantity: Quantity::Range,
            by_class: [30, 0, 0, 0, 0, 0],
            not_compared: 0,
            worst_error: Some(WorstRecord { value: Some(1e-12), sensor: "camera".into(), i: 1, j: 2 }),
            worst_ratio: None,
        }],
        wrong: vec![WrongRay {
            sensor: "beam-0".into(),
            i: 3,
            j: 1,
            quantity: Quantity::Range,
            what: "1 m and 2 m".into(),
        }],
        reasons: Vec::new(),
        candidate: None,
        failed: None,
    };
    TerrainRecord { terrain, faces: 2, parts: PartName::ALL.map(part).to_vec() }
}

/// A folder with the results of both halves of the campaign, where the second one is changed.
fn halves(change: impl FnOnce(&mut Campaign, &mut ShardResult)) -> TempDir {
    let folder = TempDir::new().unwrap();
    let mut change = Some(change);
    for index in 0..2 {
        let shard = Shard { index, count: 2 };
        let mut campaign = campaign();
        let mut result = ShardResult { shard, terrains: shard.terrains(&campaign).map(record).collect() };
        if index == 1 {
            change.take().unwrap()(&mut campaign, &mut result);
        }
        write_sealed(&result_file(folder.path(), shard), &campaign, &result, None).unwrap();
    }
    folder
}

/// The error of merging the halves, and whether a resumed run would take the second one for its own.
fn refusal(change: impl FnOnce(&mut Campaign, &mut ShardResult)) -> String {
    let folder = halves(change);
    let error = merge(&[folder.path().to_path_buf()], COMMIT).expect_err("a merge of damaged halves");
    assert!(!has_result(&campaign(), Shard { index: 1, count: 2 }, folder.path()), "{error}");
    let error = error.to_string();
    assert!(error.len() < 1500, "{error}");
    error
}

#[test]
fn undamaged_halves_are_merged() {
    let folder = halves(|_, _| {});
    let merged = merge(&[folder.path().to_path_buf()], COMMIT).unwrap();
    assert_eq!(merged.terrains, (0..4).map(record).collect::<Vec<_>>());
    assert!(has_result(&campaign(), Shard { index: 1, count: 2 }, folder.path()));
}

#[test]
fn numbers_that_no_campaign_has_are_refused() {
    for count in [0, 1_000_000_000_000, u64::MAX] {
        assert!(refusal(|_, result| result.shard.count = count).contains("shards"), "{count}");
    }
    for index in [2, u64::MAX] {
        assert!(refusal(|_, result| result.shard.index = index).contains("index"), "{index}");
    }
    for terrains in [0, 1_000_001, 1_000_000_000_000, u64::MAX] {
        assert!(refusal(|campaign, _| campaign.terrains = terrains).contains("terrains"), "{terrains}");
    }
    // A campaign that could be, and is not the one of the first half.
    assert!(refusal(|campaign, _| campaign.seed = 6).contains("seed 6"));
}

#[test]
fn records_of_another_program_are_refused() {
    assert!(refusal(|campaign, _| campaign.version = "9.9.9".into()).contains("version 9.9.9"));
    assert!(refusal(|campaign, _| campaign.commit = Some("fedc987".into())).contains("commit fedc987"));
    assert!(refusal(|campaign, _| campaign.commit = None).contains("commit 0123abc"));
    assert!(refusal(|campaign, _| campaign.cases = "0".repeat(64)).contains("scenes 00000000"));
    // All of one other commit: they fit together, and not to this program.
    let folder = halves(|_, _| {});
    let error = merge(&[folder.path().to_path_buf()], Some("fedc987")).unwrap_err().to_string();
    assert!(error.contains("commit 0123abc") && error.contains("commit fedc987"), "{error}");
}

/// A change of the first scene of the second half's first terrain.
fn part_refusal(change: impl FnOnce(&mut PartRecord)) -> String {
    refusal(|_, result| change(&mut result.terrains[0].parts[0]))
}

#[test]
fn counts_that_do_not_fit_together_are_refused() {
    assert!(part_refusal(|part| part.compared = 61).contains("61 rays compared, and 60 in all classes"));
    assert!(part_refusal(|part| part.by_class = [u64::MAX, 0, 0, 0, 0, 0]).contains("a count of"));
    assert!(part_refusal(|part| part.by_class[0] = 49).contains("59 in all classes"));
    assert!(part_refusal(|part| part.hits = 65).contains("65 hits of 64 rays"));
    assert!(part_refusal(|part| part.hits = u64::MAX).contains("a count of"));
    assert!(part_refusal(|part| part.not_compared = 1 << 62).contains("a count of"));
    assert!(part_refusal(|part| part.judged = 1 << 62).contains("a count of"));
    assert!(part_refusal(|part| part.quantities[0].by_class[5] = 1 << 62).contains("a count of"));
    assert!(part_refusal(|part| part.quantities[0].not_compared = 1 << 62).contains("a count of"));
    assert!(part_refusal(|part| part.quantities.push(part.quantities[0].clone())).contains("again"));
    assert!(part_refusal(|part| part.wrong.clear()).contains("2 wrong rays, of which 0"));
    assert!(part_refusal(|part| part.wrong = vec![part.wrong[0].clone(); 3]).contains("of which 3"));
    let many = 2 * MAX_DESCRIBED_RAYS;
    assert!(
        part_refusal(|part| {
            part.by_class[Class::Agree as usize] -= 40;
            part.by_class[Class::Defect as usize] += 40;
            part.wrong = vec![part.wrong[0].clone(); many];
        })
        .contains("of which 20")
    );
    assert!(part_refusal(|part| part.wrong[0].what = "x".repeat(1 << 15)).contains("a text of"));
    assert!(part_refusal(|part| part.failed = Some("x".repeat(1 << 15))).contains("a text of"));
    // Reports make commands for a shell of a sensor's name.
    for name in ["", "Camera", "beam-", "beam--1", "beam-01", "beam-0; reboot", "beam-99999999999999999999"] {
        assert!(part_refusal(|part| part.wrong[0].sensor = name.into()).contains("a sensor"), "{name}");
        let of_worst = |part: &mut PartRecord| {
            part.quantities[0].worst_error.as_mut().unwrap().sensor = name.into();
        };
        assert!(part_refusal(of_worst).contains("a sensor"), "{name}");
    }
    let below_zero = |part: &mut PartRecord| {
        part.quantities[0].worst_error.as_mut().unwrap().value = Some(-1e-300);
    };
    assert!(part_refusal(below_zero).contains("below 0"));
    assert!(part_refusal(|part| part.part = PartName::Lattice).contains("lattice, paper"));
    assert!(refusal(|_, result| result.terrains[0].faces = u64::MAX).contains("faces"));
    assert!(
        refusal(|_, result| _ = result.terrains[0].parts.pop()).contains("own, paper, aimed in place of")
    );
    assert!(refusal(|_, result| result.terrains[0].parts.push(record(1).parts[0].clone())).contains("own"));
    assert!(refusal(|_, result| result.terrains[0].terrain = 3).contains("exactly the terrains"));
    assert!(refusal(|_, result| _ = result.terrains.pop()).contains("exactly the terrains"));
}

#[test]
fn any_flipped_bit_of_a_record_makes_its_terrain_run_again() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("terrain-000003.json");
    write_sealed(&file, &campaign(), &record(3), Some(&this())).unwrap();
    let clean = std::fs::read(&file).unwrap();
    let read = || earlier_record(&file, &campaign(), 3).map(|(record, _)| record);
    assert_eq!(read().unwrap(), Some(record(3)));
    for at in 0..clean.len() {
        // Each bit of a byte takes its turn.
        let bit = at % 8;
        let mut damaged = clean.clone();
        damaged[at] ^= 1 << bit;
        std::fs::write(&file, &damaged).unwrap();
        // Damaged, or white space in place of other white space.
        let found = read().unwrap_or_else(|error| panic!("bit {bit} of byte {at}: {error}"));
        assert!(found.is_none() || found == Some(record(3)), "bit {bit} of byte {at}");
    }
    for length in (0..clean.len() - 1).step_by(7) {
        std::fs::write(&file, &clean[..length]).unwrap();
        assert_eq!(read().unwrap(), None, "{length} bytes");
    }
    // Whole, and of another terrain; of another campaign.
    write_sealed(&file, &campaign(), &record(2), Some(&this())).unwrap();
    assert_eq!(read().unwrap(), None);
    write_sealed(&file, &Campaign::new(6, 4).of_commit(COMMIT), &record(3), Some(&this())).unwrap();
    assert!(read().unwrap_err().to_string().contains("seed 6"));
}

#[test]
fn every_digit_of_a_seal_counts_and_what_made_a_record_is_under_it() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("terrain-000003.json");
    write_sealed(&file, &campaign(), &record(3), Some(&this())).unwrap();
    let clean: serde_json::Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    let read = |changed: &serde_json::Value| {
        std::fs::write(&file, changed.to_string()).unwrap();
        earlier_record(&file, &campaign(), 3).unwrap().0
    };
    assert_eq!(read(&clean), Some(record(3)));
    for digit in 0..64 {
        let mut changed = clean.clone();
        let mut digits: Vec<char> = clean["sha256"].as_str().unwrap().chars().collect();
        digits[digit] = if digits[digit] == '0' { '1' } else { '0' };
        changed["sha256"] = digits.into_iter().collect::<String>().into();
        assert_eq!(read(&changed), None, "digit {digit}");
    }
    // Each part that stands beside the digest, changed without it.
    let left = serde_json::json!([{ "name": "wrong/terrain-000003-own.toml", "sha256": "0".repeat(64) }]);
    let parts: [(&str, &str, serde_json::Value); 4] = [
        ("made", "program", "f".repeat(64).into()),
        ("made", "left", left),
        ("contents", "faces", 3.into()),
        ("campaign", "max_faces", 2.into()),
    ];
    for (part, key, value) in parts {
        let mut changed = clean.clone();
        changed[part][key] = value;
        assert_ne!(changed, clean, "{part}.{key}");
        assert_eq!(read(&changed), None, "{part}.{key}");
    }
}

#[test]
fn a_record_is_kept_while_all_that_decides_it_is_the_same() {
    let asked = || campaign().hunting("true {pack} {out}").unwrap();
    let of_asked = |terrain: u64| {
        let mut record = record(terrain);
        record.parts.retain(|part| part.part != PartName::Paper);
        record
    };
    let kept = |own: Campaign, now: &Campaign| {
        checked_record((own, of_asked(3)), Path::new("a.json"), now, 3).unwrap() == Some(of_asked(3))
    };
    assert!(kept(asked(), &asked()));
    let other_file = |sha256: &str| InputFile { name: "program".into(), sha256: sha256.repeat(64) };
    let changes: [fn(&mut Campaign); 4] = [
        |campaign| campaign.candidate_ms = Some(1500),
        |campaign| campaign.partial = true,
        |campaign| campaign.arithmetic = Some(raypencil_pack::Arithmetic::F32),
        |campaign| campaign.candidate_ms = Some(1_800_001),
    ];
    for (number, change) in changes.into_iter().enumerate() {
        let mut changed = asked();
        change(&mut changed);
        assert!(!kept(asked(), &changed) && !kept(changed.clone(), &asked()), "{number}");
        assert!(kept(changed.clone(), &changed), "{number}");
    }
    let with = |sha256: &str| Campaign { candidate_files: vec![other_file(sha256)], ..asked() };
    assert!(kept(with("a"), &with("a")) && !kept(with("a"), &with("b")) && !kept(with("a"), &asked()));
    // Half an hour is what it has where nothing is said.
    assert!(kept(Campaign { candidate_ms: Some(1_800_000), ..asked() }, &asked()));
}

#[test]
fn parts_of_two_divisions_are_not_one_campaign() {
    let folder = TempDir::new().unwrap();
    let write = |index, count| {
        let shard = Shard { index, count };
        let terrains = shard.terrains(&campaign()).map(record).collect();
        write_sealed(&result_file(folder.path(), shard), &campaign(), &ShardResult { shard, terrains }, None)
            .unwrap();
    };
    // All terrains are there: 0 and 2 of the halves, 1 and 3 of the quarters.
    write(0, 2);
    write(1, 4);
    write(3, 4);
    let error = merge(&[folder.path().to_path_buf()], COMMIT).unwrap_err().to_string();
    assert!(error.contains("in 4 shards; expected") && error.contains("in 2 shards, as in"), "{error}");
}

#[test]
fn counts_at_their_limits_are_taken() {
    let mut full = record(0);
    let part = &mut full.parts[0];
    part.by_class[Class::Agree as usize] -= MAX_DESCRIBED_RAYS as u64;
    part.by_class[Class::Defect as usize] += MAX_DESCRIBED_RAYS as u64;
    part.wrong = vec![part.wrong[0].clone(); MAX_DESCRIBED_RAYS];
    part.hits = part.compared + part.not_compared;
    assert_eq!(check_record(&full, &campaign()), Ok(()));
    // The largest count, as many reasons as there are sensors, and reasons that explain or break all of their rays.
    let most = 1 << 42;
    let mut large = record(0);
    let part = &mut large.parts[0];
    (part.compared, part.by_class) = (most, [most - 2, 0, 0, 0, 1, 1]);
    let reason = |mistakes: usize, explained: u64, broken: u64| ReasonRecord {
        mistakes: vec!["scaled".to_string(); mistakes],
        clause: "lengths are times 2".into(),
        wrong: 2,
        explained,
        right: 9,
        broken,
    };
    let with = |reasons: Vec<ReasonRecord>| {
        let mut with = large.clone();
        with.parts[0].reasons = reasons;
        check_record(&with, &campaign())
    };
    assert_eq!(with(vec![reason(2, 2, 9); 65]), Ok(()));
    assert!(with(vec![reason(1, 0, 0); 66]).unwrap_err().contains("66 reasons for 2 wrong rays"));
    assert!(with(vec![reason(0, 0, 0)]).unwrap_err().contains("a reason of 0 mistakes"));
    assert!(with(vec![reason(3, 0, 0)]).unwrap_err().contains("a reason of 3 mistakes"));
    assert!(with(vec![reason(1, 3, 0)]).unwrap_err().contains("explains 3 of 2 rays"));
    assert!(with(vec![reason(1, 0, 10)]).unwrap_err().contains("breaks 10 of 9"));
    // Rays of a reason, and the length of its texts.
    let of_rays = |right: u64| with(vec![ReasonRecord { right, ..reason(1, 2, 9) }]);
    assert_eq!(of_rays(most), Ok(()));
    assert!(of_rays(most + 1).unwrap_err().contains("a reason that explains 2 of 2 rays"));
    let of_text = |bytes: usize| with(vec![ReasonRecord { clause: "x".repeat(bytes), ..reason(1, 2, 9) }]);
    assert_eq!(of_text(1 << 14), Ok(()));
    assert!(of_text((1 << 14) + 1).unwrap_err().contains("a text of 16385 bytes"));
    // A ground, a text and a largest value at their limits, and two quantities in their order.
    let mut other = record(0);
    other.faces = most;
    let part = &mut other.parts[0];
    part.wrong[0].what = "x".repeat(1 << 14);
    part.quantities[0].worst_error.as_mut().unwrap().value = Some(0.0);
    part.quantities.push(part.quantities[0].clone());
    (part.quantities[0].quantity, part.quantities[1].quantity) = (Quantity::ALL[0], Quantity::ALL[1]);
    assert_eq!(check_record(&other, &campaign()), Ok(()));
    // A scene without a wrong ray has no reason.
    let mut right = record(0);
    let part = &mut right.parts[0];
    (part.by_class, part.wrong) = ([52, 3, 2, 3, 0, 0], Vec::new());
    assert_eq!(check_record(&right, &campaign()), Ok(()));
    right.parts[0].reasons = vec![reason(1, 2, 9)];
    assert!(check_record(&right, &campaign()).unwrap_err().contains("1 reasons for 0 wrong rays"));
    // As many terrains as a campaign may have, and the last of them.
    let large = Campaign::new(5, crate::plan::MAX_TERRAINS);
    assert!(large.clone().checked(None).is_ok());
    assert!(Campaign { terrains: crate::plan::MAX_TERRAINS + 1, ..large.clone() }.checked(None).is_err());
    assert!(Campaign { terrains: 1, ..large }.checked(None).is_ok());
    assert_eq!(check_record(&record(3), &campaign()), Ok(()));
    assert!(check_record(&record(4), &campaign()).unwrap_err().contains("terrain 4: there are 4 terrains"));
    // A ground of as many faces as --max-faces is small enough; of one more nothing but its lattice is run.
    let bounded = Campaign { max_faces: Some(7), ..campaign() };
    assert!(bounded.parts_of(7).eq(PartName::ALL));
    assert!(bounded.parts_of(8).eq([PartName::Lattice]));
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_not_waited_for() {
    let folder = TempDir::new().unwrap();
    let file = result_file(folder.path(), Shard { index: 0, count: 2 });
    let is_refused = |words: &str| {
        let error = merge(&[folder.path().to_path_buf()], COMMIT).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
        assert_eq!(earlier_record(&file, &campaign(), 3).unwrap(), (None, None));
    };
    let made = std::process::Command::new("mkfifo").arg(&file).status().unwrap();
    assert!(made.success());
    is_refused("not a regular file");
    std::fs::remove_file(&file).unwrap();
    std::os::unix::fs::symlink("/dev/zero", &file).unwrap();
    is_refused("not a regular file");
    std::fs::remove_file(&file).unwrap();
    // Sparse: it takes no room on the disk.
    std::fs::File::create(&file).unwrap().set_len(4 << 30).unwrap();
    is_refused("larger than");
    std::fs::remove_file(&file).unwrap();
    std::fs::create_dir(&file).unwrap();
    is_refused("not a regular file");
    std::fs::remove_dir(&file).unwrap();
    std::os::unix::fs::symlink("nowhere", &file).unwrap();
    is_refused("cannot read");
}

#[test]
fn a_shard_that_is_none_is_not_run() {
    struct Silence;
    impl CampaignProgress for Silence {
        fn done(&self, _: u64, _: u64, _: u64) {}
    }
    let folder = TempDir::new().unwrap();
    let run = |campaign: &Campaign, shard| run_shard(campaign, shard, folder.path(), &Silence).unwrap_err();
    assert!(run(&campaign(), Shard { index: 0, count: 0 }).to_string().contains("shards"));
    assert!(run(&campaign(), Shard { index: 2, count: 2 }).to_string().contains("index"));
    let endless = Campaign { terrains: u64::MAX, ..campaign() };
    assert!(run(&endless, Shard::WHOLE).to_string().contains("terrains"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn missing_shards_are_named_from_1_and_many_are_counted() {
    let missing = |given: &[u64], count: u64| {
        let folder = TempDir::new().unwrap();
        for &index in given {
            let shard = Shard { index, count };
            let terrains = shard.terrains(&campaign()).map(record).collect();
            let result = ShardResult { shard, terrains };
            write_sealed(&result_file(folder.path(), shard), &campaign(), &result, None).unwrap();
        }
        merge(&[folder.path().to_path_buf()], COMMIT).unwrap_err().to_string()
    };
    let some = missing(&[0, 2], 4);
    assert!(some.contains("no shard 2, 4 of 4; expected all of them"), "{some}");
    // Twenty of 24 are named.
    let many = missing(&[0], 25);
    assert!(many.contains("no shard 2, 3, ") && many.contains(", 20, 21 and 4 others of 25"), "{many}");
    let all = missing(&[0], 21);
    assert!(all.contains(", 20, 21 of 21"), "{all}");
}

#[test]
fn a_result_by_the_name_of_another_shard_is_not_that_shard_s() {
    let folder = halves(|_, _| {});
    let [first, second] = [0, 1].map(|index| Shard { index, count: 2 });
    assert!(has_result(&campaign(), first, folder.path()) && has_result(&campaign(), second, folder.path()));
    std::fs::copy(result_file(folder.path(), first), result_file(folder.path(), second)).unwrap();
    assert!(!has_result(&campaign(), second, folder.path()));
}

#[test]
fn a_scene_of_one_s_own_is_probed_where_it_lies_and_an_aimed_one_where_it_is_written() {
    let folder = TempDir::new().unwrap();
    let scene = folder.path().join("a.toml");
    std::fs::write(&scene, "version = 1\n").unwrap();
    let own = campaign().over(crate::OwnScenes::read(folder.path(), None).unwrap());
    assert_eq!(own.arguments(0, PartName::Own), scene.display().to_string());
    assert_eq!(own.arguments(0, PartName::Aimed), "scene.toml");
    assert_eq!(campaign().arguments(0, PartName::Own), "scene.toml");
}

#[test]
fn a_campaign_goes_on_in_its_folder_after_its_rig_changed() {
    let folder = TempDir::new().unwrap();
    let (scenes, rig) = (folder.path().join("scenes"), folder.path().join("rig.toml"));
    std::fs::create_dir(&scenes).unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(scenes.join("a.obj"), obj).unwrap();
    let with = |text: &str| {
        std::fs::write(&rig, text).unwrap();
        campaign().over(crate::OwnScenes::read(&scenes, Some(&rig)).unwrap())
    };
    let before = with("version = 1\n");
    let after = with("version = 1\ncamera = { width_px = 9 }\n");
    // It is the same plan, whose terrains are run again.
    assert!(before.is_planned_as(&after) && !before.has_same_files(&after, 0));
    let other = campaign().over(crate::OwnScenes::read(&scenes, None).unwrap());
    assert!(!before.is_planned_as(&other));
}
