//! `windfall man`

use crate::args::common::{Arguments, ManArguments};
use crate::outcome::WrittenFiles;
use crate::show::{csv_of_names, show};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use windfall_files::write_file::{check_target, make_directory, write_whole};

/// Writes a page for every command.
pub fn run(arguments: &ManArguments) -> anyhow::Result<()> {
    let mut all = Arguments::command().disable_help_subcommand(true);
    all.build();
    let mut pages = Vec::new();
    collect(&all, &mut pages)?;
    // All are written or none.
    let place = |name: &str| arguments.out.join(name);
    check_target(&arguments.out)?;
    for (name, _) in &pages {
        check_target(&place(name))?;
    }
    make_directory(&arguments.out)?;
    for (name, page) in &pages {
        write_whole(&place(name), page)?;
    }
    let written = pages
        .iter()
        .map(|(name, _)| place(name).display().to_string());
    let files = WrittenFiles {
        written: written.collect(),
    };
    show(
        &arguments.format.into(),
        || Ok::<_, anyhow::Error>(files),
        |own| own.written.join("\n") + "\n",
        |own| csv_of_names("written", &own.written),
    )?;
    Ok(())
}

/// Pages of a command and of those below it, with the names of their files.
fn collect(command: &Command, pages: &mut Vec<(String, Vec<u8>)>) -> anyhow::Result<()> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    pages.push((format!("{name}.1"), page(command)?));
    for own in command.get_subcommands().filter(|own| !own.is_hide_set()) {
        collect(own, pages)?;
    }
    Ok(())
}

fn page(command: &Command) -> std::io::Result<Vec<u8>> {
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    if command.has_subcommands() {
        man.render_subcommands_section(&mut page)?;
    }
    if let Some(more) = command.get_after_help() {
        page.extend(b".SH NOTES\n");
        for block in more.to_string().split("\n\n") {
            page.extend(roff(block).bytes());
        }
    }
    man.render_version_section(&mut page)?;
    Ok(page)
}

/// A paragraph, or lines that stay as they are: those of examples.
fn roff(block: &str) -> String {
    let mut text = String::new();
    for line in block.lines() {
        let line = line.replace('\\', "\\e").replace('-', "\\-");
        // The mark in front keeps a dot or an apostrophe from being a request.
        text += &format!("\\&{}\n", line.replace('\'', "\\(aq"));
    }
    match block.contains("\n  ") {
        true => format!(".PP\n.nf\n{text}.fi\n"),
        false => format!(".PP\n{text}"),
    }
}
