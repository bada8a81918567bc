//! Fuzz target: any text as a file of a campaign. The first byte chooses whether the text is made one of this program, and
//! whether it is sealed here: without its digest, no changed text would come past the seal.

#![no_main]

use std::path::{Path, PathBuf};

use libfuzzer_sys::fuzz_target;
use raypencil::campaign::records::{merge_bytes, record_from_bytes, sealed};
use raypencil::campaign::{Campaign, campaign_document};
use serde_json::Value;

/// The text, with the version of this program and the digest of its scenes. Another text stays as it is.
fn of_this_program(text: Vec<u8>) -> Vec<u8> {
    let Ok(mut value) = serde_json::from_slice::<Value>(&text) else { return text };
    let Some(campaign) = value.get_mut("campaign").and_then(Value::as_object_mut) else { return text };
    let this = Campaign::new(0, 1);
    campaign.insert("version".into(), this.version.into());
    campaign.insert("cases".into(), this.cases.into());
    value.to_string().into_bytes()
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&choice, text)) = bytes.split_first() else { return };
    let mut text = text.to_vec();
    if choice & 1 == 0 {
        text = of_this_program(text);
    }
    if choice & 2 == 0
        && let Some(again) = sealed(&text)
    {
        text = again.into_bytes();
    }
    let campaign = Campaign::new(5, 4);
    if let Ok(Some(record)) = record_from_bytes(&text, Path::new("any.json"), &campaign, 3) {
        assert_eq!(record.terrain, 3);
    }
    let results = vec![(PathBuf::from("any.json"), text)];
    if let Ok(Some(merged)) = merge_bytes(&results, None) {
        assert!(merged.terrains.iter().map(|one| one.terrain).eq(0..merged.campaign.terrains));
        let document = campaign_document(&merged, |_| false);
        assert!(serde_json::from_str::<Value>(&document.json()).is_ok());
        assert!(!document.screen().is_empty());
        // The same result a second time is a shard too many.
        let twice = [results.clone(), results].concat();
        assert!(merge_bytes(&twice, None).is_err());
    }
});
