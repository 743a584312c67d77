//! Repeated impacts as a figure: mean curves, differences, the statistic with
//! its critical level.

use crate::repeats::compare::Compared;
use crate::repeats::pairs::{Pair, Pairs};
use windfall_draw::xy::{Figure, Panel, Series, Style};

/// One comparison of a campaign.
pub fn figure_of_comparison(
    title: &str,
    pairs: &Pairs,
    compared: &Compared,
    index: usize,
) -> Figure {
    let comparison = &compared.comparisons[index];
    let members: Vec<&Pair> = pairs
        .pairs
        .iter()
        .filter(|pair| {
            !pair.reference
                && pair.order == comparison.order
                && (pairs.energies[pair.level] - comparison.energy).abs() < f64::EPSILON
        })
        .collect();
    let instants = members
        .first()
        .map_or(&[][..], |pair| &pair.aligned.instants);
    let points = |values: &[f64]| -> Vec<(f64, f64)> {
        instants
            .iter()
            .copied()
            .zip(values.iter().copied())
            .collect()
    };
    let mean = |of: &dyn Fn(&Pair) -> &Vec<f64>| -> Vec<f64> {
        let n = members.len() as f64;
        let at = |i: usize| {
            let parts = members
                .iter()
                .map(|p| of(p)[i] / p.aligned.first_features.peak);
            100.0 * parts.sum::<f64>() / n
        };
        (0..instants.len()).map(at).collect()
    };
    let (first, second) = (comparison.order + 1, comparison.order + 2);
    let line = |label: &str, values: &[f64]| Series::new(label, Style::Line, points(values));
    let curves = vec![
        line(
            &format!("impact {first}, mean"),
            &mean(&|pair| &pair.aligned.first),
        ),
        line(
            &format!("impact {second}, mean"),
            &mean(&|pair| &pair.aligned.second),
        ),
    ];
    let percent = |values: &[f64]| values.iter().map(|v| 100.0 * v).collect::<Vec<f64>>();
    let every = members
        .iter()
        .flat_map(|p| points(&percent(&p.aligned.difference())));
    let differences = vec![
        Series::new("each fruit", Style::Dots, every.collect()),
        line("mean", &percent(&comparison.curves.mean)),
    ];
    let mut statistic = vec![line(
        "studentised mean difference",
        &comparison.curves.statistic,
    )];
    if let Some(critical) = compared.test.as_ref().and_then(|test| test.critical) {
        let from = instants.first().copied().unwrap_or(0.0);
        let levels = vec![(from, critical), (from, -critical)];
        let label = "critical level over all instants and energies";
        statistic.push(Series::new(label, Style::Level, levels));
    }
    let axis = ("time from the crossing, in contact durations", "");
    Figure {
        title: format!(
            "{title}: {}, p = {:.4}",
            comparison.verdict.word(),
            comparison.curves.p
        ),
        panels: vec![
            Panel::new(axis, ("force / first peak", "%"), curves),
            Panel::new(axis, ("difference / first peak", "%"), differences),
            Panel::new(axis, ("statistic", ""), statistic),
        ],
    }
}
