//! How the error falls from pass to pass, and where that leads.

use std::time::Duration;

use crate::progress::Outlook;
use crate::stats::PictureError;

use super::stop::Stop;

/// Errors after passes. Their square is modelled as gather noise, which falls with every pass, plus photon noise, which
/// does not: e² = g / n + p.
#[derive(Clone, Debug)]
pub(super) struct Convergence {
    began: Duration,
    /// Passes that an earlier render made.
    pub(super) first: u32,
    /// Since the start of the render, after the last pass.
    now: Duration,
    /// Passes, error (percent of the mean).
    measured: Vec<(u32, f64)>,
}

impl Convergence {
    /// Nothing measured yet; the gather begins at `began`, since the start of the render, with `first` passes made.
    pub(super) const fn new(began: Duration, first: u32) -> Self {
        Self { began, first, now: began, measured: Vec::new() }
    }

    /// Notes the error after `passes` passes.
    pub(super) fn add(&mut self, passes: u32, elapsed: Duration, error: Option<PictureError>) {
        self.now = elapsed;
        self.measured.extend(error.map(|error| (passes, error.rms_clipped)));
    }

    /// The error after `passes` passes, if it was measured then.
    pub(super) fn error_after(&self, passes: u32) -> Option<f64> {
        self.measured.last().filter(|&&(n, _)| n == passes).map(|&(_, error)| error)
    }

    /// Where `passes` passes in all lead.
    pub(super) fn outlook(&self, passes: u32, stop: &Stop) -> Option<Outlook> {
        let &(done, error) = self.measured.last()?;
        let [gather, photons] = self.fit();
        let per_pass = (self.now - self.began).as_secs_f64() / f64::from(done - self.first);
        let seconds_to_target = stop.error_target.and_then(|target| {
            let needed = gather / (target * target - photons);
            (needed > 0.0 && needed <= f64::from(passes))
                .then(|| (needed - f64::from(done)).max(0.0) * per_pass)
        });
        let error_at_end = (gather / f64::from(passes) + photons).sqrt();
        Some(Outlook { error, error_at_end, seconds_to_target })
    }

    /// g and p, neither negative, by least squares with the relative error of each measurement the same.
    fn fit(&self) -> [f64; 2] {
        let [mut xx, mut x, mut one, mut xy, mut y] = [0.0; 5];
        for &(n, error) in &self.measured {
            let (inverse, square) = (f64::from(n).recip(), (error * error).max(f64::MIN_POSITIVE));
            let weight = (square * square).recip();
            xx += weight * inverse * inverse;
            x += weight * inverse;
            one += weight;
            xy += weight * inverse * square;
            y += weight * square;
        }
        let determinant = xx * one - x * x;
        let (gather, photons) = ((xy * one - x * y) / determinant, (xx * y - x * xy) / determinant);
        // One measurement, or one of the two below nothing: the other alone.
        if gather >= 0.0 && photons >= 0.0 && self.measured.len() > 2 {
            [gather, photons]
        } else if gather < 0.0 && self.measured.len() > 2 {
            [0.0, y / one]
        } else {
            [xy / xx, 0.0]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::GatherSettings;
    use crate::stats::StoppedBy;

    fn measured(errors: impl Iterator<Item = (u32, f64)>) -> Convergence {
        let mut convergence = Convergence::new(Duration::from_secs(2), 0);
        for (n, square) in errors {
            let error = PictureError { rms_clipped: square.sqrt(), rms_mean: 0.0, rms_peak: 0.0 };
            convergence.add(n, Duration::from_secs(2 + u64::from(n) * 3), Some(error));
        }
        convergence
    }

    #[test]
    fn both_kinds_of_noise_are_found() {
        let convergence = measured([2, 4, 6, 8].map(|n| (n, 40.0 / f64::from(n) + 0.25)).into_iter());
        let [gather, photons] = convergence.fit();
        assert!((gather - 40.0).abs() < 1e-9 && (photons - 0.25).abs() < 1e-9);
        // 1 % needs 40 / (1 - 0.25) = 53.3 passes of 3 s, 45.3 more.
        let settings = GatherSettings { error_target: 1.0, ..Default::default() };
        let stop = Stop::new(&settings, Duration::from_secs(2));
        let outlook = convergence.outlook(100, &stop).unwrap();
        assert!((outlook.seconds_to_target.unwrap() - (40.0 / 0.75 - 8.0) * 3.0).abs() < 1e-6);
        assert!((outlook.error_at_end - 0.65_f64.sqrt()).abs() < 1e-9);
        assert!(convergence.outlook(50, &stop).unwrap().seconds_to_target.is_none(), "the rays end before");
    }

    #[test]
    fn what_photons_alone_leave_is_never_reached() {
        let convergence = measured([2, 4, 6, 8].map(|n| (n, 40.0 / f64::from(n) + 4.0)).into_iter());
        let settings = GatherSettings { error_target: 1.0, ..Default::default() };
        let outlook = convergence.outlook(4096, &Stop::new(&settings, Duration::ZERO)).unwrap();
        assert_eq!(outlook.seconds_to_target, None);
    }

    #[test]
    fn the_time_limit_ends_before_the_pass_that_would_pass_it() {
        let settings = GatherSettings { time_limit: 10.0, ..Default::default() };
        let stop = Stop::new(&settings, Duration::from_secs(2));
        let convergence = Convergence::new(Duration::from_secs(2), 0);
        let after = |passes, seconds| stop.reason(&convergence, passes, Duration::from_secs(seconds));
        assert_eq!(after(1, 60), None, "each set of photons is read once");
        assert_eq!(after(2, 8), Some(StoppedBy::Time));
        assert_eq!(after(2, 7), None);
        // Of 8 passes 6 were there already: each of the two took 2 s.
        let resumed = Convergence::new(Duration::from_secs(2), 6);
        let after = |seconds| stop.reason(&resumed, 8, Duration::from_secs(seconds));
        assert_eq!((after(7), after(8)), (None, Some(StoppedBy::Time)));
    }
}
