//! What materials may ask about an object.

use glam::Vec4;
use serde::Deserialize;

/// What materials may ask about an object.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectInfo {
    /// Its color in the viewport, with alpha.
    pub color: [f32; 4],
    /// Its pass index.
    pub index: f32,
    /// A random number, 0 to 1.
    pub random: f32,
    /// Values that it or its instancer have by name.
    pub attributes: Vec<ObjectAttribute>,
}

/// A value that an object, or its instancer, has by name.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectAttribute {
    /// The name's number in programs.
    pub attribute: u32,
    /// The value, with alpha.
    pub value: [f32; 4],
}

impl Default for ObjectInfo {
    fn default() -> Self {
        Self { color: [1.0; 4], index: 0.0, random: 0.0, attributes: Vec::new() }
    }
}

impl ObjectInfo {
    /// The value of a number's name; 0 where there is none.
    #[must_use]
    pub fn attribute(&self, number: u32) -> Vec4 {
        let known = self.attributes.iter().find(|known| known.attribute == number);
        known.map_or(Vec4::ZERO, |known| Vec4::from_array(known.value))
    }
}
