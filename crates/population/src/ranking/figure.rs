//! A comparison of laws as a figure: how much worse than the best each law is, over
//! the campaign and on each impact, and how well it predicts held-out velocities.

use crate::ranking::outcome::{LawEvidenceOutcome, LawsOutcome};
use windfall_draw::axis::{Axis, axis};
use windfall_draw::files::{Painting, Picture};
use windfall_draw::frame::{Frame, Rectangle};
use windfall_draw::svg::{Anchor, Drawing, Ink};
use windfall_draw::text_width::cut_to;
use windfall_draw::width::Width;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;

/// Size of the panels and the room around them; px.
const WIDTH: f64 = 244.0;
const LEFT: f64 = 134.0;
const BETWEEN: f64 = 26.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 62.0;
const BELOW: f64 = 52.0;

/// Room for a second line of a title; px.
const LINE: f64 = 14.0;

/// Height of a law; px.
const ROW: f64 = 34.0;

/// Impacts are spread over this part of the height of their law; 1.
const SPREAD: f64 = 0.62;

/// Above the best by this much, a law has next to no support (Burnham and Anderson
/// 2002, section 2.6).
const NO_SUPPORT: f64 = 10.0;

/// The comparison: ΔAICc of each law over the campaign with its interval, ΔAICc on each
/// impact, and its prediction error.
///
/// # Errors
/// None in practice: the data are written to memory.
pub fn laws_painting(outcome: &LawsOutcome, paper: Option<Width>) -> Result<Painting, Error> {
    Ok(Painting {
        name: "laws".to_owned(),
        caption: "AICc of each law above that of the best one, over all impacts with 95 % \
                  intervals (impacts taken as independent) and on each impact; \
                  prediction error of the force at held-out velocities, ± one standard error. Beyond the broken line a law has next to no support."
            .to_owned(),
        picture: Picture::Drawn(drawing_of(outcome, paper)),
        csv: csv_of(outcome)?,
    })
}

fn csv_of(outcome: &LawsOutcome) -> Result<String, Error> {
    let header = ["panel", "law", "impact", "value", "low", "high"];
    let text = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
    let mut rows = Vec::new();
    for law in &outcome.laws {
        let name = || law.law.clone();
        let row = |panel: &str, impact: &str, values: [Option<f64>; 3]| {
            let mut row = vec![panel.to_owned(), name(), impact.to_owned()];
            row.extend(values.map(text));
            row
        };
        let ends = [Some(law.aicc), law.aicc_low, law.aicc_high];
        rows.push(row("campaign", "", ends));
        for impact in &law.impacts {
            rows.push(row("impact", &impact.id, [Some(impact.aicc), None, None]));
        }
        if let Some(value) = law.prediction {
            let end = |sign: f64| law.prediction_sd.map(|sd| value + sign * sd);
            rows.push(row(
                "unseen velocity",
                "",
                [Some(value), end(-1.0), end(1.0)],
            ));
        }
    }
    csv_text(&header.map(str::to_owned), rows)
}

/// Differences of all sizes on one axis: logarithms of 1 + |d|, with its sign.
fn squeezed(difference: f64) -> f64 {
    difference.signum() * (1.0 + difference.abs()).log10()
}

/// The axis of [`squeezed`] differences: 0, 1, 10, 100 …
fn squeezed_axis(values: impl Iterator<Item = f64>) -> Axis {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((0.0, NO_SUPPORT), |(low, high): (f64, f64), value| {
        (low.min(value), high.max(value))
    });
    let (low, high) = (squeezed(low) - 0.18, squeezed(high) + 0.18);
    let label = |power: i32| match power {
        0..=3 => format!("{}", 10_i64.pow(power.unsigned_abs())),
        power => {
            const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
            let digits = power.to_string();
            let digits = digits.chars().filter_map(|c| c.to_digit(10));
            let raised: String = digits.map(|d| RAISED[d as usize]).collect();
            format!("10{raised}")
        }
    };
    let mut found = vec![(0.0, "0".to_owned())];
    for power in 0..=18 {
        let at = squeezed(10_f64.powi(power));
        found.extend((at <= high).then(|| (at, label(power))));
        found.extend((-at >= low).then(|| (-at, format!("\u{2212}{}", label(power)))));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (ticks, labels) = found.into_iter().unzip();
    Axis {
        low,
        high,
        ticks,
        labels,
        power: 0,
    }
}

/// Where the panels stand: side by side, or below each other where they do not fit.
struct Places {
    across: f64,
    width: f64,
    height: f64,
    aside: bool,
}

impl Places {
    fn of(laws: usize, panels: f64, paper: Option<Width>) -> Self {
        let aside = paper.is_none_or(|own| own.columns(2) == 2);
        let sides = LEFT + RIGHT + if aside { BETWEEN * (panels - 1.0) } else { 0.0 };
        let beside = if aside { panels } else { 1.0 };
        let width = paper.map_or(WIDTH, |own| (own.px() - sides) / beside);
        Self {
            across: sides + beside * width,
            width,
            height: ROW * laws.max(1) as f64,
            aside,
        }
    }

    /// The panel of this number.
    fn within(&self, place: f64) -> Rectangle {
        let (across, down) = match self.aside {
            true => (place * (self.width + BETWEEN), 0.0),
            false => (0.0, place * (self.height + BELOW + LINE)),
        };
        Rectangle {
            left: LEFT + across,
            top: TOP + down,
            width: self.width,
            height: self.height,
        }
    }
}

fn drawing_of(outcome: &LawsOutcome, paper: Option<Width>) -> Drawing {
    let laws = &outcome.laws;
    let predicted = laws.iter().any(|law| law.prediction.is_some());
    let panels = if predicted { 3.0 } else { 2.0 };
    let places = Places::of(laws.len(), panels, paper);
    let within = |place: f64| places.within(place);
    let mut drawing = Drawing::at_width(
        paper,
        places.across,
        within(panels - 1.0).bottom() + BELOW + paper.map_or(0.0, |_| LINE),
    );
    let title = format!("{} laws on {} impacts", laws.len(), outcome.impacts);
    drawing.title(24.0, 26.0, &title);
    drawing.dashed(&[(24.0, 43.0), (42.0, 43.0)], Ink::Text, 1.0);
    let legend = "ΔAICc of 10: a law beyond it has next to no support";
    drawing.text((48.0, 46.8), Anchor::Start, 11.0, legend);
    let named = if places.aside { 1 } else { panels as usize };
    for (place, (row, law)) in
        (0..named).flat_map(|place| laws.iter().enumerate().map(move |own| (place, own)))
    {
        let y = within(place as f64).top + (row as f64 + 0.5) * ROW;
        let name = cut_to(&law.law, drawing.letters(11.0), LEFT - 12.0);
        drawing.text((LEFT - 8.0, y + 3.8), Anchor::End, 11.0, &name);
    }

    let ends = |law: &LawEvidenceOutcome| [Some(law.aicc), law.aicc_low, law.aicc_high];
    let across = squeezed_axis(laws.iter().flat_map(ends).flatten());
    let frame = panel(
        &mut drawing,
        within(0.0),
        across,
        "ΔAICc over all impacts",
        laws.len(),
    );
    support(&mut drawing, &frame);
    for (row, law) in laws.iter().enumerate() {
        let at = |value: f64| frame.place((squeezed(value), row as f64 + 0.5));
        if let (Some(low), Some(high)) = (law.aicc_low, law.aicc_high) {
            drawing.polyline(&[at(low), at(high)], Ink::Series(row), 2.0);
        }
        drawing.spot(at(law.aicc), 4.5, Ink::Series(row));
    }

    let values = laws.iter().flat_map(|law| &law.impacts).map(|i| i.aicc);
    let across = squeezed_axis(values);
    let frame = panel(
        &mut drawing,
        within(1.0),
        across,
        "ΔAICc on each impact",
        laws.len(),
    );
    support(&mut drawing, &frame);
    for (row, law) in laws.iter().enumerate() {
        let count = law.impacts.len().max(1) as f64;
        for (index, impact) in law.impacts.iter().enumerate() {
            let part = (index as f64 + 0.5) / count - 0.5;
            let at = (squeezed(impact.aicc), row as f64 + 0.5 + SPREAD * part);
            drawing.dot(frame.place(at), 1.8, Ink::Series(row));
        }
    }

    if predicted {
        let reach = |law: &LawEvidenceOutcome| {
            Some(100.0 * (law.prediction? + law.prediction_sd.unwrap_or(0.0)))
        };
        let high = laws.iter().filter_map(reach).fold(0.0, f64::max);
        let across = axis(0.0, 1.06 * high, 5);
        let title = "error at unseen velocities (% of peak)";
        let frame = panel(&mut drawing, within(2.0), across, title, laws.len());
        for (row, law) in laws.iter().enumerate() {
            let Some(value) = law.prediction else {
                continue;
            };
            let at = |value: f64| frame.place((100.0 * value, row as f64 + 0.5));
            if let Some(sd) = law.prediction_sd {
                let ends = [at((value - sd).max(0.0)), at(value + sd)];
                drawing.polyline(&ends, Ink::Series(row), 2.0);
            }
            drawing.spot(at(value), 4.5, Ink::Series(row));
        }
    }
    drawing
}

/// A panel of laws, the best on top.
fn panel(drawing: &mut Drawing, within: Rectangle, across: Axis, x: &str, laws: usize) -> Frame {
    let frame = Frame {
        within,
        across,
        // Downwards, as the names stand.
        up: Axis {
            low: laws.max(1) as f64,
            high: 0.0,
            ticks: Vec::new(),
            labels: Vec::new(),
            power: 0,
        },
    };
    frame.draw_grid(drawing);
    for row in 1..laws {
        let (_, y) = frame.place((0.0, row as f64));
        drawing.rule((within.left, y), (within.right(), y), Ink::Grid);
    }
    frame.draw_axes(drawing, (x, ""), ("", ""), 0.0);
    frame
}

fn support(drawing: &mut Drawing, frame: &Frame) {
    let (x, _) = frame.place((squeezed(NO_SUPPORT), 0.0));
    let ends = [(x, frame.within.top), (x, frame.within.bottom())];
    drawing.dashed(&ends, Ink::Text, 1.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0 → 0, 9 → 1, −99 → −2; ticks stand at 0, ±1, ±10, 100.
    #[test]
    fn closed_form_squeezed_differences() {
        assert_eq!([0.0, 9.0, -99.0].map(squeezed), [0.0, 1.0, -2.0]);
        let found = squeezed_axis([-12.0, 150.0].into_iter());
        assert_eq!(found.labels, ["−10", "−1", "0", "1", "10", "100"]);
        assert!((found.ticks[5] - 101.0_f64.log10()).abs() < 1e-12);
        assert_eq!(
            squeezed_axis([1e5].into_iter()).labels.last().unwrap(),
            "10⁵"
        );
    }
}
