//! How much light a GGX surface returns: directional albedos over roughness, direction and index of refraction,
//! integrated here once and interpolated afterwards.
//!
//! Single scattering loses the light that would leave only after several bounces between microfacets. These albedos say
//! how much, and the lobes are scaled up by it (Turquin 2019, "Practical multiple scattering compensation for microfacet
//! models"), as Blender's "Multiscatter GGX" does.
//!
//! The integrals are taken over visible normals with a Fibonacci lattice; the same bits come out on every machine that
//! rounds as IEEE 754 says. A slice of the dielectric table is made when the first material near its index needs it.

use std::f32::consts::PI;
use std::sync::{LazyLock, OnceLock};

use glam::Vec3;
use rayon::prelude::*;

use super::{fresnel, ggx};
use crate::color::Rgb;

/// Nodes of the index of refraction, uniform along the fourth root of F0: from 1 to infinity, dense between 1 and 2.
const INDEX_NODES: usize = 31;
/// Points of the lattice (a Fibonacci number) and its generator (the one before).
const POINTS: usize = 610;
const GENERATOR: usize = 377;

/// Albedos of GGX reflection with constant reflectance 1, and of the parts a metal's Fresnel curve is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reflection {
    /// Single-scattering albedo.
    pub(super) total: f32,
    /// Its cosine-weighted mean over directions.
    pub(super) mean: f32,
    /// Albedo with reflectance (1 − cos)⁵.
    pub(super) schlick: f32,
    /// Albedo with reflectance cos · (1 − cos)⁶.
    pub(super) dent: f32,
}

/// Albedos of a rough dielectric interface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dielectric {
    /// Albedo of reflection with reflectance [`fresnel::dielectric_rise`] (call it s).
    pub(super) rise: f32,
    /// Albedo of refraction with transmittance 1 − s.
    pub(super) through: f32,
    /// Albedo of refraction with transmittance 1 short of total reflection.
    pub(super) refracted: f32,
    /// Mean of s over visible normals that reflect upwards, by which Cycles dims what lies below a layer; only from outside.
    pub(super) layer: f32,
    /// What would be added to `through` if refracted light that ends above the surface were not lost; only from inside.
    /// Cycles has tables made with it (Blender 4.0 to 5.2) but renders without it, so that rough glass loses up to 2 % of
    /// the light at each crossing from inside. To agree, it is part of what [`compensation`] brings to 1.
    pub(super) stray: f32,
    /// Albedo of reflection and refraction together with `stray`, averaged over directions.
    pub(super) mean: f32,
}

/// Reflection albedos at Blender's roughness and the cosine of the direction.
pub(super) fn reflection(roughness: f32, cos: f32) -> Reflection {
    let t = axis(cos, 0.0);
    let [total] = TOTAL.at(roughness, t);
    let [schlick, dent] = METAL.at(roughness, t);
    Reflection { total, mean: TOTAL.mean(roughness), schlick: schlick * total, dent: dent * total }
}

/// Dielectric albedos; `eta` is the index beyond the interface over the one on the side the light comes from and leaves to,
/// `total` that of [`Reflection`] for the same roughness and cosine.
pub(super) fn dielectric(roughness: f32, cos: f32, eta: f32, total: f32) -> Dielectric {
    let (low, high, t) = index_position(eta);
    let (low, high) = (slice(low, eta < 1.0), slice(high, eta < 1.0));
    let mix = |a: f32, b: f32| a + (b - a) * t;
    let t_cos = axis(cos, critical_cos(eta));
    let (a, b) = (low.at(roughness, t_cos), high.at(roughness, t_cos));
    let [rise, through, refracted, last] = std::array::from_fn(|k| mix(a[k], b[k]));
    let (layer, stray) = if eta < 1.0 { (0.0, last) } else { (last, 0.0) };
    Dielectric {
        rise: rise * total,
        through: through * total,
        refracted: refracted * total,
        layer,
        stray: stray * total,
        mean: mix(low.mean(roughness), high.mean(roughness)),
    }
}

/// Factor that brings the single-scattering albedo `total` up to what many bounces between microfacets return, each of
/// them losing 1 − `fss` (Kulla and Conty 2017); `mean` is the hemispherical mean of `total`. For `fss` = 1 it is 1 / total.
pub(super) fn compensation(total: f32, mean: f32, fss: Rgb) -> Rgb {
    let missing = (1.0 - total).max(0.0) / total.max(1e-4);
    fss.map(|f| 1.0 + f * mean / (1.0 - f * (1.0 - mean)).max(1e-4) * missing)
}

/// Makes every slice now, for indices that are not known beforehand.
pub(super) fn prepare_all() {
    LazyLock::force(&TOTAL);
    LazyLock::force(&METAL);
    (0..INDEX_NODES).into_par_iter().for_each(|node| {
        [false, true].into_par_iter().for_each(|inside| {
            slice(node, inside);
        });
    });
}

/// Makes the slices around every `eta` now, from both sides, so that no ray has to.
pub(super) fn prepare(etas: &[f32]) {
    LazyLock::force(&TOTAL);
    LazyLock::force(&METAL);
    etas.par_iter().for_each(|&eta| {
        let (low, high, _) = index_position(eta);
        [(low, false), (high, false), (low, true), (high, true)].into_par_iter().for_each(
            |(index, inside)| {
                slice(index, inside);
            },
        );
    });
}

/// Cosine at which total reflection sets in, from inside; 0 from outside.
fn critical_cos(eta: f32) -> f32 {
    (1.0 - eta * eta).max(0.0).sqrt()
}

/// Where `cos` lies on the axis of cosines, 0 to 1: dense at grazing, where albedos bend, and with the edge of total
/// reflection in the middle, so that tables of different indices can be mixed.
fn axis(cos: f32, edge: f32) -> f32 {
    let cos = cos.max(0.0);
    if edge <= 0.0 {
        cos.sqrt()
    } else if cos < edge {
        0.5 * (cos / edge).sqrt()
    } else {
        0.5 + 0.5 * ((cos - edge) / (1.0 - edge)).sqrt()
    }
}

/// The cosine at `t` of the axis: [`axis`] inverted, kept off 0.
fn axis_cos(t: f32, edge: f32) -> f32 {
    let cos = if edge <= 0.0 {
        t * t
    } else if t < 0.5 {
        edge * (2.0 * t).powi(2)
    } else {
        edge + (1.0 - edge) * (2.0 * t - 1.0).powi(2)
    };
    cos.max(1e-4)
}

/// K values at nodes uniform in roughness and along [`axis`], and one mean over cosines per roughness.
struct Table<const K: usize> {
    rows: usize,
    columns: usize,
    values: Vec<[f32; K]>,
    means: Vec<f32>,
}

impl<const K: usize> Table<K> {
    /// `value` takes alpha and cosine; `mean_of` takes roughness, cosine and the value, and is averaged.
    fn new(
        [rows, columns]: [usize; 2],
        edge: f32,
        value: impl Fn(f32, f32) -> [f32; K],
        mean_of: impl Fn(f32, f32, &[f32; K]) -> f32,
    ) -> Self {
        let node = |k: usize, nodes: usize| k as f32 / (nodes - 1) as f32;
        let cosines: Vec<f32> = (0..columns).map(|k| axis_cos(node(k, columns), edge)).collect();
        let (mut values, mut means) = (Vec::with_capacity(rows * columns), Vec::with_capacity(rows));
        for roughness in (0..rows).map(|k| node(k, rows)) {
            let row: Vec<_> = cosines.iter().map(|&cos| value(roughness * roughness, cos)).collect();
            let averaged = cosines.iter().zip(&row).map(|(&cos, value)| mean_of(roughness, cos, value));
            means.push(mean_over_cosines(&cosines, &averaged.collect::<Vec<f32>>()));
            values.extend(row);
        }
        Self { rows, columns, values, means }
    }

    fn mean(&self, roughness: f32) -> f32 {
        let (row, t) = roughness_position(roughness, self.rows);
        self.means[row] + (self.means[row + 1] - self.means[row]) * t
    }

    /// At a roughness and a place `t` on the axis.
    fn at(&self, roughness: f32, t: f32) -> [f32; K] {
        let (row, s) = roughness_position(roughness, self.rows);
        let (column, t) = position(t, self.columns);
        let at = row * self.columns + column;
        let (a, b) = (&self.values[at], &self.values[at + 1]);
        let (c, d) = (&self.values[at + self.columns], &self.values[at + self.columns + 1]);
        std::array::from_fn(|k| {
            let low = a[k] + (b[k] - a[k]) * t;
            let high = c[k] + (d[k] - c[k]) * t;
            low + (high - low) * s
        })
    }
}

/// Single-scattering albedo of reflection. It falls off sharply where the cosine nears alpha; every other table holds
/// ratios to it, which are smooth.
static TOTAL: LazyLock<Table<1>> = LazyLock::new(|| {
    let total = |alpha, cos| integrate(alpha, cos, |wo, h| [reflection_masking(alpha, wo, h)]);
    Table::new([48, 40], 0.0, total, |_, _, [total]| *total)
});

/// Means of a metal's (1 − cos)⁵ and cos (1 − cos)⁶ over what is reflected.
static METAL: LazyLock<Table<2>> = LazyLock::new(|| {
    let parts = |alpha, cos| {
        let [total, schlick, dent] = integrate(alpha, cos, |wo, h| {
            let c = wo.dot(h).min(1.0);
            let masking = reflection_masking(alpha, wo, h);
            let schlick = masking * fresnel::schlick_rise(c);
            [masking, schlick, schlick * c * (1.0 - c)]
        });
        [schlick / total, dent / total]
    };
    Table::new([24, 32], 0.0, parts, |_, _, _| 0.0)
});

/// [`Dielectric`] at one node of the index from one side: rise, through, refracted, and layer (from outside) or stray (from
/// inside). All but `layer` are over [`TOTAL`].
fn slice(index: usize, inside: bool) -> &'static Table<4> {
    static SLICES: [[OnceLock<Table<4>>; INDEX_NODES]; 2] =
        [const { [const { OnceLock::new() }; INDEX_NODES] }; 2];
    SLICES[usize::from(inside)][index].get_or_init(|| {
        let z = (index as f32 / (INDEX_NODES - 1) as f32).clamp(0.01, 0.99);
        let ior = (1.0 + z * z) / (1.0 - z * z);
        dielectric_table(if inside { 1.0 / ior } else { ior })
    })
}

fn dielectric_table(eta: f32) -> Table<4> {
    let f0 = fresnel::f0_from_ior(eta);
    let parts = |alpha, cos| {
        let [total, rise, through, refracted, stray, layer] = integrate(alpha, cos, |wo, h| {
            let rise = fresnel::dielectric_rise(wo.dot(h).min(1.0), eta);
            let reflected = reflection_masking(alpha, wo, h);
            let (refracted, stray) = refraction_masking(alpha, wo, h, eta);
            let layer = if reflected > 0.0 { rise } else { 0.0 };
            let through = 1.0 - rise;
            [reflected, reflected * rise, refracted * through, refracted, stray * through, layer]
        });
        let last = if eta < 1.0 { stray / total } else { layer };
        [rise / total, through / total, refracted / total, last]
    };
    // Total reflection puts an edge into the albedos from inside.
    let nodes = if eta < 1.0 { [40, 40] } else { [24, 32] };
    Table::new(nodes, critical_cos(eta), parts, |roughness, cos, [rise, through, _, last]| {
        let stray = if eta < 1.0 { *last } else { 0.0 };
        let ratio = f0 * (1.0 - rise) + rise + (1.0 - f0) * (through + stray);
        ratio * TOTAL.at(roughness, axis(cos, 0.0))[0]
    })
}

/// G2/G1 of the direction mirrored at `h`; 0 where it points below the surface.
fn reflection_masking(alpha: f32, wo: Vec3, h: Vec3) -> f32 {
    let wi = h * (2.0 * wo.dot(h)) - wo;
    if wi.z > 0.0 { masking_ratio(alpha, wo.z, wi.z) } else { 0.0 }
}

/// G2/G1 of the direction refracted at `h`: where it ends below the surface, and where above.
fn refraction_masking(alpha: f32, wo: Vec3, h: Vec3, eta: f32) -> (f32, f32) {
    match fresnel::refract(wo, h, eta) {
        Some(wi) if wi.z < 0.0 => (masking_ratio(alpha, wo.z, wi.z), 0.0),
        Some(wi) => (0.0, masking_ratio(alpha, wo.z, wi.z)),
        None => (0.0, 0.0),
    }
}

fn masking_ratio(alpha: f32, cos_o: f32, cos_i: f32) -> f32 {
    let lambda_o = ggx::lambda(alpha, cos_o);
    (1.0 + lambda_o) / (1.0 + lambda_o + ggx::lambda(alpha, cos_i))
}

/// Mean of `f(wo, h)` over the normals h visible from `wo` at `cos`. The half turn of azimuths suffices by symmetry.
fn integrate<const K: usize>(alpha: f32, cos: f32, f: impl Fn(Vec3, Vec3) -> [f32; K]) -> [f32; K] {
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let stretched = Vec3::new(wo.x * alpha, 0.0, wo.z).normalize();
    let mut sum = [0.0; K];
    for (azimuth, u) in LATTICE.iter() {
        let value = f(wo, ggx::visible_normal([alpha; 2], stretched, *azimuth, *u));
        for (total, v) in sum.iter_mut().zip(value) {
            *total += v;
        }
    }
    sum.map(|v| v / POINTS as f32)
}

/// Cosine and sine of the azimuth in [0, π], and the second lattice coordinate.
static LATTICE: LazyLock<Vec<([f32; 2], f32)>> = LazyLock::new(|| {
    (0..POINTS)
        .map(|i| {
            let (sin, cos) = (PI * ((i as f32 + 0.5) / POINTS as f32)).sin_cos();
            let u = ((i * GENERATOR) % POINTS) as f32;
            ([cos, sin], (u + 0.5) / POINTS as f32)
        })
        .collect()
});

/// ∫ 2 cos f dcos / ∫ 2 cos dcos with f linear between the nodes.
fn mean_over_cosines(cosines: &[f32], values: &[f32]) -> f32 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (c, f) in cosines.windows(2).zip(values.windows(2)) {
        let (at_low, at_high) = (2.0 * c[0] + c[1], c[0] + 2.0 * c[1]);
        sum += (c[1] - c[0]) * (f[0] * at_low + f[1] * at_high);
        weights += (c[1] - c[0]) * (at_low + at_high);
    }
    sum / weights
}

/// Node below `x` in [0, 1] and the way to the next.
fn position(x: f32, nodes: usize) -> (usize, f32) {
    let x = x.clamp(0.0, 1.0) * (nodes - 1) as f32;
    let at = (x as usize).min(nodes - 2);
    (at, x - at as f32)
}

/// Node below `roughness` and the way to the next, measured in alpha: near a mirror albedos change with alpha, so the nodes
/// lie dense where it is small.
fn roughness_position(roughness: f32, nodes: usize) -> (usize, f32) {
    let (at, t) = position(roughness, nodes);
    let low = at as f32;
    (at, t * (2.0 * low + t) / (2.0 * low + 1.0))
}

/// Index nodes around `eta` (or its reciprocal, below 1) and the way between them.
fn index_position(eta: f32) -> (usize, usize, f32) {
    let z = ((eta - 1.0) / (eta + 1.0)).abs().sqrt();
    let (at, t) = position(z, INDEX_NODES);
    (at, at + 1, t)
}
