//! A world whose light differs from direction to direction. Its radiance is what the program says, wherever a ray leaves the
//! scene; a table of it decides where surfaces and photons look for light.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::Vec3;
use rayon::prelude::*;

use super::direction_table::{self, DirectionTable};
use super::{LightSample, positive};
use crate::color::Rgb;
use crate::scene::{World, WorldProgram, visibility};
use crate::shader::{Aside, Point, Quantity, Texture, Value};

/// Columns of the table where no texture asks for more, and most of them.
const COLUMNS: [usize; 2] = [512, 2048];

/// A cell of the coarsest table is divided where it gives so many times more light than cells do on average.
const BRIGHT: f32 = 3.0;

/// Looks at the world per cell, along each side: twice as many as texels, which tells the mean of what is bilinear exactly.
const LOOKS: usize = 2;

/// What lets different surfaces see different worlds.
const ASKS_KIND: [Quantity; 4] =
    [Quantity::IsDiffuse, Quantity::IsGlossy, Quantity::IsReflection, Quantity::IsTransmission];

/// The light of a world with a program.
#[derive(Clone, Debug)]
pub struct Environment {
    program: WorldProgram,
    textures: Arc<[Texture]>,
    table: DirectionTable,
    /// Irradiance from all sides (W·m⁻²): the integral of the radiance over all directions.
    fluence: Rgb,
    /// The solid angle (sr) that would hold all of it, were it as bright as it is on average where light comes from.
    solid_angle: f32,
    /// Ray kinds whose light is sampled; other rays meet it by themselves.
    sampled: u32,
}

impl Environment {
    /// Looks at a world in all directions. `None` where it has no program, or is black for every kind of ray.
    #[must_use]
    pub fn new(world: &World, textures: &Arc<[Texture]>) -> Option<Self> {
        let program = world.program.clone()?;
        let columns = program.program.columns(textures).next_power_of_two().clamp(COLUMNS[0], COLUMNS[1]);
        let rows = columns / 2;
        let cells = Survey { program: &program, textures }.cells(columns);
        let area = |i: usize| direction_table::row_area(i / columns, rows) / columns as f32;
        let fluence = cells.iter().enumerate().map(|(i, &cell)| cell * area(i)).sum();
        let sums = cells.iter().enumerate().fold([0.0_f64; 2], |[one, two], (i, cell)| {
            let (value, area) = (f64::from(cell.mean()), f64::from(area(i)));
            [one + value * area, two + value * value * area]
        });
        let weights: Vec<f32> = cells.iter().map(|cell| cell.mean()).collect();
        let asks_kind = program.program.asks(&ASKS_KIND);
        // Black for diffuse surfaces, it may be none for others and the camera, which meet it by themselves.
        let (table, sees_as_diffuse) = match DirectionTable::new(columns, &weights) {
            Some(table) if asks_kind => (table, visibility::DIFFUSE),
            Some(table) => (table, u32::MAX),
            None if asks_kind || program.program.asks(&[Quantity::IsCamera]) => {
                (DirectionTable::new(columns, &vec![1.0; weights.len()])?, 0)
            }
            None => return None,
        };
        Some(Self {
            table,
            fluence,
            solid_angle: if sums[1] > 0.0 { (sums[0] * sums[0] / sums[1]) as f32 } else { 4.0 * PI },
            sampled: world.visibility & sees_as_diffuse & !visibility::CAMERA,
            textures: Arc::clone(textures),
            program,
        })
    }

    /// Memory (bytes) of the table.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.table.bytes()
    }

    /// Integral of the radiance over all directions (W·m⁻²).
    pub(super) fn fluence(&self) -> Rgb {
        self.fluence
    }

    /// See the field.
    pub(super) fn solid_angle(&self) -> f32 {
        self.solid_angle
    }

    /// Ray kinds whose light [`Environment::sample`] finds.
    pub(super) fn sampled(&self) -> u32 {
        self.sampled
    }

    /// Radiance (W·m⁻²·sr⁻¹) that a ray of one kind sees along `direction`.
    pub(super) fn radiance(&self, direction: Vec3, kind: u32) -> Rgb {
        radiance(&self.program, &self.textures, &Sight { direction, kind, width: 0.0 })
    }

    /// A direction, by how bright it is, with the radiance diffuse surfaces see there.
    pub(super) fn sample(&self, u: [f32; 2]) -> LightSample {
        let (wi, pdf) = self.table.sample(u);
        let radiance_over_pdf = self.radiance(wi, visibility::DIFFUSE) / pdf;
        LightSample { wi, distance: f32::INFINITY, radiance_over_pdf, pdf, is_delta: false, point: None }
    }

    /// Pdf per solid angle of [`Environment::sample`].
    pub(super) fn pdf(&self, wi: Vec3) -> f32 {
        self.table.pdf(wi)
    }
}

/// Looking at a world in all directions.
struct Survey<'a> {
    program: &'a WorldProgram,
    textures: &'a [Texture],
}

impl Survey<'_> {
    /// Mean radiance of each of `columns` × `columns` / 2 cells. Only what is bright is looked at as closely as that.
    fn cells(&self, columns: usize) -> Vec<Rgb> {
        let (coarse, parts) = (COLUMNS[0], columns / COLUMNS[0]);
        let cells: Vec<Rgb> = (0..coarse * coarse / 2)
            .into_par_iter()
            .map(|i| self.mean([i % coarse, i / coarse], coarse))
            .collect();
        let area = |i: usize| direction_table::row_area(i / coarse, coarse / 2);
        let flux = |i: usize| cells[i].mean() * area(i);
        let bright = BRIGHT * (0..cells.len()).map(flux).sum::<f32>() / cells.len() as f32;
        (0..columns * columns / 2)
            .into_par_iter()
            .map(|i| {
                let [x, y] = [i % columns, i / columns];
                let within = y / parts * coarse + x / parts;
                if parts > 1 && flux(within) > bright { self.mean([x, y], columns) } else { cells[within] }
            })
            .collect()
    }

    /// Mean radiance of a cell.
    fn mean(&self, cell: [usize; 2], columns: usize) -> Rgb {
        let width = std::f32::consts::TAU / (columns * LOOKS) as f32;
        let looks = (0..LOOKS * LOOKS).map(|i| {
            let at = |axis: usize, i: usize| cell[axis] as f32 + (i as f32 + 0.5) / LOOKS as f32;
            let (x, y) = (at(0, i % LOOKS) / columns as f32, at(1, i / LOOKS) / (columns / 2) as f32);
            let direction = direction_table::direction([x, y]);
            radiance(self.program, self.textures, &Sight { direction, kind: visibility::DIFFUSE, width })
        });
        looks.sum::<Rgb>() / (LOOKS * LOOKS) as f32
    }
}

fn radiance(program: &WorldProgram, textures: &[Texture], sight: &Sight) -> Rgb {
    positive(program.program.run(sight, textures)[program.radiance as usize].rgb())
}

/// A direction as a program sees it: as in Cycles, positions are the direction itself, and normals face the viewer.
struct Sight {
    /// Unit vector away from the viewer.
    direction: Vec3,
    /// Kind of the ray.
    kind: u32,
    /// Width (rad).
    width: f32,
}

impl Sight {
    fn is(&self, kind: u32) -> Value {
        Value::number(f32::from(u8::from(self.kind & kind != 0)))
    }
}

impl Point for Sight {
    fn attribute(&self, _attribute: u32, _aside: Aside) -> Value {
        Value::default()
    }

    fn geometry(&self, quantity: Quantity, _aside: Aside) -> Value {
        match quantity {
            Quantity::Position | Quantity::ObjectPosition => {
                Value { width: self.width, ..Value::vector(self.direction) }
            }
            Quantity::Normal
            | Quantity::ObjectNormal
            | Quantity::TrueNormal
            | Quantity::Incoming
            | Quantity::ObjectIncoming
            | Quantity::Reflection => Value { width: self.width, ..Value::vector(-self.direction) },
            Quantity::IsCamera => self.is(visibility::CAMERA),
            Quantity::IsShadow => self.is(visibility::SHADOW),
            Quantity::IsDiffuse => self.is(visibility::DIFFUSE),
            Quantity::IsGlossy => Value::number(f32::from(visibility::is_glossy(self.kind))),
            Quantity::IsReflection => Value::number(f32::from(visibility::is_reflection(self.kind))),
            Quantity::IsTransmission => self.is(visibility::TRANSMISSION),
            Quantity::Parametric
            | Quantity::Backfacing
            | Quantity::RayLength
            | Quantity::ObjectLocation
            | Quantity::ObjectColor
            | Quantity::ObjectIndex
            | Quantity::ObjectRandom => Value::default(),
        }
    }

    fn steps(&self, _widths: f32) -> [Vec3; 2] {
        [Vec3::ZERO; 2]
    }

    fn tangents(&self, _attribute: u32) -> Option<[Vec3; 3]> {
        None
    }

    fn world_normal(&self, normal: Vec3) -> Vec3 {
        normal
    }
}
