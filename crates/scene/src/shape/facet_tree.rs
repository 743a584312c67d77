//! Boxes around triangles in a tree, so that few triangles are looked at for each fruit.

use crate::vector::Vector;

/// Triangles that are not parted further.
const FEW: usize = 4;

/// A tree of boxes around the triangles of a surface, by their numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct FacetTree {
    nodes: Vec<Node>,
    /// Numbers of the triangles, those of each leaf together.
    order: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vector,
    high: Vector,
    /// Of a leaf its first triangle in `order`; else the second of its two nodes, of which
    /// the first comes next.
    next: u32,
    /// Triangles of a leaf; 0 of others.
    count: u32,
}

impl FacetTree {
    /// The tree of some triangles.
    pub fn new(triangles: &[[Vector; 3]]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            order: (0..triangles.len() as u32).collect(),
        };
        let mut order = std::mem::take(&mut tree.order);
        if !order.is_empty() {
            tree.part(triangles, &mut order, 0);
        }
        tree.order = order;
        tree
    }

    /// A node of some triangles, and those below it.
    fn part(&mut self, triangles: &[[Vector; 3]], own: &mut [u32], first: u32) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in own.iter().flat_map(|&number| triangles[number as usize]) {
            for axis in 0..3 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let node = self.nodes.len();
        self.nodes.push(Node {
            low,
            high,
            next: first,
            count: own.len() as u32,
        });
        if own.len() <= FEW {
            return;
        }
        let wide = |axis: usize| high[axis] - low[axis];
        let axis = if wide(0) >= wide(1) && wide(0) >= wide(2) {
            0
        } else if wide(1) >= wide(2) {
            1
        } else {
            2
        };
        let middle = |&number: &u32| {
            let [a, b, c] = triangles[number as usize];
            a[axis] + b[axis] + c[axis]
        };
        let half = own.len() / 2;
        own.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        let (left, right) = own.split_at_mut(half);
        self.part(triangles, left, first);
        let second = self.nodes.len() as u32;
        self.part(triangles, right, first + half as u32);
        (self.nodes[node].next, self.nodes[node].count) = (second, 0);
    }

    /// Hands out every triangle whose box comes closer to a place than `reach`, in any order.
    pub(crate) fn near(&self, place: Vector, reach: f64, mut found: impl FnMut(u32)) {
        if self.nodes.is_empty() {
            return;
        }
        // Halves of halves: a tree of 2³² triangles is no deeper.
        let mut waiting = [0_u32; 64];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let number = waiting[count];
            let node = &self.nodes[number as usize];
            let mut square = 0.0;
            for axis in 0..3 {
                let at = place[axis];
                let off = (node.low[axis] - at).max(at - node.high[axis]).max(0.0);
                square += off * off;
            }
            if square >= reach * reach {
                continue;
            }
            if node.count == 0 {
                waiting[count] = node.next;
                waiting[count + 1] = number + 1;
                count += 2;
                continue;
            }
            let own = node.next as usize..(node.next + node.count) as usize;
            self.order[own].iter().copied().for_each(&mut found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{length, subtract};

    #[test]
    fn finds_every_triangle_in_reach_and_few_others() {
        // A wavy field of 2 × 60 × 60 triangles.
        let at = |i: usize, j: usize| {
            let (x, y) = (i as f64 / 60.0, j as f64 / 60.0);
            [x, y, 0.1 * (9.0 * x).sin() * (7.0 * y).cos()]
        };
        let mut triangles = Vec::new();
        for i in 0..60 {
            for j in 0..60 {
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let tree = FacetTree::new(&triangles);
        for place in [[0.5, 0.5, 0.05], [0.0, 0.0, 0.0], [2.0, 0.5, 0.0]] {
            let reach = 0.08;
            let mut found = Vec::new();
            tree.near(place, reach, |number| found.push(number));
            found.sort_unstable();
            let before = found.len();
            found.dedup();
            assert_eq!(found.len(), before);
            assert!(before < 400, "{before}");
            for (number, corners) in triangles.iter().enumerate() {
                let close = corners
                    .iter()
                    .any(|own| length(subtract(*own, place)) < reach);
                assert!(!close || found.contains(&(number as u32)), "{number}");
            }
        }
        FacetTree::new(&[]).near([0.0; 3], 1.0, |_| panic!("there is none"));
    }
}
