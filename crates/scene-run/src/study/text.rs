//! A study for people: words, tables, a page.

use crate::run::tables::{cells_of_places, text_of_files};
use crate::study::figure::figure_of_study;
use crate::study::outcome::{EffectOutcome, StudyOutcome, VariantOutcome};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::path::{Path, PathBuf};
use windfall_draw::files::{FigureFolder, write_figures};
use windfall_draw::page::{CaptionedTable, Report, Section, html_of_report};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::columns::{Column, cells_of_rows};
use windfall_files::text::statistic::number;
use windfall_files::text::table::{Cells, finding_lines, page_tables};
use windfall_files::write_file::write_whole;

/// What the intervals have in them.
const INTERVALS: &str = "Intervals (95 %) are of the share that another batch of as many fruit \
    would have. Each variant ran with other seeds (other fruit, places and paths) and, where a \
    law card states its uncertainty, with the law drawn anew; the coefficients of the bruise \
    model are drawn from theirs. All variants have the same seeds, laws and coefficients in \
    turn, so that differences between them are known better than the shares.";

fn percent(share: f64, [low, high]: [f64; 2]) -> String {
    format!(
        "{} ({} … {})",
        number(100.0 * share),
        number(100.0 * low),
        number(100.0 * high)
    )
}

fn variants(outcome: &StudyOutcome) -> Cells {
    let known = outcome.variants.iter().find(|own| !own.limits.is_empty());
    let limits = known.map_or(&[][..], |own| &own.limits);
    let mut header = vec!["variant".to_owned()];
    let above = limits.iter().map(|own| own.limit);
    header.extend(above.map(|limit| format!("bruised above {} mm³ (%)", number(1e9 * limit))));
    header.extend(["mean largest bruise (mm³)", "contacts", "worst place"].map(str::to_owned));
    let row = |own: &VariantOutcome| {
        let mut row = vec![own.name.clone()];
        if let Some(problem) = &own.failed {
            row.extend((0..limits.len()).map(|_| "failed".to_owned()));
            row.extend([String::new(), String::new(), problem.clone()]);
            return row;
        }
        row.extend(
            own.limits
                .iter()
                .map(|own| percent(own.share, own.interval)),
        );
        row.push(number(1e9 * own.mean_largest));
        row.push(format!("{:.0}", own.contacts));
        row.push(
            own.places
                .first()
                .map_or(String::new(), |own| own.name.clone()),
        );
        row
    };
    Cells {
        header,
        rows: outcome.variants.iter().map(row).collect(),
    }
}

fn effects(outcome: &StudyOutcome) -> Cells {
    let columns: [Column<EffectOutcome>; 6] = [
        ("varied", |own| own.factor.clone()),
        ("level", |own| own.level.clone()),
        ("against", |own| own.against.clone()),
        ("bruise above (mm³)", |own| number(1e9 * own.limit)),
        ("change of the bruised share (percentage points)", |own| {
            percent(own.difference, own.interval)
        }),
        ("pairs", |own| own.pairs.to_string()),
    ];
    cells_of_rows(&outcome.effects, &columns)
}

/// Results of a study, for a terminal.
pub fn text_of_study(outcome: &StudyOutcome) -> String {
    let table = |cells: &Cells, left: &[usize]| page_tables(&cells.header, &cells.rows, left);
    let mut text = format!(
        "{}\n\n{} variants, {} runs of each\n\n{}\n",
        outcome.title,
        outcome.variants.len(),
        outcome.replicates,
        table(&variants(outcome), &[0])
    );
    if !outcome.effects.is_empty() {
        text += &format!("\n{}\n", table(&effects(outcome), &[0, 1, 2]));
    }
    for line in finding_lines(&outcome.findings) {
        text += &format!("\n{line}\n");
    }
    text + &text_of_files(&outcome.files)
}

/// The variants as CSV.
pub fn csv_of_study(outcome: &StudyOutcome) -> Result<String, Error> {
    let mut header: Vec<String> = vec!["variant".to_owned()];
    header.extend(outcome.factors.iter().map(|own| own.name.clone()));
    let known = outcome.variants.iter().find(|own| !own.limits.is_empty());
    let limits = known.map_or(&[][..], |own| &own.limits);
    for own in limits {
        let limit = (1e9 * own.limit).round();
        header.extend(["", "_low", "_high"].map(|end| format!("share_above_{limit}_mm3{end}")));
    }
    header.extend(
        [
            "mean_largest_bruise_mm3",
            "fruit",
            "contacts",
            "waiting",
            "left",
            "failed",
        ]
        .map(str::to_owned),
    );
    // The last factor changes fastest, as in the study itself.
    let level = |variant: usize, factor: usize| {
        let after = outcome.factors[factor + 1..].iter();
        let each: usize = after.map(|own| own.levels.len()).product();
        let levels = &outcome.factors[factor].levels;
        levels[variant / each % levels.len()].clone()
    };
    let rows = outcome.variants.iter().enumerate().map(|(number, own)| {
        let mut row = vec![own.name.clone()];
        row.extend((0..outcome.factors.len()).map(|factor| level(number, factor)));
        match own.failed {
            Some(_) => row.extend((0..3 * limits.len()).map(|_| String::new())),
            None => {
                let numbers = own.limits.iter();
                let numbers = numbers.flat_map(|own| [own.share, own.interval[0], own.interval[1]]);
                row.extend(numbers.map(|own| own.to_string()));
            }
        }
        row.extend([
            (1e9 * own.mean_largest).to_string(),
            own.fruit.to_string(),
            own.contacts.to_string(),
            own.waiting.to_string(),
            own.left.to_string(),
            own.failed.clone().unwrap_or_default(),
        ]);
        row
    });
    let rows: Vec<Vec<String>> = rows.collect();
    csv_text(&header, rows)
}

/// Writes the page and its figure; the files.
///
/// A picture.svg or picture.png in the directory of the study, or of its first run, stands on
/// the page.
pub fn write_page(outcome: &StudyOutcome, out: &Path) -> Result<Vec<PathBuf>, Error> {
    let figures: Vec<_> = figure_of_study(outcome).into_iter().collect();
    let references: Vec<_> = figures.iter().collect();
    let folder = FigureFolder::of(&out.join("figures"));
    let mut files = write_figures(&folder, &references)?;
    let mut sections = vec![Section {
        tables: vec![CaptionedTable {
            caption: format!("Variants, {} runs of each", outcome.replicates),
            cells: variants(outcome),
        }],
        figures,
        ..Section::of_words("Bruised fruit", vec![INTERVALS.to_owned()])
    }];
    if !outcome.effects.is_empty() {
        let words = "Over all pairs of variants that differ in nothing else, from the first level.";
        sections.push(Section {
            tables: vec![CaptionedTable {
                caption: "What each level changes".to_owned(),
                cells: effects(outcome),
            }],
            ..Section::of_words("Sensitivity", vec![words.to_owned()])
        });
    }
    let table = |own: &VariantOutcome| CaptionedTable {
        caption: own.name.clone(),
        cells: cells_of_places(&own.places),
    };
    let bruised = outcome.variants.iter().filter(|own| !own.places.is_empty());
    sections.push(Section {
        tables: bruised.map(table).collect(),
        ..Section::of_words(
            "Worst places",
            vec!["Of all runs of a variant; the worst first.".to_owned()],
        )
    });
    sections.push(Section::of_words("Origin", origin(outcome)));
    let report = Report {
        title: outcome.title.clone(),
        made: format!("windfall {}, {}", outcome.made[0], outcome.made[1]),
        simulated: None,
        note: None,
        findings: outcome.findings.clone(),
        // A failed variant is a finding.
        failed: Vec::new(),
        sections,
    };
    let mut page = html_of_report(&report);
    if let Some(picture) = picture(outcome, out) {
        page = page.replacen("<main>", &format!("<main>{picture}"), 1);
    }
    let path = out.join("study.html");
    write_whole(&path, page.as_bytes())?;
    files.insert(0, path);
    Ok(files)
}

fn origin(outcome: &StudyOutcome) -> Vec<String> {
    let [study, scene] = &outcome.digests;
    vec![
        format!("SHA-256 of the study: {study}"),
        format!("SHA-256 of the scene: {scene}"),
        "Each run is kept in variants/: its scene.toml, contacts, fruit and histograms.".to_owned(),
    ]
}

/// A picture of the scene as an element of the page, if there is one.
fn picture(outcome: &StudyOutcome, out: &Path) -> Option<String> {
    let first = outcome.variants.iter().find(|own| own.failed.is_none());
    let run = first.map(|own| out.join(&own.directory).join("replicate_1"));
    for folder in [Some(out.to_path_buf()), run].into_iter().flatten() {
        for (name, kind) in [
            ("picture.svg", "image/svg+xml"),
            ("picture.png", "image/png"),
        ] {
            if let Ok(bytes) = std::fs::read(folder.join(name)) {
                return Some(format!(
                    "<figure><img alt=\"The scene\" style=\"max-width:100%\" \
                     src=\"data:{kind};base64,{}\"></figure>",
                    BASE64_STANDARD.encode(&bytes)
                ));
            }
        }
    }
    None
}
