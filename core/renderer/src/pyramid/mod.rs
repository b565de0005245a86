//! The Radiance Grid Pyramid: how much light reaches the surfaces, at every scale.
//!
//! A level is a sparse grid of cells. A cell holds, for each class of surface normals in it, the mean irradiance: the
//! flux of the photons that landed there over the exact area of those surfaces. Level 0 is the coarsest; each finer level
//! halves the cells.
//!
//! ```text
//!   Layout       triangles -> which cells exist                 (measure, clip, index)
//!   Accumulator  photons   -> flux and count of each cell       (exact integer sums)
//!   LitLayout    landings  -> which of the cells still matter   (lit)
//!   Surfaces     triangles -> how much surface of a cell counts (measure, clip)
//!   Pyramid      merge     -> irradiance of each cell, read by  lookup(point, class, footprint)
//! ```
//!
//! The pyramid knows no photon, BSDF or light, and of the scene its [`Surroundings`]: it takes deposits and answers look-ups.
//!
//! After Yue, Iwasaki, Nishita, "Radiance Grid Pyramid"; what differs: irradiance instead of radiance per direction for
//! diffuse surfaces, true area instead of the cell's face, level chosen by the parent's photon count.

mod accumulator;
mod bins;
mod build;
mod cell_id;
mod class;
mod clip;
mod divided;
mod grid;
mod index;
mod layout;
mod lit;
mod lookup;
mod measure;
mod mixed;
mod surfaces;

use std::time::Duration;

use glam::{DVec3, IVec3, Vec3};

pub use accumulator::{Accumulator, Deposit, Landing, Leaving, SETS, TOGETHER};
pub use bins::{DirectionBins, Lanes};
pub use cell_id::CellId;
pub use class::NormalClasses;
pub use grid::{Grid, PilotLandings, Reading};
pub use layout::Layout;
pub use lookup::{Place, View};

use crate::color::Rgb;
use crate::math::Side;
use bins::BinStore;
use index::LevelIndex;

/// One triangle as the pyramid sees it.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceTriangle {
    /// Corners in scene space.
    pub corners: [DVec3; 3],
    /// Unit normal: where the front looks.
    pub normal: Vec3,
    /// True when the light leaving it is needed by direction.
    pub glossy: bool,
}

/// A point on one side of a surface.
#[derive(Clone, Copy, Debug)]
pub struct SidePoint {
    /// Where, in scene space.
    pub p: Vec3,
    /// Which side.
    pub side: Side,
    /// Edge of its cell, or of the finest cells that are everywhere, if those are larger (scene units).
    pub cell_size: f32,
}

/// What is found about a [`SidePoint`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Openness {
    /// Whether light can come to the point.
    pub is_open: bool,
    /// Less than a cell straight above the point, the other side of the surface there.
    pub above: Option<(Vec3, Side)>,
}

/// What a pyramid is made around.
pub trait Surroundings: Sync {
    /// Number of triangles whose light is read.
    fn triangle_count(&self) -> usize;

    /// One of them.
    fn triangle(&self, i: usize) -> SurfaceTriangle;

    /// Tells of points, in order, whether light can come to them and what is above them.
    fn openness(&self, points: &[SidePoint]) -> Vec<Openness>;

    /// Whether a ray along the surface, to one of four sides, gets away from a point.
    fn leads_out(&self, point: &SidePoint) -> bool;

    /// Tells of pairs of points, in order, whether they see each other.
    fn see(&self, pairs: &[[Vec3; 2]]) -> Vec<bool>;

    /// False once the work is cancelled.
    fn keep_going(&self) -> bool;
}

/// Light of one cell and normal class.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
struct Cell {
    irradiance: [f32; 3],
    /// Lowest bit: whether there are enough photons for the cell's children to be read. Next: whether it is mixed. Above
    /// them: one more than the number of its direction bins, 0 where it has none.
    rest: u32,
}

impl Cell {
    fn new(irradiance: Rgb, glossy: Option<u32>) -> Self {
        Self { irradiance: irradiance.0, rest: glossy.map_or(0, |number| (number + 1) << 2) }
    }

    fn with(self, enough: bool, mixed: bool) -> Self {
        Self { rest: self.rest & !3 | u32::from(enough) | u32::from(mixed) << 1, ..self }
    }

    const fn irradiance(&self) -> Rgb {
        Rgb(self.irradiance)
    }

    const fn glossy(&self) -> Option<u32> {
        (self.rest >> 2).checked_sub(1)
    }

    const fn holds_enough(&self) -> bool {
        self.rest & 1 != 0
    }

    /// Whether it holds surfaces that do not see each other, and finer cells have to be read.
    const fn is_mixed(&self) -> bool {
        self.rest & 2 != 0
    }
}

#[derive(Debug)]
struct Level {
    index: LevelIndex,
    /// By set of photons, by place.
    cells: [Vec<Cell>; SETS],
}

impl Level {
    #[inline]
    fn find(&self, set: usize, cell: IVec3, class: usize) -> Option<&Cell> {
        self.index.find(cell, class).map(|place| &self.cells[set][place])
    }
}

/// The finished pyramid.
#[derive(Debug)]
pub struct Pyramid {
    grid: Grid,
    classes: NormalClasses,
    levels: Vec<Level>,
    store: BinStore,
    /// Wall time that merging and storing the bins took.
    bins_time: Duration,
    /// One over the area of a finest cell's face (per square scene unit).
    per_finest_area: f32,
}

impl Pyramid {
    /// Levels of the pyramid.
    #[must_use]
    pub const fn level_count(&self) -> usize {
        self.levels.len()
    }

    /// Cells that hold light, all levels.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.levels.iter().map(|level| level.index.len()).sum()
    }

    /// Memory (bytes).
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.levels
            .iter()
            .map(|level| level.index.bytes() + level.index.len() * size_of::<[Cell; SETS]>())
            .sum::<usize>()
            + self.store.bytes()
    }

    /// Memory (bytes) of the direction bins alone.
    #[must_use]
    pub const fn bin_bytes(&self) -> usize {
        self.store.bytes()
    }

    /// Wall time that the direction bins took of the build.
    #[must_use]
    pub const fn bins_time(&self) -> Duration {
        self.bins_time
    }

    /// Cells with direction bins, all levels.
    #[must_use]
    pub const fn glossy_cell_count(&self) -> usize {
        self.store.len()
    }

    /// Edge of a finest cell (scene units).
    #[must_use]
    pub fn finest_cell_size(&self) -> f32 {
        self.grid.levels[self.grid.finest()].cell_size
    }

    /// Normal class of one side of a surface.
    #[must_use]
    #[inline(always)]
    pub fn class(&self, side: Side) -> usize {
        self.classes.of(side)
    }

    /// Level whose cells match a footprint (paper, eq. 5), one finer: half the blur for no more noise. `footprint` is the
    /// area Ω r² in square scene units.
    #[must_use]
    #[expect(
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        reason = "exponents and level numbers are small"
    )]
    #[inline(always)]
    pub fn level_for(&self, footprint: f32) -> usize {
        let ratio = (footprint * self.per_finest_area).clamp(1.0, 1e30);
        // Half the binary exponent, rounded, is log2 of the ratio of lengths.
        let exponent = (ratio.to_bits() >> 23) as i32 - 127;
        let coarser = ((exponent + 1) >> 1) - 1;
        (self.grid.finest() as i32 - coarser.max(0)).max(0) as usize
    }

    /// Edge of the cells that a look-up at `p` of level `level` would read (scene units); 0 outside the pyramid.
    #[must_use]
    pub fn cell_size(&self, p: Vec3, level: usize) -> f32 {
        let located = self.grid.locate(self.grid.offset(p), level.min(self.grid.finest()));
        located.map_or(0.0, |(level, _)| self.grid.levels[level].cell_size)
    }

    /// The finest level that is everywhere.
    #[must_use]
    pub const fn base_level(&self) -> usize {
        self.grid.base()
    }

    /// Edge of the cells of a level (scene units).
    #[must_use]
    #[inline]
    pub fn nominal_cell_size(&self, level: usize) -> f32 {
        self.grid.levels[level].cell_size
    }

    /// The level that a look-up at `p` of level `level` reads where finer ones do not exist everywhere.
    #[must_use]
    #[inline(always)]
    pub fn existing_level(&self, p: Vec3, level: usize) -> usize {
        self.grid.existing(self.grid.offset(p), level)
    }

    /// Reads the light of one set of photons, below [`SETS`].
    #[must_use]
    pub const fn view(&self, set: usize) -> View<'_> {
        View { pyramid: self, set }
    }
}
