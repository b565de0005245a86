//! What has to be kept of a film so that a render can be taken up where it was left, bit by bit.

use std::sync::PoisonError;

use super::catcher::CatcherSums;
use super::sums::Sums;
use super::{Film, Halves};
use crate::error::RenderError;

/// The passes that are complete.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmState {
    /// How many there are.
    pub passes: u32,
    /// Width and height (pixels).
    pub size: [usize; 2],
    /// Sums by half of the picture, row from the bottom, pixel, and value of the pixel.
    pub sums: Vec<f32>,
    /// Values of a pixel: more where there are shadow catchers.
    pub values_per_pixel: usize,
}

const WITH_CATCHERS: usize = Sums::VALUES + CatcherSums::VALUES;

impl Film {
    /// Passes that are complete; 0 once one was cut short.
    #[must_use]
    pub fn passes(&self) -> u32 {
        self.halves.read().unwrap_or_else(PoisonError::into_inner).passes.unwrap_or(0)
    }

    /// What the film holds; `None` where a pass was cut short, whose samples cannot be told from the others.
    #[must_use]
    pub fn state(&self) -> Option<FilmState> {
        // Passes are added to catchers, too, while this is locked.
        let halves = self.halves.read().unwrap_or_else(PoisonError::into_inner);
        let (passes, size) = (halves.passes?, self.size());
        let Some(catchers) = self.catchers.get() else {
            let sums = halves.sums.iter().flatten().flat_map(Sums::values).collect();
            return Some(FilmState { passes, size, sums, values_per_pixel: Sums::VALUES });
        };
        let caught = catchers.halves();
        let pixels = halves.sums.iter().flatten().zip(caught.iter().flatten());
        let sums = pixels.flat_map(|(sums, caught)| sums.values().into_iter().chain(caught.values()));
        Some(FilmState { passes, size, sums: sums.collect(), values_per_pixel: WITH_CATCHERS })
    }

    /// Takes up a film of the same picture where it was left; `is_transparent` tells whether it is so behind shadow catchers.
    ///
    /// # Errors
    /// The state is of a film of other pixels.
    pub fn restore(&self, state: &FilmState, is_transparent: bool) -> Result<(), RenderError> {
        let (pixels, values) = (self.width * self.height, state.values_per_pixel);
        let is_known = [Sums::VALUES, WITH_CATCHERS].contains(&values);
        if !is_known || state.size != self.size() || state.sums.len() != 2 * pixels * values {
            return Err(RenderError::Settings("what was kept of a picture is of one of another size".into()));
        }
        let half = |half: usize| state.sums.chunks(values).skip(half * pixels).take(pixels);
        let first = |values: &[f32]| values.first_chunk().map(Sums::from_values);
        let last = |values: &[f32]| values.last_chunk().map(CatcherSums::from_values);
        let sums = [0, 1].map(|i| half(i).filter_map(first).collect());
        let mut halves = self.halves.write().unwrap_or_else(PoisonError::into_inner);
        if values == WITH_CATCHERS {
            self.expect_catchers(is_transparent);
        }
        if let Some(catchers) = self.catchers.get() {
            catchers.restore([0, 1].map(|i| half(i).filter_map(last).collect()));
        }
        *halves = Halves { sums, passes: Some(state.passes) };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CatcherSample, PixelSample};
    use super::*;
    use crate::color::Rgb;
    use crate::sampling::Rng;
    use crate::settings::FilmSettings;

    /// A pass of random light, some of it on shadow catchers.
    fn pass(film: &Film, number: u32) {
        for (tile, rect) in film.tiles().iter().enumerate() {
            let mut rng = Rng::new(u64::from(number) << 32 | tile as u64);
            let mut light = || Rgb(std::array::from_fn(|_| rng.draw()));
            let pixels = 0..rect.width * rect.height;
            let samples = pixels.clone().map(|_| {
                let (direct, indirect) = (light(), light());
                PixelSample { direct, indirect, alpha: 1.0, taken: true, ..PixelSample::default() }
            });
            film.take(tile, samples.collect());
            let caught = pixels.map(|i| CatcherSample {
                is_caught: i % 3 == 0,
                before: light(),
                without: light(),
                background: light(),
            });
            film.take_catchers(tile, caught.collect());
        }
        film.finish_pass(4, number as usize % 2, true);
    }

    fn film(with_catchers: bool) -> Film {
        let film = Film::new(13, 9, &FilmSettings { tile_size: 8, ..FilmSettings::default() });
        if with_catchers {
            film.expect_catchers(true);
        }
        film
    }

    #[test]
    fn a_film_that_is_taken_up_ends_as_one_that_was_never_left() {
        for with_catchers in [false, true] {
            let whole = film(with_catchers);
            (0..5).for_each(|number| pass(&whole, number));
            let left = film(with_catchers);
            (0..3).for_each(|number| pass(&left, number));
            let taken_up = film(false);
            taken_up.restore(&left.state().unwrap(), true).unwrap();
            assert_eq!(taken_up.passes(), 3);
            (3..5).for_each(|number| pass(&taken_up, number));
            assert_eq!(taken_up.state(), whole.state());
            assert_eq!(taken_up.combined(), whole.combined());
            assert_eq!(taken_up.shadow_catcher(), whole.shadow_catcher());
            assert_eq!(taken_up.error(), whole.error());
        }
    }

    #[test]
    fn a_pass_that_was_cut_short_leaves_nothing_to_take_up() {
        let film = film(false);
        pass(&film, 0);
        film.finish_pass(4, 1, false);
        assert_eq!((film.state(), film.passes()), (None, 0));
    }

    #[test]
    fn another_picture_is_refused() {
        let state = film(false).state().unwrap();
        let other = Film::new(9, 13, &FilmSettings::default());
        assert!(other.restore(&state, false).is_err());
        assert!(film(false).restore(&FilmState { values_per_pixel: 0, ..state }, false).is_err());
        assert_eq!(other.passes(), 0);
    }
}
