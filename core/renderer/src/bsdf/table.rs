//! All materials of a scene.

use std::ops::Index;

use super::{PreparedMaterial, Varying, energy_table};
use crate::scene::{Material, Problem};

/// All materials of a scene, by their index there.
#[derive(Debug, Default)]
pub struct MaterialTable {
    materials: Vec<PreparedMaterial>,
    /// Values that had to be changed, by material.
    pub problems: Vec<Problem>,
}

impl MaterialTable {
    /// Prepares `materials`, and the energy tables they need (some 20 ms the first time an index of refraction is met).
    #[must_use]
    pub fn build(materials: &[Material]) -> Self {
        let mut problems = Vec::new();
        let materials: Vec<_> = materials.iter().map(|m| PreparedMaterial::new(m, &mut problems)).collect();
        let needs_tables =
            |m: &PreparedMaterial| !m.is_plain() || m.varying().is_some_and(|v| !v.is_lambert());
        if materials.iter().any(needs_tables) {
            energy_table::prepare(&materials.iter().flat_map(|m| m.etas()).copied().collect::<Vec<_>>());
        }
        if materials.iter().filter_map(PreparedMaterial::varying).any(Varying::bends_differently) {
            energy_table::prepare_all();
        }
        Self { materials, problems }
    }

    /// The materials in order.
    pub fn iter(&self) -> impl Iterator<Item = &PreparedMaterial> {
        self.materials.iter()
    }
}

impl Index<usize> for MaterialTable {
    type Output = PreparedMaterial;

    fn index(&self, index: usize) -> &PreparedMaterial {
        &self.materials[index]
    }
}
