//! What is declared about a recording, as arguments of functions.

use raypencil::io::{DeclaredChannel, Step};
use raypencil::pack::Declarations;

use crate::failure::Failure;

/// Maps with their channels, and the metres of a unit of whole numbers.
pub(crate) fn declared(channels: &[(String, String)], scale: Option<f64>) -> Result<Declarations, Failure> {
    let channel = |(map, channel): &(String, String)| {
        DeclaredChannel::new(map, channel).map_err(|fault| Failure::new(format!("channels: {fault}")))
    };
    if let Some(scale) = scale.filter(|scale| Step::new(*scale).is_none()) {
        let expected = "a positive number of metres, such as 0.001";
        return Err(Failure::new(format!("scale is {scale}; expected {expected}")));
    }
    let channels = channels.iter().map(channel).collect::<Result<_, _>>()?;
    Ok(Declarations { channels, scale, ..Declarations::default() })
}
