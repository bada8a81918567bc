//! The packs that are published with raypencil, by the digest of the whole: that of `manifest.json`, which has the digest of
//! every other file. Who changes an answer and writes all digests anew makes another pack, and its name does not hide that.

use raypencil_files::Fault;

/// Most characters of a pack's own version.
const MAX_VERSION_CHARS: usize = 32;

/// Most characters of a licence's SPDX expression.
const MAX_LICENCE_CHARS: usize = 100;

/// Version and licence of a pack, which are not those of the program that wrote it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PackLabel {
    /// Version, such as `1.0.0`.
    pub version: Option<String>,
    /// Licence as an SPDX expression, such as `CC0-1.0`.
    pub licence: Option<String>,
}

impl PackLabel {
    /// A pack without a version or a licence of its own.
    pub const NONE: Self = Self { version: None, licence: None };

    /// Refuses what is no version and no SPDX expression.
    ///
    /// # Errors
    /// Names the key, what was found and what was expected.
    pub fn check(&self) -> Result<(), Fault> {
        let is_version = |text: &str| {
            let allowed = |c: char| c.is_ascii_alphanumeric() || ".+-".contains(c);
            text.starts_with(|c: char| c.is_ascii_digit())
                && text.len() <= MAX_VERSION_CHARS
                && text.chars().all(allowed)
        };
        if let Some(version) = self.version.as_deref().filter(|version| !is_version(version)) {
            return Err(Fault::new("version", shown(version), "digits and points, such as 1.0.0"));
        }
        let is_licence = |text: &str| {
            let allowed = |c: char| c.is_ascii_alphanumeric() || ".+-() ".contains(c);
            text.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '(')
                && text.len() <= MAX_LICENCE_CHARS
                && text.chars().all(allowed)
        };
        match self.licence.as_deref().filter(|licence| !is_licence(licence)) {
            Some(licence) => {
                Err(Fault::new("licence", shown(licence), "an SPDX expression, such as CC0-1.0"))
            }
            None => Ok(()),
        }
    }
}

/// The beginning of a text, in quotes.
fn shown(text: &str) -> String {
    format!("{:?}", text.chars().take(MAX_LICENCE_CHARS).collect::<String>())
}

/// A pack that is published with this version of raypencil.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PublishedPack {
    /// Name of its scene.
    pub name: &'static str,
    /// Version of the pack.
    pub version: &'static str,
    /// SHA-256 of its `manifest.json`, in hexadecimal digits.
    pub sha256: &'static str,
}

/// The packs with answers to a scene that are or were in `data/packs`, the present ones first; `data/packs/SHA256SUMS` has their
/// digests, for `sha256sum -c`.
pub const PUBLISHED: [PublishedPack; 6] = [
    PublishedPack {
        name: "pyramids",
        version: "2.0.0",
        sha256: "4e3e7a2c28322e9189290f48b6c794324311d1ddfe0c56db0f6fc9645775eadf",
    },
    PublishedPack {
        name: "facets",
        version: "2.0.0",
        sha256: "6bf73fca05ccfd05c72ed5cdfadac0bb8778c4c5aeed7427dc72c215e4c71236",
    },
    PublishedPack {
        name: "hard",
        version: "2.0.0",
        sha256: "f49c81680319b09f8d948aec26a4a863057454a83f05fdf27fb3ca38f2f2d9d8",
    },
    PublishedPack {
        name: "pyramids",
        version: "1.0.0",
        sha256: "a794d21ee0499c48b9b05ebee00b5df19bdf2961b82aae534a124df8e6ed2868",
    },
    PublishedPack {
        name: "facets",
        version: "1.0.0",
        sha256: "036e4f89f95af504a28d3628e2c0f502aa0b583fcbbdc4d657d901a34f8a30c0",
    },
    PublishedPack {
        name: "hard",
        version: "1.0.0",
        sha256: "3ce67bdc74936589988cc77344512af3f58628b33509623ac23680fe0d7f3545",
    },
];

/// Which pack it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackIdentity {
    /// SHA-256 of its `manifest.json`, in hexadecimal digits.
    pub sha256: String,
    /// Version and licence, by its own word.
    pub label: PackLabel,
    /// The published pack of the name that it has: of its version, if there is one, else the present one.
    pub of_that_name: Option<PublishedPack>,
}

impl PackIdentity {
    /// The identity of a pack by the digest of its manifest, and what the manifest says.
    pub(crate) fn new(sha256: String, name: &str, label: PackLabel) -> Self {
        let of_name = || PUBLISHED.into_iter().filter(|published| published.name == name);
        let of_version = |one: &PublishedPack| label.version.as_deref() == Some(one.version);
        // An earlier one that is still in use is known as well.
        let of_that_name = of_name().find(|one| one.sha256 == sha256);
        let of_that_name = of_that_name.or_else(|| of_name().find(of_version)).or_else(|| of_name().next());
        Self { sha256, label, of_that_name }
    }

    /// Whether it is the published pack of its name.
    pub fn is_published(&self) -> bool {
        self.of_that_name.is_some_and(|published| published.sha256 == self.sha256)
    }

    /// Which pack it is, in words that a sentence goes on with.
    pub fn words(&self) -> String {
        let short: String = self.sha256.chars().take(12).collect();
        match self.of_that_name {
            Some(PublishedPack { name, version, .. }) if self.is_published() => {
                format!("{name} {version}, as it is published")
            }
            Some(PublishedPack { name, version, .. }) => {
                format!("sha256 {short}..., which is not that of {name} {version} as it is published")
            }
            None => format!("sha256 {short}..."),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_a_version_and_an_spdx_expression() {
        let label = |version: &str, licence: &str| PackLabel {
            version: Some(version.into()),
            licence: Some(licence.into()),
        };
        for (version, licence) in
            [("1", "CC0-1.0"), ("1.0.0-rc.1+2", "(MIT OR Apache-2.0) AND CC-BY-4.0"), ("2026.11", "MIT")]
        {
            assert_eq!(label(version, licence).check(), Ok(()));
        }
        assert_eq!(PackLabel::NONE.check(), Ok(()));
        for (version, licence, place) in [
            ("", "MIT", "version"),
            ("one", "MIT", "version"),
            ("1\u{1b}[31m", "MIT", "version"),
            ("1.0.0.0.0.0.0.0.0.0.0.0.0.0.0.0.0.0", "MIT", "version"),
            ("1", "", "licence"),
            ("1", "MIT\nforged line", "licence"),
            ("1", &"M".repeat(101), "licence"),
        ] {
            let fault = label(version, licence).check().unwrap_err();
            assert!(fault.to_string().starts_with(place), "{fault}");
        }
    }

    #[test]
    fn a_version_and_a_licence_have_as_many_characters_as_there_is_room_for() {
        for (room, place) in [(MAX_VERSION_CHARS, "version"), (MAX_LICENCE_CHARS, "licence")] {
            let label = |length: usize| {
                let text = Some("1".repeat(length));
                match place {
                    "version" => PackLabel { version: text, licence: None },
                    _ => PackLabel { version: None, licence: text },
                }
            };
            assert_eq!(label(room).check(), Ok(()), "{place}");
            assert!(label(room + 1).check().is_err(), "{place}");
        }
    }

    #[test]
    fn every_digit_of_a_published_digest_counts() {
        for published in PUBLISHED {
            for digit in 0..64 {
                let mut digits: Vec<char> = published.sha256.chars().collect();
                digits[digit] = if digits[digit] == '0' { '1' } else { '0' };
                let forged = PackIdentity::new(digits.into_iter().collect(), published.name, PackLabel::NONE);
                assert!(!forged.is_published(), "{} {}, digit {digit}", published.name, published.version);
                assert!(forged.words().contains("which is not that of"), "{}", forged.words());
            }
        }
    }

    #[test]
    fn a_pack_of_a_published_name_with_another_digest_is_told_apart() {
        let published = PUBLISHED[0];
        let own = PackIdentity::new(published.sha256.into(), published.name, PackLabel::NONE);
        assert!(own.is_published());
        assert_eq!(own.words(), "pyramids 2.0.0, as it is published");
        let forged = PackIdentity::new("0".repeat(64), published.name, PackLabel::NONE);
        assert!(!forged.is_published());
        assert_eq!(
            forged.words(),
            "sha256 000000000000..., which is not that of pyramids 2.0.0 as it is published"
        );
        // The digest alone, under another name, is no published pack either: the digest is of a file that has the name.
        let other = PackIdentity::new("0".repeat(64), "yard", PackLabel::NONE);
        assert_eq!((other.is_published(), other.words().as_str()), (false, "sha256 000000000000..."));
    }
}
