//! Restitution from intervals as text and CSV.

use crate::intervals::outcome::{
    BouncesOutcome, MeanOutcome, TimedDropOutcome, TimedImpactOutcome,
};
use windfall_files::error::Error;
use windfall_files::table::write::{csv_text, number_cell};
use windfall_files::text::columns::strings;
use windfall_files::text::number::{plain, value_and_sd};
use windfall_files::text::statistic::{freedom, probability};
use windfall_files::text::table::{findings_list, page_tables, paragraph};

/// So many impacts at most are shown one by one.
const MOST_IMPACTS: usize = 12;

/// Drops, their mean and the line over speed.
pub fn text_of_bounces(outcome: &BouncesOutcome) -> String {
    let mut text = model_text(outcome);
    let impacts: usize = outcome.drops.iter().map(|own| own.impacts.len()).sum();
    text += &drops_table(outcome);
    if impacts <= MOST_IMPACTS {
        text += &impacts_table(outcome);
    }
    if let Some(mean) = &outcome.mean {
        text += &mean_text(mean);
    }
    if let Some(line) = &outcome.by_speed {
        let level = 100.0 * outcome.mean.as_ref().map_or(0.95, |mean| mean.confidence);
        let told = format!(
            "over speed   {} at {} m/s, changing by {} ± {} per m/s ({} % interval {} to {}, p {}, {} \
             degrees of freedom; {} to {} m/s; {})",
            plain(line.restitution),
            plain(line.speed),
            plain(line.slope),
            plain(line.slope_se),
            plain_percent(level),
            plain(line.slope_low),
            plain(line.slope_high),
            probability(line.p),
            freedom(line.df),
            plain(line.speed_low),
            plain(line.speed_high),
            line.method
        );
        text += &(paragraph(&told, 13) + "\n");
    }
    if impacts > MOST_IMPACTS {
        text += "\nEach impact with its speed: --format csv, for `windfall regress` and `windfall compare`.\n";
    }
    text + &findings_list(&outcome.findings)
}

/// What was assumed.
fn model_text(outcome: &BouncesOutcome) -> String {
    let step = match outcome.resolution_from_digits {
        true => "from the last digit written",
        false => "given",
    };
    let trigger = match outcome.trigger_sd > 0.0 {
        true => format!(
            ", an impact noticed to ± {} ms",
            plain(1e3 * outcome.trigger_sd)
        ),
        false => String::new(),
    };
    let contact = match outcome.contact > 0.0 {
        true => format!("less {} ms of contact", plain(1e3 * outcome.contact)),
        false => "taken as flights; contacts are not taken off".to_owned(),
    };
    let told = format!(
        "Restitution is the ratio of successive flights, the speed half of gravity ({} m/s²) times the \
         flight before; no drag of the air. Intervals {contact}. Step of the stopwatch {} ms \
         ({step}){trigger}.",
        plain(outcome.gravity),
        plain(1e3 * outcome.resolution)
    );
    paragraph(&told, 0) + "\n\n"
}

fn drops_table(outcome: &BouncesOutcome) -> String {
    let header = strings(&[
        "drop",
        "impacts",
        "restitution",
        "speeds (m/s)",
        "drop height (mm)",
        "",
    ]);
    let rows: Vec<Vec<String>> = outcome.drops.iter().map(drop_cells).collect();
    page_tables(&header, &rows, &[0, 5]) + "\n\n"
}

fn drop_cells(drop: &TimedDropOutcome) -> Vec<String> {
    let speeds = || drop.impacts.iter().map(|own| own.speed);
    let low = speeds().fold(f64::INFINITY, f64::min);
    let high = speeds().fold(0.0, f64::max);
    let height = match (drop.height, drop.height_estimate) {
        (Some(height), _) => format!("{} given", plain(1e3 * height)),
        (None, Some(height)) => {
            value_and_sd(1e3 * height, drop.height_estimate_sd.map(|own| 1e3 * own))
        }
        (None, None) => "-".to_owned(),
    };
    vec![
        drop.drop.clone(),
        drop.impacts.len().to_string(),
        value_and_sd(drop.restitution, Some(drop.restitution_sd)),
        match drop.impacts.len() {
            1 => plain(high),
            _ => format!("{} to {}", plain(low), plain(high)),
        },
        height,
        match (&drop.left_out, drop.unused_from) {
            (Some(_), _) => "does not count".to_owned(),
            (None, Some(impact)) => format!("used before impact {impact}"),
            (None, None) => String::new(),
        },
    ]
}

fn impacts_table(outcome: &BouncesOutcome) -> String {
    let header = strings(&[
        "drop",
        "impact",
        "speed (m/s)",
        "restitution",
        "rebound (mm)",
    ]);
    let rows = outcome.drops.iter().flat_map(|drop| {
        let cells = |own: &TimedImpactOutcome| {
            vec![
                drop.drop.clone(),
                own.impact.to_string(),
                plain(own.speed),
                value_and_sd(own.restitution, Some(own.restitution_sd)),
                plain(1e3 * own.rebound_height),
            ]
        };
        drop.impacts.iter().map(cells).collect::<Vec<_>>()
    });
    page_tables(&header, &rows.collect::<Vec<_>>(), &[0]) + "\n\n"
}

fn mean_text(mean: &MeanOutcome) -> String {
    let Some(((sd, low), high)) = mean.sd.zip(mean.low).zip(mean.high) else {
        return format!(
            "restitution  {}, from timing alone: one impact has no spread\n",
            value_and_sd(mean.restitution, Some(mean.timing_sd))
        );
    };
    let told = format!(
        "restitution  {} to {} ({} % interval of the mean of {} {}): mean {} with a standard deviation \
         of {}, of which timing explains {}; median {}{}",
        plain(low),
        plain(high),
        plain_percent(100.0 * mean.confidence),
        mean.n,
        mean.over,
        plain(mean.restitution),
        plain(sd),
        plain(mean.timing_sd),
        plain(mean.median),
        mean.robust_sd.map_or_else(String::new, |own| format!(
            ", robust standard deviation {}",
            plain(own)
        ))
    );
    paragraph(&told, 13) + "\n"
}

/// "95" and "99.5".
fn plain_percent(level: f64) -> String {
    format!("{}", (1e4 * level).round() / 1e4)
}

/// A row for each impact, with the other columns of its table.
///
/// # Errors
/// None in practice: every cell can be written.
pub fn csv_of_bounces(outcome: &BouncesOutcome) -> Result<String, Error> {
    let mut header = strings(&[
        "drop",
        "impact",
        "speed_m_s",
        "restitution",
        "restitution_sd",
        "rebound_height_m",
        "left_out",
    ]);
    let mut labels: Vec<&str> = Vec::new();
    for (name, _) in outcome.drops.iter().flat_map(|own| &own.labels) {
        if !labels.contains(&name.as_str()) && !header.iter().any(|own| own == name.as_str()) {
            labels.push(name);
        }
    }
    header.extend(labels.iter().map(|name| (*name).to_owned()));
    let mut rows = Vec::new();
    for drop in &outcome.drops {
        let label = |name: &&str| {
            let found = drop.labels.iter().find(|label| label.0 == *name);
            found.map_or_else(String::new, |label| label.1.clone())
        };
        for impact in &drop.impacts {
            let mut row = vec![drop.drop.clone(), impact.impact.to_string()];
            let numbers = [
                impact.speed,
                impact.restitution,
                impact.restitution_sd,
                impact.rebound_height,
            ];
            row.extend(numbers.map(|value| number_cell(Some(value))));
            row.push(drop.left_out.clone().unwrap_or_default());
            row.extend(labels.iter().map(label));
            rows.push(row);
        }
    }
    csv_text(&header, rows)
}
