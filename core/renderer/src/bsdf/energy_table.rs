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

use super::{fresnel, ggx};
use crate::color::Rgb;

/// Nodes along Blender's roughness, uniform.
const ROUGHNESS_NODES: usize = 32;
/// Nodes along the square root of the cosine, uniform: dense at grazing, where albedos bend.
const COS_NODES: usize = 32;
/// Nodes along the fourth root of F0, uniform: indices from 1 to infinity, dense between 1 and 2.
const INDEX_NODES: usize = 16;
/// Points of the lattice (a Fibonacci number) and its generator (the one before).
const POINTS: usize = 377;
const GENERATOR: usize = 233;

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
    let [total, schlick, dent] = REFLECTION.albedos.at(roughness, cos);
    Reflection { total, mean: interpolate(&REFLECTION.means, roughness), schlick, dent }
}

/// Dielectric albedos; `eta` is the index beyond the interface over the one on the side the light comes from and leaves to.
pub(super) fn dielectric(roughness: f32, cos: f32, eta: f32) -> Dielectric {
    let (low, high, t) = index_position(eta);
    let (low, high) = (slice(low), slice(high));
    let mix = |a: f32, b: f32| a + (b - a) * t;
    let side = usize::from(eta < 1.0);
    let a = low.sides[side].albedos.at(roughness, cos);
    let b = high.sides[side].albedos.at(roughness, cos);
    let last = mix(a[3], b[3]);
    let (layer, stray) = if side == 0 { (last, 0.0) } else { (0.0, last) };
    Dielectric {
        rise: mix(a[0], b[0]),
        through: mix(a[1], b[1]),
        refracted: mix(a[2], b[2]),
        layer,
        stray,
        mean: mix(
            interpolate(&low.sides[side].means, roughness),
            interpolate(&high.sides[side].means, roughness),
        ),
    }
}

/// Factor that brings the single-scattering albedo `total` up to what many bounces between microfacets return, each of
/// them losing 1 − `fss` (Kulla and Conty 2017); `mean` is the hemispherical mean of `total`. For `fss` = 1 it is 1 / total.
pub(super) fn compensation(total: f32, mean: f32, fss: Rgb) -> Rgb {
    let missing = (1.0 - total).max(0.0) / total.max(1e-4);
    fss.map(|f| 1.0 + f * mean / (1.0 - f * (1.0 - mean)).max(1e-4) * missing)
}

/// Makes the slices around `eta` now, so that no ray has to.
pub(super) fn prepare(eta: f32) {
    let (low, high, _) = index_position(eta);
    LazyLock::force(&REFLECTION);
    slice(low);
    slice(high);
}

/// K albedos at every node of roughness and cosine.
struct Grid<const K: usize>(Vec<[f32; K]>);

impl<const K: usize> Grid<K> {
    fn at(&self, roughness: f32, cos: f32) -> [f32; K] {
        let (row, s) = position(roughness, ROUGHNESS_NODES);
        let (column, t) = position(cos.max(0.0).sqrt(), COS_NODES);
        let at = row * COS_NODES + column;
        let (a, b) = (&self.0[at], &self.0[at + 1]);
        let (c, d) = (&self.0[at + COS_NODES], &self.0[at + COS_NODES + 1]);
        std::array::from_fn(|k| {
            let low = a[k] + (b[k] - a[k]) * t;
            let high = c[k] + (d[k] - c[k]) * t;
            low + (high - low) * s
        })
    }
}

/// Albedos by roughness and cosine, and the mean over cosines of what is scaled to 1, by roughness.
struct Table<const K: usize> {
    albedos: Grid<K>,
    means: Vec<f32>,
}

impl<const K: usize> Table<K> {
    fn new(albedos: impl Fn(f32, f32) -> [f32; K], scaled: impl Fn(f32, f32, &[f32; K]) -> f32) -> Self {
        let node = |k: usize, nodes: usize| k as f32 / (nodes - 1) as f32;
        let roughnesses = (0..ROUGHNESS_NODES).map(|k| node(k, ROUGHNESS_NODES));
        let cosines: Vec<f32> = (0..COS_NODES).map(|k| node(k, COS_NODES).powi(2).max(1e-4)).collect();
        let mut grid = Vec::with_capacity(ROUGHNESS_NODES * COS_NODES);
        let mut means = Vec::with_capacity(ROUGHNESS_NODES);
        for roughness in roughnesses {
            let row: Vec<[f32; K]> = cosines.iter().map(|&cos| albedos(roughness * roughness, cos)).collect();
            let values: Vec<f32> =
                cosines.iter().zip(&row).map(|(&cos, node)| scaled(roughness, cos, node)).collect();
            means.push(mean_over_cosines(&values));
            grid.extend(row);
        }
        Self { albedos: Grid(grid), means }
    }
}

/// Both sides of the interface at one node of the index: from outside (index above 1), from inside.
struct Slice {
    sides: [Table<4>; 2],
}

static REFLECTION: LazyLock<Table<3>> = LazyLock::new(|| {
    Table::new(
        |alpha, cos| {
            integrate(alpha, cos, |wo, h| {
                let c = wo.dot(h).min(1.0);
                let masking = reflection_masking(alpha, wo, h);
                let schlick = masking * fresnel::schlick_rise(c);
                [masking, schlick, schlick * c * (1.0 - c)]
            })
        },
        |_, _, node| node[0],
    )
});

static SLICES: [OnceLock<Slice>; INDEX_NODES] = [const { OnceLock::new() }; INDEX_NODES];

fn slice(index: usize) -> &'static Slice {
    SLICES[index].get_or_init(|| {
        let z = (index as f32 / (INDEX_NODES - 1) as f32).clamp(0.01, 0.99);
        let ior = (1.0 + z * z) / (1.0 - z * z);
        Slice { sides: [ior, 1.0 / ior].map(dielectric_table) }
    })
}

fn dielectric_table(eta: f32) -> Table<4> {
    let f0 = fresnel::f0_from_ior(eta);
    Table::new(
        |alpha, cos| {
            integrate(alpha, cos, |wo, h| {
                let rise = fresnel::dielectric_rise(wo.dot(h).min(1.0), eta);
                let reflected = reflection_masking(alpha, wo, h);
                let (refracted, stray) = refraction_masking(alpha, wo, h, eta);
                // `layer` from outside, `stray` from inside.
                let last = match (eta < 1.0, reflected > 0.0) {
                    (true, _) => stray * (1.0 - rise),
                    (false, true) => rise,
                    (false, false) => 0.0,
                };
                [reflected * rise, refracted * (1.0 - rise), refracted, last]
            })
        },
        |roughness, cos, [rise, through, _, last]| {
            let total = reflection(roughness, cos).total;
            let stray = if eta < 1.0 { *last } else { 0.0 };
            f0 * (total - rise) + rise + (1.0 - f0) * (through + stray)
        },
    )
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
        let value = f(wo, ggx::visible_normal(alpha, stretched, *azimuth, *u));
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

/// ∫ 2 cos f dcos with f linear between the nodes in √cos: f at t has weight 4 t³.
fn mean_over_cosines(values: &[f32]) -> f32 {
    const STEPS: usize = 8;
    let steps = (values.len() - 1) * STEPS;
    let (mut sum, mut weights) = (0.0, 0.0);
    for k in 0..steps {
        let t = (k as f32 + 0.5) / steps as f32;
        let weight = t * t * t;
        sum += weight * interpolate(values, t);
        weights += weight;
    }
    sum / weights
}

/// Linear interpolation between values at uniform nodes over [0, 1].
fn interpolate(values: &[f32], x: f32) -> f32 {
    let (at, t) = position(x, values.len());
    values[at] + (values[at + 1] - values[at]) * t
}

/// Node below `x` in [0, 1] and the way to the next.
fn position(x: f32, nodes: usize) -> (usize, f32) {
    let x = x.clamp(0.0, 1.0) * (nodes - 1) as f32;
    let at = (x as usize).min(nodes - 2);
    (at, x - at as f32)
}

/// Index nodes around `eta` (or its reciprocal, below 1) and the way between them.
fn index_position(eta: f32) -> (usize, usize, f32) {
    let z = ((eta - 1.0) / (eta + 1.0)).abs().sqrt();
    let (at, t) = position(z, INDEX_NODES);
    (at, at + 1, t)
}
