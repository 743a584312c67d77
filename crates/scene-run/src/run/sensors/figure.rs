//! What the sensors of a scene saw, over time.

use crate::run::sensors::flow::Flow;
use crate::run::sensors::probe::Probe;
use crate::run::sensors::space::Space;
use crate::run::sensors::watch::Sensors;
use windfall_draw::xy::{Figure, Panel, Series, Style};

/// A panel for the flow through each plane, two for the content of each box, one for the
/// acceleration of each kind of probes; `None` without sensors.
pub(crate) fn figure_of_sensors(title: &str, sensors: &Sensors) -> Option<Figure> {
    let flows = sensors.flows.iter();
    let flows = flows.map(|own| flow_panel(own, sensors.name(own.sensor), sensors.span));
    let spaces = sensors.spaces.iter();
    let spaces = spaces.flat_map(|own| space_panels(own, sensors.name(own.sensor), sensors.span));
    let probes = sensors.probes.iter();
    let probes = probes.map(|own| probe_panel(own, sensors.name(own.sensor), sensors.span));
    let panels: Vec<Panel> = flows.chain(spaces).chain(probes).collect();
    (!panels.is_empty()).then(|| Figure::new(title, panels))
}

const TIME: (&str, &str) = ("time", "s");

fn flow_panel(own: &Flow, name: &str, span: [f64; 2]) -> Panel {
    let mut series = vec![
        Series::new(
            format!("{name}: forward"),
            Style::Line,
            own.state.there.rates(span),
        )
        .coloured(0),
    ];
    if !own.state.back.points().is_empty() {
        let back = own.state.back.rates(span);
        series.push(Series::new("backward", Style::Dashed, back).coloured(1));
    }
    Panel::new(TIME, ("flow of fruit", "1/s"), series)
}

/// What stretches an axis over the whole scene, so that panels stand below each other: places
/// that show nothing.
fn ends(at: f64, span: [f64; 2]) -> [Series; 2] {
    span.map(|time| Series::new("", Style::Line, vec![(time, at)]))
}

fn space_panels(own: &Space, name: &str, span: [f64; 2]) -> [Panel; 2] {
    let panel = |what, points: Vec<(f64, f64)>| {
        let first = points.first().map_or(0.0, |own| own.1);
        let mut series = vec![Series::new(name, Style::Line, points).coloured(0)];
        series.extend(ends(first, span));
        Panel::new(TIME, what, series)
    };
    [
        panel(("fruit in the box", "1"), own.state.counts.points()),
        panel(("highest top", "m"), own.state.levels.points()),
    ]
}

fn probe_panel(own: &Probe, name: &str, span: [f64; 2]) -> Panel {
    let marks = own.state.marks.points();
    let mut series = vec![
        Series::new(name, Style::Line, own.state.magnitudes.points()).coloured(0),
        Series::new(
            "threshold of an impact",
            Style::Level,
            vec![(span[0], own.least)],
        )
        .coloured(1),
    ];
    if !marks.is_empty() {
        series.push(Series::new("impacts", Style::Spots, marks).coloured(1));
    }
    series.extend(ends(0.0, span));
    Panel::new(TIME, ("acceleration", "m/s²"), series)
}
