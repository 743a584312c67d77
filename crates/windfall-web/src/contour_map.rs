//! Contour maps: levels, lines, areas and colours of values over a grid, for the page to draw.

use serde::Serialize;
use utoipa::ToSchema;
use windfall_draw::axis::axis;
use windfall_draw::colour_map::{colour_of, css};
use windfall_draw::contour_lines::{Field, area_above, contours};
use windfall_tables::surface::outcome::GridOutcome;

/// Colours of a map from its lowest to its highest value.
const COLOURS: usize = 256;

/// Most levels but for one at an end: a screen has room for more than a printed figure.
const LEVELS: usize = 15;

/// Values on a rectangular grid with their contours.
#[derive(Debug, PartialEq, Serialize, ToSchema)]
pub(crate) struct ContourMap {
    /// First coordinates, rising.
    x: Vec<f64>,
    /// Second coordinates, rising.
    y: Vec<f64>,
    /// Values, the first coordinate varying fastest.
    values: Vec<f64>,
    /// Colour below the first level.
    ground: String,
    /// Round levels, rising.
    levels: Vec<ContourLevel>,
    /// Colours from the lowest to the highest value, evenly spaced.
    colours: Vec<String>,
}

/// A level of a contour map.
#[derive(Debug, PartialEq, Serialize, ToSchema)]
pub(crate) struct ContourLevel {
    /// Its value.
    value: f64,
    /// Colour between it and the next level.
    colour: String,
    /// Closed outlines of all that is at or above it, by the even-odd rule; points by their
    /// two coordinates.
    area: Vec<Vec<(f64, f64)>>,
    /// Lines on which the values equal it.
    lines: Vec<Vec<(f64, f64)>>,
}

/// The map of a response over two factors.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct ResponseMap {
    /// The response.
    response: String,
    /// Its predicted means.
    map: ContourMap,
    /// Standard errors of these means, in the same order.
    errors: Vec<f64>,
}

/// The contour map of values over a grid.
///
/// * `values`: `x.len() * y.len()` finite values, the first coordinate varying fastest
pub(crate) fn contour_map(x: Vec<f64>, y: Vec<f64>, values: Vec<f64>) -> ContourMap {
    let field = Field {
        x: &x,
        y: &y,
        values: &values,
    };
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let ticks = axis(low, high, LEVELS).ticks;
    let bands = (ticks.len() + 1) as f64;
    let band = |place: usize| css(colour_of((place as f64 + 0.5) / bands));
    let level = |(place, value): (usize, &f64)| ContourLevel {
        value: *value,
        colour: band(place + 1),
        area: area_above(&field, *value),
        lines: contours(&field, *value)
            .into_iter()
            .map(|line| line.points)
            .collect(),
    };
    let step = |k: usize| css(colour_of(k as f64 / (COLOURS - 1) as f64));
    ContourMap {
        ground: band(0),
        levels: ticks.iter().enumerate().map(level).collect(),
        colours: (0..COLOURS).map(step).collect(),
        x,
        y,
        values,
    }
}

/// Maps of all responses of a grid.
///
/// * `pair`: the two factors of the grid, "k,e"
/// * `responses`: their names
pub(crate) fn response_maps(
    grid: &GridOutcome,
    pair: &str,
    responses: &[String],
) -> Vec<ResponseMap> {
    let column = |name: &str| -> Option<Vec<f64>> {
        let place = grid.columns.iter().position(|own| own == name)?;
        Some(grid.rows.iter().map(|row| row[place]).collect())
    };
    let map = |response: &String| {
        let (first, second) = pair.split_once(',')?;
        let (x, y) = (column(first.trim())?, column(second.trim())?);
        // As many points along both factors, the first varying fastest.
        let points = grid.rows.len().isqrt();
        Some(ResponseMap {
            map: contour_map(
                x.into_iter().take(points).collect(),
                y.into_iter().step_by(points).collect(),
                column(response)?,
            ),
            errors: column(&format!("{response}_se"))?,
            response: response.clone(),
        })
    };
    responses.iter().filter_map(map).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of x + y on a grid from 0 to 1, each level bounds the corner above it: a triangle
    /// of area (2 − level)²/2 for levels over 1.
    #[test]
    fn closed_form_a_plane() {
        let places: Vec<f64> = (0..11).map(|i| f64::from(i) / 10.0).collect();
        let values = places
            .iter()
            .flat_map(|y| places.iter().map(move |x| x + y))
            .collect();
        let map = contour_map(places.clone(), places, values);
        let levels: Vec<f64> = map.levels.iter().map(|level| level.value).collect();
        assert!(levels.windows(2).all(|pair| pair[0] < pair[1]));
        let above: Vec<&ContourLevel> = map.levels.iter().filter(|l| l.value > 1.0).collect();
        assert!(above.len() >= 3, "{levels:?}");
        for level in above {
            let corners = &level.area[0];
            let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
            let area = 0.5 * pairs.map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum::<f64>();
            let expected = 0.5 * (2.0 - level.value).powi(2);
            assert!((area.abs() - expected).abs() < 1e-12, "{}", level.value);
            assert!(level.value > 1.99 || level.lines.len() == 1);
        }
        assert_eq!(map.colours.len(), COLOURS);
        assert_ne!(map.ground, map.levels[0].colour);
    }

    /// Columns of a grid become coordinates, values and errors.
    #[test]
    fn closed_form_a_grid() {
        let rows = [(0.0, 5.0), (1.0, 5.0), (0.0, 6.0), (1.0, 6.0)];
        let grid = GridOutcome {
            columns: ["b", "c", "a", "y", "y_se"].map(str::to_owned).to_vec(),
            rows: rows
                .iter()
                .map(|(a, b)| vec![*b, 7.0, *a, a + 10.0 * b, 0.5 * a])
                .collect(),
        };
        let maps = response_maps(&grid, "a, b", &["y".to_owned()]);
        assert_eq!(maps[0].map.x, [0.0, 1.0]);
        assert_eq!(maps[0].map.y, [5.0, 6.0]);
        assert_eq!(maps[0].map.values, [50.0, 51.0, 60.0, 61.0]);
        assert_eq!(maps[0].errors, [0.0, 0.5, 0.0, 0.5]);
        assert!(response_maps(&grid, "a,x", &["y".to_owned()]).is_empty());
    }
}
