//! Modules of the example `truth`, which makes the tables of `docs/evidence/results.md`. Examples run no tests of their own.

#[path = "../../../../crates/doors/raypencil/examples/truth/noise_level.rs"]
mod noise_level;
#[path = "../../../../crates/doors/raypencil/examples/truth/pointing.rs"]
mod pointing;
#[path = "../../../../crates/doors/raypencil/examples/truth/sector_table.rs"]
mod sector_table;
#[path = "../../../../crates/doors/raypencil/examples/truth/sensitivity.rs"]
mod sensitivity;

mod blur_and_pitch;

use raypencil::drive::{DriveJob, Missed, NotFound, SectorTruth};
use raypencil::io::{Overrides, load};

use noise_level::NoiseLevel;

fn job(name: &str) -> DriveJob {
    let loaded = load(name, &Overrides::default()).unwrap();
    DriveJob::new(&loaded, None, name.into()).unwrap()
}

#[test]
fn noise_levels_are_plans_that_can_be_driven() {
    let job = job("pyramids");
    for level in [NoiseLevel::None, NoiseLevel::Modest, NoiseLevel::Coarse] {
        let noisy = level.applied(job.clone());
        noisy.plan.validate("drive").unwrap();
        // 1 % of the distance at 0.3 m/s is 3 mm per second.
        let drift = noisy.plan.errors.position_drift.length();
        let expected = [0.0, 0.003, 0.012][level as usize];
        assert!((drift - expected).abs() < 1e-15, "{}", level.word());
    }
    assert_eq!(NoiseLevel::None.applied(job.clone()).plan, job.plan);
}

#[test]
fn a_row_names_each_count_in_its_column() {
    let truth = SectorTruth {
        sectors: 20_000,
        found: 3_985,
        missed: Missed { by_errors: 12, by_spacing: 2, by_rule: 1 },
        not_found: NotFound { hidden: 3, in_part: 1, not_swept: 3, outside: 5 },
        false_obstacle: 9,
        unknown_not_measured: 30,
        unknown_beyond_map: 7,
        unknown_may_hide: 40,
        unknown_near_limit: 50,
        clear: 60,
        clear_mm: 58_250_000,
        ..SectorTruth::default()
    };
    let missed = Missed { by_rule: 2, ..Missed::default() };
    let bound = SectorTruth {
        sectors: 20_000,
        found: 4_000,
        missed,
        false_obstacle: 1,
        clear_mm: 60_000_000,
        ..SectorTruth::default()
    };
    // 15 of 4,000 are 0.375 %; 9 of 20,000 are 0.045 %. 58,250 m in 20,000 sectors are 2.9125 m each.
    assert_eq!(
        sector_table::row(&truth, &bound, "pyramids", "mended"),
        "| pyramids | mended | 20,000 | 3,985 | 27 | 15 = 12 + 2 + 1 (0.4 %) | 3 + 4 + 5 | 9 (< 0.1 %) | 37 + 40 + 50 | 60 | 2.91 m | 4,000, 2, 1, 3.00 m |"
    );
    assert_eq!(
        sector_table::HEAD.lines().map(|line| line.matches('|').count()).collect::<Vec<_>>(),
        [13, 13]
    );
}

#[test]
fn none_is_0_percent_and_only_all_is_100() {
    let share = |found, by_rule| {
        let missed = Missed { by_rule, ..Missed::default() };
        let truth = SectorTruth { found, missed, ..SectorTruth::default() };
        let row = sector_table::row(&truth, &SectorTruth::default(), "", "");
        row.split(['(', ')']).nth(1).unwrap().to_string()
    };
    assert_eq!(
        [(7, 0), (0, 7), (1, 9_999), (1, 199), (84, 16), (0, 0)].map(|(found, missed)| share(found, missed)),
        ["0 %", "100 %", "99.9 %", "99.5 %", "16 %", "0 %"]
    );
}
