//! Drive as an animation: an APNG of all frames, in an endless loop. (PNG specification, third edition, 2025)

use raypencil_report::Scale;

use crate::animation_frame::{AnimationFrame, HALF_SIDE_PX};

/// Frames shown per second. CHOICE: 8 s for the longest animation, of 60 frames.
const FRAMES_PER_S: u16 = 8;

/// Bytes of the APNG. There must be at least one frame. All frames share one colour scale of elevations.
pub(crate) fn apng(frames: &[AnimationFrame]) -> Vec<u8> {
    let elevations = frames.iter().flat_map(|frame| frame.map.elevations());
    let scale = Scale::of(elevations).unwrap_or(Scale::linear(0.0, 0.0));
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, 2 * HALF_SIDE_PX, HALF_SIDE_PX);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // Encoding into memory fails only if the sizes do not match.
    encoder.set_animated(frames.len() as u32, 0).expect("there is at least one frame");
    encoder.set_frame_delay(1, FRAMES_PER_S).expect("the delay follows set_animated");
    let mut writer = encoder.write_header().expect("the image has at least one pixel");
    for frame in frames {
        writer.write_image_data(&frame.rgb(scale)).expect("there are as many bytes as the image has");
    }
    writer.finish().expect("memory can be written");
    out
}
