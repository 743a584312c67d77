//! A design for people: its factors, runs and what it can tell.

use crate::design::document::{alias_chains, generated};
use crate::design::file::setting_text;
use crate::design::run::DesignOutcome;
use windfall_design::factorial::roman;
use windfall_design::kind::{Design, Factor};
use windfall_design::quality::DesignQuality;
use windfall_design::word::{Fraction, letter};
use windfall_files::text::columns::strings;
use windfall_files::text::number::plain;
use windfall_files::text::table::{page_tables, paragraph, table_text};

/// Most runs of a table on a terminal.
const MOST_ROWS: usize = 200;

/// Most words and chains that are shown.
const MOST_WORDS: usize = 40;

/// A design for people.
pub fn text_of_design(outcome: &DesignOutcome) -> String {
    let design = &outcome.design;
    let blocks = match design.blocks() {
        0 | 1 => String::new(),
        blocks => format!(" in {blocks} blocks"),
    };
    let order = match design.order_seed {
        Some(seed) => format!("random order of seed {seed}"),
        None => "standard order".to_owned(),
    };
    let mut text = format!(
        "{}: {} runs{blocks}, {order}\n\n",
        design.kind,
        design.runs.len()
    );
    text += &(factor_table(&design.factors) + "\n\n");
    text += &(run_table(design) + "\n");
    if design.runs.len() > MOST_ROWS {
        let left = design.runs.len() - MOST_ROWS;
        text += &format!("… and {left} more; --out FILE.csv writes all\n");
    }
    if design.whole_plots().is_some() {
        let reset = "Reset the hard-to-change factors at the start of every whole plot, even where \
                     their settings stay the same: plots that share one setting share its error. \
                     σ is the standard deviation of a run within its whole plot.";
        text += &format!("\n{}\n", paragraph(reset, 0));
    }
    text += &format!("\n{}", properties(outcome));
    if let Some(fraction) = generated(design) {
        text += &format!("\n{}", fraction_text(fraction));
    }
    for finding in &design.findings {
        text += &format!("\n{}", paragraph(&format!("! {finding}"), 2));
    }
    text.trim_end().to_owned() + "\n"
}

fn factor_table(factors: &[Factor]) -> String {
    let header = strings(&[
        "",
        "factor",
        "unit or categories",
        "centre",
        "half-range",
        "at −1",
        "at 1",
    ]);
    let rows = factors.iter().enumerate().map(|(place, factor)| {
        let name = factor.name.clone();
        if !factor.categories.is_empty() {
            let mut row = vec![
                letter(place).to_string(),
                name,
                factor.categories.join(" | "),
            ];
            row.resize(7, String::new());
            return row;
        }
        vec![
            letter(place).to_string(),
            name,
            factor.unit.clone(),
            plain(factor.centre),
            plain(factor.half),
            plain(factor.actual(-1.0)),
            plain(factor.actual(1.0)),
        ]
    });
    table_text(&header, rows, &[0, 1, 2])
}

fn run_table(design: &Design) -> String {
    let blocks = design.blocks() > 1;
    let mut header = strings(&["run", "std"]);
    header.extend(blocks.then(|| "block".to_owned()));
    header.extend(design.whole_plots().map(|_| "whole plot".to_owned()));
    header.push("point".to_owned());
    header.extend(design.factors.iter().map(|factor| factor.name.clone()));
    let numbers = || {
        design
            .factors
            .iter()
            .enumerate()
            .filter(|(_, f)| f.categories.is_empty())
    };
    header.extend(numbers().map(|(place, _)| letter(place).to_string()));
    let rows: Vec<Vec<String>> = design
        .runs
        .iter()
        .take(MOST_ROWS)
        .enumerate()
        .map(|(index, run)| {
            let mut row = vec![(index + 1).to_string(), run.standard_order.to_string()];
            row.extend(blocks.then(|| run.block.to_string()));
            row.extend(run.whole_plot.map(|plot| plot.to_string()));
            row.push(run.point.name().to_owned());
            let settings = design.factors.iter().zip(&run.coded);
            row.extend(settings.map(|(factor, coded)| shown(factor, *coded)));
            row.extend(numbers().map(|(place, _)| coded_text(run.coded[place])));
            row
        })
        .collect();
    let point = 2 + usize::from(blocks) + usize::from(design.whole_plots().is_some());
    page_tables(&header, &rows, &[point])
}

/// A setting with few digits, unless its decimals are asked for.
fn shown(factor: &Factor, coded: f64) -> String {
    match factor.categories.is_empty() && factor.decimals.is_none() {
        true => plain(factor.actual(coded)),
        false => setting_text(factor, coded),
    }
}

/// "-1", "0", "1.682".
fn coded_text(coded: f64) -> String {
    match coded.fract() == 0.0 {
        true => format!("{coded}"),
        false => format!("{coded:.3}"),
    }
}

fn properties(outcome: &DesignOutcome) -> String {
    let mut text = String::new();
    if let Some(alpha) = outcome.design.alpha {
        text += &format!("alpha               {alpha:.10}\n");
    }
    match &outcome.quality {
        None => text + "model               none can be estimated, or it is too large to judge\n",
        Some(quality) => text + &quality_text(quality, outcome),
    }
}

fn quality_text(quality: &DesignQuality, outcome: &DesignOutcome) -> String {
    let left = quality.runs - quality.terms;
    let errors = quality.variances.iter().map(|variance| variance.sqrt());
    let mut pairs: Vec<(String, f64)> = outcome.terms.iter().cloned().zip(errors).collect();
    pairs.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut text = format!(
        "model               {}, {} terms, {left} degrees of freedom left\n",
        outcome.model, quality.terms
    );
    text += &format!("D-efficiency        {}\n", plain(quality.d_efficiency));
    text += &format!(
        "leverage            mean {}, largest {}\n",
        plain(quality.terms as f64 / quality.runs as f64),
        plain(quality.max_leverage)
    );
    text += &format!(
        "variance/σ²         of prediction over −1 … 1: mean {}, largest {}\n",
        plain(quality.mean_variance),
        plain(quality.max_variance)
    );
    if let (Some(first), Some(last)) = (pairs.first(), pairs.last()) {
        text += &match plain(first.1) == plain(last.1) {
            true => format!(
                "standard errors/σ   of coded coefficients: all {}\n",
                plain(first.1)
            ),
            false => format!(
                "standard errors/σ   of coded coefficients: from {} ({}) to {} ({})\n",
                plain(first.1),
                first.0,
                plain(last.1),
                last.0
            ),
        };
    }
    text
}

fn fraction_text(fraction: &Fraction) -> String {
    let generators: Vec<String> = fraction.generators.iter().map(|g| g.to_string()).collect();
    let resolution = fraction.resolution().map_or_else(String::new, roman);
    let mut words: Vec<String> = fraction
        .defining
        .iter()
        .map(|word| word.to_string())
        .collect();
    let more = words.len().saturating_sub(MOST_WORDS);
    words.truncate(MOST_WORDS);
    let mut relation = format!("defining relation   I = {}", words.join(" = "));
    if more > 0 {
        relation += &format!(" = … ({more} more)");
    }
    let mut text = format!(
        "resolution          {resolution}\ngenerators          {}\n{}\n",
        generators.join(", "),
        paragraph(&relation, 20)
    );
    let chains = alias_chains(fraction);
    if chains.is_empty() {
        return text + "aliases             none among main effects and two-factor interactions\n";
    }
    for (index, chain) in chains.iter().take(MOST_WORDS).enumerate() {
        let label = if index == 0 { "aliases" } else { "" };
        text += &(paragraph(&format!("{label:<20}{chain}"), 22) + "\n");
    }
    let more = chains.len().saturating_sub(MOST_WORDS);
    if more > 0 {
        text += &format!("{:20}… and {more} more (--format json has all)\n", "");
    }
    text
}
