//! What each effect costs, measured at next to no cost: rays are counted, and one unit of work of many is clocked, its time
//! split by effect. The shares of the clocked units divide the wall seconds of their pass.

use std::ops::AddAssign;
use std::time::{Duration, Instant};

use super::{EFFECTS, Effect};
use crate::stats::EffectStats;

/// Time of the clocked units that belongs to no effect (camera rays and the film), after those of the effects.
const NO_EFFECT: usize = EFFECTS;

/// What was measured, of one thread or of many together.
#[derive(Clone, Copy, Debug, Default)]
pub struct Costs {
    /// Of clocked units.
    clocked: [Duration; EFFECTS + 1],
    /// Of all units.
    rays: [u64; EFFECTS],
}

impl Costs {
    /// An effect's share of the time, 0 to 1; 0 where no unit was clocked.
    #[must_use]
    pub fn share(&self, effect: Effect) -> f64 {
        let all: Duration = self.clocked.iter().sum();
        if all.is_zero() { 0.0 } else { self.clocked[effect as usize].as_secs_f64() / all.as_secs_f64() }
    }

    /// Adds rays, and shares of the pass's wall `seconds`, to the effects they belong to.
    pub fn charge(&self, effects: &mut [EffectStats], seconds: f64) {
        for (stats, effect) in effects.iter_mut().zip(Effect::ALL) {
            stats.seconds += self.share(effect) * seconds;
            stats.rays += self.rays(effect);
        }
    }

    /// All of it, as the cost of one effect.
    #[must_use]
    pub fn all_for(&self, effect: Effect) -> Self {
        let mut all = Self::default();
        all.clocked[effect as usize] = self.clocked.iter().sum();
        all.rays[effect as usize] = self.rays.iter().sum();
        all
    }

    /// Rays traced for an effect alone.
    #[must_use]
    pub const fn rays(&self, effect: Effect) -> u64 {
        self.rays[effect as usize]
    }
}

impl AddAssign for Costs {
    fn add_assign(&mut self, o: Self) {
        for (sum, clocked) in self.clocked.iter_mut().zip(o.clocked) {
            *sum += clocked;
        }
        for (sum, rays) in self.rays.iter_mut().zip(o.rays) {
            *sum += rays;
        }
    }
}

/// Measures one thread's work. At any moment one effect, or none, is the one that is worked for; [`Meter::enter`] gives
/// the one before, for [`Meter::back`].
#[derive(Clone, Debug, Default)]
pub struct Meter {
    /// What was measured so far.
    pub costs: Costs,
    owner: Owner,
    /// Begin of the time not yet counted; `None` outside clocked units.
    since: Option<Instant>,
}

/// Who is worked for.
#[derive(Clone, Copy, Debug)]
pub struct Owner(usize);

impl Default for Owner {
    fn default() -> Self {
        Self(NO_EFFECT)
    }
}

impl Meter {
    /// Begins a unit of work, clocked or not; it belongs to no effect yet.
    #[inline]
    pub fn begin(&mut self, clocked: bool) {
        self.owner = Owner::default();
        self.since = clocked.then(Instant::now);
    }

    /// Ends a unit.
    #[inline]
    pub fn end(&mut self) {
        self.back(Owner::default());
        self.since = None;
    }

    /// Who is worked for.
    #[must_use]
    pub const fn owner(&self) -> Owner {
        self.owner
    }

    /// From here on the work is for `effect`.
    #[inline]
    pub fn enter(&mut self, effect: Effect) -> Owner {
        let before = self.owner;
        self.back(Owner(effect as usize));
        before
    }

    /// [`Meter::enter`], where there is an effect.
    #[inline]
    pub fn enter_if(&mut self, effect: Option<Effect>) -> Owner {
        effect.map_or(self.owner, |effect| self.enter(effect))
    }

    /// From here on the work is again for who was worked for before.
    #[inline]
    pub fn back(&mut self, owner: Owner) {
        if let Some(since) = self.since {
            self.split(since);
        }
        self.owner = owner;
    }

    /// Gives the time since `since` to who was worked for.
    #[cold]
    fn split(&mut self, since: Instant) {
        let now = Instant::now();
        self.costs.clocked[self.owner.0] += now - since;
        self.since = Some(now);
    }

    /// Counts rays traced for the effect that is worked for.
    #[inline]
    pub fn count_own(&mut self, rays: u64) {
        if let Some(sum) = self.costs.rays.get_mut(self.owner.0) {
            *sum += rays;
        }
    }

    /// Counts rays traced for `effect` alone.
    #[inline]
    pub fn count(&mut self, effect: Effect, rays: u64) {
        self.costs.rays[effect as usize] += rays;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spin(time: Duration) {
        let begin = Instant::now();
        while begin.elapsed() < time {}
    }

    #[test]
    fn time_goes_to_the_innermost_effect_and_only_of_clocked_units() {
        let mut meter = Meter::default();
        for clocked in [true, false, false] {
            meter.begin(clocked);
            spin(Duration::from_millis(4));
            let none = meter.enter(Effect::IndirectDiffuse);
            spin(Duration::from_millis(8));
            let outer = meter.enter(Effect::Caustics);
            meter.count(Effect::Caustics, 2);
            spin(Duration::from_millis(4));
            meter.back(outer);
            spin(Duration::from_millis(4));
            meter.back(none);
            meter.end();
        }
        let mut costs = meter.costs;
        assert!(costs.clocked.iter().sum::<Duration>() < Duration::from_millis(40), "one unit of 20 ms");
        assert!((costs.share(Effect::IndirectDiffuse) - 0.6).abs() < 0.15, "{costs:?}");
        assert!((costs.share(Effect::Caustics) - 0.2).abs() < 0.1, "{costs:?}");
        assert_eq!(costs.share(Effect::DirectLight).to_bits(), 0);
        costs += meter.costs;
        assert_eq!(costs.rays(Effect::Caustics), 12);
        assert_eq!(Costs::default().share(Effect::Caustics).to_bits(), 0);
    }
}
