//! Triangles of a file → a surface of a wall, and its flaws.

use crate::vector::{Vector, cross, length, subtract};
use std::collections::BTreeMap;

/// A surface of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Corners of each triangle that has an area, once; m.
    pub triangles: Vec<[Vector; 3]>,
    /// Flaws to report.
    pub flaws: Flaws,
}

/// Flaws of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flaws {
    /// Corners closer than this are one; m.
    pub tolerance: f64,
    /// Triangles that are nowhere wider than the tolerance, by their numbers from 0: they
    /// are left out.
    pub slivers: Vec<usize>,
    /// Triangles that were there before, by their numbers from 0: they are left out.
    pub doubled: Vec<usize>,
    /// Where the surface ends, the longest rim first.
    pub rims: Vec<Rim>,
    /// Edges of more than two triangles; m.
    pub branching: Vec<[Vector; 2]>,
    /// Edges whose two triangles are wound contrary to each other; m.
    pub contrary: Vec<[Vector; 2]>,
}

/// Edges of one triangle only that hang together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// How many.
    pub edges: usize,
    /// How long they are together; m.
    pub length: f64,
    /// Lowest corner of the box around them; m.
    pub low: Vector,
    /// Highest corner; m.
    pub high: Vector,
}

/// Corners closer than this part of the diagonal of the whole are one; 1.
const WELD: f64 = 1e-6;
/// Steps of single precision, in which STL files are written, that corners may differ by.
const STEPS: f64 = 4.0;

/// Welds the corners of triangles, leaves out those that are none, and looks at the edges.
///
/// Corners are one where they are closer than 10⁻⁶ of the diagonal of the whole, or than
/// four steps of single precision at the largest coordinate.
pub fn welded(triangles: &[[Vector; 3]]) -> Surface {
    let (low, high) = bounds(triangles.iter().flatten().copied());
    let largest = low
        .iter()
        .chain(&high)
        .fold(0.0_f64, |size, own| size.max(own.abs()));
    let rounding = STEPS * f64::from(f32::EPSILON) * largest;
    let tolerance = match triangles.is_empty() {
        true => 0.0,
        false => rounding.max(WELD * length(subtract(high, low))),
    };
    let (corners, numbers) = weld_corners(triangles, tolerance);
    let mut flaws = Flaws {
        tolerance,
        ..Flaws::default()
    };
    let mut surface = Vec::with_capacity(triangles.len());
    let mut edges = BTreeMap::new();
    let mut known = std::collections::BTreeSet::new();
    for (place, own) in numbers.iter().enumerate() {
        let [a, b, c] = *own;
        if a == b || b == c || c == a {
            flaws.slivers.push(place);
            continue;
        }
        let mut sorted = *own;
        sorted.sort_unstable();
        if !known.insert(sorted) {
            flaws.doubled.push(place);
            continue;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let ways: &mut [u32; 2] = edges.entry((from.min(to), from.max(to))).or_default();
            ways[usize::from(from > to)] += 1;
        }
        let corners = own.map(|number| corners[number as usize]);
        // A sliver with corners of its own joins its neighbours: its edges count.
        match height(corners) > tolerance {
            true => surface.push(corners),
            false => flaws.slivers.push(place),
        }
    }
    let ends = |&(a, b): &(u32, u32)| [corners[a as usize], corners[b as usize]];
    let mut open = Vec::new();
    for (edge, ways) in &edges {
        match ways {
            [1, 0] | [0, 1] => open.push(*edge),
            [1, 1] => {}
            [2, 0] | [0, 2] => flaws.contrary.push(ends(edge)),
            _ => flaws.branching.push(ends(edge)),
        }
    }
    flaws.rims = rims(&corners, &open);
    Surface {
        triangles: surface,
        flaws,
    }
}

/// Corners that differ, and the numbers of those of each triangle.
fn weld_corners(triangles: &[[Vector; 3]], tolerance: f64) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let cell = (2.0 * tolerance).max(f64::MIN_POSITIVE);
    let mut corners: Vec<Vector> = Vec::new();
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let mut number_of = |place: Vector| {
        let key = |shift: [f64; 3]| {
            let at = |axis: usize| ((place[axis] + shift[axis] * tolerance) / cell).floor() as i64;
            [at(0), at(1), at(2)]
        };
        let (low, high) = (key([-1.0; 3]), key([1.0; 3]));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let Some(own) = cells.get(&[x, y, z]) else {
                        continue;
                    };
                    let near = |&&number: &&u32| {
                        length(subtract(corners[number as usize], place)) <= tolerance
                    };
                    if let Some(number) = own.iter().find(near) {
                        return *number;
                    }
                }
            }
        }
        let number = corners.len() as u32;
        corners.push(place);
        cells.entry(key([0.0; 3])).or_default().push(number);
        number
    };
    let numbers = triangles.iter().map(|own| own.map(&mut number_of));
    let numbers = numbers.collect();
    (corners, numbers)
}

/// The smallest height of a triangle; m.
fn height([a, b, c]: [Vector; 3]) -> f64 {
    let sides = [subtract(b, a), subtract(c, b), subtract(a, c)];
    let longest = sides.map(length).into_iter().fold(0.0, f64::max);
    length(cross(sides[0], sides[2])) / longest
}

/// The box around some places.
pub fn bounds(places: impl Iterator<Item = Vector>) -> (Vector, Vector) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for place in places {
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    (low, high)
}

/// Edges that hang together by their corners.
fn rims(corners: &[Vector], open: &[(u32, u32)]) -> Vec<Rim> {
    let mut root: Vec<u32> = (0..corners.len() as u32).collect();
    for &(a, b) in open {
        let (a, b) = (root_of(&mut root, a), root_of(&mut root, b));
        root[a.max(b) as usize] = a.min(b);
    }
    let mut rims: BTreeMap<u32, Rim> = BTreeMap::new();
    for &(a, b) in open {
        let (from, to) = (corners[a as usize], corners[b as usize]);
        let own = rims.entry(root_of(&mut root, a)).or_insert(Rim {
            edges: 0,
            length: 0.0,
            low: from,
            high: from,
        });
        own.edges += 1;
        own.length += length(subtract(to, from));
        (own.low, own.high) = bounds([own.low, own.high, from, to].into_iter());
    }
    let mut rims: Vec<Rim> = rims.into_values().collect();
    rims.sort_by(|a, b| b.length.total_cmp(&a.length));
    rims
}

fn root_of(root: &mut [u32], mut own: u32) -> u32 {
    while root[own as usize] != own {
        root[own as usize] = root[root[own as usize] as usize];
        own = root[own as usize];
    }
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of 1 m as 12 triangles, wound outward.
    fn cube() -> Vec<[Vector; 3]> {
        let at = |n: usize| [n & 1, n >> 1 & 1, n >> 2 & 1].map(|own| own as f64);
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let parts = sides.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        parts.iter().flatten().map(|own| own.map(at)).collect()
    }

    #[test]
    fn a_cube_is_closed() {
        let surface = welded(&cube());
        assert_eq!(surface.triangles.len(), 12);
        let flaws = surface.flaws;
        assert!(
            flaws.rims.is_empty() && flaws.branching.is_empty(),
            "{flaws:?}"
        );
        assert!(
            flaws.contrary.is_empty() && flaws.slivers.is_empty(),
            "{flaws:?}"
        );
        // Corners that differ by less than the tolerance are one.
        let mut shaken = cube();
        for (number, corner) in shaken.iter_mut().flatten().enumerate() {
            corner[number % 3] += 1e-7 * (number % 5) as f64;
        }
        let flaws = welded(&shaken).flaws;
        assert!(
            flaws.rims.is_empty() && flaws.slivers.is_empty(),
            "{flaws:?}"
        );
    }

    #[test]
    fn rims_are_found_where_they_are() {
        // Without its top, and without one half of its bottom.
        let mut open = cube();
        open.drain(2..4);
        open.remove(0);
        let rims = welded(&open).flaws.rims;
        assert_eq!(rims.len(), 2);
        assert!(
            (rims[0].length - 4.0).abs() < 1e-12 && rims[0].edges == 4,
            "{rims:?}"
        );
        assert_eq!((rims[0].low, rims[0].high), ([0.0, 0.0, 1.0], [1.0; 3]));
        assert!(
            (rims[1].length - (2.0 + 2.0_f64.sqrt())).abs() < 1e-12,
            "{rims:?}"
        );
    }

    #[test]
    fn flaws_are_told_apart() {
        let mut own = cube();
        // One wound contrary: three edges disagree.
        own[5].swap(0, 1);
        assert_eq!(welded(&own).flaws.contrary.len(), 3);
        // One twice; one without area, one a hair wide.
        let mut own = cube();
        own.push(own[3]);
        own.push([[0.0; 3], [0.5; 3], [0.5; 3]]);
        own.push([[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1e-7, 0.0]]);
        let surface = welded(&own);
        assert_eq!(surface.flaws.doubled, [12]);
        assert_eq!(surface.flaws.slivers, [13, 14]);
        assert_eq!(surface.triangles.len(), 12);
        // A fin on an edge.
        let mut own = cube();
        own.push([[0.0; 3], [1.0, 0.0, 0.0], [0.5, -1.0, -1.0]]);
        assert_eq!(welded(&own).flaws.branching.len(), 1);
    }

    #[test]
    fn nothing_and_a_point_are_no_surface() {
        assert!(welded(&[]).triangles.is_empty());
        let point = welded(&[[[0.0; 3]; 3]; 2]);
        assert_eq!(point.flaws.slivers, [0, 1]);
        assert!(welded(&[[[1e3; 3]; 3]]).triangles.is_empty());
    }
}
