//! The figure of a study: share of bruised fruit of each variant.

use crate::study::outcome::{StudyOutcome, VariantOutcome};
use windfall_draw::files::NamedFigure;
use windfall_draw::xy::{Figure, Mark, Panel, Series, Side, Style};

/// Shares with their intervals, a panel for each limit; `None` where no variant has any.
pub fn figure_of_study(outcome: &StudyOutcome) -> Option<NamedFigure> {
    let known: Vec<&VariantOutcome> = outcome
        .variants
        .iter()
        .filter(|own| !own.limits.is_empty())
        .collect();
    let limits = known.first()?.limits.len();
    let panel = |place: usize| {
        let at = |number: usize| (known.len() - number) as f64;
        let limit = |own: &&VariantOutcome| own.limits[place];
        let bars = known.iter().enumerate().flat_map(|(number, own)| {
            let [low, high] = limit(own).interval;
            [(100.0 * low, at(number)), (100.0 * high, at(number))]
        });
        let points = known.iter().enumerate();
        let points = points.map(|(number, own)| (100.0 * limit(own).share, at(number)));
        let points: Vec<(f64, f64)> = points.collect();
        let marks = known.iter().zip(&points).map(|(own, point)| Mark {
            label: own.name.clone(),
            at: *point,
            side: Side::BelowRight,
        });
        let series = |style, points| Series {
            label: String::new(),
            style,
            colour: Some(0),
            points,
        };
        // Room for the labels, and the whole scale from nothing.
        let ends = vec![(0.0, 0.4), (0.0, known.len() as f64 + 0.4)];
        Panel {
            x: format!(
                "fruit with a bruise above {:.0} mm³",
                1e9 * known[0].limits[place].limit
            ),
            x_unit: "%".to_owned(),
            y: "variant, from below".to_owned(),
            y_unit: String::new(),
            series: vec![
                series(Style::LevelBars, bars.collect()),
                series(Style::Dots, points.clone()),
                series(Style::Line, ends),
            ],
            marks: marks.collect(),
            equal: false,
        }
    };
    Some(NamedFigure {
        name: "bruised_fruit".to_owned(),
        caption: "Share of bruised fruit of each variant, with the 95 % interval of the share \
                  that another batch would have."
            .to_owned(),
        figure: Figure {
            title: outcome.title.clone(),
            panels: (0..limits).map(panel).collect(),
        },
    })
}
