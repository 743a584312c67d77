//! Lines of equal height of values on a grid, and the areas above them.

use std::collections::BTreeMap;

/// Values on a rectangular grid; the first coordinate varies fastest.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// First coordinates, rising.
    pub x: &'a [f64],
    /// Second coordinates, rising.
    pub y: &'a [f64],
    /// Values: `x.len() * y.len()`.
    pub values: &'a [f64],
}

/// A line of equal height.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// Its points; the last is the first again where it is closed.
    pub points: Vec<(f64, f64)>,
    /// Whether it closes within the grid.
    pub closed: bool,
}

/// A side of a cell: of the grid point at its lower or left end, and whether it goes
/// up.
type Side = (usize, usize, bool);

/// Lines on which a field has a value: marching squares, straight between the places
/// where sides of cells are crossed. Where the four corners of a cell could be joined
/// in two ways, their mean decides.
///
/// # Source
/// W. E. Lorensen, H. E. Cline (1987), Computer Graphics 21:163, in two dimensions.
pub fn contours(field: &Field, level: f64) -> Vec<Contour> {
    let mut links = links(field, level);
    let mut lines = Vec::new();
    // Lines that begin at the border first: what is left is closed.
    for open in [true, false] {
        let starts: Vec<Side> = links.keys().copied().collect();
        for start in starts {
            let Some(next) = links.get(&start) else {
                continue;
            };
            if open && next.len() != 1 {
                continue;
            }
            let mut sides = vec![start];
            let mut at = start;
            while let Some(next) = links.get_mut(&at).and_then(Vec::pop) {
                if let Some(back) = links.get_mut(&next)
                    && let Some(place) = back.iter().position(|side| *side == at)
                {
                    back.remove(place);
                }
                sides.push(next);
                at = next;
            }
            links.retain(|_, next| !next.is_empty());
            if sides.len() > 1 {
                lines.push(Contour {
                    closed: sides.first() == sides.last(),
                    points: sides
                        .iter()
                        .map(|side| place(field, *side, level))
                        .collect(),
                });
            }
        }
    }
    lines
}
/// Closed lines around all that is at or above a value; what an odd number of them
/// encloses is above.
pub fn area_above(field: &Field, level: f64) -> Vec<Vec<(f64, f64)>> {
    // A rim of nothing in the same places: every line closes along the border.
    let padded = |coordinates: &[f64]| -> Vec<f64> {
        let ends = (coordinates.first(), coordinates.last());
        let ends = (ends.0.copied(), ends.1.copied());
        let inner = coordinates.iter().copied();
        ends.0.into_iter().chain(inner).chain(ends.1).collect()
    };
    let (x, y) = (padded(field.x), padded(field.y));
    let mut values = vec![f64::NEG_INFINITY; x.len() * y.len()];
    for (row, own) in field.values.chunks_exact(field.x.len()).enumerate() {
        let from = (row + 1) * x.len() + 1;
        values[from..from + own.len()].copy_from_slice(own);
    }
    let rimmed = Field {
        x: &x,
        y: &y,
        values: &values,
    };
    let lines = contours(&rimmed, level).into_iter();
    lines.map(|line| line.points).collect()
}

/// Which crossed sides are joined to which.
fn links(field: &Field, level: f64) -> BTreeMap<Side, Vec<Side>> {
    let (columns, rows) = (field.x.len(), field.y.len());
    let value = |i: usize, j: usize| field.values[j * columns + i];
    let mut links: BTreeMap<Side, Vec<Side>> = BTreeMap::new();
    for j in 0..rows.saturating_sub(1) {
        for i in 0..columns.saturating_sub(1) {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let above = corners.map(|(i, j)| value(i, j) >= level);
            let sides = [
                (i, j, false),
                (i + 1, j, true),
                (i, j + 1, false),
                (i, j, true),
            ];
            let crossed: Vec<Side> = (0..4)
                .filter(|side| above[*side] != above[(side + 1) % 4])
                .map(|side| sides[side])
                .collect();
            let joined: Vec<(Side, Side)> = match crossed[..] {
                [a, b] => vec![(a, b)],
                [a, b, c, d] => {
                    let mean = corners.map(|(i, j)| value(i, j)).iter().sum::<f64>() / 4.0;
                    // Corners like the first are joined through the middle, or cut off.
                    match (mean >= level) == above[0] {
                        true => vec![(a, b), (c, d)],
                        false => vec![(d, a), (b, c)],
                    }
                }
                _ => Vec::new(),
            };
            for (a, b) in joined {
                links.entry(a).or_default().push(b);
                links.entry(b).or_default().push(a);
            }
        }
    }
    links
}

/// Where a side has the value.
fn place(field: &Field, (i, j, up): Side, level: f64) -> (f64, f64) {
    let columns = field.x.len();
    let (k, l) = if up { (i, j + 1) } else { (i + 1, j) };
    let (from, to) = (field.values[j * columns + i], field.values[l * columns + k]);
    let part = match (from.is_finite(), to.is_finite()) {
        (true, true) => (level - from) / (to - from),
        // The rim of nothing lies on the border.
        (true, false) => 0.0,
        _ => 1.0,
    };
    let between = |a: f64, b: f64| a + part * (b - a);
    (
        between(field.x[i], field.x[k]),
        between(field.y[j], field.y[l]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(points: usize, low: f64, high: f64) -> Vec<f64> {
        (0..points)
            .map(|i| low + (high - low) * i as f64 / (points - 1) as f64)
            .collect()
    }

    fn over(x: &[f64], y: &[f64], value: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let rows = y.iter().flat_map(|y| x.iter().map(move |x| (*x, *y)));
        rows.map(|(x, y)| value(x, y)).collect()
    }

    fn size_of(points: &[(f64, f64)]) -> f64 {
        let pairs = points.iter().zip(points.iter().cycle().skip(1));
        0.5 * pairs.map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum::<f64>()
    }

    /// x² + 2 y² = 1 is one closed line of half axes 1 and √½: its points are as near
    /// to the ellipse as straight lines over cells of width h can be, h²/8 times the
    /// curvature, and the area is π √½.
    #[test]
    fn closed_form_an_ellipse() {
        let x = grid(81, -2.0, 2.0);
        let values = over(&x, &x, |x, y| x * x + 2.0 * y * y);
        let field = Field {
            x: &x,
            y: &x,
            values: &values,
        };
        let lines = contours(&field, 1.0);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].closed);
        for (x, y) in &lines[0].points {
            assert!(
                (x * x + 2.0 * y * y - 1.0).abs() < 2.0 * 0.05_f64.powi(2),
                "{x} {y}"
            );
        }
        let area = std::f64::consts::PI * 0.5_f64.sqrt();
        assert!((size_of(&lines[0].points).abs() / area - 1.0).abs() < 3e-3);
        // Above 1 is all but the ellipse: the border and the line within it.
        let above = area_above(&field, 1.0);
        assert_eq!(above.len(), 2);
        let sizes: Vec<f64> = above.iter().map(|line| size_of(line).abs()).collect();
        let whole = sizes.iter().copied().fold(0.0, f64::max);
        assert!((whole - 16.0).abs() < 1e-12);
    }

    /// A plane's lines are straight and exact, and the area above them too.
    #[test]
    fn closed_form_a_plane() {
        let (x, y) = (grid(11, 0.0, 1.0), grid(6, 0.0, 1.0));
        let values = over(&x, &y, |x, y| x + y);
        let field = Field {
            x: &x,
            y: &y,
            values: &values,
        };
        let lines = contours(&field, 0.55);
        assert_eq!((lines.len(), lines[0].closed), (1, false));
        for (x, y) in &lines[0].points {
            assert!((x + y - 0.55).abs() < 1e-12);
        }
        let above = area_above(&field, 0.55);
        assert_eq!(above.len(), 1);
        assert!((size_of(&above[0]).abs() - (1.0 - 0.5 * 0.55 * 0.55)).abs() < 1e-12);
        // All of it, and nothing.
        assert!((size_of(&area_above(&field, -1.0)[0]).abs() - 1.0).abs() < 1e-12);
        assert!(area_above(&field, 3.0).is_empty() && contours(&field, 3.0).is_empty());
    }

    /// x y = ±¼ are two branches each, and none of them meet.
    #[test]
    fn closed_form_a_saddle() {
        let x = grid(40, -1.0, 1.0);
        let values = over(&x, &x, |x, y| x * y);
        let field = Field {
            x: &x,
            y: &x,
            values: &values,
        };
        for level in [-0.25, 0.25] {
            let lines = contours(&field, level);
            assert_eq!(lines.len(), 2);
            for (x, y) in lines.iter().flat_map(|line| &line.points) {
                assert!((x * y - level).abs() < 1e-3);
            }
        }
    }

    /// Grid points that have the very value break no line.
    #[test]
    fn closed_form_values_on_grid_points() {
        let x = grid(5, 0.0, 4.0);
        let values = over(&x, &x, |x, _| x);
        let field = Field {
            x: &x,
            y: &x,
            values: &values,
        };
        let lines = contours(&field, 2.0);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].points.iter().all(|(x, _)| *x == 2.0));
        assert_eq!(lines[0].points.len(), 5);
    }
}
