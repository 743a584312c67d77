//! `windfall inspect FILE`: what a recording holds, and what looks wrong.
//!
//! The file is read once, in blocks: memory does not grow with its length.

use crate::envelope::Envelope;
use crate::figure::{csv_of_curves, drawing_of_curves};
use crate::scan_time::TimeScan;
use crate::scan_value::ValueScan;
use serde::Serialize;
use std::path::{Path, PathBuf};
use windfall_campaign::recording::find_channel::find_channel;
use windfall_campaign::settings::open_options::{OpenRequest, open_options};
use windfall_draw::curve::{Curve, CurvePoint};
use windfall_draw::plot::write_plot;
use windfall_draw::theme::LIGHT;
use windfall_draw::width::Width;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::inputs::{check_piped, protect};
use windfall_files::named::Named;
use windfall_files::option_value::unusable;
use windfall_files::text::column_guess::{ColumnHead, guess_columns};
use windfall_files::text::column_role::{role_of, seconds_per_unit, unit_in};
use windfall_formats::contents::{ChannelContents, Contents, TimeBase};
use windfall_formats::open::{OpenOptions, open};
use windfall_formats::reader::Sink;

/// Most faulty cells that are described.
const DESCRIBED_FAULTS: usize = 10;

/// What a recording holds.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Inspection {
    /// The file.
    pub file: String,
    /// Its format, with version or variant.
    pub format: String,
    /// Rows of a text file; samples of the longest channel of another.
    pub rows: u64,
    /// Channels in the order of the file.
    pub columns: Vec<ColumnInspection>,
    /// What the file says of itself.
    pub properties: Named<String>,
    /// What a new campaign assumes of the columns, and what it leaves out.
    pub assumed: Vec<String>,
    /// What looks wrong.
    pub findings: Vec<FindingOutcome>,
    /// Outlines of the channels that are no times, for plots.
    #[serde(skip)]
    pub curves: Vec<Curve>,
}

/// One channel of a recording.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ColumnInspection {
    /// Its name, by which a campaign asks for it.
    pub column: String,
    /// Unit that the file gives, or guessed from the name.
    pub unit: Option<String>,
    /// What the channel could be: "time", or a channel of a campaign.
    pub role: Option<&'static str>,
    /// What it is taken for in a new campaign; of several that could be, one or none is.
    pub channel: Option<&'static str>,
    /// How it is stored.
    pub stored_as: String,
    /// Samples that are numbers.
    pub samples: u64,
    /// Smallest value; unit of the channel.
    pub smallest: Option<f64>,
    /// Largest value; unit of the channel.
    pub largest: Option<f64>,
    /// Sampling rate, from the file or the median interval between samples; Hz.
    pub rate: Option<f64>,
    /// From the first to the last sample; s.
    pub length: Option<f64>,
    /// Time of the first sample on the clock of the file; s.
    pub start: Option<f64>,
}

/// What `inspect` is asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct InspectRequest {
    /// How the file is read.
    pub open: OpenRequest,
    /// Names of the channels to show; none shows all.
    pub channels: Vec<String>,
}

/// Looks through a recording.
///
/// Times without a unit are taken as seconds.
///
/// # Errors
/// The file cannot be read, or breaks the rules of its format.
pub fn inspect_recording(path: &Path, request: &InspectRequest) -> Result<Inspection, Error> {
    inspect_opened(path, &open_options(&request.open)?, &request.channels)
}

/// [`inspect_recording`] of a file that is read as its campaign says.
pub fn inspect_opened(
    path: &Path,
    options: &OpenOptions,
    channels: &[String],
) -> Result<Inspection, Error> {
    Ok(inspect_taking(path, options, channels, &mut |_, _| ())?.0)
}

/// [`inspect_opened`] for a caller that looks at the samples too, on the same way through the
/// file; also the channels as the file describes them.
///
/// * `take`: is given the place of a channel in the file and its next samples, in blocks that
///   may interleave with those of others; NaN where there is no sample
///
/// # Errors
/// Those of [`inspect_recording`].
pub fn inspect_taking(
    path: &Path,
    options: &OpenOptions,
    channels: &[String],
    take: &mut dyn FnMut(usize, &[f64]),
) -> Result<(Inspection, Contents), Error> {
    check_piped(path)?;
    protect(path);
    let mut reader = open(path, options).map_err(Error::Format)?;
    let contents = reader.contents().clone();
    let shown = shown_channels(&contents, channels, path)?;
    let all: Vec<usize> = (0..contents.channels.len()).collect();
    let mut scans = Scans::of(&contents);
    let mut both = Shared {
        scans: &mut scans,
        take,
    };
    reader.read(&all, &mut both).map_err(Error::Format)?;
    // What reading itself has found out is in the notes by now.
    let notes = reader.contents().notes.iter();
    let mut findings: Vec<FindingOutcome> = notes
        .map(|note| FindingOutcome::new(note.code(), note.to_string()))
        .collect();
    findings.append(&mut scans.fault_findings());

    let mut columns = Vec::new();
    let mut curves = Vec::new();
    for index in shown {
        let channel = &contents.channels[index];
        let scan = &scans.channels[index];
        let clock = clock_of(&contents, &scans, index);
        let inspected = column_inspection(channel, scan, &clock);
        match &scan.times {
            Some(times) => findings.extend(time_findings(&channel.name, times)),
            None => {
                findings.extend(value_findings(&channel.name, &scan.values));
                curves.push(curve_of(&inspected, scan, &clock));
            }
        }
        columns.push(inspected);
    }
    if contents
        .channels
        .iter()
        .all(|c| c.time == TimeBase::Unknown)
    {
        let message = "nothing says when the samples were taken; give the sampling rate or the \
                       column of times in campaign.toml: [files] rate = \"200 kHz\"";
        findings.push(FindingOutcome::new("no-time", message.to_owned()));
    }
    let assumed = guess_channels(&mut columns);
    let rows = scans.channels.iter().map(|scan| scan.values.rows).max();
    let inspection = Inspection {
        file: path.display().to_string(),
        format: format!("{} {}", contents.format, contents.variant)
            .trim()
            .to_owned(),
        rows: rows.unwrap_or(0),
        columns,
        properties: contents.properties.clone().into_iter().collect(),
        assumed,
        findings,
        curves,
    };
    Ok((inspection, contents))
}

/// Channels by their names; all if none is named.
pub(crate) fn shown_channels(
    contents: &Contents,
    wanted: &[String],
    path: &Path,
) -> Result<Vec<usize>, Error> {
    if wanted.is_empty() {
        return Ok((0..contents.channels.len()).collect());
    }
    let find = |name: &String| find_channel(contents, name, path, " (asked for with --channel)");
    wanted.iter().map(find).collect()
}

/// Writes a figure of a recording as SVG, PNG or PDF, by the ending of its name, and its
/// data as CSV beside it; returns the two files.
///
/// # Errors
/// There is not exactly one recording, its name has another ending than ".svg", ".png"
/// and ".pdf", or a file cannot be written.
pub fn write_figure(
    path: &Path,
    inspections: &[Inspection],
    width: Option<Width>,
) -> Result<[PathBuf; 2], Error> {
    let unusable =
        |problem: &str| unusable(format!("--plot {}", path.display()), problem.to_owned());
    let [inspection] = inspections else {
        return Err(unusable(
            "a figure shows one recording; name one that can be read",
        ));
    };
    let name = Path::new(&inspection.file).file_name();
    let title = name.map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let svg = drawing_of_curves(&title, &inspection.curves, width).svg(&LIGHT);
    let data = csv_of_curves(&inspection.curves)?;
    write_plot("--plot", path, &svg, &data)
}

/// What one pass over a channel has found.
struct ChannelScan {
    values: ValueScan,
    envelope: Envelope,
    times: Option<TimeScan>,
}

struct Scans {
    channels: Vec<ChannelScan>,
    faults: Vec<String>,
    more_faults: usize,
}

impl Scans {
    fn of(contents: &Contents) -> Self {
        let is_time = |index: usize| {
            let base = TimeBase::Channel(index);
            contents.channels.iter().any(|channel| channel.time == base)
                || role_of(&contents.channels[index].name) == Some("time")
        };
        let channels = (0..contents.channels.len()).map(|index| ChannelScan {
            values: ValueScan::default(),
            envelope: Envelope::default(),
            times: is_time(index).then(TimeScan::default),
        });
        Self {
            channels: channels.collect(),
            faults: Vec::new(),
            more_faults: 0,
        }
    }

    fn fault_findings(&mut self) -> Vec<FindingOutcome> {
        let faults = self.faults.drain(..);
        let mut findings: Vec<_> = faults
            .map(|fault| FindingOutcome::new("cell", fault))
            .collect();
        if self.more_faults > 0 {
            let message = format!("{} more cells are no finite numbers", self.more_faults);
            findings.push(FindingOutcome::new("cell", message));
        }
        findings
    }
}

impl Sink for Scans {
    fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), windfall_formats::Error> {
        let scan = &mut self.channels[position];
        scan.values.take(samples);
        match &mut scan.times {
            Some(times) => times.take(samples),
            None => scan.envelope.take(samples),
        }
        Ok(())
    }

    fn fault(&mut self, fault: windfall_formats::Error) -> Result<(), windfall_formats::Error> {
        match self.faults.len() < DESCRIBED_FAULTS {
            true => self.faults.push(fault.to_string()),
            false => self.more_faults += 1,
        }
        Ok(())
    }
}

/// Samples that are looked through, and go on to the caller.
struct Shared<'a> {
    scans: &'a mut Scans,
    take: &'a mut dyn FnMut(usize, &[f64]),
}

impl Sink for Shared<'_> {
    fn take(&mut self, position: usize, samples: &[f64]) -> Result<(), windfall_formats::Error> {
        (self.take)(position, samples);
        self.scans.take(position, samples)
    }

    fn fault(&mut self, fault: windfall_formats::Error) -> Result<(), windfall_formats::Error> {
        self.scans.fault(fault)
    }
}

/// When the rows of a channel were.
enum Clock<'a> {
    Unknown,
    Uniform { start: f64, interval: f64 },
    Times { scan: &'a TimeScan, scale: f64 },
}

impl Clock<'_> {
    fn at(&self, row: u64) -> Option<f64> {
        match self {
            Self::Unknown => None,
            Self::Uniform { start, interval } => Some(start + row as f64 * interval),
            Self::Times { scan, scale } => scan.at(row).map(|time| time * scale),
        }
    }

    fn interval(&self) -> Option<f64> {
        match self {
            Self::Unknown => None,
            Self::Uniform { interval, .. } => Some(*interval),
            Self::Times { scan, scale } => scan.median_interval().map(|i| i * scale),
        }
    }
}

fn clock_of<'a>(contents: &Contents, scans: &'a Scans, index: usize) -> Clock<'a> {
    match contents.channels[index].time {
        TimeBase::Unknown => Clock::Unknown,
        TimeBase::Uniform { start, interval } => Clock::Uniform { start, interval },
        TimeBase::Channel(at) => match &scans.channels[at].times {
            Some(scan) => Clock::Times {
                scan,
                scale: seconds_per_unit(&contents.channels[at]),
            },
            None => Clock::Unknown,
        },
    }
}

fn column_inspection(
    channel: &ChannelContents,
    scan: &ChannelScan,
    clock: &Clock,
) -> ColumnInspection {
    let unit = unit_in(channel);
    let role = scan.times.as_ref().map(|_| "time");
    let rows_between = scan.values.usual_gap().map(|gap| gap as f64);
    let interval = clock.interval().zip(rows_between).map(|(i, gap)| i * gap);
    let ends = scan.values.span();
    let start = ends.and_then(|(first, _)| clock.at(first));
    let end = ends.and_then(|(_, last)| clock.at(last));
    ColumnInspection {
        column: channel.name.clone(),
        unit,
        role,
        channel: None,
        stored_as: channel.stored_as.clone(),
        samples: scan.values.samples,
        smallest: scan.values.smallest,
        largest: scan.values.largest,
        rate: interval.filter(|interval| *interval > 0.0).map(f64::recip),
        length: start.zip(end).map(|(start, end)| end - start),
        start,
    }
}

/// Fills in what each column could be and is taken for; what was assumed.
fn guess_channels(columns: &mut [ColumnInspection]) -> Vec<String> {
    let heads = columns.iter().map(|column| ColumnHead {
        name: &column.column,
        unit: column.unit.as_deref(),
        is_time: column.role == Some("time"),
    });
    let guess = guess_columns(&heads.collect::<Vec<_>>());
    for (index, column) in columns.iter_mut().enumerate() {
        column.role = guess.roles[index];
        column.channel = guess.channels[index];
    }
    guess.assumed
}

fn curve_of(column: &ColumnInspection, scan: &ChannelScan, clock: &Clock) -> Curve {
    let points = scan.envelope.buckets().map(|bucket| CurvePoint {
        x: clock.at(bucket.row).unwrap_or(bucket.row as f64),
        first: bucket.first,
        last: bucket.last,
        smallest: bucket.smallest,
        largest: bucket.largest,
    });
    Curve {
        name: column.column.clone(),
        unit: column.unit.clone(),
        timed: !matches!(clock, Clock::Unknown),
        points: points.collect(),
    }
}

fn time_findings(name: &str, times: &TimeScan) -> Vec<FindingOutcome> {
    if let Some(step) = times.backwards() {
        let message = format!(
            "\"{name}\": time does not increase at sample {}: {} after {}; \
             split the recording there, or give a sampling rate in place of the time column",
            step.row, step.time, step.before
        );
        return vec![FindingOutcome::new("time-backwards", message)];
    }
    let (Some(median), Some(worst)) = (times.median_interval(), times.irregular()) else {
        return Vec::new();
    };
    let message = format!(
        "\"{name}\": sampling is irregular: the median interval is {median:.6}, but {:.6} after {:.6}",
        worst.interval(),
        worst.before
    );
    vec![FindingOutcome::new("irregular-sampling", message)]
}

fn value_findings(name: &str, values: &ValueScan) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    if values.infinite > 0 {
        let message = format!("\"{name}\": {} samples are infinite", values.infinite);
        findings.push(FindingOutcome::new("infinite", message));
    }
    if let Some(value) = values.dead() {
        let message = format!(
            "\"{name}\": all {} samples are {value}; nothing was connected, or it is switched off",
            values.samples
        );
        findings.push(FindingOutcome::new("dead-channel", message));
    }
    if let Some((limit, run)) = values.clipped() {
        let message = format!(
            "\"{name}\": {run} successive samples stand at the extreme value {limit}; \
             the channel may be clipped"
        );
        findings.push(FindingOutcome::new("clipped", message));
    }
    if let Some(spikes) = values.spikes() {
        let [before, value, after] = spikes.first.values;
        let message = format!(
            "\"{name}\": {}{} sample(s) far from both neighbours, the first is {value} between \
             {before} and {after} (sample {}); blank such cells or choose a range of time without \
             them",
            if spikes.more { "at least " } else { "" },
            spikes.count,
            spikes.first.sample
        );
        findings.push(FindingOutcome::new("spike", message));
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_rate_length_and_faults_of_a_small_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("r.csv");
        std::fs::write(&path, "time_s,force_N,position_mm\n0,1,5\n0.5,9,\n1,9,6\n1.5,9,\n2,9,7\n2.5,x,\n3,3,8\n3.5,4,\n").unwrap();
        let found = inspect_recording(&path, &InspectRequest::default()).unwrap();
        assert_eq!(
            (
                found.rows,
                found.columns[1].samples,
                found.columns[2].samples
            ),
            (8, 7, 4)
        );
        assert_eq!(
            (found.columns[1].rate, found.columns[2].rate),
            (Some(2.0), Some(1.0))
        );
        assert_eq!(
            (found.columns[1].length, found.columns[2].length),
            (Some(3.5), Some(3.0))
        );
        let codes: Vec<&str> = found.findings.iter().map(|f| f.code.as_str()).collect();
        assert_eq!(codes, ["cell", "clipped"]);
    }
}
