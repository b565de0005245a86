//! A uniform grid of flux and photon counts (Hansson, Harrysson 2002, "Fast Photon Mapping Using Grids"): about a gather
//! hit, cells are added ring by ring until they hold enough photons.
//!
//! As published the grid is dense, knows no normals and serves diffuse light only: a glossy surface counts as a diffuse
//! one of the same albedo.

use glam::{IVec3, Vec3};

use super::photon_store::Photons;
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::math::Side;

/// Rings after which the search gives up; the light found by then is spread over all of them.
const MAX_RINGS: i32 = 16;

#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    flux: [f32; 3],
    count: u32,
}

/// The grid.
#[derive(Debug)]
pub struct UniformGrid {
    low: Vec3,
    cell_size: f32,
    size: IVec3,
    cells: Vec<Cell>,
    /// Photons that are enough.
    k: u32,
}

impl UniformGrid {
    /// A grid over `bounds` with `resolution` cells along the longest side.
    #[must_use]
    pub fn new(photons: &Photons, bounds: [Vec3; 2], resolution: u32, k: u32) -> Self {
        let [low, high] = bounds;
        let cell_size = (high - low).max_element().max(f32::MIN_POSITIVE) / resolution as f32;
        let size = ((high - low) / cell_size).ceil().as_ivec3().max(IVec3::ONE);
        let cells = vec![Cell::default(); size.as_usizevec3().element_product()];
        let mut grid = Self { low, cell_size, size, cells, k };
        for photon in &photons.0 {
            let index = grid.index(grid.cell(photon.p));
            let cell = &mut grid.cells[index];
            cell.flux = (Rgb(cell.flux) + photon.flux).0;
            cell.count += 1;
        }
        grid
    }

    /// Memory (bytes).
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.cells.len() * size_of::<Cell>()
    }

    fn cell(&self, p: Vec3) -> IVec3 {
        ((p - self.low) / self.cell_size).floor().as_ivec3().clamp(IVec3::ZERO, self.size - 1)
    }

    #[expect(clippy::cast_sign_loss, reason = "within the grid")]
    const fn index(&self, cell: IVec3) -> usize {
        ((cell.z * self.size.y + cell.y) * self.size.x + cell.x) as usize
    }

    /// Adds the cells at distance `ring` (the largest coordinate) from `center`.
    fn add_ring(&self, center: IVec3, ring: i32, sum: &mut Cell) {
        let (low, high) = ((center - ring).max(IVec3::ZERO), (center + ring).min(self.size - 1));
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                let inside = (z - center.z).abs() < ring && (y - center.y).abs() < ring;
                // Within the ring a row has only its ends in it.
                let step = if inside { 2 * ring as usize } else { 1 };
                for x in (center.x - ring..=center.x + ring).step_by(step) {
                    if (low.x..=high.x).contains(&x) {
                        let cell = self.cells[self.index(IVec3::new(x, y, z))];
                        sum.flux = (Rgb(sum.flux) + Rgb(cell.flux)).0;
                        sum.count += cell.count;
                    }
                }
            }
        }
    }
}

impl Estimator for UniformGrid {
    type Place = Vec3;

    #[inline]
    fn place(&self, p: Vec3, _side: Side, _wo: Vec3, footprint: Footprint) -> Option<Vec3> {
        (!footprint.sharp).then_some(p)
    }

    /// Flux over the face of the cube that holds enough photons.
    fn read(&self, p: &Vec3) -> Option<Rgb> {
        let center = self.cell(*p);
        let mut sum = Cell::default();
        let mut ring = 0;
        self.add_ring(center, 0, &mut sum);
        while sum.count < self.k && ring < MAX_RINGS {
            ring += 1;
            self.add_ring(center, ring, &mut sum);
        }
        let edge = (2 * ring + 1) as f32 * self.cell_size;
        Some(Rgb(sum.flux) * (1.0 / (edge * edge)))
    }
}
