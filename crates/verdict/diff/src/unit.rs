//! The unit of a channel, from the attributes of the OpenEXR files that hold it.

use raypencil_files::{Channel, Channels};

/// Attributes that state units, each with the prefix of the channels that it concerns.
const UNIT_ATTRIBUTES: [(&str, &str); 3] = [("fluxUnit", "flux.beam"), ("returnUnit", ""), ("unit", "")];

/// Maximum length of a unit that a file states.
const MAX_UNIT_CHARS: usize = 16;

/// The unit of the channel `key`, from the first file of either side that states it. Empty if no file does, or if the
/// values have no unit.
pub(crate) fn unit_of(sides: [&Channels; 2], key: &str) -> String {
    let name = key.rsplit('/').next().unwrap_or(key);
    for channels in sides {
        let coarser = channels.coarser.iter().filter(|(of, _)| of == key).map(|(_, channel)| channel);
        let files = channels.by_key.get(key).into_iter().chain(coarser);
        let attributes = files.filter_map(|channel: &Channel| channels.attributes.get(&channel.file));
        for attributes in attributes {
            let concerning = UNIT_ATTRIBUTES.iter().filter(|(_, prefix)| name.starts_with(prefix));
            let unit = concerning
                .filter_map(|(attribute, _)| attributes.get(*attribute))
                .find_map(|text| stated_unit(text, name));
            if let Some(unit) = unit {
                return unit;
            }
        }
    }
    String::new()
}

/// The unit of a channel according to a text such as `range, depth, P: metre; N: 1` or `metre`.
fn stated_unit(text: &str, name: &str) -> Option<String> {
    let quantity = name.split('.').next().unwrap_or(name);
    let unit = text.split(';').find_map(|clause| match clause.split_once(':') {
        None => Some(clause),
        Some((names, unit)) => names.split(',').any(|one| one.trim() == quantity).then_some(unit),
    })?;
    Some(match unit.trim() {
        "metre" => "m".into(),
        // Numbers without a unit.
        "1" | "index" | "0 or 1" => String::new(),
        other => other.chars().take(MAX_UNIT_CHARS).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_are_found_by_the_quantity() {
        let text = "range, depth, P: metre; N, incidence: 1; face: index";
        assert_eq!(stated_unit(text, "range.T"), Some("m".into()));
        assert_eq!(stated_unit(text, "P.X"), Some("m".into()));
        assert_eq!(stated_unit(text, "N.X"), Some(String::new()));
        assert_eq!(stated_unit(text, "flux.V"), None);
        assert_eq!(stated_unit("visible: 0 or 1; pixel: index; flux: W/m", "flux.V"), Some("W/m".into()));
        assert_eq!(stated_unit("W per pixel", "flux.beam0"), Some("W per pixel".into()));
        assert_eq!(stated_unit("metre", "anything"), Some("m".into()));
    }
}
