//! Materials whose closures differ from point to point.

use glam::Vec3;
use smallvec::SmallVec;

use super::PreparedMaterial;
use super::normals::Assignment;
use super::oren_nayar::LEAST_ROUGHNESS;
use crate::color::Rgb;
use crate::scene::MaterialProgram;
use crate::scene::record::{ClosureRecord, Input, InputMut, WeightedClosure};
use crate::shader::{Point, Register, Registers, Texture};

/// Closures, and the program that computes those of their inputs that vary.
#[derive(Clone, Debug)]
pub struct Varying {
    closures: SmallVec<[WeightedClosure; 2]>,
    program: MaterialProgram,
    normals: Assignment,
    is_lambert: bool,
}

impl Varying {
    pub(super) fn new(closures: &[WeightedClosure], program: &MaterialProgram) -> Self {
        let is_smooth = |part: &WeightedClosure| matches!(part.closure, ClosureRecord::Diffuse { roughness, .. } if roughness < LEAST_ROUGHNESS);
        let roughness_varies = program.outputs.iter().any(|output| output.input == Input::Roughness);
        let normals = Assignment::new(closures, program);
        let is_lambert =
            normals.registers[..] == [None] && !roughness_varies && closures.iter().all(is_smooth);
        Self { closures: closures.into(), program: program.clone(), normals, is_lambert }
    }

    /// True where the material is nothing but a Lambert reflector everywhere, its shading normal the surface's own.
    #[must_use]
    pub fn is_lambert(&self) -> bool {
        self.is_lambert
    }

    /// Everything the program computes at a point.
    #[must_use]
    pub fn run(&self, point: &impl Point, textures: &[Texture]) -> Registers {
        self.program.program.run(point, textures)
    }

    /// The albedo of a material that [`Varying::is_lambert`].
    #[must_use]
    pub fn lambert(&self, registers: &Registers) -> Rgb {
        let closures = self.closures_with(registers);
        let clamped = |c: f32| if c.is_finite() { c.clamp(0.0, 1.0) } else { 0.0 };
        let albedo = closures.iter().map(|part| match part.closure {
            ClosureRecord::Diffuse { color, .. } => part.weight.map(clamped) * color.map(clamped),
            _ => Rgb::BLACK,
        });
        albedo.sum::<Rgb>().map(|c| c.min(1.0))
    }

    /// The material as it is where the program gave `registers` and its normals are `normals`.
    #[must_use]
    pub(super) fn material(&self, registers: &Registers, normals: &[Vec3]) -> PreparedMaterial {
        let tangents = self.tangents(registers);
        PreparedMaterial::at_hit(&self.closures_with(registers), self.normals.at(normals), &tangents)
    }

    /// By closure, 0 where it has none; empty where none has.
    fn tangents(&self, registers: &Registers) -> SmallVec<[Vec3; 2]> {
        let mut tangents = SmallVec::new();
        for record in &self.program.tangents {
            tangents.resize(self.closures.len(), Vec3::ZERO);
            tangents[record.closure] = registers[record.register as usize].v.truncate();
        }
        tangents
    }

    /// The results that are shading normals, the surface's own first; `None` is the mesh's. Where there are several, closures
    /// have others than the surface, and the shading normal of their [`Bsdf`](super::Bsdf) must be the geometric one.
    #[must_use]
    pub fn normals(&self) -> &[Option<Register>] {
        &self.normals.registers
    }

    fn closures_with(&self, registers: &Registers) -> SmallVec<[WeightedClosure; 2]> {
        let mut closures = self.closures.clone();
        for output in &self.program.outputs {
            let value = registers[output.register as usize];
            set(&mut closures[output.closure], output.input, value.rgb());
        }
        closures
    }

    /// Closures that between them make every class of lobe that can occur: whatever varies has middle values, roughness also
    /// none and all.
    pub(super) fn extremes(&self) -> impl Iterator<Item = SmallVec<[WeightedClosure; 2]>> {
        [0.0, 0.4, 1.0].into_iter().map(|roughness| {
            let mut closures = self.closures.clone();
            for output in &self.program.outputs {
                let value = match output.input {
                    Input::Roughness | Input::DiffuseRoughness | Input::CoatRoughness => roughness,
                    // The wider the lobes, the rounder: both together have all classes between them.
                    Input::Anisotropic | Input::Anisotropy => 1.0 - roughness,
                    Input::Ior | Input::CoatIor => 1.5,
                    _ => 0.5,
                };
                set(&mut closures[output.closure], output.input, Rgb::splat(value));
            }
            closures
        })
    }

    /// True where the index of refraction differs from point to point.
    pub(super) fn bends_differently(&self) -> bool {
        let bends = |input| matches!(input, Input::Ior | Input::CoatIor | Input::SpecularIorLevel);
        self.program.outputs.iter().any(|output| bends(output.input))
    }
}

fn set(part: &mut WeightedClosure, input: Input, value: Rgb) {
    match part.input_mut(input) {
        Some(InputMut::Color(color)) => *color = value,
        Some(InputMut::Number(number)) => *number = value.0[0],
        None => {}
    }
}
