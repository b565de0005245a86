//! Materials, directions and statistics for the tests of `bsdf`.
#![allow(dead_code, reason = "each test file uses a part")]

use std::f64::consts::{PI, TAU};

use glam::Vec3;
use rgp_renderer::bsdf::{Bsdf, LobeSet, MaterialTable, PreparedMaterial, TransportMode};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::Material;
use rgp_renderer::scene::record::{ClosureRecord, PrincipledRecord, WeightedClosure};

pub(crate) const RADIANCE: TransportMode = TransportMode::Radiance;
pub(crate) const IMPORTANCE: TransportMode = TransportMode::Importance;

/// A material of one closure.
pub(crate) fn prepared(closure: ClosureRecord) -> PreparedMaterial {
    mixed(vec![WeightedClosure { weight: Rgb::WHITE, closure }])
}

pub(crate) fn mixed(closures: Vec<WeightedClosure>) -> PreparedMaterial {
    PreparedMaterial::new(
        &Material { name: "test".into(), closures, program: None, absorption: Rgb::BLACK },
        &mut Vec::new(),
    )
}

pub(crate) fn table(closures: Vec<WeightedClosure>) -> MaterialTable {
    MaterialTable::build(&[Material { name: "test".into(), closures, program: None, absorption: Rgb::BLACK }])
}

pub(crate) fn diffuse(color: f32) -> ClosureRecord {
    rough_diffuse(color, 0.0)
}

pub(crate) fn rough_diffuse(color: f32, roughness: f32) -> ClosureRecord {
    ClosureRecord::Diffuse { color: Rgb::splat(color), roughness }
}

pub(crate) fn glossy(color: f32, roughness: f32) -> ClosureRecord {
    ClosureRecord::Glossy {
        color: Rgb::splat(color),
        roughness,
        anisotropy: 0.0,
        rotation: 0.0,
        multiscatter: true,
    }
}

pub(crate) fn glass(color: f32, roughness: f32, ior: f32) -> ClosureRecord {
    ClosureRecord::Glass { color: Rgb::splat(color), roughness, ior, multiscatter: true }
}

pub(crate) fn translucent(color: f32) -> ClosureRecord {
    ClosureRecord::Translucent { color: Rgb::splat(color) }
}

pub(crate) fn sheen(color: f32, roughness: f32) -> ClosureRecord {
    ClosureRecord::Sheen { color: Rgb::splat(color), roughness }
}

pub(crate) fn principled(change: impl FnOnce(&mut PrincipledRecord)) -> ClosureRecord {
    let mut record = PrincipledRecord::default();
    change(&mut record);
    ClosureRecord::Principled(record)
}

/// Direction at `cos` from +z.
pub(crate) fn at(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

/// The BSDF seen at `cos` from the front of a plane facing +z, or from behind.
pub(crate) fn seen(material: &PreparedMaterial, cos: f32, front: bool) -> Bsdf<'_> {
    let normal = if front { Vec3::Z } else { Vec3::NEG_Z };
    material.bsdf(at(cos), normal, normal)
}

/// SplitMix64: the tests' own random numbers, the same on every run.
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1_u64 << 24) as f32
    }

    /// Uniform on the sphere.
    pub(crate) fn direction(&mut self) -> Vec3 {
        let (z, phi) = (2.0 * self.next() - 1.0, std::f32::consts::TAU * self.next());
        let sin = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(sin * phi.cos(), sin * phi.sin(), z)
    }
}

/// Mean weight of one sample in each of `cells`³ cells of the sampling cube: an estimate of the albedo that owes nothing to the
/// tables but the choice of lobes.
pub(crate) fn sampled_albedo(bsdf: &Bsdf<'_>, set: LobeSet, mode: TransportMode, cells: u32) -> f64 {
    let mut rng = Rng(7);
    let mut sum = 0.0;
    for cell in 0..cells.pow(3) {
        let mut u = |k: u32| ((cell / cells.pow(k) % cells) as f32 + rng.next()) / cells as f32;
        if let Some(sample) = bsdf.sample(u(0), [u(1), u(2)], set, mode) {
            sum += f64::from(sample.weight.mean());
        }
    }
    sum / f64::from(cells.pow(3))
}

/// Rings about a pole and sectors of each, for [`chi_square`].
const RINGS: usize = 20;
const SECTORS: usize = 16;

/// Directions binned about a pole, finely near it: 1 − cos = 2 t⁴ with t uniform over the rings.
struct Grid {
    pole: Vec3,
    tangent: Vec3,
    bitangent: Vec3,
}

impl Grid {
    fn new(pole: Vec3) -> Self {
        let (tangent, bitangent) = pole.any_orthonormal_pair();
        Self { pole, tangent, bitangent }
    }

    fn direction(&self, t: f64, phi: f64) -> Vec3 {
        let (cos, sin) = (1.0 - 2.0 * t.powi(4), 2.0 * t * t * (1.0 - t.powi(4)).max(0.0).sqrt());
        let (x, y) = ((sin * phi.cos()) as f32, (sin * phi.sin()) as f32);
        (self.tangent * x + self.bitangent * y + self.pole * cos as f32).normalize()
    }

    fn bin(&self, wi: Vec3) -> usize {
        let (x, y) = (f64::from(wi.dot(self.tangent)), f64::from(wi.dot(self.bitangent)));
        let cos = f64::from(wi.dot(self.pole));
        let versine = if cos > 0.0 { (x * x + y * y) / (1.0 + cos) } else { 1.0 - cos };
        let t = (0.5 * versine).powf(0.25);
        let sector = (y.atan2(x).rem_euclid(TAU) / TAU * SECTORS as f64) as usize;
        ((t * RINGS as f64) as usize).min(RINGS - 1) * SECTORS + sector.min(SECTORS - 1)
    }

    /// Integral of `density` over `bin`.
    fn integral(&self, bin: usize, density: impl Fn(Vec3) -> f32) -> f64 {
        const STEPS: usize = 14;
        let (ring, sector) = (bin / SECTORS, bin % SECTORS);
        let part = |index: usize, step: usize, count: usize| {
            (index as f64 + (step as f64 + 0.5) / STEPS as f64) / count as f64
        };
        let cell = 8.0 * TAU / (RINGS * SECTORS * STEPS * STEPS) as f64;
        (0..STEPS * STEPS)
            .map(|step| {
                let t = part(ring, step / STEPS, RINGS);
                let phi = part(sector, step % STEPS, SECTORS) * TAU;
                f64::from(density(self.direction(t, phi))) * t.powi(3) * cell
            })
            .sum()
    }
}

/// Pearson's test that `sample` draws from `pdf`. Directions above and below the surface are binned about a pole each, best
/// put where the lobes peak. Returns the probability of a worse fit.
pub(crate) fn chi_square(bsdf: &Bsdf<'_>, set: LobeSet, poles: [Vec3; 2], seed: u64) -> f64 {
    const SAMPLES: u32 = 100_000;
    const BINS: usize = RINGS * SECTORS;
    let above = |wi: Vec3| wi.dot(bsdf.frame.ns) > 0.0;
    let grids = poles.map(Grid::new);
    let mut expected: Vec<f64> = (0..2 * BINS)
        .map(|bin| {
            let upper = bin < BINS;
            let density = |wi| if above(wi) == upper { bsdf.pdf(wi, set) } else { 0.0 };
            grids[usize::from(!upper)].integral(bin % BINS, density)
        })
        .collect();
    let inside: f64 = expected.iter().sum();
    assert!(inside < 1.005, "density integrates to {inside}");
    expected.push((1.0 - inside).max(0.0));

    let mut counts = vec![0.0; expected.len()];
    let mut rng = Rng(seed);
    for _ in 0..SAMPLES {
        let bin = match bsdf.sample(rng.next(), [rng.next(), rng.next()], set, RADIANCE) {
            Some(sample) if above(sample.wi) => grids[0].bin(sample.wi),
            Some(sample) => BINS + grids[1].bin(sample.wi),
            None => 2 * BINS,
        };
        counts[bin] += 1.0;
    }
    p_value(&expected.iter().map(|e| e * f64::from(SAMPLES)).collect::<Vec<_>>(), &counts)
}

/// Probability of counts at least this far from `expected`; bins expecting fewer than 8 are pooled.
fn p_value(expected: &[f64], counts: &[f64]) -> f64 {
    let (mut statistic, mut freedom) = (0.0, -1.0);
    let (mut pooled_expected, mut pooled_count) = (0.0, 0.0);
    for (&e, &c) in expected.iter().zip(counts) {
        if e < 8.0 {
            pooled_expected += e;
            pooled_count += c;
        } else {
            statistic += (c - e) * (c - e) / e;
            freedom += 1.0;
        }
    }
    if pooled_expected > 1.0 || pooled_count > 4.0 {
        statistic += (pooled_count - pooled_expected).powi(2) / f64::max(pooled_expected, 0.5);
        freedom += 1.0;
    }
    // Wilson and Hilferty: the cube root of chi square over its degrees of freedom is nearly normal.
    let spread = 2.0 / (9.0 * freedom);
    upper_tail(((statistic / freedom).cbrt() - (1.0 - spread)) / spread.sqrt())
}

/// Upper tail of the standard normal distribution, by the midpoint rule.
fn upper_tail(z: f64) -> f64 {
    let steps = 4000;
    let top = 12.0_f64.max(z + 1.0);
    let width = (top - z) / f64::from(steps);
    let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * PI).sqrt();
    (0..steps).map(|i| density(z + (f64::from(i) + 0.5) * width) * width).sum()
}

/// Significance of each of `count` tests for one of 1 % over all of them (Šidák).
pub(crate) fn significance(count: usize) -> f64 {
    1.0 - 0.99_f64.powf(1.0 / count as f64)
}
