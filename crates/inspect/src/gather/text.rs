//! A campaign that was made of recordings, for a terminal.

use crate::gather::add::Added;
use crate::gather::new::Gathered;
use crate::gather::watch::Watched;
use std::fmt::Write;
use std::path::Path;
use windfall_campaign::impacts::text::{counted_under, derived_cell, own_codes};
use windfall_campaign::result::quantity::quantity_named;
use windfall_distribution::tail::t_upper_quantile;
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::number::{plain, value_and_sd};
use windfall_files::text::quote::{command, path_word};

/// More files than this are counted, not named.
const NAMED: usize = 5;

/// What was made, what was assumed, and what a person has to write.
pub fn text_of_gathered(gathered: &Gathered, directory: &Path) -> String {
    let shown = directory.display();
    let impacts = match gathered.impacts == gathered.recordings {
        true => String::new(),
        false => format!(" with {} impacts", gathered.impacts),
    };
    let mut text = format!(
        "{} recordings{impacts} of {} specimens, copied into {shown}/raw; both tables are filled.\n",
        gathered.recordings, gathered.specimens
    );
    text += &listed("Assumed", &gathered.assumed);
    text += &listed("Left out", &gathered.left_out);
    text + &next(&gathered.missing, directory)
}

/// What is left to do.
fn next(missing: &[String], directory: &Path) -> String {
    if missing.is_empty() {
        return format!("\nNext: {}\n", fit(directory));
    }
    let shown = directory.display();
    let mut text =
        format!("\nWrite into {shown}/campaign.toml, in the lines that say WRITE YOURS:\n");
    for line in missing {
        let _ = writeln!(text, "  {line}");
    }
    let _ = writeln!(text, "then\n  {}", fit(directory));
    text
}

/// Lines below a title; nothing without lines.
fn listed(title: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{title}:\n");
    for line in lines.iter().take(NAMED) {
        let _ = writeln!(text, "  {line}");
    }
    if lines.len() > NAMED {
        let _ = writeln!(text, "  and {} more", lines.len() - NAMED);
    }
    text
}

fn fit(directory: &Path) -> String {
    command(&["fit", &path_word(directory)])
}

/// The files written, one in a line.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_gathered(gathered: &Gathered) -> Result<String, Error> {
    let rows = gathered
        .written
        .iter()
        .map(|path| vec![path.display().to_string()]);
    csv_text(&["written".to_owned()], rows)
}

/// What a fit of a watched campaign found: the new impacts, and the mean so far with its 95 %
/// interval.
pub fn text_of_watched(watched: &Watched) -> String {
    let outcome = watched.outcome;
    let mut text = String::new();
    for impact in outcome
        .impacts
        .iter()
        .filter(|own| watched.new.contains(&own.id))
    {
        let parameters = impact.parameters.0.iter().filter(|(_, own)| !own.held);
        let parameters = parameters
            .map(|(name, own)| format!("{name} {} {}", value_and_sd(own.value, own.sd), own.unit));
        let restitution = quantity_named("restitution");
        let restitution = restitution.map(|own| format!("e {}", derived_cell(impact, own)));
        let all: Vec<String> = parameters.chain(restitution).collect();
        let codes = own_codes(impact, &USUAL);
        let _ = writeln!(text, "{}: {}  {codes}", impact.id, all.join(", "));
    }
    for failure in outcome
        .failed
        .iter()
        .filter(|own| watched.new.contains(&own.id))
    {
        let _ = writeln!(text, "{}: NOT FITTED: {}", failure.id, failure.message);
    }
    for name in watched.left_out {
        let _ = writeln!(text, "NOT LISTED: {name}");
    }
    let first = outcome.impacts.first();
    let counted = counted_under(outcome, first.map(|own| own.law.as_str()));
    let _ = write!(text, "  {counted}");
    let parameters = first.map_or(&[][..], |own| &own.parameters.0);
    for (name, _) in parameters {
        let Some(spread) = outcome.summary.get(name) else {
            continue;
        };
        let _ = write!(text, "; mean {name} {}", plain(spread.mean));
        if let Some(sd) = spread.sd {
            let half =
                t_upper_quantile(0.025, (spread.n - 1) as f64) * sd / (spread.n as f64).sqrt();
            let (low, high) = (plain(spread.mean - half), plain(spread.mean + half));
            let _ = write!(text, " ({low} to {high})");
        }
    }
    text + "\n"
}

/// Findings that say nothing odd.
const USUAL: [&str; 4] = [
    "freed",
    "counted-displacement",
    "computed-rate",
    "uncertain-mass",
];

/// What was added to a campaign.
pub fn text_of_added(added: &Added, directory: &Path) -> String {
    let mut text = format!(
        "{} impacts added, of which {} specimens are new.\n",
        added.impacts.len(),
        added.specimens.len()
    );
    if added.known > 0 {
        let _ = writeln!(text, "{} recordings are listed already.", added.known);
    }
    text += &listed("Assumed", &added.assumed);
    text += &listed("Left out", &added.left_out);
    text + &next(&added.missing, directory)
}
