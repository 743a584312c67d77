//! What each impact says of the bench, by Newton's law alone.

use windfall_campaign::result::bench::says_of_bench;
use windfall_campaign::result::outcome::{CampaignOutcome, ImpactOutcome, PooledOutcome};
use windfall_draw::files::NamedFigure;
use windfall_draw::xy::{Figure, Panel, Series, Style};

/// Standard deviations of a 95 % interval, about; 1.
const REACH: f64 = 2.0;

/// Gain and delay of the force of each impact in the order of impacts.csv, with the common value;
/// `None` where the campaign tells neither.
pub fn figure_of_bench(
    outcome: &CampaignOutcome,
    impacts: &[&ImpactOutcome],
) -> Option<NamedFigure> {
    let asked: Vec<&ImpactOutcome> = impacts
        .iter()
        .copied()
        .filter(|own| says_of_bench(own))
        .collect();
    let panels: Vec<Panel> = [
        (
            "force_gain",
            ("force over mass × acceleration", ""),
            (1.0, 1.0),
        ),
        ("force_delay", ("force later by", "µs"), (0.0, 1e6)),
    ]
    .into_iter()
    .filter_map(|(name, title, (perfect, scale))| {
        let pooled = outcome.bench.get(name)?;
        Some(panel(&asked, (name, title), pooled, (perfect, scale)))
    })
    .collect();
    if panels.is_empty() {
        return None;
    }
    Some(NamedFigure {
        name: "bench".to_owned(),
        caption: "Force against mass × acceleration of the displacement, at every instant of each \
                  impact, with ± two standard deviations; no law of the fruit enters. Lines: the \
                  common value of all impacts ± two of its deviations, which contain what the time \
                  between samples or counts may shift in all impacts alike, and a perfect bench."
            .to_owned(),
        figure: Figure::new("the bench by Newton's law".to_owned(), panels),
    })
}

/// * `perfect`: value of a bench that is as told
/// * `scale`: shown over SI
fn panel(
    impacts: &[&ImpactOutcome],
    (name, title): (&str, (&str, &str)),
    pooled: &PooledOutcome,
    (perfect, scale): (f64, f64),
) -> Panel {
    let (mut dots, mut bars) = (Vec::new(), Vec::new());
    for (order, impact) in impacts.iter().enumerate() {
        let (Some(value), Some(sd)) = (impact.derived(name), impact.derived_sd.get(name)) else {
            continue;
        };
        let at = (order + 1) as f64;
        dots.push((at, scale * value));
        bars.extend([-REACH, REACH].map(|reach| (at, scale * (value + reach * sd))));
    }
    let ends = [0.5, impacts.len() as f64 + 0.5];
    let along = |value: f64| ends.map(|at| (at, scale * value));
    let mut band = along(pooled.value - REACH * pooled.sd).to_vec();
    band.extend(along(pooled.value + REACH * pooled.sd).into_iter().rev());
    let series = vec![
        Series::new("common value ± 2 SD", Style::Band, band).coloured(6),
        Series::new("common value", Style::Line, along(pooled.value).to_vec()).coloured(6),
        Series::new("as told", Style::Level, vec![(0.0, scale * perfect)]).coloured(1),
        Series::new("", Style::Bars, bars).coloured(0),
        Series::new("impacts", Style::Dots, dots).coloured(0),
    ];
    Panel::new(("impact", ""), title, series)
}
