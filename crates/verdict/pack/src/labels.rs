//! The labels of a pack's arrays and maps: types, shapes, names and units of channels. All of them follow from a file's name, from its
//! sensor and from the scene's model of light.

use std::collections::BTreeSet;

use raypencil_files::Fault;
use raypencil_scene::FluxModel;

use crate::manifest::{ChannelType, FileRole, FileType, Manifest, ManifestFile};
use crate::rays::RAY_CHANNELS;
use crate::units::unit_of_channel;

/// Refuses labels that are not those of the files that they name, by the files' paths. Rows and columns were compared with those of
/// the sensors when the manifest was read.
pub(crate) fn check_labels(manifest: &Manifest) -> Result<(), Fault> {
    for (at, file) in manifest.files.iter().enumerate() {
        let Some((kind, channels)) = labels(manifest, file) else { continue };
        let place = format!("files[{at}] {:?}", file.path);
        if file.kind != Some(kind) {
            let found = file.kind.map_or("none".into(), |kind| format!("{kind:?}"));
            return Err(Fault::new(format!("{place}: type"), found, format!("{kind:?}")));
        }
        let stated: Vec<Label<'_>> = file
            .channels
            .iter()
            .map(|one| Label { name: &one.name, unit: &one.unit, kind: one.kind })
            .collect();
        if stated != channels {
            let differs = |at: &usize| stated.get(*at) != channels.get(*at);
            let first = (0..stated.len().max(channels.len())).find(differs).unwrap_or(0);
            let words = |one: Option<&Label<'_>>| one.map_or("none".into(), Label::words);
            let place = format!("{place}: channels[{first}]");
            return Err(Fault::new(place, words(stated.get(first)), words(channels.get(first))));
        }
        let third = (kind != FileType::Exr && channels.len() > 1).then_some(channels.len() as u32);
        if file.shape.as_ref().is_some_and(|shape| shape.get(2).copied() != third) {
            let found = format!("{:?}", file.shape.as_deref().unwrap_or_default());
            let expected = third
                .map_or("rows and columns".into(), |count| format!("rows, columns and {count} components"));
            return Err(Fault::new(format!("{place}: shape"), found, expected));
        }
    }
    Ok(())
}

/// A channel as a manifest describes it.
#[derive(Debug, PartialEq, Eq)]
struct Label<'a> {
    name: &'a str,
    unit: &'a str,
    kind: ChannelType,
}

impl Label<'_> {
    fn words(&self) -> String {
        format!("{:?}, unit {:?}, {:?}", self.name, self.unit, self.kind)
    }
}

/// The type and the channels of a file with rays or answers; `None` for any other.
fn labels<'m>(manifest: &'m Manifest, file: &'m ManifestFile) -> Option<(FileType, Vec<Label<'m>>)> {
    let model = manifest.flux_model;
    match file.role {
        FileRole::Rays => {
            let channel = |name| Label { name, unit: "m", kind: ChannelType::Float64 };
            Some((FileType::Float64, RAY_CHANNELS.map(channel).into()))
        }
        FileRole::Answers => match file.path.strip_suffix(".exr") {
            // Each quantity and each margin stands twice: the map has the channels of all arrays of its sensor, in order.
            Some(sensor) => {
                let is_of_sensor = |one: &&ManifestFile| {
                    one.role == FileRole::Answers
                        && one.path.split_once('/').is_some_and(|(folder, _)| folder == sensor)
                };
                let arrays = manifest.files.iter().filter(is_of_sensor);
                let names = arrays.flat_map(|one| &one.channels).map(|one| one.name.as_str());
                let names: BTreeSet<&str> = names.collect();
                let single = |name| {
                    let unit = unit_of_channel(name, model);
                    let kind = if unit == "index" { ChannelType::Uint32 } else { ChannelType::Float32 };
                    Label { name, unit, kind }
                };
                Some((FileType::Exr, names.into_iter().map(single).collect()))
            }
            None => {
                let name = file.path.split_once('/')?.1.strip_suffix(".npy")?;
                Some(array(name, model))
            }
        },
        _ => None,
    }
}

/// The type and the channels of an array with answers.
fn array(name: &str, model: FluxModel) -> (FileType, Vec<Label<'_>>) {
    let unit = unit_of_channel(name, model);
    let (file, kind) = match name {
        "P" => return (FileType::Float64, vectors(["P.X", "P.Y", "P.Z"], model)),
        "N" => return (FileType::Float64, vectors(["N.X", "N.Y", "N.Z"], model)),
        "visible.V" => (FileType::Uint8, ChannelType::Uint8),
        _ if unit == "index" => (FileType::Uint32, ChannelType::Uint32),
        _ => (FileType::Float64, ChannelType::Float64),
    };
    (file, vec![Label { name, unit, kind }])
}

fn vectors(names: [&'static str; 3], model: FluxModel) -> Vec<Label<'static>> {
    let component = |name| Label { name, unit: unit_of_channel(name, model), kind: ChannelType::Float64 };
    names.map(component).into()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn published(name: &str) -> Manifest {
        let pack = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/packs").join(name);
        Manifest::read(pack).expect("a manifest")
    }

    #[test]
    fn each_label_that_is_false_is_refused() {
        // Both models of light.
        for name in ["hard", "facets"] {
            let manifest = published(name);
            check_labels(&manifest).expect("true labels");
            let refused = |at: usize, change: &dyn Fn(&mut ManifestFile)| {
                let mut forged = manifest.clone();
                change(&mut forged.files[at]);
                let fault = check_labels(&forged).expect_err(&forged.files[at].path).to_string();
                assert!(fault.starts_with("files["), "{fault}");
            };
            let labelled = (0..manifest.files.len()).filter(|&at| manifest.files[at].kind.is_some());
            for at in labelled {
                for channel in 0..manifest.files[at].channels.len() {
                    refused(at, &|file| file.channels[channel].unit = "mm".into());
                    refused(at, &|file| file.channels[channel].name = "depth.V".into());
                    refused(at, &|file| {
                        file.channels[channel].kind = match file.channels[channel].kind {
                            ChannelType::Uint8 => ChannelType::Uint32,
                            _ => ChannelType::Uint8,
                        }
                    });
                }
                refused(at, &|file| _ = file.channels.pop());
                let has_third = |shape: &Vec<u32>| shape.len() == 3;
                refused(at, &|file| match file.shape.as_mut().expect("a shape") {
                    shape if has_third(shape) => shape[2] += 1,
                    shape => shape.push(2),
                });
                refused(at, &|file| {
                    file.kind = Some(if file.kind == Some(FileType::Uint8) {
                        FileType::Exr
                    } else {
                        FileType::Uint8
                    });
                });
            }
        }
    }
}
