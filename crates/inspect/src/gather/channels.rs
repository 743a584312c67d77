//! campaign.toml of recordings that were looked at: the template of a rig, with the channels,
//! times and units that the recordings have.

use crate::run::{ColumnInspection, Inspection};
use std::fmt::Write;
use windfall_campaign::settings::template::UNWRITTEN;
use windfall_files::text::column_guess::unit_meant;
use windfall_files::text::quote::{comment_text, string_text as quoted};
use windfall_numerics::unit::quantity::{parse_as, parse_unit};

/// Channels that a campaign of impacts takes, with the SI units of their quantities.
const TAKEN: [(&str, &str); 8] = [
    ("force", "N"),
    ("position", "m"),
    ("velocity", "m/s"),
    ("acceleration", "m/s^2"),
    ("angle", "rad"),
    ("phase_a", ""),
    ("phase_b", ""),
    ("count", ""),
];

/// What was taken from the recordings, and what a person has to write.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Guessed {
    /// The text of campaign.toml.
    pub text: String,
    /// What was assumed.
    pub assumed: Vec<String>,
    /// What is missing.
    pub missing: Vec<String>,
}

/// campaign.toml for recordings like one that was looked at.
///
/// * `template`: that of the rig, whose tables `[files]` and `[channels.…]` are replaced and
///   whose values of `[rig]` are left for a person to write
/// * `group`: the column to group by, if there is one
/// * `names`: the pattern of file names
pub fn campaign_text(
    template: &str,
    seen: &Inspection,
    group: Option<&str>,
    names: &str,
) -> Guessed {
    let mut guessed = Guessed {
        assumed: seen.assumed.clone(),
        ..Guessed::default()
    };
    let channels = channels_text(seen, template, &mut guessed);
    let files = files_text(seen, names, &mut guessed);
    let (mut text, mut section, mut waiting) = (String::new(), "", String::new());
    for line in template.lines() {
        let header = line
            .split_once(']')
            .map(|(name, _)| name.trim_start_matches('['));
        if let (true, Some(name)) = (line.starts_with('['), header) {
            if name == "files" {
                text += &files;
            }
            let first = name.starts_with("channels.") && !section.starts_with("channels.");
            if first {
                text += &channels;
            }
            section = name;
        }
        let replaced =
            section == "files" || section.starts_with("channels.") || section == "encoder";
        // A remark before a table belongs to it.
        if line.is_empty() || (line.starts_with('#') && !replaced) {
            waiting += line;
            waiting.push('\n');
            continue;
        }
        if !replaced {
            text += &waiting;
            text += &line_of(line, section, group, (seen, &mut guessed));
        }
        waiting.clear();
    }
    guessed.text = text;
    // The rig is what a person knows best.
    guessed
        .missing
        .sort_by_key(|missing| !missing.starts_with("[rig]"));
    guessed
}

/// What was assumed, as remarks of campaign.toml.
pub(crate) fn remarks(assumed: &[String]) -> String {
    let lines = assumed.iter();
    lines
        .map(|line| format!("# Assumed: {}\n", comment_text(line)))
        .collect()
}

/// A line of the template as it stands in the campaign.
fn line_of(
    line: &str,
    section: &str,
    group: Option<&str>,
    (seen, guessed): (&Inspection, &mut Guessed),
) -> String {
    let key = line.split_once('=').map(|(key, _)| key.trim());
    match (section, key) {
        ("rig", Some(key)) if key != "kind" && !key.starts_with('#') => {
            guessed.missing.push(format!("[rig] {key}"));
            format!("{UNWRITTEN}{line}\n")
        }
        ("fit", Some("quantities")) => quantities_line(line, seen),
        ("contact", Some("threshold")) => "threshold = \"auto\"\n".to_owned(),
        ("summary", Some("group")) => match group {
            Some(group) => format!("group = {}\n", quoted(group)),
            None => format!("# {line}\n"),
        },
        _ => format!("{line}\n"),
    }
}

/// The quantities to be fitted, of those of the template that the recordings have; an
/// acceleration where there is no displacement.
fn quantities_line(line: &str, seen: &Inspection) -> String {
    let has = |roles: &[&str]| {
        let mut channels = seen.columns.iter().filter_map(|column| column.channel);
        channels.any(|channel| roles.contains(&channel))
    };
    let displacement = has(&["position", "angle", "count", "phase_a"]);
    let found = [
        ("displacement", displacement),
        ("rate", !displacement && has(&["velocity"])),
        ("force", has(&["force"])),
        ("acceleration", !displacement && has(&["acceleration"])),
    ];
    let found = found.iter().filter(|(_, has)| *has);
    let found: Vec<String> = found.map(|(name, _)| quoted(name)).collect();
    match (displacement && has(&["force"])) || found.is_empty() {
        true => format!("{line}\n"),
        false => format!("quantities = [{}]\n", found.join(", ")),
    }
}

fn files_text(seen: &Inspection, names: &str, guessed: &mut Guessed) -> String {
    let mut text = "\n[files]\ndirectory = \"raw\"\n".to_owned();
    let _ = writeln!(text, "names = {}", quoted(names));
    let column = seen
        .columns
        .iter()
        .find(|column| column.channel == Some("time"));
    let in_file = seen.columns.iter().any(|column| column.rate.is_some());
    match column {
        Some(time) => {
            let _ = writeln!(text, "time = {}", quoted(&time.column));
            let unit = time
                .unit
                .clone()
                .filter(|unit| parse_as(&format!("1 {unit}"), "s").is_ok());
            match unit {
                Some(unit) => {
                    let _ = writeln!(text, "time_unit = {}", quoted(&unit));
                }
                None => guessed.assumed.push(format!(
                    "the times in \"{}\" are in seconds: nothing says their unit",
                    time.column
                )),
            }
        }
        None if in_file => text += "# the recordings say themselves when samples were taken\n",
        None => {
            guessed.missing.push("[files] rate".to_owned());
            let _ = writeln!(text, "{UNWRITTEN}rate = \"200 kHz\"");
        }
    }
    text
}

/// The tables of the channels that could be told, of those that the kind of rig takes.
fn channels_text(seen: &Inspection, template: &str, guessed: &mut Guessed) -> String {
    let any = ["pendulum", "carriage"].map(|kind| format!("kind = \"{kind}\""));
    let any = any.iter().any(|kind| template.contains(kind));
    let taken = |role: &str| any || template.contains(&format!("[channels.{role}]"));
    let mut text = String::new();
    let mut encoder = false;
    for (role, quantity) in TAKEN.iter().filter(|(role, _)| taken(role)) {
        let mut columns = seen.columns.iter();
        let column = columns.find(|column| column.channel == Some(role));
        let could = seen
            .columns
            .iter()
            .filter(|column| column.role == Some(role));
        let could: Vec<&ColumnInspection> = could.collect();
        let (Some(column), mark) = (match column {
            Some(column) => (Some(column), ""),
            None => (could.first().copied(), UNWRITTEN),
        }) else {
            continue;
        };
        let others: Vec<&str> = could
            .iter()
            .skip(1)
            .map(|own| own.column.as_str())
            .collect();
        let rest = match mark {
            "" => String::new(),
            _ => {
                guessed.missing.push(format!("[channels.{role}] column"));
                format!("    # or {}", comment_text(&others.join(", ")))
            }
        };
        let name = quoted(&column.column);
        let _ = write!(text, "\n[channels.{role}]\n{mark}column = {name}{rest}\n");
        text += &unit_text(column, role, quantity, guessed);
        encoder |= ["phase_a", "count"].contains(role);
    }
    if template.contains("[channels.sound]") {
        text += &sound_text(seen, guessed);
    }
    if encoder {
        let (key, example) = match template.contains("kind = \"carriage\"") {
            true => ("count_length", "count_length = \"0.17 mm\""),
            false => (
                "counts_per_revolution",
                "counts_per_revolution = 360000    # after x4 decoding",
            ),
        };
        guessed.missing.push(format!("[encoder] {key}"));
        let _ = writeln!(text, "\n[encoder]\n{UNWRITTEN}{example}");
    }
    if text.is_empty() {
        guessed.missing.push("[channels.force] column".to_owned());
        let _ = writeln!(text, "\n[channels.force]\n{UNWRITTEN}column = \"force_N\"");
    }
    text
}

/// The channel of taps, which may be in any unit: the only column that holds no times.
fn sound_text(seen: &Inspection, guessed: &mut Guessed) -> String {
    let columns = seen.columns.iter();
    let columns = columns.filter(|column| column.role != Some("time"));
    let names: Vec<&str> = columns.map(|column| column.column.as_str()).collect();
    let (mark, rest) = match &names[..] {
        [_] => ("", String::new()),
        [_, others @ ..] => (
            UNWRITTEN,
            format!("    # or {}", comment_text(&others.join(", "))),
        ),
        [] => (UNWRITTEN, String::new()),
    };
    if !mark.is_empty() {
        guessed.missing.push("[channels.sound] column".to_owned());
    }
    let name = quoted(names.first().unwrap_or(&"channel 1"));
    // Whatever it is called, it is used.
    if mark.is_empty() {
        guessed
            .assumed
            .retain(|said| !said.contains(&format!("\"{}\"", names[0])));
    }
    format!("\n[channels.sound]\n{mark}column = {name}{rest}\n")
}

fn unit_text(
    column: &ColumnInspection,
    role: &str,
    quantity: &str,
    guessed: &mut Guessed,
) -> String {
    if quantity.is_empty() {
        return String::new();
    }
    let same = |unit: &str| match (parse_unit(unit), parse_unit(quantity)) {
        (Ok(unit), Ok(quantity)) => unit.dimension.matches(&quantity.dimension),
        _ => false,
    };
    let unit = column.unit.as_deref();
    if let Some((unit, meant)) = unit.and_then(|unit| Some((unit, unit_meant(role, unit)?))) {
        guessed.assumed.push(format!(
            "{unit} of \"{}\" are {meant}: it is a channel of {role}",
            column.column
        ));
        return format!("unit = {}\n", quoted(meant));
    }
    match unit {
        Some(unit) if same(unit) => format!("unit = {}\n", quoted(unit)),
        Some("V" | "mV") => {
            guessed
                .missing
                .push(format!("[channels.{role}] sensitivity"));
            format!("{UNWRITTEN}sensitivity = \"11 mV/{quantity}\"\n")
        }
        _ => {
            guessed.missing.push(format!("[channels.{role}] unit"));
            format!("{UNWRITTEN}unit = \"{quantity}\"\n")
        }
    }
}
