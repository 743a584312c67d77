//! A slow compression as a figure: force against deformation, with the laws.

use windfall_compression::fit::{CompressionFit, LoadingCurve};
use windfall_draw::xy::{Figure, Mark, Panel, Series, Side, Style};
use windfall_signal::compression::{CompressionCurve, CurvePoint};

/// The loading curve with the fitted range, the laws, the yield and the softening.
///
/// * `fits`: the laws, each with the part of the curve that it was fitted to
pub fn figure_of_compression(
    title: &str,
    curve: &CompressionCurve,
    fits: &[(LoadingCurve, CompressionFit)],
) -> Figure {
    let end = curve.loading_end.index;
    let points = |range: std::ops::Range<usize>| -> Vec<(f64, f64)> {
        let point = |i: usize| (1e3 * curve.deformation[i], curve.force[i]);
        range.map(point).collect()
    };
    // What follows the loading is shown near it: a controller may go wild.
    let near = |(d, f): &(f64, f64)| {
        let limit = &curve.loading_end;
        (0.0..=1.3e3 * limit.deformation).contains(d) && (0.0..=1.3 * limit.force).contains(f)
    };
    let after = points(end + 1..curve.force.len()).into_iter().filter(near);
    let mut all = vec![
        Series::new("loading", Style::Dots, points(0..end + 1)),
        Series::new("after it (not used)", Style::Dots, after.collect()),
    ];
    let mut marks: Vec<Mark> = Vec::new();
    for (part, fit) in fits {
        let last = part.deformation[part.deformation.len() - 1];
        let end = (1e3 * last, part.force[part.force.len() - 1]);
        if marks.iter().all(|mark| mark.at != end) {
            marks.push(Mark {
                label: "end of the fitted range".to_owned(),
                at: end,
                side: Side::BelowRight,
            });
        }
        let touch = fit.touches[0].value;
        let force = |d: f64, rate: f64| (1e3 * d, fit.law.force(d - touch, rate, d - touch));
        let rate = part.rate[part.rate.len() - 1];
        let measured = part.deformation.iter().zip(&part.rate);
        let mut line: Vec<(f64, f64)> = measured.map(|(d, v)| force(*d, *v)).collect();
        // Beyond the fitted range, to show where the fruit leaves the law.
        line.extend((1..=20).map(|i| force(last + 0.02 * f64::from(i) * (last - touch), rate)));
        let first = part.deformation[0];
        let before = (0..20).map(|i| touch + 0.05 * f64::from(i) * (first - touch));
        line.splice(0..0, before.map(|d| force(d, part.rate[0])));
        line.retain(|(_, force)| *force <= 1.3 * curve.loading_end.force);
        let label = format!("{}, fitted up to the ring", fit.law.kind().name());
        all.push(Series::new(label, Style::Line, line));
    }
    let mark = |label: &str, point: &CurvePoint| Mark {
        label: label.to_owned(),
        at: (1e3 * point.deformation, point.force),
        side: Side::AboveLeft,
    };
    marks.extend(curve.bioyield.iter().map(|point| mark("bioyield", point)));
    if curve.bioyield.is_none() {
        marks.extend(curve.softening.iter().map(|point| mark("softening", point)));
    }
    let axis = ("deformation since the first sample", "mm");
    let panel = Panel::new(axis, ("force", "N"), all);
    Figure::new(title, vec![Panel { marks, ..panel }])
}
