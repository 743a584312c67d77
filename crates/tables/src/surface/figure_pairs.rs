//! What the figures over pairs of factors share: which grids, titles and places.

use crate::surface::figure_heights::Heights;
use crate::surface::fitted::{
    FittedSurfaces, Shown, SurfaceGrid, desirability_at, pairs_of_factors, surface_grid,
};
use crate::surface::outcome::SurfaceOutcome;
use windfall_draw::axis::unit_label;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::column_title::column_title;
use windfall_files::text::number::plain;

/// More pairs than this are left to `--grid`.
pub const MOST_PAIRS: usize = 15;

/// One quantity over every pair of factors.
#[derive(Clone, Debug)]
pub struct SurfacePairs {
    /// Name of the files.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Its unit.
    pub unit: String,
    /// Values over each pair.
    pub grids: Vec<SurfaceGrid>,
    /// Levels that all pairs share.
    pub heights: Heights,
}

/// Each response, and the desirability if there are goals, on a grid of `points` along
/// every pair of factors.
pub fn surface_pairs(fitted: &FittedSurfaces, points: usize) -> Vec<SurfacePairs> {
    let mut pairs = pairs_of_factors(fitted);
    pairs.truncate(MOST_PAIRS);
    if pairs.is_empty() {
        return Vec::new();
    }
    let grids = |shown: Shown| -> Vec<SurfaceGrid> {
        let own = pairs.iter();
        own.map(|pair| surface_grid(fitted, shown, *pair, points))
            .collect()
    };
    let mut found = Vec::new();
    for (place, response) in fitted.responses.iter().enumerate() {
        let grids = grids(Shown::Response(place));
        let (title, unit) = column_title(&response.name);
        found.push(SurfacePairs {
            name: response.name.clone(),
            heights: Heights::of(grids.iter().flat_map(|grid| &grid.values)),
            title,
            unit,
            grids,
        });
    }
    if fitted
        .responses
        .iter()
        .any(|response| response.goal.is_some())
    {
        found.push(SurfacePairs {
            name: "desirability".to_owned(),
            title: "overall desirability".to_owned(),
            unit: String::new(),
            grids: grids(Shown::Desirability),
            heights: Heights::between(0.0, 1.0),
        });
    }
    found
}

/// Where the factors that a grid does not vary are: "c = 5.56e-4, …"; "" for none.
pub fn others_of(fitted: &FittedSurfaces, grid: &SurfaceGrid) -> String {
    let factors = fitted.coded.factors.iter().enumerate();
    let others = factors.filter(|(place, _)| *place != grid.factors.0 && *place != grid.factors.1);
    let texts = others.map(|(place, factor)| {
        let (name, unit) = column_title(&factor.name);
        let value = plain(factor.actual(fitted.reference[place]));
        format!("{name} = {value} {unit}").trim_end().to_owned()
    });
    texts.collect::<Vec<_>>().join(", ")
}

/// Title and unit of the factor at this place.
pub fn factor_title(fitted: &FittedSurfaces, place: usize) -> (String, String) {
    column_title(&fitted.coded.factors[place].name)
}

/// Name with unit: "force (N)".
pub fn with_unit((name, unit): &(String, String), power: i32) -> String {
    format!("{name}{}", unit_label(unit, power))
}

/// Where others stand, in words of a caption.
pub fn reference_words(fitted: &FittedSurfaces) -> &'static str {
    match fitted.at_optimum {
        true => "the most desirable settings",
        false => "their centre, or where they are held",
    }
}

/// Places that are named on a pair of factors.
#[derive(Clone, Debug, Default)]
pub struct PairPlaces {
    /// Settings of the runs.
    pub runs: Vec<(f64, f64)>,
    /// The most desirable settings.
    pub optimum: Option<(f64, f64)>,
    /// Settings that are as good.
    pub family: Vec<(f64, f64)>,
}

/// Runs, optimum and its family on a pair of factors, in actual units.
pub fn places_of(
    fitted: &FittedSurfaces,
    outcome: &SurfaceOutcome,
    (first, second): (usize, usize),
) -> PairPlaces {
    let coded = &fitted.coded;
    let actual =
        |factor: usize, run: usize| coded.factors[factor].actual(coded.values[factor][run]);
    let runs = coded.values.first().map_or(0, Vec::len);
    let pick = |settings: &[f64]| (settings[first], settings[second]);
    let best = outcome.optimum.as_ref().filter(|o| o.desirability > 0.0);
    let family = outcome.family.iter().flat_map(|family| &family.members);
    PairPlaces {
        runs: (0..runs)
            .map(|run| (actual(first, run), actual(second, run)))
            .collect(),
        optimum: best.map(|setting| pick(&setting.actual)),
        family: family.map(|member| pick(&member.actual)).collect(),
    }
}

/// Grids with standard errors of the means, runs, optimum and family as CSV.
pub fn csv_of_pairs(
    fitted: &FittedSurfaces,
    outcome: &SurfaceOutcome,
    own: &SurfacePairs,
) -> Result<String, Error> {
    let header = ["kind", "x_factor", "x", "y_factor", "y", "value", "se"];
    let name = |place: usize| fitted.coded.factors[place].name.clone();
    let mut rows: Vec<Vec<String>> = Vec::new();
    for grid in &own.grids {
        let (first, second) = grid.factors;
        let mut row = |kind: &str, (x, y): (f64, f64), value: String, se: String| {
            let (x, y) = (x.to_string(), y.to_string());
            rows.push(vec![
                kind.to_owned(),
                name(first),
                x,
                name(second),
                y,
                value,
                se,
            ]);
        };
        for (index, value) in grid.values.iter().enumerate() {
            let at = (grid.x[index % grid.x.len()], grid.y[index / grid.x.len()]);
            let se = grid.errors.as_ref().and_then(|errors| errors.get(index));
            let se = se.map_or_else(String::new, f64::to_string);
            row("grid", at, value.to_string(), se);
        }
        let places = places_of(fitted, outcome, grid.factors);
        let named = [
            ("run", places.runs),
            ("optimum", places.optimum.into_iter().collect()),
            ("as good", places.family),
        ];
        for (kind, points) in named {
            for point in points {
                row(kind, point, String::new(), String::new());
            }
        }
    }
    csv_text(&header.map(str::to_owned), rows)
}

/// Height of the quantity at the reference, for a mark on its surface.
pub fn height_at_reference(fitted: &FittedSurfaces, own: &SurfacePairs) -> Option<f64> {
    let response = fitted.responses.iter().find(|r| r.name == own.name);
    match response {
        Some(response) => Some(response.surface.value(&fitted.reference)),
        None => desirability_at(fitted, &fitted.reference),
    }
}
