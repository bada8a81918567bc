//! The unit of a channel, from the attributes of the OpenEXR files that have it.

use raypencil_files::{Channel, Channels};

/// The attributes that name units, and the start of the channels that each is for.
const ATTRIBUTES: [(&str, &str); 3] = [("fluxUnit", "flux.beam"), ("returnUnit", ""), ("unit", "")];

/// The unit of the channel `key`, from the first file of either side that says one; nothing if none does, or
/// if the values are bare numbers.
pub(super) fn of(sides: [&Channels; 2], key: &str) -> String {
    let name = key.rsplit('/').next().unwrap_or(key);
    for channels in sides {
        let coarser = channels.coarser.iter().filter(|(of, _)| of == key).map(|(_, channel)| channel);
        let files = channels.by_key.get(key).into_iter().chain(coarser);
        let attributes = files.filter_map(|channel: &Channel| channels.attributes.get(&channel.file));
        for attributes in attributes {
            let said = ATTRIBUTES.iter().filter(|(_, start)| name.starts_with(start));
            let unit = said
                .filter_map(|(attribute, _)| attributes.get(*attribute))
                .find_map(|text| said_in(text, name));
            if let Some(unit) = unit {
                return unit;
            }
        }
    }
    String::new()
}

/// What a text such as `range, depth, P: metre; N: 1` or `metre` says of a channel.
fn said_in(text: &str, name: &str) -> Option<String> {
    let quantity = name.split('.').next().unwrap_or(name);
    let unit = text.split(';').find_map(|clause| match clause.split_once(':') {
        None => Some(clause),
        Some((names, unit)) => names.split(',').any(|one| one.trim() == quantity).then_some(unit),
    })?;
    Some(match unit.trim() {
        "metre" => "m".into(),
        // Bare numbers have none.
        "1" | "index" | "0 or 1" => String::new(),
        other => other.chars().take(16).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_are_found_by_the_quantity() {
        let text = "range, depth, P: metre; N, incidence: 1; face: index";
        assert_eq!(said_in(text, "range.T"), Some("m".into()));
        assert_eq!(said_in(text, "P.X"), Some("m".into()));
        assert_eq!(said_in(text, "N.X"), Some(String::new()));
        assert_eq!(said_in(text, "flux.V"), None);
        assert_eq!(said_in("visible: 0 or 1; pixel: index; flux: W/m", "flux.V"), Some("W/m".into()));
        assert_eq!(said_in("W per pixel", "flux.beam0"), Some("W per pixel".into()));
        assert_eq!(said_in("metre", "anything"), Some("m".into()));
    }
}
