//! `windfall new`

use crate::args::{NewArguments, NewKind};
use crate::args_format::Format;
use crate::show::{write_json, write_result};
use windfall::workflow_new::{TemplateKind, write_template};

/// Writes a template and names the files.
pub fn run(arguments: &NewArguments) -> anyhow::Result<()> {
    let kind = match arguments.kind {
        NewKind::Pendulum => TemplateKind::Pendulum,
        NewKind::Carriage => TemplateKind::Carriage,
        NewKind::Compression => TemplateKind::Compression,
        NewKind::Acoustic => TemplateKind::Acoustic,
        NewKind::Repeats => TemplateKind::Repeats,
        NewKind::Drop => TemplateKind::Drop,
    };
    let written = write_template(kind, &arguments.directory)?;
    let names: Vec<String> = written
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    match arguments.format {
        Format::Json => write_json(&serde_json::json!({ "written": names })),
        Format::Csv => write_result(&format!("written\n{}\n", names.join("\n"))),
        Format::Text => write_result(&format!(
            "{}\n\nNext: put the recordings into raw/, edit the files, then\n  windfall fit {}\n",
            names.join("\n"),
            arguments.directory.display()
        )),
    }
}
