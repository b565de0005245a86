//! Where the passes meet: what takes the photons of the photon pass, and what then answers for the light at the end of
//! a gather ray.
//!
//! The renderer has one of each, the accumulator and the pyramid it becomes. The traits let other methods be measured
//! under the same photons and the same gather rays (module `baseline`); everything generic over them is compiled for
//! each, so that the pyramid pays nothing for the choice.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::accel::LANES;
use crate::bsdf::LobeSet;
use crate::color::Rgb;
use crate::lit_scene::Surface;
use crate::math::Side;
use crate::sampling::Rng;

/// A photon on a surface that scatters widely enough for its light to be stored.
#[derive(Debug)]
pub struct Landing<'a> {
    /// The surface; its `bsdf.wo` points to where the photon came from.
    pub surface: &'a Surface<'a>,
    /// Set of photons it belongs to.
    pub set: usize,
    /// Flux before the surface's albedo (W).
    pub flux: Rgb,
    /// The photon lights glossy lobes of the surface.
    pub glossy: bool,
    /// A random point of the unit square that belongs to a landing on glossy lobes.
    pub at: [f32; 2],
}

/// Takes photons.
pub trait PhotonSink: Sync {
    /// What one task of the photon pass collects on its own.
    type Batch: Default + Send;

    /// Adds a photon.
    fn land(&self, batch: &mut Self::Batch, landing: &Landing<'_>);

    /// Takes over a full batch. Batches are numbered in the order of their photons, whichever ends first.
    fn finish(&self, number: u64, batch: Self::Batch);
}

/// The solid angle a ray stands for, and how far it came.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    /// Solid angle (sr); 0 asks for the finest detail there is.
    pub solid_angle: f32,
    /// Length so far (scene units).
    pub travelled: f32,
    /// Mirror-like: what is seen must be shaded, not read, unless the footprint hides the difference.
    pub sharp: bool,
}

impl Footprint {
    /// Ω r² (square scene units).
    #[must_use]
    #[inline(always)]
    pub fn area(&self) -> f32 {
        self.solid_angle * self.travelled * self.travelled
    }
}

/// Answers for the light that leaves surfaces where gather rays end: their diffuse and glossy lobes. Sharper lobes are
/// followed by the gather whatever the method.
pub trait Estimator: Sync {
    /// All that a look-up needs.
    type Place: Copy + Default + Send + Sync;

    /// What is read is radiance that leaves towards `wo`, the surface's albedo included, and not irradiance.
    const READS_RADIANCE: bool = false;

    /// Light on the far side of a surface can be read too, for what scatters it through; else such surfaces are followed.
    const READS_BOTH_SIDES: bool = false;

    /// Answers are put off until many hits have come together, see [`Estimator::answer`].
    const DEFERS: bool = false;

    /// Bounces that a path is allowed at least, whatever the setting.
    const LEAST_DEPTH: u32 = 0;

    /// Where to read the light at `p` on one side of a surface, seen from the unit vector `wo`; `None` where the ray has to
    /// be followed instead.
    fn place(&self, p: Vec3, side: Side, wo: Vec3, footprint: Footprint) -> Option<Self::Place>;

    /// Irradiance (W·m⁻²), or radiance (W·m⁻²·sr⁻¹) of those that read radiance; `None` where it cannot be told, and the ray
    /// has to be followed after all.
    fn read(&self, place: &Self::Place) -> Option<Rgb>;

    /// [`Estimator::read`] at the places that are `set`, which those that cannot be told then are no more; black at the
    /// others.
    #[inline]
    fn read_all(&self, places: &[Self::Place; LANES], set: &mut [bool; LANES]) -> [Rgb; LANES] {
        std::array::from_fn(|i| {
            let read = if set[i] { self.read(&places[i]) } else { None };
            set[i] = read.is_some();
            read.unwrap_or(Rgb::BLACK)
        })
    }

    /// Those that defer answer nothing but this: the light at every place, in order; black where it cannot be told.
    fn answer(&self, places: &[Self::Place]) -> Vec<Rgb> {
        places.iter().map(|place| self.read(place).unwrap_or(Rgb::BLACK)).collect()
    }

    /// Radiance that those of the diffuse and glossy lobes of `surface` that are in `lobes` send to where the ray came from;
    /// `None` where the ray has to be followed instead. Methods that know nothing but irradiance treat a glossy lobe as a diffuse one of the same
    /// albedo.
    fn radiance(
        &self,
        surface: &Surface<'_>,
        lobes: LobeSet,
        footprint: Footprint,
        _rng: &mut Rng,
    ) -> Option<Rgb> {
        let place = self.place(surface.p, surface.bsdf.frame.side(), surface.bsdf.wo(), footprint)?;
        Some(reflectance::<Self>(surface, lobes) * self.read(&place)?)
    }
}

/// No structure at all: every gather hit is shaded and its path followed to the end, with next-event estimation and
/// roulette. Unbiased, and the reference for all others.
#[derive(Clone, Copy, Debug)]
pub struct Path;

impl Estimator for Path {
    type Place = ();

    /// Roulette ends a path long before.
    const LEAST_DEPTH: u32 = 1000;

    #[inline]
    fn place(&self, _p: Vec3, _side: Side, _wo: Vec3, _footprint: Footprint) -> Option<()> {
        None
    }

    fn read(&self, (): &()) -> Option<Rgb> {
        None
    }

    fn radiance(
        &self,
        _surface: &Surface<'_>,
        _lobes: LobeSet,
        _footprint: Footprint,
        _rng: &mut Rng,
    ) -> Option<Rgb> {
        None
    }
}

/// What turns a reading into radiance: the albedo over π of the lobes whose light is read, taken as diffuse.
#[must_use]
pub fn reflectance<E: Estimator + ?Sized>(surface: &Surface<'_>, lobes: LobeSet) -> Rgb {
    if E::READS_RADIANCE {
        return Rgb::WHITE;
    }
    surface.bsdf.albedo(lobes) * FRAC_1_PI
}
