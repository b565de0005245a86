//! One light of any kind.

use super::area::AreaLamp;
use super::cluster::Bounds;
use super::distant::SceneBall;
use super::emitter::MeshEmitter;
use super::point::PointLamp;
use super::proxy::Hull;
use super::spot::SpotCone;
use super::sun::SunLamp;
use super::{is_in_reach, positive};
use crate::color::Rgb;
use crate::scene::{Lamp, LampShape, visibility};

/// The kinds of light a surface can ask for.
pub(super) enum Shape {
    Point(PointLamp),
    Area(AreaLamp),
    Sun(SunLamp),
    Mesh(MeshEmitter),
}

/// A light and what the renderer must know of it.
pub(super) struct Light {
    pub shape: Shape,
    /// Index into the scene's lamps; `None` for a mesh.
    pub lamp: Option<usize>,
    /// Mask of shadow rays; 0 where the light passes through everything.
    pub blockers: u32,
    /// Sets of objects that it lights.
    pub receivers: u32,
    pub visibility: u32,
}

impl Light {
    /// `None` for a lamp that gives no light.
    pub(super) fn from_lamp(index: usize, lamp: &Lamp) -> Option<Self> {
        let lamp = &Lamp { power: positive(lamp.power), ..lamp.clone() };
        if lamp.power.is_black() || !is_in_reach(lamp.position) {
            return None;
        }
        let shape = match lamp.shape {
            LampShape::Point { radius, soft_falloff } => {
                Shape::Point(PointLamp::new(lamp, radius, soft_falloff, None)?)
            }
            LampShape::Spot { radius, soft_falloff, cone_angle, blend } => {
                let cone = SpotCone::new(lamp, cone_angle, blend)?;
                Shape::Point(PointLamp::new(lamp, radius, soft_falloff, Some(cone))?)
            }
            LampShape::Sun { angle } => Shape::Sun(SunLamp::new(lamp, angle)?),
            LampShape::Rectangle { size, spread } => Shape::Area(AreaLamp::new(lamp, size, spread, false)?),
            LampShape::Ellipse { size, spread } => Shape::Area(AreaLamp::new(lamp, size, spread, true)?),
        };
        Some(Self {
            shape,
            lamp: Some(index),
            blockers: lamp.links.shadow_mask(lamp.casts_shadow),
            receivers: lamp.links.receivers,
            visibility: lamp.visibility,
        })
    }

    pub(super) fn flux(&self, ball: &SceneBall) -> Rgb {
        match &self.shape {
            Shape::Point(lamp) => lamp.flux(),
            Shape::Area(lamp) => lamp.flux(),
            Shape::Sun(lamp) => lamp.flux(ball),
            Shape::Mesh(mesh) => mesh.flux(),
        }
    }

    /// Bounds of the lamp, or of each emitting triangle.
    pub(super) fn bounds(&self) -> Vec<Bounds> {
        let mut bounds = match &self.shape {
            Shape::Point(lamp) => vec![lamp.bounds()],
            Shape::Area(lamp) => vec![lamp.bounds()],
            Shape::Sun(lamp) => vec![lamp.bounds()],
            Shape::Mesh(mesh) => mesh.bounds().collect(),
        };
        bounds.iter_mut().for_each(|bounds| bounds.receivers = self.receivers);
        bounds
    }

    /// True where rays can meet the light. Light that passes through everything is left to direct sampling alone, since a
    /// ray ends at what it should pass through.
    pub(super) fn can_be_met(&self) -> bool {
        let has_extent = match &self.shape {
            Shape::Point(lamp) => lamp.has_extent(),
            Shape::Area(lamp) => lamp.has_extent(),
            Shape::Sun(lamp) => lamp.has_extent(),
            Shape::Mesh(_) => true,
        };
        has_extent && self.blockers != 0
    }

    /// True where not everything blocks the light: a ray drawn from a surface would end at what the light passes through,
    /// so that direct sampling alone brings it, and such rays meet it off mirrors and glass alone.
    pub(super) const fn is_left_to_sampling(&self) -> bool {
        self.blockers != visibility::SHADOW
    }

    /// What holds the lamp, where rays can meet it.
    pub(super) fn hull(&self) -> Option<Hull> {
        match &self.shape {
            Shape::Point(lamp) if self.can_be_met() => Some(lamp.hull()),
            Shape::Area(lamp) if self.can_be_met() => Some(lamp.hull()),
            _ => None,
        }
    }
}
