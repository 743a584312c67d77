//! Commands in groups, as `windfall --help` shows them.

use clap::Command;

/// Headings and the commands below each.
const GROUPS: [(&str, &[&str]); 6] = [
    (
        "Recordings and campaigns",
        &["new", "add", "inspect", "fit", "report", "serve", "explain"],
    ),
    (
        "Laws and fruit",
        &[
            "laws",
            "population",
            "calibrate",
            "card",
            "bounces",
            "radius",
        ],
    ),
    ("Simulation", &["simulate", "scene", "bruise"]),
    (
        "Tables and statistics",
        &["plan", "design", "regress", "surface", "compare", "summary"],
    ),
    ("Shells and editors", &["schema", "completions", "man"]),
    ("Help", &["help", "licences"]),
];

/// The command line with its commands listed in groups.
pub fn grouped(command: Command) -> Command {
    let mut command = command;
    command.build();
    let width = command
        .get_subcommands()
        .map(|own| own.get_name().len())
        .max()
        .unwrap_or(0);
    let mut list = String::new();
    for (heading, names) in GROUPS {
        list += &format!("{heading}:\n");
        for name in names {
            let about = command.find_subcommand(name).and_then(Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            list += &format!("  {name:width$}  {about}\n");
        }
        list.push('\n');
    }
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{list}Options:\n{{options}}{{after-help}}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::common::Arguments;
    use clap::CommandFactory;

    #[test]
    fn reference_every_command_stands_in_one_group() {
        let mut command = Arguments::command();
        command.build();
        let mut grouped: Vec<&str> = GROUPS
            .iter()
            .flat_map(|(_, names)| *names)
            .copied()
            .collect();
        let mut all: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
        grouped.sort_unstable();
        all.sort_unstable();
        assert_eq!(grouped, all);
    }
}
