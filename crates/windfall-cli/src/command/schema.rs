//! `windfall schema`

use crate::args::kind::NewKind;
use crate::args::schema::{Described, SchemaArguments};
use crate::show::{tell_written, write_result};
use windfall_files::text::file_schema::FileSchema;
use windfall_files::write_file::write_whole;
use windfall_report::schema_of_template::schema_of_template;
use windfall_scene_run::schema::{scene_schema, study_schema};

/// Writes what a file may say, or what a result says.
pub fn run(arguments: &SchemaArguments) -> anyhow::Result<()> {
    let text = match arguments.kind {
        Described::File(kind) => schema_of_file(kind).text()?,
        Described::Result(kind) => (kind.described)().text()?,
    };
    let Some(path) = &arguments.out else {
        return write_result(&text);
    };
    write_whole(path, text.as_bytes())?;
    tell_written([path]);
    Ok(())
}

fn schema_of_file(kind: NewKind) -> FileSchema {
    match kind.template() {
        Some(template) => schema_of_template(template),
        None if kind == NewKind::Scene => scene_schema(),
        None => study_schema(),
    }
}
