//! Response surfaces as seen from above and aside.

use crate::surface::figure_pairs::{
    SurfacePairs, csv_of_pairs, factor_title, height_at_reference, others_of, places_of,
    reference_words, surface_pairs, with_unit,
};
use crate::surface::fitted::{FittedSurfaces, SurfaceGrid};
use crate::surface::outcome::SurfaceOutcome;
use std::f64::consts::PI;
use windfall_draw::axis::{Axis, axis};
use windfall_draw::contour_lines::{Field, contours};
use windfall_draw::files::{Painting, Picture, file_name};
use windfall_draw::frame::Rectangle;
use windfall_draw::svg::{Anchor, Drawing, Ink};
use windfall_draw::width::Width;
use windfall_files::error::Error;

/// Points of a grid along each factor: a facet is then a few px wide.
const POINTS: usize = 31;

/// Where the eye is: turned about the upright axis, and above the floor; rad.
const AZIMUTH: f64 = 38.0 * PI / 180.0;
const ELEVATION: f64 = 27.0 * PI / 180.0;

/// Height of the box over the half width of its floor; 1.
const TALL: f64 = 1.25;

/// Size of a panel, and px per half width of the floor.
const WIDTH: f64 = 400.0;
const HEIGHT: f64 = 342.0;
const SCALE: f64 = 112.0;

/// Panels side by side, and room for the title; px.
const COLUMNS: usize = 2;
const TOP: f64 = 36.0;
const BESIDE: f64 = 92.0;

/// Each response as a surface over every pair of factors, with contours and optimum.
pub fn view_paintings(
    fitted: &FittedSurfaces,
    outcome: &SurfaceOutcome,
    paper: Option<Width>,
) -> Result<Vec<Painting>, Error> {
    let all = surface_pairs(fitted, POINTS);
    let painting = |own: &SurfacePairs| {
        Ok(Painting {
            name: file_name(&format!("surface-{}", own.name)),
            caption: format!(
                "{} over pairs of factors, the others at {}; its contours on the floor.",
                own.title,
                reference_words(fitted)
            ),
            picture: Picture::Drawn(drawing_of((fitted, outcome), own, paper)),
            csv: csv_of_pairs(fitted, outcome, own)?,
        })
    };
    all.iter().map(painting).collect()
}

/// On paper the upright axes alone say how high it is; a bar beside them would take their room.
fn drawing_of(
    (fitted, outcome): (&FittedSurfaces, &SurfaceOutcome),
    own: &SurfacePairs,
    paper: Option<Width>,
) -> Drawing {
    let count = own.grids.len();
    let columns = paper.map_or(count.min(COLUMNS), |own| own.columns(count).min(COLUMNS));
    let rows = count.div_ceil(columns.max(1));
    let panel = paper.map_or(WIDTH, |own| (own.px() / columns as f64).min(WIDTH));
    let high = HEIGHT * panel / WIDTH + paper.map_or(0.0, |_| 24.0);
    let width = columns as f64 * panel + BESIDE;
    let mut drawing = Drawing::at_width(paper, width, TOP + rows as f64 * high + 8.0);
    let title = format!("Surface of {}", own.title);
    drawing.title(24.0, 26.0, &title);
    for (index, grid) in own.grids.iter().enumerate() {
        let middle = (
            (index % columns) as f64 * panel + 0.5 * panel,
            TOP + (index / columns) as f64 * high + 0.57 * high,
        );
        let scene = scene_of(own, grid, (middle, SCALE * panel / WIDTH));
        let others = others_of(fitted, grid);
        let corner = (middle.0 - 0.5 * panel + 24.0, middle.1 - 0.57 * high + 12.0);
        drawing.text(corner, Anchor::Start, 10.5, &others);
        let titles = [grid.factors.0, grid.factors.1].map(|place| factor_title(fitted, place));
        scene.draw_box(
            &mut drawing,
            &titles,
            &(own.title.clone(), own.unit.clone()),
        );
        scene.draw_floor(&mut drawing, own, grid);
        let best = places_of(fitted, outcome, grid.factors).optimum;
        let best = best.zip(height_at_reference(fitted, own));
        if let Some(((x, y), z)) = best {
            let floor = scene.place(x, y, scene.up.low);
            drawing.spot(floor, 3.0, Ink::Series(1));
            drawing.dashed(&[floor, scene.place(x, y, z)], Ink::Series(1), 1.2);
        }
        scene.draw_surface(&mut drawing, own, grid);
        if let Some(((x, y), z)) = best {
            drawing.spot(scene.place(x, y, z), 5.0, Ink::Series(1));
        }
    }
    if paper.is_some() {
        return drawing;
    }
    let bar = Rectangle {
        left: columns as f64 * panel + 10.0,
        top: TOP + 50.0,
        width: 14.0,
        height: HEIGHT - 130.0,
    };
    own.heights
        .draw_bar(&mut drawing, bar, &own.title, &own.unit);
    drawing
}

/// A box of axes as it is seen.
struct Scene {
    across: Axis,
    along: Axis,
    up: Axis,
    middle: (f64, f64),
    /// px per half width of the floor.
    scale: f64,
}

fn scene_of(own: &SurfacePairs, grid: &SurfaceGrid, (middle, scale): ((f64, f64), f64)) -> Scene {
    let ends = |values: &[f64]| {
        let (first, last) = (values.first(), values.last());
        (first.copied().unwrap_or(0.0), last.copied().unwrap_or(1.0))
    };
    let ((left, right), (low, high)) = (ends(&grid.x), ends(&grid.y));
    // A little air between the floor and the surface, to see the contours.
    let height = &own.heights.axis;
    let air = 0.22 * (height.high - height.low);
    Scene {
        across: axis(left, right, 4),
        along: axis(low, high, 4),
        up: axis(height.low - air, height.high, 5),
        middle,
        scale,
    }
}

impl Scene {
    /// Place of a point of the data in the drawing, in parallel projection.
    fn place(&self, x: f64, y: f64, z: f64) -> (f64, f64) {
        let part = |value: f64, axis: &Axis| (value - axis.low) / (axis.high - axis.low);
        let x = 2.0 * part(x, &self.across) - 1.0;
        let y = 2.0 * part(y, &self.along) - 1.0;
        let z = TALL * part(z, &self.up);
        self.project(x, y, z)
    }

    fn project(&self, x: f64, y: f64, z: f64) -> (f64, f64) {
        let (sine, cosine) = AZIMUTH.sin_cos();
        let aside = x * cosine - y * sine;
        let away = x * sine + y * cosine;
        let rise = z * ELEVATION.cos() + away * ELEVATION.sin();
        (
            self.middle.0 + self.scale * aside,
            self.middle.1 - self.scale * (rise - 0.25),
        )
    }

    /// Floor, rear walls with their lines, ticks and titles.
    fn draw_box(
        &self,
        drawing: &mut Drawing,
        titles: &[(String, String); 2],
        up: &(String, String),
    ) {
        let (x, y, z) = (&self.across, &self.along, &self.up);
        let line = |drawing: &mut Drawing, from: [f64; 3], to: [f64; 3], ink: Ink| {
            let ends = (
                self.place(from[0], from[1], from[2]),
                self.place(to[0], to[1], to[2]),
            );
            drawing.rule(ends.0, ends.1, ink);
        };
        for &at in &x.ticks {
            let corner = [at, y.high, z.low];
            line(drawing, [at, y.low, z.low], corner, Ink::Grid);
            line(drawing, corner, [at, y.high, z.high], Ink::Grid);
        }
        for &at in &y.ticks {
            let corner = [x.high, at, z.low];
            line(drawing, [x.low, at, z.low], corner, Ink::Grid);
            line(drawing, corner, [x.high, at, z.high], Ink::Grid);
        }
        for &at in &z.ticks {
            let corner = [x.high, y.high, at];
            line(drawing, [x.low, y.high, at], corner, Ink::Grid);
            line(drawing, [x.high, y.low, at], corner, Ink::Grid);
        }
        for (from, to) in [
            ([x.low, y.low, z.low], [x.high, y.low, z.low]),
            ([x.low, y.low, z.low], [x.low, y.high, z.low]),
            ([x.low, y.high, z.low], [x.low, y.high, z.high]),
        ] {
            line(drawing, from, to, Ink::Frame);
        }

        let small = 10.0;
        for (at, label) in x.ticks.iter().zip(&x.labels) {
            let (px, py) = self.place(*at, y.low, z.low);
            drawing.rule((px, py), (px + 3.0, py + 4.0), Ink::Frame);
            drawing.text((px + 5.0, py + 14.0), Anchor::Start, small, label);
        }
        for (at, label) in y.ticks.iter().zip(&y.labels) {
            let (px, py) = self.place(x.low, *at, z.low);
            drawing.rule((px, py), (px - 3.0, py + 4.0), Ink::Frame);
            drawing.text((px - 5.0, py + 14.0), Anchor::End, small, label);
        }
        for (at, label) in z.ticks.iter().zip(&z.labels) {
            let (px, py) = self.place(x.low, y.high, *at);
            drawing.rule((px - 4.0, py), (px, py), Ink::Frame);
            drawing.text((px - 7.0, py + 3.5), Anchor::End, small, label);
        }
        let (px, py) = self.project(0.1, -1.0, 0.0);
        let title = with_unit(&titles[0], x.power);
        drawing.text((px + 26.0, py + 34.0), Anchor::Start, 11.5, &title);
        let (px, py) = self.project(-1.0, 0.1, 0.0);
        let title = with_unit(&titles[1], y.power);
        drawing.text((px - 24.0, py + 34.0), Anchor::End, 11.5, &title);
        let (px, py) = self.project(-1.0, 1.0, TALL);
        let title = with_unit(up, z.power);
        drawing.text(
            ((px - 34.0).max(3.0), py - 10.0),
            Anchor::Start,
            11.5,
            &title,
        );
    }

    /// The contours below the surface.
    fn draw_floor(&self, drawing: &mut Drawing, own: &SurfacePairs, grid: &SurfaceGrid) {
        let field = Field {
            x: &grid.x,
            y: &grid.y,
            values: &grid.values,
        };
        for level in &own.heights.axis.ticks {
            for line in contours(&field, *level) {
                let points = line.points.iter();
                let points: Vec<_> = points
                    .map(|(x, y)| self.place(*x, *y, self.up.low))
                    .collect();
                drawing.polyline(&points, Ink::Frame, 0.8);
            }
        }
    }

    /// The facets, the farthest first: nearer ones hide what is behind them.
    fn draw_surface(&self, drawing: &mut Drawing, own: &SurfacePairs, grid: &SurfaceGrid) {
        let columns = grid.x.len();
        let value = |i: usize, j: usize| grid.values[j * columns + i];
        for j in (0..grid.y.len().saturating_sub(1)).rev() {
            for i in (0..columns.saturating_sub(1)).rev() {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let mean = corners.map(|(i, j)| value(i, j)).iter().sum::<f64>() / 4.0;
                if !mean.is_finite() {
                    continue;
                }
                let points = corners.map(|(i, j)| self.place(grid.x[i], grid.y[j], value(i, j)));
                drawing.facet(&points, own.heights.ink_of(mean), Ink::Frame);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::figure_heights::Heights;

    /// Seen from the front corner: the nearest corner of the floor is lowest, the
    /// farthest highest, what is higher stands higher, and parallels stay parallel.
    #[test]
    fn closed_form_projection() {
        let own = SurfacePairs {
            name: String::new(),
            title: String::new(),
            unit: String::new(),
            grids: Vec::new(),
            heights: Heights::between(0.0, 1.0),
        };
        let grid = SurfaceGrid {
            factors: (0, 1),
            x: vec![0.0, 1.0],
            y: vec![0.0, 2.0],
            values: vec![0.0; 4],
            errors: None,
        };
        let scene = scene_of(&own, &grid, ((0.0, 0.0), SCALE));
        let near = scene.place(0.0, 0.0, 0.0);
        let (right, left) = (scene.place(1.0, 0.0, 0.0), scene.place(0.0, 2.0, 0.0));
        let far = scene.place(1.0, 2.0, 0.0);
        assert!(near.1 > right.1 && near.1 > left.1 && far.1 < right.1 && far.1 < left.1);
        assert!(right.0 > near.0 && left.0 < near.0);
        assert!(scene.place(0.0, 0.0, 1.0).1 < near.1);
        let (a, b) = (right.0 - near.0, far.0 - left.0);
        let (c, d) = (right.1 - near.1, far.1 - left.1);
        assert!((a - b).abs() < 1e-9 && (c - d).abs() < 1e-9);
    }
}
