//! Results of `fit` as text for a terminal.

use crate::impacts::findings::findings_text;
use crate::impacts::groups::{
    SOURCES, derived_tables, groups_of, heading_of, law_table, parameter_table, restitution_table,
};
use crate::result::counted::reasons_counted;
use crate::result::outcome::{CampaignOutcome, GroupOutcome, ImpactOutcome, JointOutcome};
use crate::result::quantity::{Quantity, quantities_named};
use itertools::Itertools;
use std::fmt::Write;
use windfall_files::text::number::{interval, plain, unit_text, value_and_sd};
use windfall_files::text::statistic::probability;
use windfall_files::text::table::{header_of, page_tables, paragraph, title_lines};

/// More impacts than this are shown as groups only.
const LISTED_IMPACTS: usize = 40;

/// Quantities in the table of impacts.
const OF_IMPACTS: [&str; 3] = ["impact_velocity", "restitution", "absorbed_energy"];

/// A campaign's results: impacts, groups, what was left out, findings.
pub fn text_of_campaign(outcome: &CampaignOutcome) -> String {
    let mut text = title_lines(
        &outcome.campaign,
        outcome.simulated.as_deref(),
        outcome.note.as_deref(),
    );
    let _ = writeln!(text, "{}", paragraph(&counted_line(outcome), 2));
    let _ = writeln!(text, "{}", mass_line(outcome));
    for line in bench_lines(outcome) {
        let _ = writeln!(text, "{}", paragraph(&line, 2));
    }
    let laws = laws_of(outcome);
    for law in &laws {
        text += &law_text(outcome, law);
    }
    if let Some(first) = laws.first() {
        for (source, words) in SOURCES {
            let tables = derived_tables(outcome, first, source);
            if tables.is_empty() {
                continue;
            }
            let (initial, rest) = words.split_at(1);
            let spread = if outcome.impacts.len() > 1 {
                ", mean ± SD in %"
            } else {
                ""
            };
            text += &format!("\n{}{rest}{spread}:\n{tables}", initial.to_uppercase());
        }
        text += "Duration and displacement count from the force threshold; the fitted law's: --format json.\n";
    }
    if laws.len() > 1 {
        text += "\nThe laws compared by residual over noise; 1 is a law that describes the signal to its noise:\n";
        let _ = writeln!(text, "{}", law_table(outcome, &laws));
    }
    text + &findings_text(outcome)
}

/// One law: its impacts, if they are few, and its groups.
fn law_text(outcome: &CampaignOutcome, law: &str) -> String {
    let of_law = |impact: &&ImpactOutcome| impact.law == law;
    let impacts: Vec<&ImpactOutcome> = outcome.impacts.iter().filter(of_law).collect();
    let mut text = format!("\n{law}, fitted to {}\n", impacts[0].quantities.join(", "));
    if impacts.len() <= LISTED_IMPACTS {
        text += "Each impact (± standard deviation of the estimate):\n";
        let _ = writeln!(text, "{}", impact_table(&impacts));
        text += &interval_table(&impacts);
    }
    if impacts.len() > 1 {
        text += "\nMean ± SD over the impacts (SD in % of the mean):\n";
        let groups = groups_of(outcome, law);
        let table = parameter_table(&groups, &impacts);
        let _ = writeln!(text, "{table}");
        if let Some(line) = common_line(outcome, &groups) {
            let _ = writeln!(text, "{}", paragraph(&line, 2));
        }
    }
    text += &joint_table(outcome, law, &impacts);
    text += &restitution_table(&impacts);
    if impacts.len() > LISTED_IMPACTS {
        let n = impacts.len();
        let _ = writeln!(text, "Each of the {n} impacts: --format csv or json.");
    }
    text
}

/// How many impacts count, of how many, and what becomes of the others; of each law where the
/// laws differ.
pub fn counted_line(outcome: &CampaignOutcome) -> String {
    let fitted = outcome.impacts.iter().map(|own| own.law.as_str());
    let failed = outcome.failed.iter().filter_map(|own| own.law.as_deref());
    let laws: Vec<&str> = fitted.chain(failed).unique().collect();
    let lines: Vec<String> = match laws.as_slice() {
        [] => vec![counted_under(outcome, None)],
        laws => laws
            .iter()
            .map(|law| counted_under(outcome, Some(law)))
            .collect(),
    };
    match lines.iter().all_equal() {
        true => lines[0].clone(),
        false => {
            let told = laws.iter().zip(&lines);
            told.map(|(law, line)| format!("{law}: {}", line.replacen("All", "all", 1)))
                .join(". ")
        }
    }
}

/// How many impacts count under a law.
pub fn counted_under(outcome: &CampaignOutcome, law: Option<&str>) -> String {
    let of_law = |own: &&ImpactOutcome| Some(own.law.as_str()) == law;
    let fitted: Vec<&ImpactOutcome> = outcome.impacts.iter().filter(of_law).collect();
    // What failed before a law was fitted failed under all of them.
    let failed = outcome.failed.iter();
    let failed = failed.filter(|own| own.law.is_none() || own.law.as_deref() == law);
    let failed = failed.count();
    let counted = fitted.iter().filter(|impact| impact.counts()).count();
    let all = fitted.len() + failed;
    if counted == all {
        return match all {
            1 => "1 impact, which counts".to_owned(),
            _ => format!("All {all} impacts count"),
        };
    }
    let mut rest = Vec::new();
    if counted < fitted.len() {
        rest.push(format!("left out: {}", reasons_counted(fitted)));
    }
    if failed > 0 {
        rest.push(format!("{failed} could not be fitted"));
    }
    format!("{counted} of {all} impacts count; {}", rest.join("; "))
}

/// The effective mass and where it comes from.
pub fn mass_line(outcome: &CampaignOutcome) -> String {
    let mass = &outcome.effective_mass;
    let value = value_and_sd(mass.value, Some(mass.sd));
    let known = format!("Effective mass {value} kg");
    match mass.impacts {
        0 => known,
        1 => format!("{known}, from impulse and change of velocity of one impact"),
        n => format!("{known}, from impulse and change of velocity of {n} impacts"),
    }
}

/// What of the bench was estimated, and what Newton's law says of force and displacement over
/// all impacts.
pub fn bench_lines(outcome: &CampaignOutcome) -> Vec<String> {
    let estimated = outcome.estimated.0.iter().map(|(name, own)| {
        let (factor, unit) = match own.unit.as_str() {
            "1" => (1.0, String::new()),
            "s" => (1e6, " µs".to_owned()),
            unit => (1.0, format!(" {}", unit_text(unit))),
        };
        let told = own
            .told
            .map(|told| format!(" (campaign.toml: {})", plain(factor * told)));
        format!(
            "Estimated from {} impacts: {name} = {}{unit}{}",
            own.impacts,
            value_and_sd(factor * own.value, Some(factor * own.sd)),
            told.unwrap_or_default()
        )
    });
    let shown = |name: &str, factor: f64| {
        let own = outcome.bench.get(name)?;
        Some(value_and_sd(own.value * factor, Some(own.sd * factor)))
    };
    let gain = shown("force_gain", 1.0).map(|gain| format!("is {gain} times mass × acceleration"));
    let delay = outcome.bench.get("force_delay").map(|own| {
        let delay = value_and_sd(1e6 * own.value.abs(), Some(1e6 * own.sd));
        let side = if own.value < 0.0 { "before" } else { "after" };
        format!("comes {delay} µs {side} the displacement")
    });
    let told = gain.into_iter().chain(delay).join(" and ");
    let pooled = outcome.bench.0.first().map(|(_, own)| {
        let impacts = own.impacts;
        format!("By Newton's law, over {impacts} impacts: the force {told}")
    });
    estimated.chain(pooled).collect()
}

/// What the uncertainties that all impacts share make of the means.
pub fn common_line(outcome: &CampaignOutcome, groups: &[&GroupOutcome]) -> Option<String> {
    let group = groups.first()?;
    let causes = outcome.impacts.iter().flat_map(|impact| &impact.common.0);
    let (priors, bench): (Vec<_>, Vec<_>) =
        causes.partition(|(name, _)| name.starts_with("prior."));
    let of = match (priors.is_empty(), bench.is_empty()) {
        (true, _) => "the bench",
        (false, true) => "the priors",
        (false, false) => "bench and priors",
    };
    let parts = group.parameters.0.iter().filter_map(|(name, spread)| {
        let part = spread.common_sd? / spread.mean.abs();
        Some(format!("{name} by {:.2} %", 100.0 * part))
    });
    let parts: Vec<String> = parts.collect();
    (!parts.is_empty()).then(|| {
        format!(
            "The uncertainty of {of} shifts all impacts together, {}; more impacts do not \
             reduce it",
            parts.join(", ")
        )
    })
}

/// One law for each specimen.
fn joint_table(outcome: &CampaignOutcome, law: &str, impacts: &[&ImpactOutcome]) -> String {
    let joint: Vec<&JointOutcome> = outcome.joint.iter().filter(|own| own.law == law).collect();
    let Some(first) = joint.first() else {
        return String::new();
    };
    let mut header = header_of(&["specimen", "impacts"]);
    let names = first.parameters.names();
    header.extend(names.map(|name| heading_of(impacts, name)));
    header.extend(header_of(&["χ²/df", "p"]));
    let rows = joint.iter().map(|own| {
        let estimates = own.parameters.0.iter();
        let counts = [own.specimen.clone(), own.impacts.len().to_string()];
        let values = estimates.map(|(_, own)| value_and_sd(own.value, own.sd));
        let reduced = own.chi_square / own.freedom as f64;
        let tests = [format!("{reduced:.2}"), probability(own.p)];
        counts.into_iter().chain(values).chain(tests).collect()
    });
    let table = page_tables(&header, &rows.collect::<Vec<_>>(), &[0]);
    format!("\nOne law for all impacts on a specimen (± standard deviation):\n{table}\n")
}

/// Laws in order of first appearance.
pub fn laws_of(outcome: &CampaignOutcome) -> Vec<&str> {
    let laws = outcome.impacts.iter().map(|impact| impact.law.as_str());
    laws.unique().collect()
}

fn impact_table(impacts: &[&ImpactOutcome]) -> String {
    let mut header = vec!["impact".to_owned()];
    let named = impacts.iter().any(|impact| impact.id != impact.specimen);
    if named {
        header.push("specimen".to_owned());
    }
    header.extend(parameter_headings(impacts));
    let columns = quantities_named(&OF_IMPACTS);
    header.extend(columns.iter().map(|column| column.narrow_title()));
    let shared = shared_codes(impacts);
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut remarks = false;
    for impact in impacts {
        let mut row = vec![impact.id.clone()];
        if named {
            row.push(impact.specimen.clone());
        }
        row.extend(impact.parameters.0.iter().map(|(_, e)| match e.held {
            false => value_and_sd(e.value, e.sd),
            true => format!("{} held", plain(e.value)),
        }));
        row.extend(columns.iter().map(|column| derived_cell(impact, column)));
        let codes = own_codes(impact, &shared);
        remarks |= !codes.is_empty();
        row.push(codes);
        rows.push(row);
    }
    let mut left = vec![0];
    left.extend(named.then_some(1));
    if remarks {
        left.push(header.len());
        header.push("findings".to_owned());
    }
    rows.iter_mut().for_each(|row| row.truncate(header.len()));
    page_tables(&header, &rows, &left)
}

/// A derived quantity with its deviation where that is known, in the unit for people.
pub fn derived_cell(impact: &ImpactOutcome, quantity: &Quantity) -> String {
    let sd = impact.derived_sd.get(quantity.name);
    let sd = sd.map(|sd| sd * quantity.factor);
    match impact.derived(quantity.name) {
        Some(value) if sd.is_some() => value_and_sd(value * quantity.factor, sd),
        Some(value) => plain(value * quantity.factor),
        None => "-".to_owned(),
    }
}

/// Intervals that are more than ± a multiple of the deviation.
fn interval_table(impacts: &[&ImpactOutcome]) -> String {
    let followed = impacts
        .iter()
        .find(|impact| !matches!(impact.intervals.method.as_str(), "" | "asymptotic"));
    let Some(first) = followed else {
        return String::new();
    };
    let title = match first.intervals.method.as_str() {
        "profile" => "95 % intervals by profile likelihood".to_owned(),
        "bootstrap" => format!(
            "95 % intervals by bootstrap of residual blocks, {} recordings of each impact",
            first.intervals.replicates.unwrap_or(0)
        ),
        _ => format!(
            "95 % intervals of the posterior, {} draws of {} chains",
            first.intervals.draws.unwrap_or(0),
            first.intervals.chains.unwrap_or(0)
        ),
    };
    let mut header = vec!["impact".to_owned()];
    header.extend(parameter_headings(impacts));
    let sampled = impacts
        .iter()
        .any(|impact| !impact.intervals.mixing.0.is_empty());
    if sampled {
        header.extend(["largest R-hat", "fewest draws", "divergences"].map(str::to_owned));
    }
    let rows: Vec<Vec<String>> = impacts
        .iter()
        .map(|impact| {
            let mut row = vec![impact.id.clone()];
            let parameters = impact.parameters.0.iter();
            row.extend(parameters.map(|(_, estimate)| match estimate.interval() {
                Some((low, high)) => interval(low, high),
                None => "held".to_owned(),
            }));
            if sampled {
                row.extend(mixing_cells(impact));
            }
            row
        })
        .collect();
    format!("\n{title}:\n{}\n", page_tables(&header, &rows, &[0]))
}

fn mixing_cells(impact: &ImpactOutcome) -> [String; 3] {
    let mixing = || impact.intervals.mixing.0.iter().map(|(_, m)| m);
    let r_hat = mixing().map(|m| m.r_hat.unwrap_or(f64::INFINITY));
    let draws = mixing().map(|m| m.bulk_draws.min(m.tail_draws));
    [
        format!("{:.3}", r_hat.fold(1.0, f64::max)),
        format!("{:.0}", draws.fold(f64::INFINITY, f64::min)),
        impact.intervals.divergences.unwrap_or(0).to_string(),
    ]
}

/// Codes of an impact's findings that not all share, each once; why it does not count.
pub fn own_codes(impact: &ImpactOutcome, shared: &[&str]) -> String {
    let codes = impact.findings.iter().map(|finding| finding.code.as_str());
    let reasons = || impact.left_out.iter().map(|reason| reason.code.as_str());
    let left_out = match impact.counts() {
        true => String::new(),
        false => format!("LEFT OUT: {}", reasons().unique().join(", ")),
    };
    let codes = codes.filter(|code| !shared.contains(code) && !reasons().contains(code));
    let codes = codes.unique().map(str::to_owned);
    let all = std::iter::once(left_out).chain(codes);
    all.filter(|text| !text.is_empty()).join(" ")
}

/// Codes of findings that every impact has: a column of them would say nothing.
pub fn shared_codes<'a>(impacts: &[&'a ImpactOutcome]) -> Vec<&'a str> {
    let Some((first, rest)) = impacts.split_first() else {
        return Vec::new();
    };
    let has = |impact: &ImpactOutcome, code: &str| impact.findings.iter().any(|f| f.code == code);
    let codes = first.findings.iter().map(|finding| finding.code.as_str());
    codes
        .filter(|code| rest.iter().all(|impact| has(impact, code)))
        .collect()
}

fn parameter_headings(impacts: &[&ImpactOutcome]) -> Vec<String> {
    let names = impacts
        .first()
        .into_iter()
        .flat_map(|i| i.parameters.names());
    names.map(|name| heading_of(impacts, name)).collect()
}
