//! `windfall schema`

use crate::args::kind::NewKind;
use crate::args::schema::{Described, SchemaArguments};
use crate::show::{tell_written, write_result};
use windfall_campaign::settings::schema::impacts_schema;
use windfall_drop::schema::drop_schema;
use windfall_files::text::file_schema::FileSchema;
use windfall_files::write_file::write_whole;
use windfall_measure::schema::{
    acoustic_schema, compression_schema, relaxation_schema, repeats_schema,
};
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
    match kind {
        NewKind::Pendulum | NewKind::Carriage => impacts_schema(),
        NewKind::Compression => compression_schema(),
        NewKind::Relaxation => relaxation_schema(),
        NewKind::Acoustic => acoustic_schema(),
        NewKind::Repeats => repeats_schema(),
        NewKind::Drop => drop_schema(),
        NewKind::Scene => scene_schema(),
        NewKind::SceneStudy => study_schema(),
    }
}
