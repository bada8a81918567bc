//! What options take at their limits, and in which unit.

use super::*;

#[test]
fn parts_are_counted_from_one() {
    assert_eq!(shard("1/4"), Ok(Shard { index: 0, count: 4 }));
    assert_eq!(shard(" 4 / 4 "), Ok(Shard { index: 3, count: 4 }));
    assert_eq!(shard(&format!("1/{MAX_SHARDS}")).map(|shard| shard.count), Ok(MAX_SHARDS));
    for text in ["0/4", "5/4", "1/0", "0/0", "1", "1/2/3", "-1/4", &format!("1/{}", MAX_SHARDS + 1)] {
        assert!(shard(text).is_err(), "{text}");
    }
}

#[test]
fn numbers_are_taken_at_their_limits_and_not_beyond() {
    for (text, expected) in [("0", 0.0), ("100", 100.0), ("0.1", 0.1)] {
        assert_eq!(percent(text), Ok(expected));
    }
    for text in ["-0.1", "100.1", "nan", "inf", ""] {
        assert!(percent(text).is_err(), "{text}");
    }
    assert_eq!((metres("1e-9"), metres(" 2 ")), (Ok(1e-9), Ok(2.0)));
    for text in ["0", "-1", "inf", "nan", "1m"] {
        assert!(metres(text).is_err(), "{text}");
    }
    assert_eq!((threshold("0"), threshold("1e-6")), (Ok(0.0), Ok(1e-6)));
    for text in ["-1e-9", "inf", "nan"] {
        assert!(threshold(text).is_err(), "{text}");
    }
    // A time is told in seconds, and kept in milliseconds.
    for (text, expected) in [("0.001", 1), ("1.5", 1500), ("1e9", 1_000_000_000_000)] {
        assert_eq!(seconds(text), Ok(expected), "{text}");
    }
    for text in ["0", "0.0009", "-1", "1.1e9", "nan", "1s"] {
        assert!(seconds(text).is_err(), "{text}");
    }
}

#[test]
fn several_numbers_keep_their_order_and_each_has_its_limit() {
    assert_eq!(window("1200,3400,24,12"), Ok([1200.0, 3400.0, 24.0, 12.0]));
    for text in ["0,0,1,0", "0,0,0,1", "0,0,1,-1", "0,0,-1,1", "0,0,1", "0,0,1,1,1", "0,inf,1,1"] {
        assert!(window(text).is_err(), "{text}");
    }
    assert_eq!(numbers("1, -2,3e1"), Ok([1.0, -2.0, 30.0]));
    assert!(numbers::<3>("1,2").is_err() && numbers::<3>("1,2,3,4").is_err());
    assert_eq!(pair("3, 4"), Ok([3_u32, 4]));
    assert!(pair::<u32>("3").is_err() && pair::<u32>("3,-4").is_err());
    assert_eq!(switch("facing=paper"), Ok(("facing".into(), Fidelity::Paper)));
    assert_eq!(switch("facing=exact"), Ok(("facing".into(), Fidelity::Exact)));
    assert!(switch("facing").is_err());
}
