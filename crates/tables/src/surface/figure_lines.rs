//! Response surfaces along single factors, and how well they meet the runs.

use crate::figures::diagnostics::{Arrangement, Diagnostics, diagnostics_painting};
use crate::surface::figure_pairs::{factor_title, reference_words};
use crate::surface::fitted::{FittedSurfaces, desirability_at, settings_along};
use crate::surface::outcome::{SurfaceModel, SurfaceOutcome};
use windfall_draw::files::{NamedFigure, Painting};
use windfall_draw::xy::{Figure, Mark, Panel, Series, Side, Style};
use windfall_files::error::Error;
use windfall_files::text::column_title::column_title;
use windfall_statistics::surface::desirability::desirability;

const POINTS: usize = 81;

fn drawn(label: &str, style: Style, colour: usize, points: Vec<(f64, f64)>) -> Series {
    Series {
        label: label.to_owned(),
        style,
        colour: Some(colour),
        points,
    }
}

/// Each response along one factor at a time from the reference, in coded units.
pub fn figure_of_perturbation(fitted: &FittedSurfaces) -> NamedFigure {
    let panels = fitted.responses.iter().map(|response| {
        let series = (0..fitted.coded.factors.len()).map(|factor| {
            let settings = settings_along(fitted, factor, POINTS);
            let points = settings.iter().map(|point| {
                let away = point[factor] - fitted.reference[factor];
                (away, response.surface.value(point))
            });
            let (name, _) = factor_title(fitted, factor);
            drawn(&name, Style::Line, factor, points.collect())
        });
        let (y, y_unit) = column_title(&response.name);
        Panel {
            x: "distance from the reference in coded units".to_owned(),
            x_unit: String::new(),
            y,
            y_unit,
            series: series.collect(),
            marks: vec![Mark {
                label: String::new(),
                at: (0.0, response.surface.value(&fitted.reference)),
                side: Side::BelowRight,
            }],
            equal: false,
        }
    });
    NamedFigure {
        name: "perturbation".to_owned(),
        caption: format!(
            "Each response as one factor alone leaves the reference, which is {}.",
            reference_words(fitted)
        ),
        figure: Figure {
            title: "Perturbation: one factor at a time".to_owned(),
            panels: panels.collect(),
        },
    }
}

/// Desirability of each response and of all, over each factor; `None` without goals.
pub fn figure_of_desirability(fitted: &FittedSurfaces) -> Option<NamedFigure> {
    desirability_at(fitted, &fitted.reference)?;
    let panels = (0..fitted.coded.factors.len()).map(|factor| {
        let own = &fitted.coded.factors[factor];
        let settings = settings_along(fitted, factor, 4 * POINTS);
        let x: Vec<f64> = settings.iter().map(|p| own.actual(p[factor])).collect();
        let over = |value: &dyn Fn(&[f64]) -> Option<f64>| -> Vec<(f64, f64)> {
            let pairs = x.iter().zip(&settings);
            pairs.filter_map(|(x, p)| Some((*x, value(p)?))).collect()
        };
        let mut series = Vec::new();
        for (place, response) in fitted.responses.iter().enumerate() {
            if let Some(goal) = &response.goal {
                let (name, _) = column_title(&response.name);
                let points = over(&|p| Some(desirability(goal, response.surface.value(p))));
                series.push(drawn(&name, Style::Line, place, points));
            }
        }
        let all = over(&|p| desirability_at(fitted, p));
        series.push(drawn("all together", Style::Dashed, 6, all));
        let reference = (own.actual(fitted.reference[factor]), 0.0);
        series.push(drawn("reference", Style::Upright, 6, vec![reference]));
        // The axis of a share reaches from nothing to all.
        if let Some(x) = x.first() {
            let end = |y: f64| drawn("", Style::Bars, 6, vec![(*x, y)]);
            series.extend([end(0.0), end(1.0)]);
        }
        let (x, x_unit) = factor_title(fitted, factor);
        Panel {
            x,
            x_unit,
            y: "desirability".to_owned(),
            y_unit: String::new(),
            series,
            marks: Vec::new(),
            equal: false,
        }
    });
    Some(NamedFigure {
        name: "desirability-factors".to_owned(),
        caption: format!(
            "Desirability of each response and of all together over each factor, the others at {}.",
            reference_words(fitted)
        ),
        figure: Figure {
            title: "Desirability over each factor".to_owned(),
            panels: panels.collect(),
        },
    })
}

/// Fitted against measured, residuals and influence of the runs, for each response without random
/// groups.
pub fn paintings_of_models(
    outcome: &SurfaceOutcome,
    confidence: f64,
) -> Result<Vec<Painting>, Error> {
    let painting = |model: &SurfaceModel| {
        let rows = &model.influence;
        let own = Diagnostics {
            response: model.response.clone(),
            lines: rows.iter().map(|row| row.line).collect(),
            rows: rows.iter().map(|row| row.influence).collect(),
            df: model.residual.df,
            parameters: rows.iter().count() - model.residual.df as usize,
            confidence,
        };
        let name = format!("model-{}", model.response);
        diagnostics_painting(&name, &own, Arrangement::Surface, Vec::new())
    };
    let models = outcome.responses.iter();
    models
        .filter(|model| model.random.is_none())
        .map(painting)
        .collect()
}
