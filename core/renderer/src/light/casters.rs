//! Balls that hold all mirrors and glass of a scene, at which photons of caustics are aimed.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::warp;

/// Balls at most. A few dozen fit round rings and facades as well as round scattered glasses.
const MOST: usize = 64;

/// How much wider a ball is than what it holds, for rounding.
const MARGIN: f32 = 1.001;

/// The same in scene units, for what is flat.
const LEAST_RADIUS: f32 = 1e-5;

/// Parts of the mirrors and glass, each within its ball.
#[derive(Clone, Debug)]
pub struct Casters {
    balls: Vec<Ball>,
}

#[derive(Clone, Copy, Debug)]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// What the casters look like from one place.
pub(super) struct View<'a> {
    casters: &'a Casters,
    /// Where from.
    apex: Vec3,
    /// What the balls are widened by.
    extra: f32,
    /// By ball: 1 − cos of half the angle it is seen under.
    cones: [f32; MOST],
    /// Sum of the solid angles (sr).
    total: f32,
}

impl Casters {
    /// Balls about boxes (lowest and highest corner, scene units), one for each triangle. `None` where there is none.
    #[must_use]
    pub fn new(mut boxes: Vec<[Vec3; 2]>) -> Option<Self> {
        let mut groups = vec![(0..boxes.len(), true)];
        while groups.len() < MOST {
            let size = |range: &std::ops::Range<usize>| Ball::about(&boxes[range.clone()]).radius;
            let whole = groups.iter().enumerate().filter(|(_, (range, splits))| *splits && range.len() > 1);
            let largest = whole.max_by(|a, b| size(&a.1.0).total_cmp(&size(&b.1.0)));
            let Some((index, (range, _))) = largest.map(|(i, group)| (i, group.clone())) else { break };
            let below = halve(&mut boxes[range.clone()]);
            if below == 0 || below == range.len() {
                groups[index].1 = false;
                continue;
            }
            let middle = range.start + below;
            groups[index].0 = range.start..middle;
            groups.push((middle..range.end, true));
        }
        let balls = groups.into_iter().map(|(range, _)| Ball::about(&boxes[range])).collect();
        (!boxes.is_empty()).then_some(Self { balls })
    }

    /// From the nearest of their centers (scene units).
    pub(super) fn distance(&self, p: Vec3) -> f32 {
        self.balls.iter().map(|ball| ball.center.distance(p)).fold(f32::INFINITY, f32::min)
    }

    /// As seen from `apex`, with balls that are wider by `extra`.
    pub(super) fn view(&self, apex: Vec3, extra: f32) -> View<'_> {
        let mut cones = [0.0; MOST];
        for (cone, ball) in cones.iter_mut().zip(&self.balls) {
            let sin_squared = (ball.radius + extra).powi(2) / apex.distance_squared(ball.center);
            *cone = if sin_squared < 1.0 { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) } else { 2.0 };
        }
        let total = TAU * cones.iter().sum::<f32>();
        View { casters: self, apex, extra, cones, total }
    }

    /// A place on the disks across `direction` that hold the balls, one of them chosen by area.
    pub(super) fn place_across(&self, direction: Vec3, choice: f32, u: [f32; 2]) -> Vec3 {
        let area = |ball: &Ball| ball.radius * ball.radius;
        let mut left = choice * self.balls.iter().map(area).sum::<f32>();
        let last = self.balls[self.balls.len() - 1];
        let ball = self.balls.iter().find(|ball| {
            left -= area(ball);
            left < 0.0
        });
        let ball = ball.copied().unwrap_or(last);
        let across = (warp::disk(u) * ball.radius).extend(0.0);
        ball.center + crate::math::Frame::new(direction).from_local(across)
    }

    /// Density per area across `direction` with which [`Casters::place_across`] finds the line through `p`; 0 for lines that
    /// pass all balls.
    pub(super) fn density_across(&self, p: Vec3, direction: Vec3) -> f32 {
        let (mut met, mut total) = (0_u32, 0.0);
        for ball in &self.balls {
            let squared = ball.radius * ball.radius;
            met += u32::from((p - ball.center).cross(direction).length_squared() <= squared * MARGIN);
            total += PI * squared;
        }
        met as f32 / total
    }
}

impl View<'_> {
    /// A direction towards one of the balls, chosen by solid angle.
    pub(super) fn direction(&self, choice: f32, u: [f32; 2]) -> Vec3 {
        let mut left = choice * self.total / TAU;
        let found = self.casters.balls.iter().zip(&self.cones).find(|(_, cone)| {
            left -= **cone;
            left < 0.0
        });
        let last = self.casters.balls.len() - 1;
        let (ball, cone) = found.unwrap_or((&self.casters.balls[last], &self.cones[last]));
        warp::cone((ball.center - self.apex).try_normalize().unwrap_or(Vec3::Z), *cone, u).0
    }

    /// Density per solid angle of [`View::direction`]; 0 for directions that pass all balls.
    pub(super) fn density(&self, direction: Vec3) -> f32 {
        let met = self.casters.balls.iter().zip(&self.cones).filter(|(ball, cone)| {
            let to = ball.center - self.apex;
            let radius = ball.radius + self.extra;
            let ahead =
                to.dot(direction) > 0.0 && to.cross(direction).length_squared() <= radius * radius * MARGIN;
            **cone >= 2.0 || ahead
        });
        met.count() as f32 / self.total
    }
}

impl Ball {
    fn about(boxes: &[[Vec3; 2]]) -> Self {
        let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let [low, high] = boxes.iter().fold(empty, |[l, h], [low, high]| [l.min(*low), h.max(*high)]);
        Self { center: 0.5 * (low + high), radius: 0.5 * (high - low).length() * MARGIN + LEAST_RADIUS }
    }
}

/// Sorts boxes by the side of the middle that theirs lie on, along the longest axis; gives the number of those below.
fn halve(boxes: &mut [[Vec3; 2]]) -> usize {
    let middle = |[low, high]: &[Vec3; 2]| *low + *high;
    let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = boxes.iter().map(middle).fold(empty, |(low, high), m| (low.min(m), high.max(m)));
    let axis = (high - low).max_position();
    let at = 0.5 * (low + high)[axis];
    boxes.sort_unstable_by(|a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
    boxes.partition_point(|one| middle(one)[axis] < at)
}
