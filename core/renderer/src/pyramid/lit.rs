//! What matters of a layout once photons have landed: the cells that light came to, and beside them, in the same coarser
//! cell, those that it did not come to. The rest, such as the inside of every solid, is of no more use, and is most of it.

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
    /// By level and place: whether light landed in the cell or a finer one of it.
    pub(super) is_lit: Vec<Vec<bool>>,
}

impl<'a> LitLayout<'a> {
    /// `landed` tells of all cells, by level and place, whether photons landed there.
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 cells fit in memory")]
    pub(super) fn new(whole: &'a Layout, mut landed: Vec<Vec<bool>>) -> Self {
        for level in (1..landed.len()).rev() {
            let (coarser, finer) = landed.split_at_mut(level);
            for (place, _) in finer[0].iter().enumerate().filter(|(_, lit)| **lit) {
                if let Some(parent) = whole.parent(level, place) {
                    coarser[level - 1][parent] = true;
                }
            }
        }
        let matters = |level: usize, place: usize| {
            let beside_lit = || whole.parent(level, place).is_some_and(|parent| landed[level - 1][parent]);
            landed[level][place] || beside_lit()
        };
        let matter = |level: usize| {
            let places = (0..landed[level].len()).into_par_iter().filter(|&place| matters(level, place));
            places.map(|place| place as u32).collect()
        };
        let places: Vec<Vec<u32>> = (0..landed.len()).map(matter).collect();
        let of_places = |(landed, places): (&Vec<bool>, &Vec<u32>)| {
            places.par_iter().map(|&place| landed[place as usize]).collect()
        };
        let is_lit = landed.iter().zip(&places).map(of_places).collect();
        Self { whole, layout: whole.part(&places), places, is_lit }
    }
}
