//! Blender's noise: hashes of lattice points, gradients between them (Perlin 2002, "Improving Noise"), and sums of it over
//! octaves (Musgrave 1994, in Ebert et al., "Texturing and Modeling").

use glam::Vec3;
use serde::Deserialize;

/// How octaves are put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum Fractal {
    Fbm,
    Multifractal,
    RidgedMultifractal,
    HybridMultifractal,
    HeteroTerrain,
}

/// The octaves of a noise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Octaves {
    pub(super) fractal: Fractal,
    /// Number of octaves beyond the first; a part of one counts in part.
    pub(super) detail: f32,
    pub(super) roughness: f32,
    pub(super) lacunarity: f32,
    pub(super) offset: f32,
    pub(super) gain: f32,
    /// Within 0 and 1.
    pub(super) normalize: bool,
}

/// A point of one to four dimensions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Position {
    pub(super) x: [f32; 4],
    pub(super) dimensions: usize,
}

impl Position {
    fn map(mut self, f: impl Fn(usize, f32) -> f32) -> Self {
        for i in 0..self.dimensions {
            self.x[i] = f(i, self.x[i]);
        }
        self
    }

    fn scaled(self, factor: f32) -> Self {
        self.map(|_, x| x * factor)
    }

    /// Moved far away, to where noise has nothing to do with the noise here.
    fn elsewhere(self, seed: u8) -> Self {
        let seed = f32::from(seed);
        let one = self.dimensions == 1;
        self.map(|i, x| {
            let random = if one { unit_hash(&[seed]) } else { unit_hash(&[seed, i as f32]) };
            x + 100.0 + random * 100.0
        })
    }
}

/// Noise over octaves at a point that is moved by noise first.
pub(super) fn distorted(p: Position, distortion: f32, octaves: &Octaves) -> f32 {
    fractal(moved(p, distortion), octaves)
}

/// Three such noises that have nothing to do with each other.
pub(super) fn distorted_color(p: Position, distortion: f32, octaves: &Octaves) -> Vec3 {
    let p_moved = moved(p, distortion);
    let seed = p.dimensions as u8;
    let channel = |seed| fractal(p_moved.elsewhere(seed), octaves);
    Vec3::new(fractal(p_moved, octaves), channel(seed), channel(seed + 1))
}

fn moved(p: Position, distortion: f32) -> Position {
    if distortion == 0.0 {
        return p;
    }
    p.map(|i, x| x + perlin(p.elsewhere(i as u8)) * distortion)
}

/// Noise over octaves.
pub(super) fn fractal(p: Position, o: &Octaves) -> f32 {
    match o.fractal {
        Fractal::Fbm => fbm(p, o),
        Fractal::Multifractal => multifractal(p, o),
        Fractal::RidgedMultifractal => ridged(p, o),
        Fractal::HybridMultifractal => hybrid(p, o),
        Fractal::HeteroTerrain => terrain(p, o),
    }
}

fn fbm(p: Position, o: &Octaves) -> f32 {
    let (mut scale, mut amplitude, mut most, mut sum) = (1.0, 1.0, 0.0, 0.0);
    for _ in 0..=o.detail as u32 {
        sum += perlin(p.scaled(scale)) * amplitude;
        most += amplitude;
        amplitude *= o.roughness;
        scale *= o.lacunarity;
    }
    let finished = |sum: f32, most: f32| if o.normalize { 0.5 * sum / most + 0.5 } else { sum };
    let rest = o.detail.fract();
    if rest == 0.0 {
        return finished(sum, most);
    }
    let (low, high) = (finished(sum, most), sum + perlin(p.scaled(scale)) * amplitude);
    low + (finished(high, most + amplitude) - low) * rest
}

fn multifractal(mut p: Position, o: &Octaves) -> f32 {
    let (mut value, mut power) = (1.0, 1.0);
    for _ in 0..=o.detail as u32 {
        value *= power * perlin(p) + 1.0;
        power *= o.roughness;
        p = p.scaled(o.lacunarity);
    }
    let rest = o.detail.fract();
    if rest == 0.0 { value } else { value * (rest * power * perlin(p) + 1.0) }
}

fn terrain(mut p: Position, o: &Octaves) -> f32 {
    let (mut power, mut value) = (o.roughness, o.offset + perlin(p));
    p = p.scaled(o.lacunarity);
    for _ in 1..=o.detail as u32 {
        value += (perlin(p) + o.offset) * power * value;
        power *= o.roughness;
        p = p.scaled(o.lacunarity);
    }
    let rest = o.detail.fract();
    if rest == 0.0 { value } else { value + rest * (perlin(p) + o.offset) * power * value }
}

fn hybrid(mut p: Position, o: &Octaves) -> f32 {
    let (mut power, mut value, mut weight) = (1.0, 0.0, 1.0_f32);
    for _ in 0..=o.detail as u32 {
        if weight <= 0.001 {
            break;
        }
        weight = weight.min(1.0);
        let signal = (perlin(p) + o.offset) * power;
        power *= o.roughness;
        value += weight * signal;
        weight *= o.gain * signal;
        p = p.scaled(o.lacunarity);
    }
    let rest = o.detail.fract();
    if rest == 0.0 || weight <= 0.001 {
        return value;
    }
    value + rest * weight.min(1.0) * (perlin(p) + o.offset) * power
}

fn ridged(mut p: Position, o: &Octaves) -> f32 {
    let mut power = o.roughness;
    let mut signal = (o.offset - perlin(p).abs()).powi(2);
    let mut value = signal;
    for _ in 1..=o.detail as u32 {
        p = p.scaled(o.lacunarity);
        let weight = (signal * o.gain).clamp(0.0, 1.0);
        signal = (o.offset - perlin(p).abs()).powi(2) * weight;
        value += signal * power;
        power *= o.roughness;
    }
    value
}

/// Gradient noise, about -1 to 1.
fn perlin(p: Position) -> f32 {
    const SCALES: [f32; 5] = [0.0, 0.25, 0.6616, 0.982, 0.8344];
    let n = p.dimensions;
    let floor = p.x.map(f32::floor);
    let mut sum = 0.0;
    for corner in 0..1_usize << n {
        let (mut words, mut beyond, mut weight) = ([0; 4], [0.0; 4], 1.0);
        for i in 0..n {
            let high = corner >> i & 1;
            let t = p.x[i] - floor[i];
            let fade = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
            words[i] = (floor[i] as i32).wrapping_add(high as i32).cast_unsigned();
            beyond[i] = t - high as f32;
            weight *= if high == 1 { fade } else { 1.0 - fade };
        }
        sum += weight * gradient(hash(&words[..n]), beyond, n);
    }
    let noise = sum * SCALES[n];
    if noise.is_finite() { noise } else { 0.0 }
}

/// A gradient that a hash chooses, times where one is beyond its lattice point.
fn gradient(hash: u32, [x, y, z, w]: [f32; 4], dimensions: usize) -> f32 {
    let signed = |value: f32, bit: u32| if hash & bit != 0 { -value } else { value };
    match dimensions {
        1 => {
            let h = hash & 15;
            signed((1 + (h & 7)) as f32 * x, 8)
        }
        2 => {
            let h = hash & 7;
            let (u, v) = if h < 4 { (x, y) } else { (y, x) };
            signed(u, 1) + signed(2.0 * v, 2)
        }
        3 => {
            let h = hash & 15;
            let u = if h < 8 { x } else { y };
            let other = if h == 12 || h == 14 { x } else { z };
            signed(u, 1) + signed(if h < 4 { y } else { other }, 2)
        }
        _ => {
            let h = hash & 31;
            let (u, v, s) =
                (if h < 24 { x } else { y }, if h < 16 { y } else { z }, if h < 8 { z } else { w });
            signed(u, 1) + signed(v, 2) + signed(s, 4)
        }
    }
}

/// The White Noise node: a color for every point.
pub(super) fn white(p: Position) -> Vec3 {
    let [x, y, z, w] = p.x;
    match p.dimensions {
        1 => Vec3::new(unit_hash(&[x]), unit_hash(&[x, 1.0]), unit_hash(&[x, 2.0])),
        2 => Vec3::new(unit_hash(&[x, y]), unit_hash(&[x, y, 1.0]), unit_hash(&[x, y, 2.0])),
        3 => Vec3::new(unit_hash(&[x, y, z]), unit_hash(&[x, y, z, 1.0]), unit_hash(&[x, y, z, 2.0])),
        _ => Vec3::new(unit_hash(&[x, y, z, w]), unit_hash(&[z, x, w, y]), unit_hash(&[w, z, y, x])),
    }
}

/// 0 to 1 from the bits of one to four numbers.
pub(super) fn unit_hash(numbers: &[f32]) -> f32 {
    let mut words = [0; 4];
    for (word, number) in words.iter_mut().zip(numbers) {
        *word = number.to_bits();
    }
    hash(&words[..numbers.len()]) as f32 * (1.0 / u32::MAX as f32)
}

/// Bob Jenkins' lookup3 of one to four words.
fn hash(words: &[u32]) -> u32 {
    let start = 0xdead_beef_u32.wrapping_add((words.len() as u32) << 2).wrapping_add(13);
    let word = |i: usize| words.get(i).copied().unwrap_or(0);
    let mut a = start.wrapping_add(word(0));
    let mut b = start.wrapping_add(word(1));
    let mut c = start.wrapping_add(word(2));
    if words.len() > 3 {
        let mix =
            |x: u32, z: u32, y: u32, bits: u32| (x.wrapping_sub(z) ^ z.rotate_left(bits), z.wrapping_add(y));
        (a, c) = mix(a, c, b, 4);
        (b, a) = mix(b, a, c, 6);
        (c, b) = mix(c, b, a, 8);
        (a, c) = mix(a, c, b, 16);
        (b, a) = mix(b, a, c, 19);
        (c, b) = mix(c, b, a, 4);
        a = a.wrapping_add(word(3));
    }
    let step = |x: u32, y: u32, bits: u32| (x ^ y).wrapping_sub(y.rotate_left(bits));
    c = step(c, b, 14);
    a = step(a, c, 11);
    b = step(b, a, 25);
    c = step(c, b, 16);
    a = step(a, c, 4);
    b = step(b, a, 14);
    step(c, b, 24)
}
