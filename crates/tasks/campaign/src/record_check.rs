//! Whether a record that was read can be that of a terrain: its numbers must fit together. A digest says only that a file is
//! as it was written, and anyone can write a digest.

use raypencil_judge::Class;

use crate::plan::Campaign;
use crate::record::{MAX_DESCRIBED_RAYS, PartName, PartRecord, ReasonRecord, TerrainRecord};

/// Maximum of any count of a scene. Sums over all terrains of a campaign stay below 2^63.
const MAX_COUNT: u64 = 1 << 42;

/// Maximum length of a text of a record, bytes.
const MAX_TEXT_BYTES: usize = 1 << 14;

/// Maximum number of reasons of a scene: one for each sensor.
const MAX_REASONS: usize = 65;

/// Refuses a record that no terrain of the campaign can have: what is wrong.
pub(crate) fn check_record(record: &TerrainRecord, campaign: &Campaign) -> Result<(), String> {
    let at = |words: String| format!("terrain {}: {words}", record.terrain);
    if record.terrain >= campaign.terrains {
        return Err(at(format!("there are {} terrains", campaign.terrains)));
    }
    let parts: Vec<PartName> = record.parts.iter().map(|part| part.part).collect();
    let expected: Vec<PartName> = campaign.parts_of(record.faces).collect();
    if parts != expected {
        let words = |parts: &[PartName]| parts.iter().map(|part| part.word()).collect::<Vec<_>>().join(", ");
        return Err(at(format!("scenes {} in place of {}", words(&parts), words(&expected))));
    }
    if record.faces > MAX_COUNT {
        return Err(at(format!("{} faces", record.faces)));
    }
    for part in &record.parts {
        check_part(part).map_err(|words| at(format!("{}: {words}", part.part.word())))?;
    }
    Ok(())
}

fn check_part(part: &PartRecord) -> Result<(), String> {
    let counts = [part.compared, part.hits, part.not_compared, part.judged];
    let of_quantities = part.quantities.iter().flat_map(|one| one.by_class.iter().chain([&one.not_compared]));
    let all = counts.iter().chain(&part.by_class).chain(of_quantities);
    if let Some(count) = all.into_iter().find(|count| **count > MAX_COUNT) {
        return Err(format!("a count of {count}, more than {MAX_COUNT}"));
    }
    let classes: u64 = part.by_class.iter().sum();
    if classes != part.compared {
        return Err(format!("{} rays compared, and {classes} in all classes together", part.compared));
    }
    if part.hits > part.compared + part.not_compared {
        let rays = part.compared + part.not_compared;
        return Err(format!("{} hits of {rays} rays", part.hits));
    }
    if let Some(again) = (1..part.quantities.len())
        .find(|&at| part.quantities[at - 1].quantity as usize >= part.quantities[at].quantity as usize)
    {
        return Err(format!("quantity {} again, or out of order", part.quantities[again].quantity));
    }
    let wrong = part.of_class(Class::Defect) + part.of_class(Class::Undecided);
    let described = part.wrong.len();
    if described > MAX_DESCRIBED_RAYS || described as u64 > wrong || (described == 0) != (wrong == 0) {
        return Err(format!("{wrong} wrong rays, of which {described} are described"));
    }
    let of_wrong = part.wrong.iter().flat_map(|ray| [&ray.sensor, &ray.what]);
    let of_worst = part.quantities.iter().flat_map(|one| [&one.worst_error, &one.worst_ratio]);
    let texts = of_wrong
        .chain(of_worst.flatten().map(|worst| &worst.sensor))
        .chain(&part.candidate)
        .chain(&part.failed);
    for text in texts {
        if text.len() > MAX_TEXT_BYTES {
            return Err(format!("a text of {} bytes, longer than {MAX_TEXT_BYTES}", text.len()));
        }
    }
    let texts = part.reasons.iter().flat_map(|one| one.mistakes.iter().chain([&one.clause]));
    for text in texts {
        if text.len() > MAX_TEXT_BYTES {
            return Err(format!("a text of {} bytes, longer than {MAX_TEXT_BYTES}", text.len()));
        }
    }
    for ReasonRecord { mistakes, wrong, explained, right, broken, .. } in &part.reasons {
        if !(1..=2).contains(&mistakes.len()) {
            return Err(format!("a reason of {} mistakes", mistakes.len()));
        }
        if explained > wrong || broken > right || [wrong, right].into_iter().any(|count| *count > MAX_COUNT) {
            return Err(format!(
                "a reason that explains {explained} of {wrong} rays and breaks {broken} of {right}"
            ));
        }
    }
    if part.reasons.len() > MAX_REASONS || (part.wrong.is_empty() && !part.reasons.is_empty()) {
        return Err(format!("{} reasons for {wrong} wrong rays", part.reasons.len()));
    }
    // Reports show commands with these names, which people copy into a shell.
    let worst = || part.quantities.iter().flat_map(|one| [&one.worst_error, &one.worst_ratio]).flatten();
    let sensors = part.wrong.iter().map(|ray| &ray.sensor).chain(worst().map(|worst| &worst.sensor));
    if let Some(name) = sensors.into_iter().find(|name| !is_sensor(name)) {
        return Err(format!("a sensor {name:?}, neither `camera` nor `beam-` and its number"));
    }
    // Differences and their ratios have no sign.
    if let Some(value) = worst().filter_map(|worst| worst.value).find(|value| !(*value >= 0.0)) {
        return Err(format!("a largest value of {value}, below 0"));
    }
    Ok(())
}

/// Whether a text is the name of a sensor, as a record has it.
fn is_sensor(name: &str) -> bool {
    let is_number = |text: &str| text.parse().is_ok_and(|index: usize| index.to_string() == text);
    name == "camera" || name.strip_prefix("beam-").is_some_and(is_number)
}
