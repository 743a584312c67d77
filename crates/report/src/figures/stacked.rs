//! Residuals of all impacts, laid upon each other over the contact.

use windfall_campaign::result::outcome::ImpactOutcome;
use windfall_distribution::tail::t_upper_quantile;
use windfall_draw::files::{NamedFigure, file_name};
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_identify::fit::result::PHASES;

/// Fewest impacts whose mean says something.
const FEWEST: usize = 5;

/// Mean residual of each quantity in the parts of the contact, with the 95 % intervals of these
/// means over impacts; `None` with fewer than five.
pub fn figure_of_stacked(law: &str, impacts: &[&ImpactOutcome]) -> Option<NamedFigure> {
    let first = impacts.first()?;
    let panels = first.residuals.0.iter().filter_map(|(name, _)| {
        let own = impacts.iter().filter_map(|own| own.residuals.get(name));
        let rows: Vec<[f64; PHASES]> = own.map(|own| own.by_phase).collect();
        (rows.len() >= FEWEST).then(|| panel(name, &rows))
    });
    let panels: Vec<Panel> = panels.collect();
    if panels.is_empty() {
        return None;
    }
    let count = impacts.len();
    Some(NamedFigure {
        name: file_name(&format!("{law}-residuals")),
        caption: format!(
            "{law}: mean residual of {count} impacts in eight parts of the contact, over the root \
             mean square of all residuals, with 95 % intervals. What is not zero is in every \
             impact: the law or the bench, not noise."
        ),
        figure: Figure::new(format!("{law}: residuals of {count} impacts"), panels),
    })
}

fn panel(name: &str, rows: &[[f64; PHASES]]) -> Panel {
    let count = rows.len() as f64;
    let reach = t_upper_quantile(0.025, count - 1.0) / count.sqrt();
    let (mut means, mut bars) = (Vec::new(), Vec::new());
    for phase in 0..PHASES {
        let place = 100.0 * (phase as f64 + 0.5) / PHASES as f64;
        let values = || rows.iter().map(|row| row[phase]);
        let mean = values().sum::<f64>() / count;
        let square = values().map(|value| (value - mean).powi(2)).sum::<f64>();
        let half = reach * (square / (count - 1.0)).sqrt();
        means.push((place, mean));
        bars.extend([(place, mean - half), (place, mean + half)]);
    }
    let series = vec![
        Series::new("0: nothing in common", Style::Level, vec![(0.0, 0.0)]).coloured(1),
        Series::new("95 % interval", Style::Bars, bars).coloured(0),
        Series::new("mean of all impacts", Style::Dots, means).coloured(0),
    ];
    let residual = format!("{name}, mean residual");
    Panel::new(
        ("part of the contact", "%"),
        (&residual, "of its rms"),
        series,
    )
}
