//! How far the picture is from its own limit, from the difference of two independent halves.
//!
//! The halves share no camera sample, no gather ray and no photon. With weights v, w the mean of A and B has the variance
//! (A - B)² v w / (v + w)². Blur that both halves share (the size of the cells) is not in it.

use rayon::prelude::*;

use super::sums::Sums;
use crate::color::Rgb;
use crate::stats::{CLIPPED_AT, PictureError};

/// Variance of the mean of two values with these weights; 0 where one has no weight.
fn variance(a: Rgb, b: Rgb, [v, w]: [f32; 2]) -> f32 {
    let squares: f32 = a.0.iter().zip(b.0).map(|(a, b)| (a - b) * (a - b)).sum();
    if v > 0.0 && w > 0.0 { squares / 3.0 * (v * w / ((v + w) * (v + w))) } else { 0.0 }
}

/// Variance of a pixel's radiance, mean over the channels; 0 where a half does not know it.
pub(super) fn of_pixel(a: &Sums, b: &Sums) -> f32 {
    variance(a.combined(), b.combined(), [a.weight(), b.weight()])
}

/// Of the mean of two halves of a picture with rows of `width` pixels; `None` while no pixel is known to both, or all are
/// black.
pub(super) fn of_picture(a: &[Sums], b: &[Sums], width: usize) -> Option<PictureError> {
    let [mean, square, peak] = moments(a, b, width, f32::INFINITY)?;
    if mean <= 0.0 {
        return None;
    }
    let rms = square.sqrt();
    let [clipped_mean, clipped_square, _] = moments(a, b, width, CLIPPED_AT * mean as f32)?;
    Some(PictureError {
        rms_clipped: 100.0 * clipped_square.sqrt() / clipped_mean,
        rms_mean: 100.0 * rms / mean,
        rms_peak: 100.0 * rms / peak,
    })
}

/// Mean and mean variance over all pixels and channels, and the largest channel, of halves that are clipped at `most`;
/// `None` where no pixel is known to both.
fn moments(a: &[Sums], b: &[Sums], width: usize, most: f32) -> Option<[f64; 3]> {
    let clip = |sums: &Sums| Rgb(sums.combined().0.map(|channel| channel.min(most)));
    let row = |(a, b): (&[Sums], &[Sums])| {
        let mut row = [0.0, 0.0, 0.0_f64, 0.0];
        for (a, b) in a.iter().zip(b).filter(|(a, b)| a.is_known() && b.is_known()) {
            let pixel = clip(&a.with(b));
            row[0] += f64::from(pixel.0.iter().sum::<f32>());
            row[1] += f64::from(variance(clip(a), clip(b), [a.weight(), b.weight()]));
            row[2] = row[2].max(f64::from(pixel.max_channel()));
            row[3] += 1.0;
        }
        row
    };
    let rows = a.par_chunks(width.max(1)).zip(b.par_chunks(width.max(1)));
    let rows: Vec<[f64; 4]> = rows.map(row).collect();
    // Row by row, so that the sums do not depend on threads.
    let [sum, square, peak, known] = rows.iter().fold([0.0, 0.0, 0.0_f64, 0.0], |total, row| {
        [total[0] + row[0], total[1] + row[1], total[2].max(row[2]), total[3] + row[3]]
    });
    (known > 0.0).then(|| [sum / (3.0 * known), square / known, peak])
}
