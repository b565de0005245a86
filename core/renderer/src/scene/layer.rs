//! Values at the corners of a mesh's triangles.

/// A layer of values, one to four at each corner: texture coordinates, colors.
#[derive(Clone, Debug, Default)]
pub struct CornerLayer {
    /// The number by which programs know it.
    pub attribute: u32,
    /// Values per corner.
    pub channels: usize,
    /// Corner by corner, triangle by triangle.
    pub values: Vec<f32>,
}

impl CornerLayer {
    /// The values at the three corners of a triangle, missing color channels 0 and a missing alpha 1.
    #[must_use]
    #[inline]
    pub fn corners(&self, triangle: usize) -> [[f32; 4]; 3] {
        let n = self.channels;
        let corner = |c: usize| {
            let mut value = [0.0, 0.0, 0.0, 1.0];
            let first = (triangle * 3 + c) * n;
            value[..n].copy_from_slice(&self.values[first..first + n]);
            if n == 1 {
                value = [value[0], value[0], value[0], 1.0];
            }
            value
        };
        [corner(0), corner(1), corner(2)]
    }

    /// Keeps the triangles whose flag is set.
    pub(super) fn retain(&mut self, keep: &[bool]) {
        let size = 3 * self.channels;
        let mut index = 0;
        self.values.retain(|_| {
            index += 1;
            keep[(index - 1) / size]
        });
    }

    /// Swaps the second and third corner of every triangle.
    pub(super) fn turn(&mut self) {
        let n = self.channels;
        for triangle in self.values.chunks_exact_mut(3 * n) {
            let (second, third) = triangle[n..].split_at_mut(n);
            second.swap_with_slice(third);
        }
    }
}
