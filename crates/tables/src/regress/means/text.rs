//! Marginal means, slopes and comparisons as text and CSV.

use crate::regress::means::outcome::{
    DifferenceOutcome, EqualityOutcome, MeanOutcome, MeansOutcome, OnScale,
};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::columns::{Column, text_of_rows};
use windfall_files::text::number::beside_sd;
use windfall_files::text::statistic::{freedom, number, probability};
use windfall_files::text::table::paragraph;

const fn columns_of(title: &'static str) -> [Column<MeanOutcome>; 6] {
    [
        ("", |own| own.levels.join(" ")),
        (title, |own| beside_sd(own.mean, own.se)),
        ("se", |own| number(own.se)),
        ("df", |own| freedom(own.df)),
        ("from", |own| beside_sd(own.low, own.se)),
        ("to", |own| beside_sd(own.high, own.se)),
    ]
}

const DIFFERENCES: [Column<DifferenceOutcome>; 8] = [
    ("", |own| compared(own)),
    ("difference", |own| beside_sd(own.difference, own.se)),
    ("se", |own| number(own.se)),
    ("df", |own| freedom(own.df)),
    ("t", |own| number(own.t)),
    ("p", |own| probability(own.p)),
    ("from", |own| beside_sd(own.low, own.se)),
    ("to", |own| beside_sd(own.high, own.se)),
];

const TESTS: [Column<EqualityOutcome>; 5] = [
    ("within", |own| own.within.join(" ")),
    ("F", |own| number(own.f)),
    ("df", |own| own.df.to_string()),
    ("df of noise", |own| freedom(own.df_denominator)),
    ("p", |own| probability(own.p)),
];

/// Columns of a value on the original scale, behind what it belongs to.
type Scaled = (String, OnScale);

const SCALED: [Column<Scaled>; 4] = [
    ("", |own| own.0.clone()),
    ("value", |own| number(own.1.value)),
    ("from", |own| number(own.1.low)),
    ("to", |own| number(own.1.high)),
];

fn compared(own: &DifferenceOutcome) -> String {
    match own.within.is_empty() {
        true => own.contrast.clone(),
        false => format!("{}: {}", own.within.join(" "), own.contrast),
    }
}

/// Means and comparisons as CSV, a row each.
pub(crate) fn csv_of_means(outcomes: &[MeansOutcome]) -> Result<String, Error> {
    let header = [
        "of",
        "what",
        "estimate",
        "se",
        "df",
        "t",
        "p",
        "low",
        "high",
        "original",
        "original_low",
        "original_high",
    ];
    let header = header.map(str::to_owned);
    let row = |of: &MeansOutcome, what: &str, numbers: [f64; 7], scaled: Option<OnScale>| {
        let names = [title(of), what.to_owned()];
        let cell = |own: f64| match own.is_nan() {
            true => String::new(),
            false => own.to_string(),
        };
        let scaled = scaled.map_or([f64::NAN; 3], |own| [own.value, own.low, own.high]);
        names
            .into_iter()
            .chain(numbers.map(cell))
            .chain(scaled.map(cell))
            .collect::<Vec<_>>()
    };
    let none = f64::NAN;
    let rows = outcomes.iter().flat_map(|of| {
        let means = of.means.iter().map(move |own| {
            let numbers = [own.mean, own.se, own.df, none, none, own.low, own.high];
            row(of, &own.levels.join(" "), numbers, own.original)
        });
        let differences = of.differences.iter().map(move |own| {
            let numbers = [
                own.difference,
                own.se,
                own.df,
                own.t,
                own.p,
                own.low,
                own.high,
            ];
            row(of, &compared(own), numbers, own.ratio)
        });
        means.chain(differences)
    });
    csv_text(&header, rows)
}

/// What was asked for: "slope on V, of dose within variety".
fn title(own: &MeansOutcome) -> String {
    let slope = own.slope_on.iter().map(|name| format!("slope on {name}"));
    let of = (!own.of.is_empty()).then(|| own.of.join(","));
    let mut text = slope.chain(of).collect::<Vec<_>>().join(" of ");
    if !own.within.is_empty() {
        text += &format!(" within {}", own.within.join(","));
    }
    text
}

/// Means and comparisons as text.
pub(crate) fn means_text(outcomes: &[MeansOutcome]) -> String {
    outcomes.iter().map(text_of).collect()
}

fn text_of(own: &MeansOutcome) -> String {
    let at = own.at.iter();
    let at: Vec<String> = at
        .map(|(name, value)| format!("{name} {}", number(*value)))
        .collect();
    let at = match at.is_empty() {
        true => String::new(),
        false => format!(" at {}", at.join(", ")),
    };
    let what = match own.slope_on {
        Some(_) => format!("Marginal {}", title(own)),
        None => format!("Marginal means of {}", title(own)),
    };
    let mut text = format!("\n{what}{at}:\n");
    let estimate = own.slope_on.as_ref().map_or("mean", |_| "slope");
    text += &text_of_rows(&own.means, &columns_of(estimate), &[0]);
    let scaled = own.means.iter();
    let scaled = scaled.filter_map(|mean| Some((mean.levels.join(" "), mean.original?)));
    let scaled: Vec<Scaled> = scaled.collect();
    if let (Some(column), Some(meaning)) = (&own.original, &own.meaning) {
        text += &format!("\n\nThe same as {column}:\n");
        text += &text_of_rows(&scaled, &SCALED, &[0]);
        text += &format!("\n{}", paragraph(meaning, 0));
    }
    if !own.tests.is_empty() {
        text += "\n\nTest that they are equal:\n";
        let columns = if own.within.is_empty() {
            &TESTS[1..]
        } else {
            &TESTS[..]
        };
        text += &text_of_rows(&own.tests, columns, &[0]);
    }
    if !own.differences.is_empty() {
        let what = match own.compared {
            "polynomial" => "Trends over the levels, taken as equally spaced",
            _ => "Differences",
        };
        text += &format!("\n\n{what} ({}):\n", own.adjusted);
        text += &text_of_rows(&own.differences, &DIFFERENCES, &[0]);
        let ratios = own.differences.iter();
        let ratios = ratios.filter_map(|own| Some((compared(own), own.ratio?)));
        let ratios: Vec<Scaled> = ratios.collect();
        if let (false, Some(column)) = (ratios.is_empty(), &own.original) {
            text += &format!("\n\nThe same as ratios of {column}:\n");
            text += &text_of_rows(&ratios, &SCALED, &[0]);
        }
    }
    text + "\n"
}
