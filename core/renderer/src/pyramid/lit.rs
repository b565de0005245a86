//! What matters of a layout once photons have landed: the cells that can be read, which is where the coarser cell around
//! them holds enough photons. Light of the others is that of the coarser ones. Most of a layout, such as the inside of every
//! solid, is of no more use.

use rayon::prelude::*;

use super::layout::Layout;

/// The cells of a layout that matter.
#[derive(Debug)]
pub(super) struct LitLayout<'a> {
    /// All cells, those that do not matter too.
    pub(super) whole: &'a Layout,
    /// Those that matter, in the same order.
    pub(super) layout: Layout,
    /// By level and place: the place in the whole layout.
    pub(super) places: Vec<Vec<u32>>,
    /// By level and place: whether the finer cells of the cell matter.
    pub(super) finer_matter: Vec<Vec<bool>>,
    /// By level and place in the whole layout: photons that landed in the cell or a finer one of it.
    pub(super) counts: Vec<Vec<u64>>,
    /// Photons that a cell has to hold for its finer cells to matter.
    pub(super) enough: u64,
}

impl<'a> LitLayout<'a> {
    /// `counts` tells of all cells, by level and place, how many photons landed there.
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 cells fit in memory")]
    pub(super) fn new(whole: &'a Layout, mut counts: Vec<Vec<u64>>, enough: u64) -> Self {
        for level in (1..counts.len()).rev() {
            let (coarser, finer) = counts.split_at_mut(level);
            for (place, &count) in finer[0].iter().enumerate().filter(|(_, count)| **count > 0) {
                if let Some(parent) = whole.parent(level, place) {
                    coarser[level - 1][parent] += count;
                }
            }
        }
        let matter = |level: usize| {
            let places = 0..counts[level].len();
            let matters = |&place: &usize| matters(whole, &counts, enough, level, place);
            places.into_par_iter().filter(matters).map(|place| place as u32).collect()
        };
        let places: Vec<Vec<u32>> = (0..counts.len()).map(matter).collect();
        let of_places = |(counts, places): (&Vec<u64>, &Vec<u32>)| {
            places.par_iter().map(|&place| counts[place as usize] >= enough).collect()
        };
        let finer_matter = counts.iter().zip(&places).map(of_places).collect();
        Self { whole, layout: whole.part(&places), places, finer_matter, counts, enough }
    }

    /// Whether a cell of the whole layout matters.
    pub(super) fn matters(&self, level: usize, place: usize) -> bool {
        matters(self.whole, &self.counts, self.enough, level, place)
    }
}

fn matters(whole: &Layout, counts: &[Vec<u64>], enough: u64, level: usize, place: usize) -> bool {
    whole.parent(level, place).map_or(counts[level][place] > 0, |parent| counts[level - 1][parent] >= enough)
}
