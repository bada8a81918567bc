/// A colour: red, green, blue.
pub type Colour = [u8; 3];
