//! The summary of a campaign keeps to its schema.

use raypencil_campaign::{Campaign, Merged, WrongRay, campaign_json, terrain};
use raypencil_judge::Quantity;
use raypencil_tests::schema::schema_faults;
use serde_json::Value;

#[test]
fn the_summary_keeps_to_its_schema() {
    let campaign = Campaign::new(5, 1);
    let mut record = terrain(&campaign, 0, None).unwrap();
    record.parts[0].wrong.push(WrongRay {
        sensor: "beam-0".into(),
        i: 3,
        j: 1,
        quantity: Quantity::Range,
        what: "1 m and 2 m".into(),
    });
    let merged = Merged { campaign, terrains: vec![record] };
    let schema: Value =
        serde_json::from_str(include_str!("../../../docs/formats/campaign.schema.json")).unwrap();
    let mut summary: Value = serde_json::from_str(&campaign_json(&merged)).unwrap();
    assert_eq!(schema_faults(&schema, &summary), [""; 0]);
    // The schema is no sieve: a key that is not there and one that should not be are both found.
    let total = summary["parts"]["own"].as_object_mut().unwrap();
    total.remove("judged");
    total.insert("surplus".into(), Value::Null);
    assert_eq!(schema_faults(&schema, &summary).len(), 2);
}
