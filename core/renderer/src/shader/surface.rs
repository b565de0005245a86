//! Instructions that look at the surface: normals, and weights that depend on the view.

use glam::{Vec3, Vec4};

use super::Point;
use super::instruction::{Aside, Axis, NormalSpace, Quantity};

/// What a bump is made of.
pub(super) struct BumpHeights {
    /// Height at the point.
    pub(super) here: f32,
    /// Height `filter_width` widths of the ray aside.
    pub(super) aside: [f32; 2],
    pub(super) filter_width: f32,
    /// Metres per unit of height.
    pub(super) distance: f32,
}

fn ask(point: &impl Point, quantity: Quantity) -> Vec3 {
    point.geometry(quantity, Aside::HERE).v.truncate()
}

/// True where the viewer is not on the modelled side.
fn is_back(point: &impl Point) -> bool {
    point.geometry(Quantity::Backfacing, Aside::HERE).v.x > 0.0
}

/// The normal tilted by the slope of the height: Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU". Heights
/// rise to the modelled side: seen from behind, hills are hollows.
pub(super) fn bump(point: &impl Point, heights: &BumpHeights, strength: f32, normal: Vec3) -> Vec3 {
    let [x, y] = point.steps(heights.filter_width);
    let (of_x, of_y) = (y.cross(normal), normal.cross(x));
    let determinant = x.dot(of_x);
    let slope = of_x * (heights.aside[0] - heights.here) + of_y * (heights.aside[1] - heights.here);
    let distance = if is_back(point) { -heights.distance } else { heights.distance };
    let tilted = normal * determinant.abs() - slope * (distance * determinant.signum());
    let tilted = tilted.try_normalize().unwrap_or(normal);
    let strength = strength.max(0.0);
    (tilted * strength + normal * (1.0 - strength)).try_normalize().unwrap_or(normal)
}

/// The normal that a normal map's color stands for.
pub(super) fn normal_map(
    point: &impl Point,
    color: Vec3,
    strength: f32,
    space: NormalSpace,
    attribute: u32,
) -> Vec3 {
    let ns = ask(point, Quantity::Normal);
    let mut n = color * 2.0 - 1.0;
    let strength = strength.max(0.0);
    let mapped = match space {
        NormalSpace::Tangent => {
            let Some([tangent, bitangent, normal]) = point.tangents(attribute) else { return ns };
            n = Vec3::new(n.x * strength, n.y * strength, 1.0 + (n.z - 1.0) * strength.min(1.0));
            let mapped = point.world_normal(tangent * n.x + bitangent * n.y + normal * n.z);
            return mapped.try_normalize().unwrap_or(ns);
        }
        NormalSpace::Object => point.world_normal(n),
        NormalSpace::World => {
            let back = is_back(point);
            if back { -n } else { n }
        }
    };
    let mapped = mapped.try_normalize().unwrap_or(ns);
    (ns + (mapped - ns) * strength).try_normalize().unwrap_or(ns)
}

/// The Tangent of the Geometry node, and the radial ones of the Tangent node: around an axis of the object, along the surface.
pub(super) fn tangent(point: &impl Point, generated: Vec3, axis: Axis) -> Vec3 {
    let p = generated - Vec3::splat(0.5);
    along_surface(
        point,
        match axis {
            Axis::X => Vec3::new(0.0, -p.z, p.y),
            Axis::Y => Vec3::new(-p.z, 0.0, p.x),
            Axis::Z => Vec3::new(-p.y, p.x, 0.0),
        },
    )
}

/// The Tangent node's of a UV map.
pub(super) fn uv_tangent(point: &impl Point, attribute: u32) -> Vec3 {
    point.tangents(attribute).map_or(Vec3::ZERO, |[tangent, ..]| along_surface(point, tangent))
}

/// A direction of the object's space laid on the surface; 0 along the normal.
fn along_surface(point: &impl Point, direction: Vec3) -> Vec3 {
    let along = point.world_normal(direction);
    let back = is_back(point);
    let (along, ns) = (if back { -along } else { along }, ask(point, Quantity::Normal));
    ns.cross(along.cross(ns).normalize_or_zero())
}

/// Fresnel's equations for unpolarized light: the share reflected at `cos` by an interface of relative index `eta`.
fn dielectric(cos: f32, eta: f32) -> f32 {
    let c = cos.abs();
    let g = eta * eta - 1.0 + c * c;
    if g <= 0.0 {
        return 1.0;
    }
    let g = g.sqrt();
    let a = (g - c) / (g + c);
    let b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    0.5 * a * a * (1.0 + b * b)
}

/// The Fresnel node.
pub(super) fn fresnel(point: &impl Point, ior: f32, normal: Vec3) -> f32 {
    let back = is_back(point);
    let ior = ior.max(1e-5);
    dielectric(ask(point, Quantity::Incoming).dot(normal), if back { 1.0 / ior } else { ior })
}

/// The Layer Weight node.
pub(super) fn layer_weight(point: &impl Point, blend: f32, normal: Vec3, facing: bool) -> f32 {
    let cos = ask(point, Quantity::Incoming).dot(normal);
    if !facing {
        let back = is_back(point);
        let eta = (1.0 - blend).max(1e-5);
        return dielectric(cos, if back { eta } else { 1.0 / eta });
    }
    let blend = blend.clamp(0.0, 1.0 - 1e-5);
    let exponent = if blend < 0.5 { 2.0 * blend } else { 0.5 / (1.0 - blend) };
    1.0 - if blend == 0.5 { cos.abs() } else { cos.abs().powf(exponent) }
}

/// The mean of a texture seen along the three axes of the object, weighted by how much the surface faces them: sharp edges
/// for a `blend` of 0, soft ones for 1.
pub(super) fn box_projected(p: Vec3, normal: Vec3, blend: f32, color: impl Fn([f32; 2]) -> Vec4) -> Vec4 {
    let n = normal.abs();
    let n = n / n.element_sum().max(f32::MIN_POSITIVE);
    let limit = 0.5 * (1.0 + blend);
    let weight = if n.x > limit * (n.x + n.y) && n.x > limit * (n.x + n.z) {
        Vec3::X
    } else if n.y > limit * (n.x + n.y) && n.y > limit * (n.y + n.z) {
        Vec3::Y
    } else if n.z > limit * (n.x + n.z) && n.z > limit * (n.y + n.z) {
        Vec3::Z
    } else if blend <= 0.0 {
        Vec3::X
    } else {
        soft_weights(n, limit, blend)
    };
    let mut sum = Vec4::ZERO;
    if weight.x > 0.0 {
        sum += color([if normal.x < 0.0 { 1.0 - p.y } else { p.y }, p.z]) * weight.x;
    }
    if weight.y > 0.0 {
        sum += color([if normal.y > 0.0 { 1.0 - p.x } else { p.x }, p.z]) * weight.y;
    }
    if weight.z > 0.0 {
        sum += color([if normal.z > 0.0 { 1.0 - p.y } else { p.y }, p.x]) * weight.z;
    }
    sum
}

/// Between two axes a ramp of width `blend`; where all three meet, the three ramps together.
fn soft_weights(n: Vec3, limit: f32, blend: f32) -> Vec3 {
    let share = |a: f32, b: f32| ((a / (a + b) - 0.5 * (1.0 - blend)) / blend).clamp(0.0, 1.0);
    let beyond = |c: f32, a: f32, b: f32| c < (1.0 - limit) * (a + c) && c < (1.0 - limit) * (b + c);
    if beyond(n.z, n.x, n.y) {
        let x = share(n.x, n.y);
        Vec3::new(x, 1.0 - x, 0.0)
    } else if beyond(n.x, n.y, n.z) {
        let y = share(n.y, n.z);
        Vec3::new(0.0, y, 1.0 - y)
    } else if beyond(n.y, n.x, n.z) {
        let x = share(n.x, n.z);
        Vec3::new(x, 0.0, 1.0 - x)
    } else {
        let raw = (n * (2.0 - limit) + Vec3::splat(limit - 1.0)) / (2.0 * limit - 1.0);
        let raw = raw.max(Vec3::ZERO);
        raw / raw.element_sum().max(f32::MIN_POSITIVE)
    }
}
