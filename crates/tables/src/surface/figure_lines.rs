//! Response surfaces along single factors, and how well they meet the runs.

use crate::regress::outcome::RowOutcome;
use crate::surface::figure_pairs::{factor_title, reference_words};
use crate::surface::fitted::{FittedSurfaces, desirability_at, settings_along};
use crate::surface::outcome::{SurfaceModel, SurfaceOutcome};
use windfall_draw::files::{NamedFigure, file_name};
use windfall_draw::xy::{Figure, Mark, Panel, Series, Side, Style};
use windfall_files::text::column_title::column_title;
use windfall_statistics::distribution::tail::{normal_quantile, t_upper_quantile};
use windfall_statistics::residuals::diagnostics::RowInfluence;
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

/// Fitted against measured, and studentised residuals over the fitted value, in the order
/// of the table and against normal scores, for each response.
pub fn figures_of_models(outcome: &SurfaceOutcome, confidence: f64) -> Vec<NamedFigure> {
    let models = outcome.responses.iter();
    models
        .map(|model| figure_of_model(model, confidence))
        .collect()
}

fn figure_of_model(model: &SurfaceModel, confidence: f64) -> NamedFigure {
    let (name, unit) = column_title(&model.response);
    let rows = &model.influence;
    let points = |x: fn(&RowInfluence) -> f64, y: fn(&RowInfluence) -> f64| {
        let rows = rows
            .iter()
            .map(|row| (x(&row.influence), y(&row.influence)));
        rows.collect::<Vec<(f64, f64)>>()
    };
    let ends = rows.iter();
    let ends = ends.flat_map(|row| [row.influence.observed, row.influence.fitted]);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let mut panels = vec![Panel {
        x: format!("measured {name}"),
        x_unit: unit.clone(),
        y: format!("fitted {name}"),
        y_unit: unit.clone(),
        series: vec![
            drawn("", Style::Dashed, 6, vec![(low, low), (high, high)]),
            drawn("runs", Style::Dots, 0, points(|r| r.observed, |r| r.fitted)),
        ],
        marks: Vec::new(),
    }];
    // A residual is held against the others without it: one degree of freedom less.
    let limit = match model.residual.df > 1.0 {
        true => t_upper_quantile(0.5 * (1.0 - confidence), model.residual.df - 1.0),
        false => f64::NAN,
    };
    let label = format!(
        "{} % of those of independent normal noise",
        100.0 * confidence
    );
    let mut over = |x: String, x_unit: &str, dots: Vec<(f64, f64)>| {
        let at = dots.first().map_or(0.0, |point| point.0);
        panels.push(Panel {
            x,
            x_unit: x_unit.to_owned(),
            y: "studentised residual".to_owned(),
            y_unit: String::new(),
            series: vec![
                drawn("runs", Style::Dots, 0, dots),
                drawn(&label, Style::Level, 1, vec![(at, limit), (at, -limit)]),
            ],
            marks: Vec::new(),
        });
    };
    over(
        format!("fitted {name}"),
        &unit,
        points(|r| r.fitted, |r| r.studentised),
    );
    over(
        "line of the table".to_owned(),
        "",
        rows.iter()
            .map(|r| (r.line as f64, r.influence.studentised))
            .collect(),
    );
    panels.push(normal_panel(rows));
    NamedFigure {
        name: file_name(&format!("model-{}", model.response)),
        caption: "Fitted against measured; residuals over their standard deviation without the \
                  run itself, over the fitted value, in the order of the table, and against \
                  normal scores."
            .to_owned(),
        figure: Figure {
            title: format!("{name}: model and runs"),
            panels,
        },
    }
}

/// Studentised residuals against normal scores (Blom 1958: (i − 3/8)/(n + 1/4)).
fn normal_panel(rows: &[RowOutcome]) -> Panel {
    let finite = rows.iter().map(|row| row.influence.studentised);
    let mut sorted: Vec<f64> = finite.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let score = |i: usize| normal_quantile((i as f64 + 0.625) / (n + 0.25));
    let points: Vec<(f64, f64)> = (0..sorted.len()).map(|i| (score(i), sorted[i])).collect();
    let ends = points.first().zip(points.last());
    let line = ends.map_or(Vec::new(), |(a, b)| vec![(a.0, a.0), (b.0, b.0)]);
    Panel {
        x: "normal score".to_owned(),
        x_unit: String::new(),
        y: "studentised residual".to_owned(),
        y_unit: String::new(),
        series: vec![
            drawn("", Style::Dashed, 6, line),
            drawn("runs", Style::Dots, 0, points),
        ],
        marks: Vec::new(),
    }
}
