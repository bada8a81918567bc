//! One public type for each noun that all crates speak. A second one would be a second house: what is mended in one is
//! forgotten in the other.

use std::collections::BTreeMap;

use super::source::{crates, is_for_tests, sources};

/// A noun: the last word of a type's name.
struct Noun {
    word: &'static str,
    /// The one type that has it.
    one: &'static str,
    /// Types that are of another kind, with what they are.
    others: &'static [(&'static str, &'static str)],
}

const NOUNS: [Noun; 6] = [
    Noun {
        word: "Ruling",
        one: "referee::Ruling",
        others: &[
            ("referee::VisibilityRuling", "the two rulings on one answer about the camera's view"),
            ("diff::ChannelRuling", "what thresholds of a user allow in a channel of two files"),
        ],
    },
    Noun {
        word: "Margin",
        one: "referee::Margin",
        others: &[("judge::DefectMargin", "which of its margins a wrong ray shows")],
    },
    Noun {
        word: "Margins",
        one: "referee::Margins",
        others: &[
            ("referee::VisibilityMargins", "what may change of the camera's view of a point"),
            ("explorer::RayMargins", "the lower ends of a sensor's margins, as a page has them"),
            ("rover::ErrorMargins", "how far a map's errors move a test of an obstacle"),
        ],
    },
    Noun { word: "Mistake", one: "diagnosis::Mistake", others: &[] },
    Noun { word: "Manifest", one: "pack::Manifest", others: &[] },
    Noun {
        word: "Candidate",
        one: "harness::Candidate",
        others: &[
            ("harness::ProbedCandidate", "what it answers to one ray"),
            ("harness::JudgedCandidate", "what became of it on one scene"),
        ],
    },
];

/// The last word of a name in camel case.
fn last_word(name: &str) -> &str {
    &name[name.rfind(char::is_uppercase).unwrap_or(0)..]
}

fn list(of: &str, items: &[syn::Item], found: &mut BTreeMap<String, Vec<String>>) {
    for item in items {
        let (visibility, name) = match item {
            syn::Item::Struct(item) => (&item.vis, &item.ident),
            syn::Item::Enum(item) => (&item.vis, &item.ident),
            syn::Item::Type(item) => (&item.vis, &item.ident),
            syn::Item::Mod(item) if !is_for_tests(&item.attrs) => {
                if let Some((_, items)) = &item.content {
                    list(of, items, found);
                }
                continue;
            }
            _ => continue,
        };
        let name = name.to_string();
        if matches!(visibility, syn::Visibility::Public(_)) {
            found.entry(last_word(&name).to_string()).or_default().push(format!("{of}::{name}"));
        }
    }
}

#[test]
fn each_noun_has_one_type() {
    let mut found = BTreeMap::new();
    for name in crates().into_keys() {
        for (_, file) in sources(&name) {
            list(name.trim_start_matches("raypencil-"), &file.items, &mut found);
        }
    }
    for Noun { word, one, others } in NOUNS {
        let mut expected = vec![one.to_string()];
        expected.extend(others.iter().map(|(name, _)| name.to_string()));
        let mut there = found.remove(word).unwrap_or_default();
        expected.sort();
        there.sort();
        assert_eq!(there, expected, "types named {word}: use {one}, or say here what the other is");
    }
}

#[test]
fn the_last_word_of_a_name_is_its_noun() {
    assert_eq!(["Ruling", "CastRuling", "RulingOf"].map(last_word), ["Ruling", "Ruling", "Of"]);
}
