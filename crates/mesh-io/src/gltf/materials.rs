//! Kinds of ground: the reflectivity of a material. (glTF 2.0, section 3.9.2)

use gltf::json::{Material as MaterialJson, Root};
use serde::Deserialize;
use serde_json::Value;

use raypencil_files::Fault;
use raypencil_scene::Material;

/// One kind of ground for each material of the file, in its order; `json` is what `root` was made of.
pub(super) fn read(root: &Root, json: &[u8], default: f64) -> Result<Vec<Material>, Fault> {
    if root.materials.len() >= usize::from(u16::MAX) {
        let found = root.materials.len().to_string();
        return Err(Fault::new("materials", found, "fewer than 65535"));
    }
    let colours = Colours::read(json)?;
    let kind = |(index, material): (usize, &MaterialJson)| {
        let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
        let place = || format!("material {index} {:?}", material.name.as_deref().unwrap_or(""));
        // What is said outright wins over what follows from a colour.
        let reflectivity = match own(material, place)? {
            Some(reflectivity) => reflectivity,
            None => colours.luminance(index, place)?.unwrap_or(default),
        };
        Ok(Material { name, reflectivity })
    };
    root.materials.iter().enumerate().map(kind).collect()
}

/// `extras.reflectivity` of a material, if its extras are an object that has it.
fn own(material: &MaterialJson, place: impl Fn() -> String) -> Result<Option<f64>, Fault> {
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

/// The colours of a file as they stand there: the `gltf` crate fills in white where there is none, and rounds
/// to single precision.
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

    /// The luminance of a material's colour, if it gives one.
    ///
    /// CHOICE: that of Rec. 709 (ITU-R BT.709), whose primaries glTF's colours have; factors are linear. A colour
    /// that a texture multiplies is none of the ground, since textures are not read; and white, which is the
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
        // 0.2126 R + 0.7152 G + 0.0722 B, so written that a grey is exactly its own luminance.
        let luminance = green + 0.2126 * (red - green) + 0.0722 * (blue - green);
        Ok(surface.texture.is_none().then_some(luminance))
    }
}
