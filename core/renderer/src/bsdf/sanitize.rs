//! Values outside their range are brought into it, and the user is told.

use crate::color::Rgb;
use crate::scene::Problem;
use crate::scene::record::{ClosureRecord, PrincipledRecord};

/// Indices of refraction kept; Blender's sockets allow 0 to 1000.
const IOR: [f32; 2] = [1e-2, 100.0];

/// Rotations kept (turns), so that a part of a turn is left of them.
const TURNS: [f32; 2] = [-1e3, 1e3];

/// Largest emission kept, so that sums and products stay finite.
const BRIGHTEST: f32 = 1e15;

/// Largest absorption coefficient kept (1/m), so that its product with any distance stays finite.
const DARKEST: f32 = 1e15;

/// Brings values into range and counts what it changed, for one material.
#[derive(Debug, Default)]
pub(super) struct Sanitizer {
    /// Values that were NaN or infinite.
    not_finite: u64,
    /// Values that were out of range.
    out_of_range: u64,
    /// Closures that did not fit.
    pub(super) dropped: u64,
}

impl Sanitizer {
    fn value(&mut self, value: f32, [low, high]: [f32; 2]) -> f32 {
        if !value.is_finite() {
            self.not_finite += 1;
            return low;
        }
        let kept = value.clamp(low, high);
        self.out_of_range += u64::from(kept != value);
        kept
    }

    fn color(&mut self, color: Rgb, high: f32) -> Rgb {
        Rgb(color.0.map(|c| self.value(c, [0.0, high])))
    }

    /// Share of a closure. Mix Shader keeps it within 0 and 1.
    pub(super) fn weight(&mut self, weight: Rgb) -> Rgb {
        self.color(weight, 1.0)
    }

    /// An absorption coefficient (1/m).
    pub(super) fn absorption(&mut self, coefficient: Rgb) -> Rgb {
        self.color(coefficient, DARKEST)
    }

    /// A sum of shares that must not exceed 1.
    pub(super) fn at_most_one(&mut self, sum: Rgb) -> Rgb {
        // Shares that add up to 1 may exceed it by rounding; that is no problem to report.
        self.out_of_range += u64::from(sum.max_channel() > 1.0 + 1e-4);
        sum.map(|c| c.min(1.0))
    }

    /// The closure with every value in range.
    pub(super) fn closure(&mut self, closure: &ClosureRecord) -> ClosureRecord {
        const UNIT: [f32; 2] = [0.0, 1.0];
        match *closure {
            ClosureRecord::Diffuse { color, roughness } => ClosureRecord::Diffuse {
                color: self.color(color, 1.0),
                roughness: self.value(roughness, UNIT),
            },
            ClosureRecord::Transparent { color } => {
                ClosureRecord::Transparent { color: self.color(color, 1.0) }
            }
            ClosureRecord::Translucent { color } => {
                ClosureRecord::Translucent { color: self.color(color, 1.0) }
            }
            ClosureRecord::Sheen { color, roughness } => {
                ClosureRecord::Sheen { color: self.color(color, 1.0), roughness: self.value(roughness, UNIT) }
            }
            ClosureRecord::Holdout => ClosureRecord::Holdout,
            ClosureRecord::Emission { radiance } => {
                ClosureRecord::Emission { radiance: self.color(radiance, BRIGHTEST) }
            }
            ClosureRecord::Glossy { color, roughness, anisotropy, rotation, multiscatter } => {
                ClosureRecord::Glossy {
                    color: self.color(color, 1.0),
                    roughness: self.value(roughness, UNIT),
                    anisotropy: self.value(anisotropy, [-1.0, 1.0]),
                    rotation: self.value(rotation, TURNS),
                    multiscatter,
                }
            }
            ClosureRecord::Glass { color, roughness, ior, multiscatter } => ClosureRecord::Glass {
                color: self.color(color, 1.0),
                roughness: self.value(roughness, UNIT),
                ior: self.value(ior, IOR),
                multiscatter,
            },
            ClosureRecord::Refraction { color, roughness, ior } => ClosureRecord::Refraction {
                color: self.color(color, 1.0),
                roughness: self.value(roughness, UNIT),
                ior: self.value(ior, IOR),
            },
            ClosureRecord::Principled(ref record) => ClosureRecord::Principled(self.principled(record)),
        }
    }

    fn principled(&mut self, record: &PrincipledRecord) -> PrincipledRecord {
        const UNIT: [f32; 2] = [0.0, 1.0];
        PrincipledRecord {
            base_color: self.color(record.base_color, 1.0),
            metallic: self.value(record.metallic, UNIT),
            roughness: self.value(record.roughness, UNIT),
            multiscatter: record.multiscatter,
            anisotropic: self.value(record.anisotropic, UNIT),
            anisotropic_rotation: self.value(record.anisotropic_rotation, TURNS),
            diffuse_roughness: self.value(record.diffuse_roughness, UNIT),
            ior: self.value(record.ior, IOR),
            alpha: self.value(record.alpha, UNIT),
            specular_ior_level: self.value(record.specular_ior_level, [0.0, 1e3]),
            specular_tint: self.color(record.specular_tint, 1e3),
            transmission_weight: self.value(record.transmission_weight, UNIT),
            thin_wall: record.thin_wall,
            subsurface_weight: self.value(record.subsurface_weight, UNIT),
            subsurface_anisotropy: self.value(record.subsurface_anisotropy, [-1.0, 1.0]),
            sheen_weight: self.value(record.sheen_weight, UNIT),
            sheen_roughness: self.value(record.sheen_roughness, UNIT),
            sheen_tint: self.color(record.sheen_tint, 1.0),
            coat_weight: self.value(record.coat_weight, UNIT),
            coat_roughness: self.value(record.coat_roughness, UNIT),
            coat_ior: self.value(record.coat_ior, [1.0, IOR[1]]),
            coat_tint: self.color(record.coat_tint, 1.0),
            emission_color: self.color(record.emission_color, BRIGHTEST),
            emission_strength: self.value(record.emission_strength, [0.0, BRIGHTEST]),
        }
    }

    /// Adds what was changed in the material `name` to `problems`.
    pub(super) fn report(&self, name: &str, problems: &mut Vec<Problem>) {
        let found = [
            (self.not_finite, "values that are not a number were replaced by the lowest of their range"),
            (
                self.out_of_range,
                "values out of range were clamped; colors above 1 would make light from nothing",
            ),
            (self.dropped, "closures were left out: the material mixes too many shaders"),
        ];
        problems.extend(found.into_iter().filter(|(count, _)| *count > 0).map(|(count, message)| Problem {
            subject: name.to_owned(),
            message: message.to_owned(),
            count,
        }));
    }
}
