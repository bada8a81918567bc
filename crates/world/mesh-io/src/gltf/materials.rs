//! Materials: name and reflectivity. (glTF 2.0, section 3.9.2)

use gltf::json::{Material as MaterialJson, Root};
use raypencil_files::Fault;
use raypencil_scene::Material;
use serde::Deserialize;
use serde_json::Value;

use crate::gltf::limits::MAX_MATERIALS;

/// Materials of the file, in its order. `json` is the text of `root`; `default` is the reflectivity of materials that
/// state none.
pub(super) fn read(root: &Root, json: &[u8], default: f64) -> Result<Vec<Material>, Fault> {
    if root.materials.len() > MAX_MATERIALS {
        let found = root.materials.len().to_string();
        return Err(Fault::new("materials", found, "fewer than 65535"));
    }
    let colours = Colours::read(json)?;
    let kind = |(index, material): (usize, &MaterialJson)| {
        let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
        let place = || format!("material {index} {:?}", material.name.as_deref().unwrap_or(""));
        // A stated reflectivity has precedence over the luminance of the colour.
        let reflectivity = match stated_reflectivity(material, place)? {
            Some(reflectivity) => reflectivity,
            None => colours.luminance(index, place)?.unwrap_or(default),
        };
        Ok(Material { name, reflectivity })
    };
    root.materials.iter().enumerate().map(kind).collect()
}

/// `extras.reflectivity` of a material; `None` if its extras are no object or lack it.
fn stated_reflectivity(material: &MaterialJson, place: impl Fn() -> String) -> Result<Option<f64>, Fault> {
    #[derive(Deserialize)]
    struct Extras {
        reflectivity: Option<Value>,
    }
    let Some(extras) = &material.extras else { return Ok(None) };
    if !extras.get().trim_start().starts_with('{') {
        return Ok(None);
    }
    let unfit = |found: String| Fault::new(place(), found, "extras.reflectivity from 0 to 1");
    let extras: Extras = serde_json::from_str(extras.get()).map_err(|error| unfit(error.to_string()))?;
    match extras.reflectivity {
        None => Ok(None),
        Some(value) => match value.as_f64() {
            Some(number) if (0.0..=1.0).contains(&number) => Ok(Some(number)),
            _ => Err(unfit(value.to_string())),
        },
    }
}

/// Colours of a file as its JSON has them. The `gltf` crate fills in white where a colour is absent, and rounds to
/// single precision.
#[derive(Default, Deserialize)]
struct Colours {
    #[serde(default)]
    materials: Vec<Coloured>,
}

#[derive(Default, Deserialize)]
struct Coloured {
    #[serde(rename = "pbrMetallicRoughness")]
    surface: Option<Surface>,
}

#[derive(Default, Deserialize)]
struct Surface {
    #[serde(rename = "baseColorFactor")]
    factor: Option<Vec<f64>>,
    #[serde(rename = "baseColorTexture")]
    texture: Option<serde::de::IgnoredAny>,
}

impl Colours {
    fn read(json: &[u8]) -> Result<Self, Fault> {
        let unfit = |error: serde_json::Error| Fault::new("JSON", error.to_string(), "a glTF 2.0 asset");
        serde_json::from_slice(json).map_err(unfit)
    }

    /// Luminance of a material's colour; `None` if it has no colour, or one that a texture multiplies.
    ///
    /// CHOICE: the luminance of Rec. 709 (ITU-R BT.709), since glTF's colours have its primaries and are linear.
    /// Textures are not read, so that a colour which a texture multiplies does not describe the ground. White, the
    /// default of glTF, is not the default here.
    fn luminance(&self, index: usize, place: impl Fn() -> String) -> Result<Option<f64>, Fault> {
        let Some(surface) = self.materials.get(index).and_then(|material| material.surface.as_ref()) else {
            return Ok(None);
        };
        let Some(factor) = &surface.factor else { return Ok(None) };
        let unfit =
            || Fault::new(place(), format!("{factor:?}"), "baseColorFactor of four numbers from 0 to 1");
        let &[red, green, blue, _] = factor.as_slice() else { return Err(unfit()) };
        if !factor.iter().all(|part| (0.0..=1.0).contains(part)) {
            return Err(unfit());
        }
        // 0.2126 R + 0.7152 G + 0.0722 B, in a form that gives a grey exactly its own luminance.
        let luminance = green + 0.2126 * (red - green) + 0.0722 * (blue - green);
        Ok(surface.texture.is_none().then_some(luminance))
    }
}
