//! Test results of a campaign: a case for each scene of each terrain, and two of the whole.

use raypencil_campaign::{PartName, campaign_document};
use raypencil_judge::Class;

use super::summary::{made_up, with_hits, wrong_ray};

#[test]
fn a_wrong_ray_of_any_scene_fails_its_own_case_and_stands_on_the_screen() {
    for (index, part) in PartName::ALL.into_iter().enumerate() {
        for class in [Class::Undecided, Class::Defect] {
            let mut merged = made_up([1000, 0, 0, 0, 0, 0], Vec::new());
            let record = &mut merged.terrains[1].parts[index];
            record.by_class[Class::Agree as usize] -= 1;
            record.by_class[class as usize] += 1;
            record.wrong = vec![wrong_ray()];
            assert!(!merged.passes());
            let document = campaign_document(&merged, |_| false);
            let junit = document.junit().unwrap();
            assert_eq!(junit.matches("<failure").count(), 1, "{junit}");
            let suite = format!("campaign of seed 5: {}\"", part.word());
            let suite = junit.split("<testsuite ").find(|text| text.contains(&suite)).expect("a suite");
            let (before, message) = suite.split_once("<failure").expect("its failure");
            assert!(before.trim_end().ends_with("<testcase name=\"terrain 1\">"), "{suite}");
            assert!(
                message.contains("\"1 of 1,000 rays are wrong or undecided\"")
                    && message.contains("beam-0 3,1, range")
            );
            let (screen, place) = (document.screen(), format!("terrain 1 {}, beam-0 3,1", part.word()));
            assert!(
                screen.contains("1 of 8,000 rays are wrong or undecided") && screen.contains(&place),
                "{screen}"
            );
        }
    }
}

#[test]
fn a_campaign_that_compares_or_hits_nothing_has_a_case_that_fails() {
    let whole = |hits: u64, by_class: [u64; 6]| {
        let junit = campaign_document(&with_hits(hits, by_class, Vec::new()), |_| false).junit().unwrap();
        let suite =
            junit.split("<testsuite ").find(|text| text.starts_with("name=\"campaign\"")).expect("a suite");
        let of = |name: &str| {
            let (_, case) = suite.split_once(&format!("<testcase name=\"{name}\"")).expect(name);
            case.split("<testcase").next().unwrap().contains("<failure")
        };
        [of("something is compared"), of("something is hit")]
    };
    assert_eq!(whole(500, [1000, 0, 0, 0, 0, 0]), [false, false]);
    assert_eq!(whole(0, [1000, 0, 0, 0, 0, 0]), [false, true]);
    assert_eq!(whole(0, [0; 6]), [true, true]);
}
