//! What can go wrong with files and campaigns, said so that it can be mended.

use crate::error_words::what_to_do;
use crate::error_words::{nearest_columns, why_nothing};
use crate::found::FailureOutcome;
use std::path::{Path, PathBuf};

pub use crate::place::{DropQuantity, Place};

/// What can go wrong between a file and a result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The work was cancelled.
    #[error("stopped before it was done; nothing of it was kept")]
    Cancelled,
    /// What a file asks for cannot be.
    #[error("{place}: {problem}")]
    Refused {
        /// Where the file says so.
        place: Place,
        /// What is wrong.
        problem: String,
    },
    /// An error that only one room knows, such as that of a scene.
    #[error("{0}")]
    Room(Box<dyn Fault>),
    /// Another engine that is absent, fails, or cannot represent a scene.
    #[error("{engine}: {problem}")]
    Engine {
        /// Its name.
        engine: &'static str,
        /// What is wrong.
        problem: String,
    },
    /// A change that would leave no campaign that can be read.
    #[error("nothing was written: {problem}")]
    ChangeRefused {
        /// What would be wrong.
        problem: String,
    },
    /// The recordings of a campaign lie outside of its directory.
    #[error(
        "the recordings of this campaign lie outside of its directory ([files] directory in campaign.toml); they can be fitted, but not listed, shown or added to here"
    )]
    RecordingsElsewhere,
    /// No impact of that id.
    #[error("impacts.csv has no impact \"{id}\"{known}")]
    ImpactUnknown {
        /// The id.
        id: String,
        /// Those that there are, for the message, as [`crate::known_names::known_names`].
        known: String,
    },
    /// No campaign of that name.
    #[error("there is no campaign \"{id}\" here")]
    CampaignUnknown {
        /// The name.
        id: String,
    },
    /// The campaign was changed concurrently.
    #[error(
        "the files of the campaign have changed since they were read; nothing was written. Read them again and repeat the change"
    )]
    ChangedMeanwhile,
    /// A change that cannot be undone, because its files are no longer what it made of them.
    #[error(
        "{file} was changed again after this change ({change}); undoing it would lose that, so nothing was written"
    )]
    ChangedSince {
        /// The file.
        file: String,
        /// What the change did.
        change: String,
    },
    /// A name that would lead out of a directory, or that some system cannot have.
    #[error("the name \"{name}\" {problem}")]
    NameRefused {
        /// The name.
        name: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A figure that cannot be drawn as dots.
    #[error("the figure cannot be drawn as PNG: {detail}; its SVG and CSV are complete")]
    FigureUndrawable {
        /// What the renderer said.
        detail: String,
    },
    /// A result that cannot be put into words of JSON.
    #[error("the result on \"{item}\" cannot be kept: {detail}")]
    ResultUnwritable {
        /// Id in impacts.csv.
        item: String,
        /// What the writer said.
        detail: String,
    },
    /// A recording that cannot be read.
    #[error("{0}")]
    Format(windfall_formats::Error),
    /// A design or a model that cannot be.
    #[error("{0}")]
    Statistics(windfall_statistics::error::Error),
    /// A file that was named is not there.
    #[error("{path}: there is no such file; {advice}", path = path.display())]
    FileAbsent {
        /// The file.
        path: PathBuf,
        /// Where its name came from and what to do.
        advice: String,
    },
    /// A file could not be read or written.
    #[error("{path}: cannot {action}: {source}{}", what_to_do(action, source), path = path.display())]
    FileAccess {
        /// The file.
        path: PathBuf,
        /// What was attempted: "read", "write", "create".
        action: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// A table without a header.
    #[error(
        "{path}: the file is empty; expected a header line with the names of the columns, \
         then one line per sample", path = path.display()
    )]
    TableEmpty {
        /// The file.
        path: PathBuf,
    },
    /// A table with a header and nothing below it.
    #[error(
        "{path}: the file has a header and no rows; expected one line per {row_is}",
        path = path.display()
    )]
    TableWithoutRows {
        /// The file.
        path: PathBuf,
        /// What one row stands for.
        row_is: &'static str,
    },
    /// A requested column is not in the header.
    #[error(
        "{path}: there is no column \"{column}\"{asked_by}; {nearest}",
        path = path.display(),
        nearest = nearest_columns(nearest, *columns)
    )]
    ColumnMissing {
        /// The file.
        path: PathBuf,
        /// The requested column.
        column: String,
        /// Who asks, for the message: " (asked for by [channels.force])" or "".
        asked_by: String,
        /// The columns, those with the most similar names first; not all of many.
        nearest: Vec<String>,
        /// How many columns the file has.
        columns: usize,
    },
    /// Two columns of one name.
    #[error(
        "{path}, line 1: the column \"{column}\" appears twice in the header; rename one of them, \
         or map the channel to another column", path = path.display()
    )]
    ColumnRepeated {
        /// The file.
        path: PathBuf,
        /// The name.
        column: String,
    },
    /// A row with more or fewer cells than the header.
    #[error(
        "{place}: the row has {found} cells where the header has {expected}; \
         the file may be cut short, or use another separator in this line (it is read with {separator})"
    )]
    RowRagged {
        /// Where.
        place: Place,
        /// Cells in the header.
        expected: usize,
        /// Cells in the row.
        found: usize,
        /// Name of the separator that the header uses.
        separator: &'static str,
    },
    /// A cell that should hold a number.
    #[error(
        "{place}, column \"{column}\": \"{text}\" is not a number{hint}; \
         leave the cell blank where there is no sample"
    )]
    CellNotNumber {
        /// Where.
        place: Place,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
        /// What may be meant, for the message.
        hint: &'static str,
    },
    /// A cell that holds NaN or an infinity.
    #[error(
        "{place}, column \"{column}\": the value is {text}, which is no finite number below 1e100; \
         leave the cell blank where there is no sample"
    )]
    CellNotFinite {
        /// Where.
        place: Place,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
    },
    /// Text that is not UTF-8.
    #[error(
        "{place}: the text is not UTF-8; save the file as UTF-8 (in a spreadsheet: \"CSV UTF-8\")"
    )]
    NotUtf8 {
        /// Where.
        place: Place,
    },
    /// A campaign file that is not TOML or does not have the shape of one.
    #[error("{place}: {message}")]
    CampaignSyntax {
        /// Where.
        place: Place,
        /// What the reader of TOML says.
        message: String,
    },
    /// A key of a campaign file that windfall does not know.
    #[error("{place}: there is no key \"{key}\" here{nearest}; known keys: {known}", known = known.join(", "))]
    KeyUnknown {
        /// Where.
        place: Place,
        /// The key.
        key: String,
        /// Suggestion for the message, or "".
        nearest: String,
        /// The keys that may stand here.
        known: Vec<String>,
    },
    /// A value that the campaign leaves out and windfall cannot guess.
    #[error("{place}: {table} needs `{key}` ({meaning}); add for example: {example}")]
    ValueMissing {
        /// Where the table starts.
        place: Place,
        /// The table, with brackets.
        table: String,
        /// The key left out.
        key: &'static str,
        /// What it is.
        meaning: &'static str,
        /// A line that would do.
        example: &'static str,
    },
    /// A value whose text cannot be used.
    #[error("{place}: {key} = \"{text}\": {problem}")]
    ValueInvalid {
        /// Where.
        place: Place,
        /// Table and key.
        key: String,
        /// What stands there.
        text: String,
        /// What is wrong with it and what was expected.
        problem: String,
    },
    /// A row without a value that it must have.
    #[error("{place}: the cell in column \"{column}\" is blank; every row needs one")]
    CellBlank {
        /// Where.
        place: Place,
        /// The column.
        column: String,
    },
    /// A directory or file that a command would have to overwrite.
    #[error("{path}: exists already and is not overwritten; choose another name or remove it first", path = path.display())]
    AlreadyThere {
        /// The file or directory.
        path: PathBuf,
    },
    /// A file of the user's where a result should go.
    #[error("{path}: this file was not written by windfall, or was changed since, and is not replaced; choose another name, move it away, or replace it with --force", path = path.display())]
    NotWrittenHere {
        /// The file.
        path: PathBuf,
    },
    /// A pipe, socket or device where a file is read.
    #[error("{path}: this is not a regular file but a pipe, a socket or a device; put the file itself there", path = path.display())]
    NotRegular {
        /// What was named.
        path: PathBuf,
    },
    /// A file that would replace an input of the command.
    #[error("{path}: this is an input ({input}) and is not replaced; choose another name", path = path.display(), input = input.display())]
    WouldReplaceInput {
        /// The file to be written.
        path: PathBuf,
        /// The input, as it was named.
        input: PathBuf,
    },
    /// A file that would lie among the recordings of a campaign.
    #[error("{path}: {folder} holds recordings, and nothing else may be written there; choose another directory", path = path.display(), folder = folder.display())]
    AmongRecordings {
        /// The file to be written.
        path: PathBuf,
        /// The folder of the recordings.
        folder: PathBuf,
    },
    /// Not one impact of a campaign could be fitted.
    #[error("{path}: nothing could be fitted{}", why_nothing(failures), path = path.display())]
    NothingFitted {
        /// The campaign directory.
        path: PathBuf,
        /// What could not be fitted, and why.
        failures: Vec<FailureOutcome>,
    },
    /// An option of a command that cannot be used.
    #[error("{option}: {problem}")]
    OptionInvalid {
        /// The option, as written on the command line.
        option: String,
        /// What is wrong with it and what was expected.
        problem: String,
    },
    /// A cell that should hold a quantity above zero.
    #[error(
        "{place}, column \"{column}\": \"{text}\" is not a number above zero; \
         leave the cell blank where it is not known"
    )]
    CellNotPositive {
        /// Where.
        place: Place,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
    },
    /// A drop without its mass or its height.
    #[error(
        "{place}: the {} of \"{item}\" is not known: column \"{}\" is {found}; \
         fill it in, or give one value for all drops in campaign.toml: [rig] {}",
        needed.name, needed.column, needed.example
    )]
    DropUnknown {
        /// Row of impacts.csv.
        place: Place,
        /// Id in impacts.csv.
        item: String,
        /// What is not known.
        needed: &'static DropQuantity,
        /// "blank" or "not there".
        found: &'static str,
    },
    /// A value that a result needs is not in the tables.
    #[error("{item}: {missing}; {advice}")]
    ValueNotKnown {
        /// Id in impacts.csv, or of the specimen.
        item: String,
        /// What is not known.
        missing: String,
        /// What would tell it.
        advice: String,
    },
    /// A recording that could not be evaluated.
    #[error("{path}: {source}", path = path.display())]
    Evaluation {
        /// The recording.
        path: PathBuf,
        /// What is wrong.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The signals of a recording could not be used.
    #[error("{path}: {source}", path = path.display())]
    Signal {
        /// The recording.
        path: PathBuf,
        /// What is wrong.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A fit or a simulation failed.
    #[error("{subject}: {source}")]
    Identify {
        /// The impact or event.
        subject: String,
        /// What is wrong.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}

impl Error {
    /// Whether the request (options, campaign files) is wrong, not the work.
    pub fn is_request(&self) -> bool {
        if let Self::Room(fault) = self {
            return fault.is_request();
        }
        !matches!(
            self,
            Self::FileAccess { .. }
                | Self::Cancelled
                | Self::NothingFitted { .. }
                | Self::Signal { .. }
                | Self::Identify { .. }
        )
    }
}

impl Error {
    /// A file that the system does not let us "read", "write" or "create".
    pub fn access(path: &Path, action: &'static str, source: std::io::Error) -> Self {
        Self::FileAccess {
            path: path.to_path_buf(),
            action,
            source,
        }
    }

    /// A file that is not there, and what to do.
    pub fn absent(path: impl Into<PathBuf>, advice: impl Into<String>) -> Self {
        Self::FileAbsent {
            path: path.into(),
            advice: advice.into(),
        }
    }

    /// A result that cannot be written, and what the writer said.
    pub fn unwritable(item: &str, detail: impl ToString) -> Self {
        Self::ResultUnwritable {
            item: item.to_owned(),
            detail: detail.to_string(),
        }
    }

    /// A value that a result needs, and what would tell it.
    pub fn not_known(item: &str, missing: impl Into<String>, advice: impl Into<String>) -> Self {
        Self::ValueNotKnown {
            item: item.to_owned(),
            missing: missing.into(),
            advice: advice.into(),
        }
    }

    /// A recording whose signals could not be used.
    pub fn signal(path: PathBuf, source: impl std::error::Error + Send + Sync + 'static) -> Self {
        let source = Box::new(source);
        Self::Signal { path, source }
    }

    /// A fit or a simulation that failed.
    pub fn identify(
        subject: impl Into<String>,
        source: impl std::error::Error + Send + Sync + 'static,
    ) -> Self {
        Self::Identify {
            subject: subject.into(),
            source: Box::new(source),
        }
    }

    /// The error of a room, where this is one of type `T`.
    pub fn of_room<T: Fault>(&self) -> Option<&T> {
        let Self::Room(fault) = self else { return None };
        let fault: &dyn std::error::Error = &**fault;
        fault.downcast_ref()
    }
}

impl<T: Fault> From<T> for Error {
    fn from(fault: T) -> Self {
        Self::Room(Box::new(fault))
    }
}

/// An error that one room declares and the rooms above it pass on as [`Error::Room`].
pub trait Fault: std::error::Error + Send + Sync + 'static {
    /// Whether the request is wrong, rather than the work having failed.
    fn is_request(&self) -> bool;

    /// Whether the requested thing does not exist.
    fn is_absence(&self) -> bool {
        false
    }
}
