//! The paper's approximations in words, for people who meet one on a page.

use raypencil_scene::Switches;
use serde_json::{Map, Value, json};

/// Title and words of each switch, in the order of [`Switches::NAMES`].
const WORDS: [(&str, &str); 5] = [
    (
        "straight sides on a curved grid",
        "Rows of a beam start at different heights of its focal axis. On the beam's grid the side of a face is therefore a \
         curve. The paper clips the face to the stripe, projects its corners, and draws straight lines between them. A \
         pencil between the line and the curve gets the face that the line gives it. The error grows with the thickness of \
         the sheet and with the slant of the side.",
    ),
    (
        "rules that skip too many faces",
        "The paper skips faces early, to save time. Rule 3b skips a face whose corners all lie beyond the maximum range, \
         although its inside may be nearer. Rule 1b asks once for a face whether its front is turned to the beam, although \
         the rows of a beam may see different sides of it. Rule 3c skips a face whose corners lie outside the screen, \
         although its curved sides may reach into it.",
    ),
    (
        "facing by the camera's axis",
        "What may hide a stripe from the camera? The paper takes faces whose outward normal makes less than 90 degrees with \
         the camera's axis. Exactly, every face hides what lies behind it, and whether its back is turned to the camera \
         depends on the ray to the point and not on the axis. The rule loses shadows and adds none.",
    ),
    (
        "what hides is no deeper than the upper stripe",
        "The paper only considers faces with a corner that is not past the farthest hit of the upper beam in this frame, \
         by depth along the camera's axis. A face behind that depth may still hide a point of the other beam, which \
         reaches farther where the upper beam ends at a rock.",
    ),
    (
        "the pixel's centre in place of the stripe's point",
        "The paper compares a stripe's point with a range map of what may hide it, and that map is known at pixel centres. \
         The point lies anywhere in its pixel. Along the outline of what hides, centre and point may lie on different \
         sides.",
    ),
];

/// The words as the page model has them, by the name of the switch.
pub(crate) fn switch_words() -> Value {
    let named = Switches::NAMES.into_iter().zip(WORDS);
    let entries =
        named.map(|(name, (title, words))| (name.to_string(), json!({ "title": title, "words": words })));
    Value::Object(entries.collect::<Map<_, _>>())
}
