//! Hostile records of a terrain: a campaign that goes on takes none of them for its own.

use std::path::Path;

use raypencil_campaign::Campaign;
use raypencil_campaign::records::record_from_bytes;
use raypencil_tests::malformed::hostile::hostile_record;

#[test]
fn a_terrain_with_a_hostile_record_is_run_again() {
    let campaign = Campaign::new(5, 2);
    let cases = hostile_record(&serde_json::to_value(&campaign).unwrap());
    let (mut good, mut foreign) = (0, 0);
    for (name, bytes, is_good) in &cases {
        match record_from_bytes(bytes, Path::new("any.json"), &campaign, 1) {
            Ok(record) => {
                assert_eq!(record.is_some(), *is_good, "{name}");
                good += usize::from(*is_good);
            }
            // It is whole, and of another campaign: to run that again would lose it.
            Err(error) => {
                let message = error.to_string();
                assert!(!is_good && message.starts_with("any.json: a record of "), "{name}: {message}");
                assert!(message.len() < 1500, "{name}: {} bytes", message.len());
                foreign += 1;
            }
        }
    }
    assert_eq!((cases.len(), good, foreign), (607, 28, 8), "cases, good ones and foreign ones");
}
