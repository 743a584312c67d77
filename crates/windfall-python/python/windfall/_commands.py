# Written by tests/functions.rs from the definitions of the command line; do not edit.
"""One function for each command of windfall."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from windfall._call import Path, Table, Value, call
from windfall._result import Result

__all__ = [
    "add",
    "bounces",
    "bruise",
    "calibrate",
    "card_show",
    "card_transfer",
    "compare",
    "design_box_behnken",
    "design_ccd",
    "design_d_optimal",
    "design_factorial",
    "design_i_optimal",
    "design_latin_hypercube",
    "design_plackett_burman",
    "design_sobol",
    "design_split_plot",
    "explain",
    "fit_campaign",
    "inspect",
    "laws",
    "licences",
    "new",
    "plan_achieved",
    "plan_critical_energy",
    "plan_difference",
    "plan_groups",
    "plan_mean",
    "plan_model",
    "plan_population",
    "plan_slope",
    "plan_surface",
    "population",
    "radius",
    "regress",
    "report",
    "scene_export",
    "scene_picture",
    "scene_run",
    "scene_study",
    "scene_table",
    "scene_vtk",
    "schema",
    "simulate_carriage",
    "simulate_compression",
    "simulate_drop",
    "simulate_impact",
    "simulate_pendulum",
    "simulate_repeats",
    "simulate_tap",
    "summary",
    "surface",
]


def new(
    kind: Literal["pendulum", "carriage", "compression", "relaxation", "acoustic", "repeats", "drop", "scene", "scene-study"],
    directory: Path,
    *,
    from_: Path | None = None,
    names: Value | None = None,
    preset: Value | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Write a commented template of a campaign or a scene.

    The command `windfall new`.

    * `kind`: Kind of rig
    * `directory`: Directory to make; it must not exist or be empty
    * `from_`: Folder of recordings, which are copied into the campaign: both tables and the
      channels are filled from what they are called and hold
    * `names`: What the names of the recordings say, such as
      '{variety}_f{fruit}_{height_mm}mm_{rep}.csv'
    * `preset`: Program that wrote the recordings, which says what their columns are called;
      `windfall inspect --presets` lists them
    """
    return call(
        "new",
        [kind, directory],
        {
            "--from": from_,
            "--names": names,
            "--preset": preset,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def add(
    directory: Path,
    files: Path | Sequence[Path] | None = None,
    *,
    names: Value | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """List further recordings in a campaign.

    The command `windfall add`.

    * `directory`: The campaign directory
    * `files`: Recordings to copy into the campaign; those that lie in its raw/ if left out
    * `names`: What their names say, in place of [files] names of the campaign
    """
    return call(
        "add",
        [directory, files],
        {
            "--names": names,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def inspect(
    files: Path | Sequence[Path] | None = None,
    *,
    preset: Value | None = None,
    presets: bool = False,
    channel: Value | Sequence[Value] | None = None,
    plot: Path | None = None,
    width: Value | None = None,
    export: Path | None = None,
    file_format: Value | None = None,
    separator: Value | None = None,
    decimal: Value | None = None,
    thousands: Value | None = None,
    encoding: Value | None = None,
    header_line: int | None = None,
    comment: Value | None = None,
    missing: Value | Sequence[Value] | None = None,
    footer: int | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Show what recordings hold and what looks wrong.

    The command `windfall inspect`.

    * `files`: Recordings of any format
    * `preset`: Program that wrote the recordings, which says what their columns are called
    * `presets`: List the presets, with the exports that they were made from
    * `channel`: Show only this channel; may be repeated
    * `plot`: Write a figure of the channels (SVG, PNG or PDF, by its ending) and its data (CSV,
      same name); one recording only
    * `width`: Width of the figure in print, as a journal asks for it: 84mm, 174mm; letters are 8
      pt at that size
    * `export`: Write every sample as it was read, as CSV or NumPy array (by its ending); one
      recording only
    * `file_format`: Format, whatever the first bytes say: text, lvm, tdms, mat, hdf5, wav, uff58,
      sigrok, xlsx, ods, npy, zip
    * `separator`: Between the cells of a text: comma, semicolon, tab, bar or blanks
    * `decimal`: Before decimals: point or comma
    * `thousands`: Between groups of three digits: point, comma, apostrophe or space
    * `encoding`: Encoding of a text: utf-8, windows-1252, utf-16le or utf-16be
    * `header_line`: Line with the names of the columns, from 1; 0 if there is none
    * `comment`: Beginning of lines that are passed over
    * `missing`: A word or number that stands for a missing sample, beside the usual words (NaN,
      N/A, OVLD, …); may be repeated
    * `footer`: Lines at the end of a text that are not rows of numbers [default: 0]
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "inspect",
        [files],
        {
            "--preset": preset,
            "--presets": presets,
            "--channel": channel,
            "--plot": plot,
            "--width": width,
            "--export": export,
            "--file-format": file_format,
            "--separator": separator,
            "--decimal": decimal,
            "--thousands": thousands,
            "--encoding": encoding,
            "--header-line": header_line,
            "--comment": comment,
            "--missing": missing,
            "--footer": footer,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def fit_campaign(
    directory: Path | None = None,
    *,
    law: Value | Sequence[Value] | None = None,
    laws: Path | None = None,
    free: Value | Sequence[Value] | None = None,
    prior: Value | Sequence[Value] | None = None,
    bounds: Value | Sequence[Value] | None = None,
    quantities: Value | Sequence[Value] | None = None,
    weights: Literal["inverse-variance", "inverse-mean"] | None = None,
    noise: Literal["automatic", "white"] | None = None,
    noise_sd: Value | Sequence[Value] | None = None,
    intervals: Literal["asymptotic", "profile", "bootstrap", "posterior"] | None = None,
    replicates: int | None = None,
    draws: int | None = None,
    seed: int | None = None,
    onset: Literal["auto", "free", "fixed"] | None = None,
    initial_velocity: Value | None = None,
    displacement_offset: Literal["auto", "free", "fixed"] | None = None,
    end: Literal["force-zero", "gap-zero"] | None = None,
    group: Value | None = None,
    joint: bool = False,
    refit: bool = False,
    figures: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    detail: Path | None = None,
    card: Path | None = None,
    threads: int | None = None,
    out: Path | None = None,
    shard: Value | None = None,
    only: Path | None = None,
    rig: Literal["pendulum", "carriage"] | None = None,
    inertia: Value | None = None,
    arm: Value | None = None,
    mass: Value | None = None,
    centre_of_mass: Value | None = None,
    gravity: Value | None = None,
    driving_acceleration: Value | None = None,
    channel: Value | Sequence[Value] | None = None,
    time: Value | None = None,
    sampling_rate: Value | None = None,
    counts_per_revolution: float | None = None,
    count_length: Value | None = None,
    threshold: Value | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Fit force laws to the impacts of a campaign.

    The command `windfall fit`.

    * `directory`: The campaign directory, one recording of a campaign, or any recording with
      --rig [default: .]
    * `law`: Law to fit in place of those of the campaign; may be repeated
    * `laws`: File of own laws ([laws.NAME] tables) that --law can name, besides those of the
      campaign
    * `free`: Parameter to estimate although it has a value, such as an exponent; may be repeated
    * `prior`: What is known of a parameter before the data, "k=2.4e5 ± 0.3e5 N/m^1.5"; may be
      repeated
    * `bounds`: Values outside of which a parameter is not searched, "c=0 … 50 N s/m"; may be
      repeated
    * `quantities`: Quantities of the cost function: displacement, rate, force, acceleration
    * `weights`: Weights of the cost function: by each channel's noise, or 1/mean as in the 2003
      study
    * `noise`: Noise of the channels: as the recording shows it, or white sample by sample
    * `noise_sd`: Noise of a sample of a quantity, "force=0.2 N", in place of what recordings
      show; may be repeated
    * `intervals`: How the 95 % intervals are made
    * `replicates`: Resampled recordings of each impact for --intervals bootstrap (1000)
    * `draws`: Draws of each of four chains for --intervals posterior (1000)
    * `seed`: Seed of bootstrap and posterior (1)
    * `onset`: Time of first touch: fixed where the force passes its threshold, free, or as the
      data can tell
    * `initial_velocity`: Velocity at first touch: auto, free, fixed (as measured), or held at a
      value ("0.35 m/s")
    * `displacement_offset`: Zero of the displacement
    * `end`: When the contact is over
    * `group`: Column of specimens.csv or impacts.csv by which results are grouped
    * `joint`: Estimate one law for all impacts on a specimen, too
    * `refit`: Fit every impact again, even where nothing has changed
    * `figures`: Write figures into this directory: each as SVG, PNG (300 dots per inch) and its
      data as CSV
    * `theme`: Colours of the figures [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `figure_format`: Formats of the figures in place of SVG and PNG; the data are always CSV
    * `detail`: Write samples, residuals, weights, covariance and draws of each fit into this
      directory, as ID-LAW.json for arviz.from_json; fits every impact once more
    * `card`: Write the law as a law card: the median fruit, how fruit differ, and in what it was
      seen
    * `threads`: Number of threads; all cores if left out. It never changes a result
    * `out`: Write the table of results into a file, too: .csv, .parquet or .arrow
    * `shard`: Fit this part of the impacts alone, such as 3/64, and write its rows to --out as
      they come; results.sqlite is left alone
    * `only`: Fit only the impacts that a file ("-": standard input) names, an id or a recording
      in each line, and write their rows to --out as they come; results.sqlite is left alone
    * `rig`: The rig that the recording comes from
    * `inertia`: Pendulum: moment of inertia about the pivot, such as "0.01435 kg m^2"
    * `arm`: Pendulum: pivot to point of contact, such as "0.505 m"
    * `mass`: Mass of arm and impactor, or of the carriage: "0.11 kg", or "from impulse" for a
      carriage
    * `centre_of_mass`: Pendulum: pivot to centre of mass, such as "0.3 m"
    * `gravity`: Pendulum: acceleration of gravity; 9.80665 m/s^2 if left out
    * `driving_acceleration`: Carriage: acceleration towards the fruit when nothing touches; 0 if
      left out
    * `channel`: A channel: force, position, velocity, acceleration, angle, count, phase_a or
      phase_b, its column, and after a colon the unit of the column (SI if left out), what one unit
      of it stands for ("-1 N"), or the sensitivity of a sensor ("11 mV/N"); repeated
    * `time`: Column of times, in s unless a unit follows a colon
    * `sampling_rate`: Sampling rate, where there is no column of times
    * `counts_per_revolution`: Counts per revolution of a rotary encoder, after x4 decoding
    * `count_length`: Displacement per count of a linear encoder, such as "0.17 mm"
    * `threshold`: Force above which there is contact: "1 N", or "auto" (from the noise before
      contact)
    """
    return call(
        "fit",
        [directory],
        {
            "--law": law,
            "--laws": laws,
            "--free": free,
            "--prior": prior,
            "--bounds": bounds,
            "--quantities": quantities,
            "--weights": weights,
            "--noise": noise,
            "--noise-sd": noise_sd,
            "--intervals": intervals,
            "--replicates": replicates,
            "--draws": draws,
            "--seed": seed,
            "--onset": onset,
            "--initial-velocity": initial_velocity,
            "--displacement-offset": displacement_offset,
            "--end": end,
            "--group": group,
            "--joint": joint,
            "--refit": refit,
            "--figures": figures,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--detail": detail,
            "--card": card,
            "--threads": threads,
            "--out": out,
            "--shard": shard,
            "--only": only,
            "--rig": rig,
            "--inertia": inertia,
            "--arm": arm,
            "--mass": mass,
            "--centre-of-mass": centre_of_mass,
            "--gravity": gravity,
            "--driving-acceleration": driving_acceleration,
            "--channel": channel,
            "--time": time,
            "--sampling-rate": sampling_rate,
            "--counts-per-revolution": counts_per_revolution,
            "--count-length": count_length,
            "--threshold": threshold,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def laws(
    directory: Path | None = None,
    *,
    law: Value | Sequence[Value] | None = None,
    free: Value | Sequence[Value] | None = None,
    quantities: Value | Sequence[Value] | None = None,
    figures: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    refit: bool = False,
    threads: int | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Compare force laws: which one the impacts of a campaign obey, and how sure that is.

    The command `windfall laws`.

    * `directory`: The campaign directory [default: .]
    * `law`: A law to compare; may be repeated. None: the campaign's, if it names two or more,
      else one of each form
    * `free`: A parameter to estimate although it has a usual value; may be repeated
    * `quantities`: Quantities in the cost function in place of the campaign's
    * `figures`: Write figures into this directory: each as SVG, PNG (300 dots per inch) and its
      data as CSV
    * `theme`: Colours of the figures [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `figure_format`: Formats of the figures in place of SVG and PNG; the data are always CSV
    * `refit`: Find the answer anew, even where nothing has changed since it was found
    * `threads`: Threads; all cores if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "laws",
        [directory],
        {
            "--law": law,
            "--free": free,
            "--quantities": quantities,
            "--figures": figures,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--refit": refit,
            "--threads": threads,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def population(
    directory: Path | None = None,
    *,
    covariate: Value | Sequence[Value] | None = None,
    law: Value | None = None,
    free: Value | Sequence[Value] | None = None,
    posterior: bool = False,
    draws: int | None = None,
    seed: int | None = None,
    detail: Path | None = None,
    card: Path | None = None,
    refit: bool = False,
    threads: int | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Estimate how the law varies between fruit and with covariates.

    The command `windfall population`.

    * `directory`: The campaign directory [default: .]
    * `covariate`: Column, log(column) or impact_velocity that the parameters may depend on; may
      be repeated
    * `law`: Law in place of the campaign's
    * `free`: Parameter to estimate although it has a value, such as an exponent; may be repeated
    * `posterior`: Draw the posterior beside the estimate, as a check; minutes for large campaigns
    * `draws`: Draws of each of four chains for --posterior (1000)
    * `seed`: Seed of the posterior's draws (1)
    * `detail`: Write the posterior's draws, as JSON for arviz.from_json or as a table (.parquet,
      .arrow or .csv); draws them anew
    * `card`: Write the population as a law card (TOML, or JSON where the name ends with .json)
    * `refit`: Find the answer anew, even where nothing has changed since it was found
    * `threads`: Number of threads; all cores if left out. It never changes a result
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "population",
        [directory],
        {
            "--covariate": covariate,
            "--law": law,
            "--free": free,
            "--posterior": posterior,
            "--draws": draws,
            "--seed": seed,
            "--detail": detail,
            "--card": card,
            "--refit": refit,
            "--threads": threads,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def report(
    directory: Path | None = None,
    *,
    out: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    law: Value | Sequence[Value] | None = None,
    free: Value | Sequence[Value] | None = None,
    intervals: Literal["asymptotic", "profile", "bootstrap", "posterior"] | None = None,
    group: Value | None = None,
    threads: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Write figures, tables and a page on a campaign: methods, results, findings, origin.

    The command `windfall report`.

    * `directory`: The campaign directory [default: .]
    * `out`: Directory to write into in place of DIR/report
    * `theme`: Colours of the files of figures; the page follows the reader's setting [default:
      light]
    * `width`: Width of the files of figures in print, as a journal asks for it: 84mm, 174mm;
      letters are 8 pt at that size
    * `figure_format`: Formats of the files of figures in place of SVG and PNG
    * `law`: Law to fit in place of those of the campaign; may be repeated
    * `free`: Parameter to estimate although it has a value; may be repeated
    * `intervals`: How the 95 % intervals are made
    * `group`: Column of specimens.csv or impacts.csv by which results are grouped
    * `threads`: Number of threads; all cores if left out. It never changes a result
    """
    return call(
        "report",
        [directory],
        {
            "--out": out,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--law": law,
            "--free": free,
            "--intervals": intervals,
            "--group": group,
            "--threads": threads,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def calibrate(
    directory: Path | None = None,
    *,
    way: Literal["waveform", "features", "design"] | Sequence[Literal["waveform", "features", "design"]] | None = None,
    figures: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    tables: Table | None = None,
    card: Path | None = None,
    profile: bool = False,
    threads: int | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Calibrate a contact law to dropped fruit: by features, and by design and surface.

    The command `windfall calibrate`.

    * `directory`: The campaign directory [default: .]
    * `way`: Ways to calibrate in place of the campaign's; may be repeated
    * `figures`: Write figures into this directory: each as SVG, PNG (300 dots per inch) and its
      data as CSV
    * `theme`: Colours of the figures [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `figure_format`: Formats of the figures in place of SVG and PNG; the data are always CSV
    * `tables`: Write all tables as CSV and text into this directory
    * `card`: Write the calibrated law as a law card
    * `profile`: Intervals from the profile of the sum of squares, which takes longer, in place of
      ±1.96 sd
    * `threads`: Threads; all cores if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "calibrate",
        [directory],
        {
            "--way": way,
            "--figures": figures,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--tables": tables,
            "--card": card,
            "--profile": profile,
            "--threads": threads,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_mean(
    *,
    difference: float | None = None,
    sd: Value | None = None,
    between: Value | None = None,
    within: Value | None = None,
    from_: Table | None = None,
    formula: Value | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A mean: half-width of its interval, or its difference from a reference.

    The command `windfall plan mean`.

    * `difference`: Difference from a reference that the mean is tested against
    * `sd`: Standard deviation of one value for each fruit; two for groups that differ: 12,15
    * `between`: Standard deviation between fruit
    * `within`: Standard deviation between the impacts of a fruit
    * `from_`: Table of earlier impacts (CSV) whose mixed model, --formula, tells both
    * `formula`: Mixed model of that table: 'k ~ V + (1 | fruit)'
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan mean",
        [],
        {
            "--difference": difference,
            "--sd": sd,
            "--between": between,
            "--within": within,
            "--from": from_,
            "--formula": formula,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_difference(
    *,
    difference: float | None = None,
    ratio: float | None = None,
    pooled: bool = False,
    same_fruit: bool = False,
    effect_sd: float | None = None,
    sd: Value | None = None,
    between: Value | None = None,
    within: Value | None = None,
    from_: Table | None = None,
    formula: Value | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A difference between two groups of fruit, or between two treatments of the same fruit.

    The command `windfall plan difference`.

    * `difference`: Difference of the means that is to be found
    * `ratio`: Fruit in the second group for each in the first [default: 1]
    * `pooled`: One variance for both groups with --sd (Student's t test), in place of Welch's
    * `same_fruit`: Every fruit gets both treatments, --impacts of each; --sd is then that of the
      differences
    * `effect_sd`: Standard deviation between fruit of the difference itself, with --same-fruit
    * `sd`: Standard deviation of one value for each fruit; two for groups that differ: 12,15
    * `between`: Standard deviation between fruit
    * `within`: Standard deviation between the impacts of a fruit
    * `from_`: Table of earlier impacts (CSV) whose mixed model, --formula, tells both
    * `formula`: Mixed model of that table: 'k ~ V + (1 | fruit)'
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan difference",
        [],
        {
            "--difference": difference,
            "--ratio": ratio,
            "--pooled": pooled,
            "--same-fruit": same_fruit,
            "--effect-sd": effect_sd,
            "--sd": sd,
            "--between": between,
            "--within": within,
            "--from": from_,
            "--formula": formula,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_groups(
    *,
    means: Value,
    same_fruit: bool = False,
    sd: Value | None = None,
    between: Value | None = None,
    within: Value | None = None,
    from_: Table | None = None,
    formula: Value | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Differences between the means of several groups.

    The command `windfall plan groups`.

    * `means`: Means of the groups, whose differences are to be found: 10,12,15
    * `same_fruit`: Every fruit gets every treatment, --impacts of each
    * `sd`: Standard deviation of one value for each fruit; two for groups that differ: 12,15
    * `between`: Standard deviation between fruit
    * `within`: Standard deviation between the impacts of a fruit
    * `from_`: Table of earlier impacts (CSV) whose mixed model, --formula, tells both
    * `formula`: Mixed model of that table: 'k ~ V + (1 | fruit)'
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan groups",
        [],
        {
            "--means": means,
            "--same-fruit": same_fruit,
            "--sd": sd,
            "--between": between,
            "--within": within,
            "--from": from_,
            "--formula": formula,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_slope(
    *,
    slope: float | None = None,
    x: Value | None = None,
    spread_x: float | None = None,
    same_fruit: bool = False,
    effect_sd: float | None = None,
    sd: Value | None = None,
    between: Value | None = None,
    within: Value | None = None,
    from_: Table | None = None,
    formula: Value | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A slope on a property of the fruit, or on what changes between the impacts of a fruit.

    The command `windfall plan slope`.

    * `slope`: Slope that is to be found
    * `x`: Values of x, each as often as the others: 0.1,0.3,0.5
    * `spread_x`: Standard deviation of x, where its values are not chosen: x as they fall, normal
      with this standard deviation; with --same-fruit that of the x of every fruit
    * `same_fruit`: x changes from impact to impact of every fruit (velocity), not from fruit to
      fruit (firmness)
    * `effect_sd`: Standard deviation between fruit of the slope itself, with --same-fruit
    * `sd`: Standard deviation of one value for each fruit; two for groups that differ: 12,15
    * `between`: Standard deviation between fruit
    * `within`: Standard deviation between the impacts of a fruit
    * `from_`: Table of earlier impacts (CSV) whose mixed model, --formula, tells both
    * `formula`: Mixed model of that table: 'k ~ V + (1 | fruit)'
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan slope",
        [],
        {
            "--slope": slope,
            "--x": x,
            "--spread-x": spread_x,
            "--same-fruit": same_fruit,
            "--effect-sd": effect_sd,
            "--sd": sd,
            "--between": between,
            "--within": within,
            "--from": from_,
            "--formula": formula,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_model(
    table: Table,
    *,
    formula: Value,
    term: Value | None = None,
    effect: Value | Sequence[Value] | None = None,
    simulations: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A term of a mixed model of earlier impacts, by simulation.

    The command `windfall plan model`.

    * `table`: Table of earlier impacts (CSV), whose rows are the layout of the study
    * `formula`: Mixed model of that table: 'k ~ V + variety + (1 + V | fruit)'
    * `term`: Term that is to be found; the only one if left out
    * `effect`: Coefficient that is taken in place of the fitted one: V=-0.3; may be repeated
    * `simulations`: Simulated studies of each size [default: 1000]
    * `seed`: Seed of the simulations [default: 1]
    * `threads`: Number of threads; all cores if left out. It never changes a result
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan model",
        [table],
        {
            "--formula": formula,
            "--term": term,
            "--effect": effect,
            "--simulations": simulations,
            "--seed": seed,
            "--threads": threads,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_surface(
    table: Table,
    *,
    response: Value | None = None,
    coefficients: Value | None = None,
    model: Value | None = None,
    factor: Value | Sequence[Value] | None = None,
    range: Value | Sequence[Value] | None = None,
    sd: Value | None = None,
    between: Value | None = None,
    within: Value | None = None,
    from_: Table | None = None,
    formula: Value | None = None,
    simulations: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """The optimum of a response surface: the response there, and where it lies.

    The command `windfall plan surface`.

    * `table`: Table of runs (CSV), as `windfall design` writes it
    * `response`: A column of earlier responses, whose surface is taken for the truth
    * `coefficients`: The surface itself, coefficients of coded terms: 'A=1, A^2=-2, B^2=-1';
      those left out are zero
    * `model`: The model that is to be fitted [default: quadratic]
    * `factor`: A factor; repeated in the order of the letters A, B, C …; as the header of a
      design says if left out
    * `range`: Actual values of coded -1 and 1 of a factor: k=0.44..0.86; may be repeated
    * `sd`: Standard deviation of one value for each fruit; two for groups that differ: 12,15
    * `between`: Standard deviation between fruit
    * `within`: Standard deviation between the impacts of a fruit
    * `from_`: Table of earlier impacts (CSV) whose mixed model, --formula, tells both
    * `formula`: Mixed model of that table: 'k ~ V + (1 | fruit)'
    * `simulations`: Simulated studies of each size [default: 1000]
    * `seed`: Seed of the simulations [default: 1]
    * `threads`: Number of threads; all cores if left out. It never changes a result
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan surface",
        [table],
        {
            "--response": response,
            "--coefficients": coefficients,
            "--model": model,
            "--factor": factor,
            "--range": range,
            "--sd": sd,
            "--between": between,
            "--within": within,
            "--from": from_,
            "--formula": formula,
            "--simulations": simulations,
            "--seed": seed,
            "--threads": threads,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_population(
    card: Path,
    *,
    parameter: Value,
    within: float | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A parameter of a population of laws: its median, and its spread between fruit.

    The command `windfall plan population`.

    * `card`: Law card with a population, as `windfall population DIR --card FILE` writes it
    * `parameter`: Parameter of the law
    * `within`: Standard deviation between the impacts of a fruit, in the unit of the card's
      covariance (0.05 of a logarithm is 5 %); that of the card if left out
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan population",
        [card],
        {
            "--parameter": parameter,
            "--within": within,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_critical_energy(
    *,
    median: float,
    spread: float,
    energies: Value,
    weibull: bool = False,
    simulations: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    fruit: Value | None = None,
    impacts: Value | None = None,
    power: float | None = None,
    half_width: float | None = None,
    assurance: float | None = None,
    confidence: float | None = None,
    one_sided: bool = False,
    most_fruit: int | None = None,
    cost_fruit: float | None = None,
    cost_impact: float | None = None,
    budget: float | None = None,
    figure: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """The critical impact energy, by simulation.

    The command `windfall plan critical-energy`.

    * `median`: Energy that half the fruit stand, expected
    * `spread`: Standard deviation between fruit of the logarithm of the critical energy (0.3 is
      about 30 %); of a Weibull distribution 1/shape
    * `energies`: Energies at which every fruit is struck, rising, until it changes:
      0.05,0.1,0.2,0.4
    * `weibull`: The distribution is Weibull's, not log-normal
    * `simulations`: Simulated studies of each size [default: 1000]
    * `seed`: Seed of the simulations [default: 1]
    * `threads`: Number of threads; all cores if left out. It never changes a result
    * `fruit`: Fruit: 12, or 6,12,24, or 6..60; looked for from the smallest number up if left
      out. In each group, where there are groups
    * `impacts`: Impacts on each fruit: 1, or 1,2,4,8
    * `power`: Wanted probability of finding the effect
    * `half_width`: Wanted half-width of the interval, in the unit of what is measured
    * `assurance`: Probability with which the interval is as narrow as wanted; its mean is, if
      left out
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `one_sided`: Test for an effect in the expected direction alone
    * `most_fruit`: Most fruit (in each group) that are tried [default: 1000]
    * `cost_fruit`: What a fruit costs before it is struck
    * `cost_impact`: What an impact costs
    * `budget`: What the study may cost
    * `figure`: Draw power or half-width against the number of fruit (SVG, PNG or PDF, by its
      ending), with its data (CSV, same name)
    * `theme`: Colours of the figure [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan critical-energy",
        [],
        {
            "--median": median,
            "--spread": spread,
            "--energies": energies,
            "--weibull": weibull,
            "--simulations": simulations,
            "--seed": seed,
            "--threads": threads,
            "--fruit": fruit,
            "--impacts": impacts,
            "--power": power,
            "--half-width": half_width,
            "--assurance": assurance,
            "--confidence": confidence,
            "--one-sided": one_sided,
            "--most-fruit": most_fruit,
            "--cost-fruit": cost_fruit,
            "--cost-impact": cost_impact,
            "--budget": budget,
            "--figure": figure,
            "--theme": theme,
            "--width": width,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def plan_achieved(
    table: Table,
    *,
    formula: Value,
    means: Value | Sequence[Value] | None = None,
    power: float | None = None,
    confidence: float | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Look back: what a finished table has achieved, and what more or fewer fruit would have.

    The command `windfall plan achieved`.

    * `table`: Table of impacts (CSV)
    * `formula`: Its mixed model: 'k ~ V + variety + (1 | fruit)'
    * `means`: Marginal means of a category, or of several, as in `windfall regress`; may be
      repeated
    * `power`: Power with which the detectable effects are found [default: 0.8]
    * `confidence`: Level of the intervals; tests are made at 1 minus it [default: 0.95]
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "plan achieved",
        [table],
        {
            "--formula": formula,
            "--means": means,
            "--power": power,
            "--confidence": confidence,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_factorial(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    points: int | None = None,
    fraction: Value | None = None,
    runs: int | None = None,
    replicates: int | None = None,
    centre: int | None = None,
    blocks: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """All combinations of levels, or a two-level fraction of them.

    The command `windfall design factorial`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `points`: Levels of each range [default: 2]
    * `fraction`: Generators 'D=AB, E=AC', or 1/2, 1/4 … for the fraction of least aberration
    * `runs`: Runs of the fraction of least aberration, instead of --fraction
    * `replicates`: Runs of every combination [default: 1]
    * `centre`: Centre points in each block, at each combination of categories [default: 0]
    * `blocks`: Blocks of a two-level design: 2, 4, 8 … [default: 1]
    """
    return call(
        "design factorial",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--points": points,
            "--fraction": fraction,
            "--runs": runs,
            "--replicates": replicates,
            "--centre": centre,
            "--blocks": blocks,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_plackett_burman(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    runs: int | None = None,
    centre: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Main effects of many factors in few runs.

    The command `windfall design plackett-burman`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `runs`: Runs, a multiple of 4; the smallest number if left out
    * `centre`: Centre points at each combination of categories [default: 0]
    """
    return call(
        "design plackett-burman",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--runs": runs,
            "--centre": centre,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_ccd(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    alpha: Value | None = None,
    levels: Value | None = None,
    fraction: Value | None = None,
    centre: Value | None = None,
    blocks: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Central composite: cube, axial points, centre; for a quadratic model.

    The command `windfall design ccd`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `alpha`: rotatable, face, spherical, orthogonal, blocks, or a number of half-ranges;
      rotatable if left out, with blocks the one that keeps them out of the model
    * `levels`: What LOW and HIGH of the factors are: corners of the cube (factorial) or axial
      points (axial) [default: factorial]
    * `fraction`: Fraction of the cube: 'E=ABCD', or 1/2
    * `centre`: Centre points; with blocks in each, or 'CUBE,AXIAL'; 5 if left out, 2 in each
      block
    * `blocks`: Blocks: 2 (cube, axial points), 3, 5 or 9 (the cube divided) [default: 1]
    """
    return call(
        "design ccd",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--alpha": alpha,
            "--levels": levels,
            "--fraction": fraction,
            "--centre": centre,
            "--blocks": blocks,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_box_behnken(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    centre: int | None = None,
    blocks: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Three levels without corners, 3 to 7 factors; for a quadratic model.

    The command `windfall design box-behnken`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `centre`: Centre points in each block; 5 if left out, 2 with blocks
    * `blocks`: Blocks: 3 for four factors, 2 for five to seven [default: 1]
    """
    return call(
        "design box-behnken",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--centre": centre,
            "--blocks": blocks,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_latin_hypercube(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    runs: int,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Levels each used once, points far apart; for computer experiments.

    The command `windfall design latin-hypercube`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `runs`: Runs
    """
    return call(
        "design latin-hypercube",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--runs": runs,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_sobol(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    runs: int,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Sobol points: fill the space evenly, more can be added.

    The command `windfall design sobol`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `runs`: Runs
    """
    return call(
        "design sobol",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--runs": runs,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_d_optimal(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    runs: int,
    candidates: Table | None = None,
    augment: Table | None = None,
    model: Value | None = None,
    points: int | None = None,
    starts: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Best for the coefficients of a given model.

    The command `windfall design d-optimal`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `runs`: New runs
    * `candidates`: Choose from the rows of this table, with a column for each factor
    * `augment`: Runs already made, which are kept; a column for each factor
    * `model`: linear, 2fi, quadratic, or a formula in names or letters; factors stand for their
      coded values [default: quadratic]
    * `points`: Levels of each range to choose from; what the model needs if left out
    * `starts`: Random starts; as many as take seconds if left out
    """
    return call(
        "design d-optimal",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--runs": runs,
            "--candidates": candidates,
            "--augment": augment,
            "--model": model,
            "--points": points,
            "--starts": starts,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_i_optimal(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    runs: int,
    candidates: Table | None = None,
    augment: Table | None = None,
    model: Value | None = None,
    points: int | None = None,
    starts: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Best for the predictions of a given model.

    The command `windfall design i-optimal`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `runs`: New runs
    * `candidates`: Choose from the rows of this table, with a column for each factor
    * `augment`: Runs already made, which are kept; a column for each factor
    * `model`: linear, 2fi, quadratic, or a formula in names or letters; factors stand for their
      coded values [default: quadratic]
    * `points`: Levels of each range to choose from; what the model needs if left out
    * `starts`: Random starts; as many as take seconds if left out
    """
    return call(
        "design i-optimal",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--runs": runs,
            "--candidates": candidates,
            "--augment": augment,
            "--model": model,
            "--points": points,
            "--starts": starts,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def design_split_plot(
    *,
    factor: Value | Sequence[Value] | None = None,
    decimals: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    order: Literal["random", "standard"] | None = None,
    out: Path | None = None,
    hard: Value | Sequence[Value],
    whole_plots: int,
    runs: int,
    ratio: float | None = None,
    criterion: Literal["d", "i"] | None = None,
    model: Value | None = None,
    points: int | None = None,
    starts: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Whole plots of runs for factors that are hard to change; best for a given model.

    The command `windfall design split-plot`.

    * `factor`: 'NAME=LOW..HIGH UNIT', 'NAME=1, 2, 5 UNIT' or 'NAME=category, category'; A, B, C …
      in this order
    * `decimals`: Print the settings of a factor with so many decimals; coded values stay exact
    * `seed`: Seed of the run order and of all that is drawn [default: 1]
    * `order`: Order of the runs, within blocks [default: random]
    * `out`: Write the design to this file (CSV), and show it as text
    * `hard`: A factor that is hard to change, set once for each whole plot; may be repeated
    * `whole_plots`: Whole plots: how often the hard-to-change factors are set
    * `runs`: Runs of all whole plots
    * `ratio`: Expected variance between whole plots over that within [default: 1]
    * `criterion`: What is made good: the coefficients (d), or the predictions (i) [default: d]
    * `model`: linear, 2fi, quadratic, or a formula in names or letters; factors stand for their
      coded values [default: quadratic]
    * `points`: Levels of each range to choose from; what the model needs if left out
    * `starts`: Random starts; as many as take seconds if left out
    """
    return call(
        "design split-plot",
        [],
        {
            "--factor": factor,
            "--decimals": decimals,
            "--seed": seed,
            "--order": order,
            "--out": out,
            "--hard": hard,
            "--whole-plots": whole_plots,
            "--runs": runs,
            "--ratio": ratio,
            "--criterion": criterion,
            "--model": model,
            "--points": points,
            "--starts": starts,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def simulate_impact(
    *,
    law: Value,
    laws: Path | None = None,
    mass: Value,
    velocity: Value | None = None,
    height: Value | None = None,
    driving_acceleration: Value | None = None,
    end: Literal["force-zero", "gap-zero"] | None = None,
    plot: Path | None = None,
    width: Value | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A free body strikes once: peaks, duration, restitution, energy.

    The command `windfall simulate impact`.

    * `law`: Force law with its parameters, or a law card (FILE.toml)
    * `laws`: File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    * `mass`: Effective mass, such as "0.2 kg"
    * `velocity`: Impact velocity, such as "0.5 m/s"
    * `height`: Fall from this height in the place of an impact velocity, such as "0.5 m"
    * `driving_acceleration`: Acceleration towards the fruit before and during contact, such as
      "9.81 m/s^2" [default: 0 m/s^2, and 9.80665 m/s^2 with --height]
    * `end`: When the contact is over [default: force-zero]
    * `plot`: Write a figure of the impact, loop and force over time (SVG, PNG or PDF, by its
      ending), and its data (CSV, same name)
    * `width`: Width of the figure in print, as a journal asks for it: 84mm, 174mm; letters are 8
      pt at that size
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "simulate impact",
        [],
        {
            "--law": law,
            "--laws": laws,
            "--mass": mass,
            "--velocity": velocity,
            "--height": height,
            "--driving-acceleration": driving_acceleration,
            "--end": end,
            "--plot": plot,
            "--width": width,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def simulate_pendulum(
    *,
    law: Value | None = None,
    laws: Path | None = None,
    example: Path | None = None,
    recordings: Path | None = None,
    specimens: int | None = None,
    repeats: int | None = None,
    spread: Value | Sequence[Value] | None = None,
    inertia: Value | None = None,
    arm: Value | None = None,
    mass: Value | None = None,
    centre_of_mass: Value | None = None,
    velocity: Value | None = None,
    rate: Value | None = None,
    encoder: Literal["phases", "counts"] | None = None,
    counts_per_revolution: float | None = None,
    sensitivity: Value | None = None,
    noise: Value | None = None,
    bits: int | None = None,
    range: Value | None = None,
    end: Literal["force-zero", "gap-zero"] | None = None,
    seed: int | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A pendulum strikes: motion, or a campaign of recordings.

    The command `windfall simulate pendulum`.

    * `law`: Force law with its parameters, or a law card (FILE.toml)
    * `laws`: File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    * `example`: Write the example campaign into this directory
    * `recordings`: Write a campaign of recordings into this directory
    * `specimens`: Number of specimens of the campaign [default: 20]
    * `repeats`: Impacts on each specimen [default: 1]
    * `spread`: Standard deviation of a parameter between specimens, such as k=133165
    * `inertia`: Moment of inertia about the pivot [default: 0.01435 kg m^2]
    * `arm`: Pivot to point of contact [default: 0.505 m]
    * `mass`: Mass of arm and impactor [default: 0.11 kg]
    * `centre_of_mass`: Pivot to centre of mass [default: 0.3 m]
    * `velocity`: Impact velocity [default: 0.388 m/s]
    * `rate`: Sampling rate [default: 200 kHz]
    * `encoder`: What the encoder writes into the recordings: phases A and B, or decoded counts
      [default: phases]
    * `counts_per_revolution`: Resolution of the encoder after x4 decoding [default: 360000]
    * `sensitivity`: Sensitivity of the force sensor [default: 11 mV/N]
    * `noise`: Standard deviation of the force noise of the recordings [default: 1 N]
    * `bits`: Resolution of the analogue-to-digital converter; no rounding if left out
    * `range`: Largest voltage of the converter, of either sign; beyond it the force is clipped
      [default: 10 V]
    * `end`: When the contact is over [default: force-zero]
    * `seed`: Seed of specimens and noise [default: 1]
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "simulate pendulum",
        [],
        {
            "--law": law,
            "--laws": laws,
            "--example": example,
            "--recordings": recordings,
            "--specimens": specimens,
            "--repeats": repeats,
            "--spread": spread,
            "--inertia": inertia,
            "--arm": arm,
            "--mass": mass,
            "--centre-of-mass": centre_of_mass,
            "--velocity": velocity,
            "--rate": rate,
            "--encoder": encoder,
            "--counts-per-revolution": counts_per_revolution,
            "--sensitivity": sensitivity,
            "--noise": noise,
            "--bits": bits,
            "--range": range,
            "--end": end,
            "--seed": seed,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def simulate_carriage(
    *,
    law: Value,
    laws: Path | None = None,
    mass: Value,
    velocity: Value,
    driving_acceleration: Value | None = None,
    rate: Value | None = None,
    recordings: Path | None = None,
    sensor: Value | Sequence[Value] | None = None,
    unweighed: bool = False,
    specimens: int | None = None,
    repeats: int | None = None,
    spread: Value | Sequence[Value] | None = None,
    seed: int | None = None,
    end: Literal["force-zero", "gap-zero"] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A body on a line strikes: motion, or a campaign of recordings.

    The command `windfall simulate carriage`.

    * `law`: Force law with its parameters, or a law card (FILE.toml)
    * `laws`: File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    * `mass`: Mass of the body
    * `velocity`: Impact velocity
    * `driving_acceleration`: Acceleration towards the fruit [default: 0 m/s^2]
    * `rate`: Sampling rate of the motion; recordings have the rates of their sensors [default:
      200 kHz]
    * `recordings`: Write a campaign of recordings into this directory
    * `sensor`: A sensor of the recordings: force, position, velocity or acceleration, then after
      a colon any of rate, noise, sensitivity, offset, bits, range; or an encoder, count or phases,
      with length and rate; repeated. Force and position at 10 kHz if left out
    * `unweighed`: Leave the mass out of the campaign, so that fit finds it from impulse
    * `specimens`: Number of specimens of the campaign [default: 20]
    * `repeats`: Impacts on each specimen [default: 1]
    * `spread`: Standard deviation of a parameter between specimens, such as k=133165
    * `seed`: Seed of specimens and noise [default: 1]
    * `end`: When the contact is over [default: force-zero]
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "simulate carriage",
        [],
        {
            "--law": law,
            "--laws": laws,
            "--mass": mass,
            "--velocity": velocity,
            "--driving-acceleration": driving_acceleration,
            "--rate": rate,
            "--recordings": recordings,
            "--sensor": sensor,
            "--unweighed": unweighed,
            "--specimens": specimens,
            "--repeats": repeats,
            "--spread": spread,
            "--seed": seed,
            "--end": end,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def simulate_compression(
    directory: Path,
    *,
    law: Value,
    laws: Path | None = None,
    rate: Value | Sequence[Value] | None = None,
    deformation: Value | None = None,
    radius: Value | None = None,
    plates: int | None = None,
    yield_force: Value | None = None,
    fruit: int | None = None,
    spread: float | None = None,
    force_noise: Value | None = None,
    sampling_rate: Value | None = None,
    seed: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Slow compressions: a campaign of recordings.

    The command `windfall simulate compression`.

    * `directory`: Directory of the campaign to make; it must not exist or be empty
    * `law`: Force law of the crosshead's travel, with its parameters
    * `laws`: File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    * `rate`: Rate of deformation; may be repeated: every fruit is compressed at each [default: 1
      mm/s]
    * `deformation`: Largest deformation [default: 2 mm]
    * `radius`: Radius of the fruit [default: 38 mm]
    * `plates`: Plates that deform the fruit: 1 or 2 [default: 2]
    * `yield_force`: Force at which the tissue yields; never if left out
    * `fruit`: Number of fruit [default: 3]
    * `spread`: Spread of stiffness and damping between fruit, as a part [default: 0]
    * `force_noise`: Standard deviation of the noise of force [default: 0.02 N]
    * `sampling_rate`: Sampling rate [default: 1 kHz]
    * `seed`: Seed of noise and spread [default: 1]
    """
    return call(
        "simulate compression",
        [directory],
        {
            "--law": law,
            "--laws": laws,
            "--rate": rate,
            "--deformation": deformation,
            "--radius": radius,
            "--plates": plates,
            "--yield-force": yield_force,
            "--fruit": fruit,
            "--spread": spread,
            "--force-noise": force_noise,
            "--sampling-rate": sampling_rate,
            "--seed": seed,
        },
        json=False,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def simulate_tap(
    directory: Path,
    *,
    frequency: Value | None = None,
    quality: float | None = None,
    mass: Value | None = None,
    fruit: int | None = None,
    taps: int | None = None,
    spread: float | None = None,
    split: float | None = None,
    signal_to_noise: float | None = None,
    file: Value | None = None,
    sampling_rate: Value | None = None,
    seed: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Taps on fruit: a campaign of sound recordings.

    The command `windfall simulate tap`.

    * `directory`: Directory of the campaign to make; it must not exist or be empty
    * `frequency`: Frequency of the first mode [default: 800 Hz]
    * `quality`: Its quality: frequency over width of the peak [default: 20]
    * `mass`: Mass of a fruit [default: 0.2 kg]
    * `fruit`: Number of fruit [default: 6]
    * `taps`: Taps in a recording; each fruit has a recording at each of two places [default: 2]
    * `spread`: Spread of frequency and mass between fruit, as a part [default: 0.08]
    * `split`: Distance of the two frequencies of a split mode, as a part; 0 for spheres [default:
      0]
    * `signal_to_noise`: Signal over noise, in power over the first 50 ms of a tap; dB [default:
      30]
    * `file`: Format of the recordings: wav or csv [default: wav]
    * `sampling_rate`: Sampling rate [default: 44100 Hz]
    * `seed`: Seed of noise and spread [default: 1]
    """
    return call(
        "simulate tap",
        [directory],
        {
            "--frequency": frequency,
            "--quality": quality,
            "--mass": mass,
            "--fruit": fruit,
            "--taps": taps,
            "--spread": spread,
            "--split": split,
            "--signal-to-noise": signal_to_noise,
            "--file": file,
            "--sampling-rate": sampling_rate,
            "--seed": seed,
        },
        json=False,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def simulate_repeats(
    directory: Path,
    *,
    fruit: int | None = None,
    energy: Value | Sequence[Value] | None = None,
    repeats: int | None = None,
    spots: Literal["same", "fresh"] | None = None,
    critical_energy: Value | None = None,
    spread: float | None = None,
    mass: Value | None = None,
    force_noise: Value | None = None,
    velocity_scatter: float | None = None,
    sampling_rate: Value | None = None,
    seed: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Drops repeated on one spot of fruit with a critical energy: a campaign of recordings.

    The command `windfall simulate repeats`.

    * `directory`: Directory of the campaign to make; it must not exist or be empty
    * `fruit`: Number of fruit; an elastic ball is added as reference [default: 12]
    * `energy`: Impact energy; may be repeated [default: 0.04 J, 0.056 J, 0.08 J, 0.11 J, 0.16 J,
      0.22 J, 0.31 J]
    * `repeats`: Impacts on the spot at each energy [default: 2]
    * `spots`: Where the impacts of the next energy fall: on the same spot, or on a fresh one
      [default: same]
    * `critical_energy`: Median critical energy of the fruit [default: 0.12 J]
    * `spread`: Standard deviation of the logarithm of the critical energy between fruit [default:
      0.3]
    * `mass`: Mass that falls [default: 200 g]
    * `force_noise`: Standard deviation of the noise of force [default: 0.3 N]
    * `velocity_scatter`: Relative standard deviation of the impact velocity from drop to drop
      [default: 0.003]
    * `sampling_rate`: Sampling rate [default: 50 kHz]
    * `seed`: Seed of fruit and noise [default: 1]
    """
    return call(
        "simulate repeats",
        [directory],
        {
            "--fruit": fruit,
            "--energy": energy,
            "--repeats": repeats,
            "--spots": spots,
            "--critical-energy": critical_energy,
            "--spread": spread,
            "--mass": mass,
            "--force-noise": force_noise,
            "--velocity-scatter": velocity_scatter,
            "--sampling-rate": sampling_rate,
            "--seed": seed,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def simulate_drop(
    directory: Path | None = None,
    *,
    law: Value,
    laws: Path | None = None,
    mass: Value,
    height: Value | Sequence[Value],
    plate_mass: Value | None = None,
    plate_stiffness: Value | None = None,
    plate_damping: Value | None = None,
    effective_mass_factor: float | None = None,
    gravity: Value | None = None,
    impacts: int | None = None,
    end: Literal["force-zero", "gap-zero"] | None = None,
    sampling_rate: Value | None = None,
    duration: Value | None = None,
    offset: Value | None = None,
    radius: Value | None = None,
    offset_angle: Value | None = None,
    semi_axes: Value | None = None,
    tilt: Value | None = None,
    inertia: Value | None = None,
    friction: float | None = None,
    spin: Value | None = None,
    tangential_velocity: Value | None = None,
    drops: int | None = None,
    mass_spread: float | None = None,
    mass_sd: Value | None = None,
    height_sd: Value | None = None,
    spread: Value | Sequence[Value] | None = None,
    hold: Value | Sequence[Value] | None = None,
    sensitivity: Value | None = None,
    noise: Value | None = None,
    bits: int | None = None,
    range: Value | None = None,
    lowest: Value | None = None,
    seed: int | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """A fruit falls on a plate and bounces: impacts, motion, or a campaign of recordings.

    The command `windfall simulate drop`.

    * `directory`: Directory of a campaign of recordings to make; it must not exist or be empty.
      Without it, one drop is simulated and shown
    * `law`: Force law with its parameters, or a law card (FILE.toml)
    * `laws`: File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    * `mass`: Mass of the fruit, such as "4.8 g"
    * `height`: Height of its lowest point above the plate, such as "500 mm"; for a campaign,
      repeated
    * `plate_mass`: Mass of the plate and of what moves with it
    * `plate_stiffness`: Stiffness under the plate
    * `plate_damping`: Damping under the plate
    * `effective_mass_factor`: Part of its mass that the contact of the fruit feels; 1 for a
      central impact [default: 1]
    * `gravity`: Acceleration of gravity [default: 9.80665 m/s^2]
    * `impacts`: Impacts to follow [default: 2]
    * `end`: When a contact is over [default: force-zero]
    * `sampling_rate`: Sampling rate: of the motion, which is shown then in csv and json; of the
      recordings of a campaign, 10 kHz if left out
    * `duration`: Length of the motion, to a little after the last impact if left out; of each
      recording of a campaign, 1.5 s if left out
    * `offset`: Distance of the centre of mass from the centre of the fruit, such as "3.8 mm";
      with --radius
    * `radius`: Radius of the fruit
    * `offset_angle`: Direction of the offset at release, from straight down [default: 90 deg]
    * `semi_axes`: Semi-axes of an ellipse instead, such as "12 mm,9 mm"
    * `tilt`: Tilt of its first axis at release, from the horizontal [default: 0 deg]
    * `inertia`: Moment of inertia about the centre of mass, such as "1.92e-7 kg m^2"; that of a
      solid ball or ellipsoid if left out
    * `friction`: Coefficient of friction between fruit and plate [default: 0]
    * `spin`: Angular velocity at release, anticlockwise [default: 0 rad/s]
    * `tangential_velocity`: Horizontal velocity at release [default: 0 m/s]
    * `drops`: Drops from each height, of a fresh fruit each [default: 5]
    * `mass_spread`: Spread of mass between fruit, as a part [default: 0.06]
    * `mass_sd`: Standard deviation of the weighing [default: 0.02 g]
    * `height_sd`: Standard deviation of the setting of a height [default: 1 mm]
    * `spread`: Standard deviation of a parameter between fruit, such as c=0.05; repeated
    * `hold`: Parameter that campaign.toml gives, so that it is not estimated; repeated. The depth
      d of adams-impact if left out
    * `sensitivity`: Sensitivity of load cell and transmitter [default: 0.1 V/N]
    * `noise`: Standard deviation of the noise of force [default: 0.03 N]
    * `bits`: Resolution of the analogue-to-digital converter; 0 for no rounding [default: 12]
    * `range`: Largest voltage of the converter [default: 5 V]
    * `lowest`: Its lowest voltage; minus the largest if left out. At "0 V" the downward swings of
      a ringing plate are cut off
    * `seed`: Seed of fruit, heights, trigger and noise [default: 1]
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "simulate drop",
        [directory],
        {
            "--law": law,
            "--laws": laws,
            "--mass": mass,
            "--height": height,
            "--plate-mass": plate_mass,
            "--plate-stiffness": plate_stiffness,
            "--plate-damping": plate_damping,
            "--effective-mass-factor": effective_mass_factor,
            "--gravity": gravity,
            "--impacts": impacts,
            "--end": end,
            "--sampling-rate": sampling_rate,
            "--duration": duration,
            "--offset": offset,
            "--radius": radius,
            "--offset-angle": offset_angle,
            "--semi-axes": semi_axes,
            "--tilt": tilt,
            "--inertia": inertia,
            "--friction": friction,
            "--spin": spin,
            "--tangential-velocity": tangential_velocity,
            "--drops": drops,
            "--mass-spread": mass_spread,
            "--mass-sd": mass_sd,
            "--height-sd": height_sd,
            "--spread": spread,
            "--hold": hold,
            "--sensitivity": sensitivity,
            "--noise": noise,
            "--bits": bits,
            "--range": range,
            "--lowest": lowest,
            "--seed": seed,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def scene_run(
    file: Path,
    *,
    out: Path | None = None,
    threads: int | None = None,
    set: Value | Sequence[Value] | None = None,
    resume: bool = False,
    restart: bool = False,
    engine: Literal["windfall", "lammps", "liggghts"] | None = None,
    ranks: int | None = None,
    engine_program: Path | None = None,
    engine_library: Path | None = None,
    engine_frames: bool = False,
    pulses: Path | None = None,
    frames: Path | None = None,
    classes: int | None = None,
    frame_steps: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Run a scene, and write every contact and every fruit.

    The command `windfall scene run`.

    * `file`: The scene
    * `out`: Directory to write into
    * `threads`: Number of threads; all cores if left out. It never changes a result
    * `set`: Another value than the file has, such as walls.edge.material=foam (repeatable)
    * `resume`: Go on with a run that was stopped, from its last checkpoint
    * `restart`: Begin anew where a run was stopped
    * `engine`: The engine that moves the fruit [default: windfall]
    * `ranks`: For LAMMPS and LIGGGHTS: ranks of MPI [default: 1]
    * `engine_program`: For LAMMPS and LIGGGHTS: the program, if it is not on the path as lmp or
      liggghts
    * `engine_library`: For LAMMPS: its library, if it is neither beside the program nor where the
      system looks
    * `engine_frames`: For LAMMPS: read where all fruit are every few steps, and find contacts
      outside of its ranks
    * `pulses`: For LAMMPS: pulses that the ranks of an earlier run found, by the directory of its
      deck, instead of a new run
    * `frames`: For LAMMPS and LIGGGHTS: frames that an earlier run of the scene's deck wrote,
      instead of a new run
    * `classes`: For LAMMPS and LIGGGHTS: classes of size of one material at most, each with
      coefficients of its own [default: 12]
    * `frame_steps`: For LAMMPS and LIGGGHTS: steps between frames, of which contacts are made; a
      contact lasts 40 frames of LAMMPS or 80 of LIGGGHTS at least if left out
    """
    return call(
        "scene run",
        [file],
        {
            "--out": out,
            "--threads": threads,
            "--set": set,
            "--resume": resume,
            "--restart": restart,
            "--engine": engine,
            "--ranks": ranks,
            "--engine-program": engine_program,
            "--engine-library": engine_library,
            "--engine-frames": engine_frames,
            "--pulses": pulses,
            "--frames": frames,
            "--classes": classes,
            "--frame-steps": frame_steps,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def scene_study(
    file: Path,
    *,
    out: Path | None = None,
    threads: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Run variants of a scene several times each, and compare who is bruised.

    The command `windfall scene study`.

    * `file`: The study
    * `out`: Directory to write into
    * `threads`: Number of threads, over which runs are spread; all cores if left out. It never
      changes a result
    """
    return call(
        "scene study",
        [file],
        {
            "--out": out,
            "--threads": threads,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def scene_picture(
    run: Path,
    *,
    time: Value | None = None,
    from_: Value | None = None,
    largest_force: Value | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Draw a scene that has run: walls, and fruit coloured by their largest impact.

    The command `windfall scene picture`.

    * `run`: Directory that `windfall scene run` wrote into, or the scene file beside it
    * `time`: When, as "1.2 s"; the end if left out
    * `from_`: From where: azimuth from x towards y and elevation, as "-62 deg,24 deg"
    * `largest_force`: Force of the last colour, as "100 N"; the largest of the scene if left out
    * `theme`: Colours [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `out`: An .svg, .png (300 dots per inch) or .pdf; picture.svg and picture.png in RUN if left
      out
    """
    return call(
        "scene picture",
        [run],
        {
            "--time": time,
            "--from": from_,
            "--largest-force": largest_force,
            "--theme": theme,
            "--width": width,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def scene_vtk(
    run: Path,
    *,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Write the frames of a scene that has run for ParaView.

    The command `windfall scene vtk`.

    * `run`: Directory that `windfall scene run` wrote into, or the scene file beside it
    * `out`: Directory to write into; RUN/vtk if left out
    """
    return call(
        "scene vtk",
        [run],
        {
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def scene_table(
    run: Path,
    table: Literal["events", "fruit", "frames"],
    *,
    out: Path,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Write a table of a scene that has run as Parquet, Arrow or CSV.

    The command `windfall scene table`.

    * `run`: Directory that `windfall scene run` wrote into, or the scene file beside it
    * `table`: Which table; frames need [record] frames in the scene
    * `out`: File to write: .parquet, .arrow or .csv
    """
    return call(
        "scene table",
        [run, table],
        {
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def scene_export(
    file: Path,
    *,
    engine: Literal["lammps", "liggghts", "adams", "yade", "mercurydpm", "edem", "chrono"],
    speed: float | None = None,
    out: Path | None = None,
    classes: int | None = None,
    frame_steps: int | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Write a scene as a complete deck for LAMMPS or LIGGGHTS, or its contacts for others.

    The command `windfall scene export`.

    * `file`: The scene
    * `engine`: The engine
    * `speed`: For the others: impact speed in m/s at which damping that is not the law's takes as
      much energy [default: the middle of the range of the law's card, in all of which it must hold;
      1 without a card]
    * `out`: Directory to write into
    * `classes`: For LAMMPS and LIGGGHTS: classes of size of one material at most, each with
      coefficients of its own [default: 12]
    * `frame_steps`: For LAMMPS and LIGGGHTS: steps between frames, of which contacts are made; a
      contact lasts 40 frames of LAMMPS or 80 of LIGGGHTS at least if left out
    """
    return call(
        "scene export",
        [file],
        {
            "--engine": engine,
            "--speed": speed,
            "--out": out,
            "--classes": classes,
            "--frame-steps": frame_steps,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def summary(
    table: Table,
    *,
    by: Value | Sequence[Value] | None = None,
    value: Value | Sequence[Value] | None = None,
    confidence: float | None = None,
    figures: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Describe the values of a table group by group: mean, SD, CV, interval, quartiles.

    The command `windfall summary`.

    * `table`: Table with a header line (CSV, Parquet or Arrow), or a folder of Parquet files
    * `by`: Columns that group the rows, separated by commas; all rows are one group if left out
    * `value`: Column of values; may be repeated; all columns of numbers if left out
    * `confidence`: Level of the intervals of means [default: 0.95]
    * `figures`: Write figures into this directory: each as SVG, PNG (300 dots per inch) and its
      data as CSV
    * `theme`: Colours of the figures [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `figure_format`: Formats of the figures in place of SVG and PNG; the data are always CSV
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "summary",
        [table],
        {
            "--by": by,
            "--value": value,
            "--confidence": confidence,
            "--figures": figures,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def compare(
    table: Table,
    *,
    value: Value | None = None,
    by: Value | Sequence[Value] | None = None,
    paired: Value | None = None,
    specimen: Value | None = None,
    pairs: Literal["tukey", "games-howell", "holm"] | None = None,
    confidence: float | None = None,
    figures: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    measured: Value | None = None,
    predicted: Value | None = None,
    parameters: int | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Compare groups of a table, or predictions with what was measured.

    The command `windfall compare`.

    * `table`: Table with a header line (CSV, Parquet or Arrow), or a folder of Parquet files
    * `value`: Column of values [default: ]
    * `by`: Columns that group the rows, separated by commas
    * `paired`: Column of specimens that were measured in every group
    * `specimen`: Column of specimens measured several times within a group: their means are
      compared
    * `pairs`: How pairs of groups are compared [default: tukey]
    * `confidence`: Level of all intervals; letters say what differs at one less this [default:
      0.95]
    * `figures`: Write figures into this directory: each as SVG, PNG (300 dots per inch) and its
      data as CSV
    * `theme`: Colours of the figures [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `figure_format`: Formats of the figures in place of SVG and PNG; the data are always CSV
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `measured`: Column of measured values, to hold predictions against
    * `predicted`: Column of predicted values
    * `parameters`: Parameters that were fitted to these values [default: 0]
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "compare",
        [table],
        {
            "--value": value,
            "--by": by,
            "--paired": paired,
            "--specimen": specimen,
            "--pairs": pairs,
            "--confidence": confidence,
            "--figures": figures,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--missing": missing,
            "--levels": levels,
            "--measured": measured,
            "--predicted": predicted,
            "--parameters": parameters,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def regress(
    table: Table,
    *,
    response: Value | None = None,
    terms: Value | None = None,
    formula: Value | None = None,
    random: Value | Sequence[Value] | None = None,
    likelihood: Literal["reml", "ml"] | None = None,
    df: Literal["satterthwaite", "kenward-roger"] | None = None,
    weights: Value | None = None,
    variance: Value | None = None,
    select: Literal["backward", "forward", "stepwise"] | None = None,
    criterion: Literal["p", "aicc", "bic"] | None = None,
    p_remove: float | None = None,
    p_enter: float | None = None,
    hierarchy: bool = False,
    anova: Value | None = None,
    contrasts: Literal["treatment", "sum", "helmert", "poly"] | None = None,
    means: Value | Sequence[Value] | None = None,
    slopes: Value | Sequence[Value] | None = None,
    at: Value | Sequence[Value] | None = None,
    compare: Value | Sequence[Value] | None = None,
    adjust: Literal["tukey", "t", "holm", "none"] | None = None,
    robust: bool = False,
    folds: int | None = None,
    fold_by: Value | None = None,
    seed: int | None = None,
    confidence: float | None = None,
    predict: Table | None = None,
    figures: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Fit a linear model to a table.

    The command `windfall regress`.

    * `table`: Table with a header line (CSV, Parquet or Arrow), or a folder of Parquet files
    * `response`: What is modelled: a column, or a function of one
    * `terms`: What it is modelled by
    * `formula`: Both at once: 'response ~ terms'
    * `random`: What varies between groups: 'specimen' (its mean), '1 + V | specimen' (its mean
      and its slope), 'variety/fruit' (fruit within variety); makes the model a mixed one; may be
      repeated
    * `likelihood`: What is maximised where there are random effects, or variances by level
      [default: reml]
    * `df`: How degrees of freedom are found where there are random effects; intervals of
      predictions are always Satterthwaite's [default: satterthwaite]
    * `weights`: Column of weights of the rows, such as the number of impacts behind each mean:
      the variance of a row is σ² over its weight
    * `variance`: Category whose levels have residual variances of their own; estimated by
      --likelihood
    * `select`: Select terms
    * `criterion`: What decides on a term [default: p]
    * `p_remove`: A term leaves at this probability or above [default: 0.1]
    * `p_enter`: A term enters below this probability [default: 0.05]
    * `hierarchy`: Keep a term while one that contains it is in the model (SPSS does not)
    * `anova`: Type of the analysis of variance: 1 in order, 2 after all that do not contain the
      term, 3 after all others (categories by sum contrasts); with random effects always 3 [default:
      2]
    * `contrasts`: Contrasts of categories [default: treatment]
    * `means`: Marginal means of a category, or of several ('variety,dose'), with their
      differences: over the levels of the other categories in equal parts, at the mean of each
      column of numbers; 'dose | variety' compares doses within each variety; names with a comma or
      a bar stand in backticks; may be repeated
    * `slopes`: Slopes on a column of numbers ('V'), at levels ('V,variety'), within others
      ('V,dose | variety'); may be repeated
    * `at`: Where a column of numbers is held for means and slopes: 'V=0.5'; may be repeated
    * `compare`: Which means are compared: pairs, control (with the first level), control=LEVEL,
      mean (of all), polynomial, or a sum of your own with a weight for each mean: 'treated -
      control = -1, 0.5, 0.5'; may be repeated
    * `adjust`: How comparisons of means allow for their number: Tukey's for pairs, multivariate t
      for others, not at all for polynomials and sums of your own, unless this says otherwise
    * `robust`: Standard errors that hold for unequal variances (HC3)
    * `folds`: Parts for cross-validation, without random effects; 0 for none [default: 10]
    * `fold_by`: Column of fruit (or lots, days) whose rows stay together in cross-validation: how
      well another fruit is predicted
    * `seed`: Seed of the division into parts [default: 1]
    * `confidence`: Level of the intervals [default: 0.95]
    * `predict`: Table with the columns of the model, to be predicted
    * `figures`: Write figures into this directory: each as SVG, PNG (300 dots per inch) and its
      data as CSV
    * `theme`: Colours of the figures [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `figure_format`: Formats of the figures in place of SVG and PNG; the data are always CSV
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "regress",
        [table],
        {
            "--response": response,
            "--terms": terms,
            "--formula": formula,
            "--random": random,
            "--likelihood": likelihood,
            "--df": df,
            "--weights": weights,
            "--variance": variance,
            "--select": select,
            "--criterion": criterion,
            "--p-remove": p_remove,
            "--p-enter": p_enter,
            "--hierarchy": hierarchy,
            "--anova": anova,
            "--contrasts": contrasts,
            "--means": means,
            "--slopes": slopes,
            "--at": at,
            "--compare": compare,
            "--adjust": adjust,
            "--robust": robust,
            "--folds": folds,
            "--fold-by": fold_by,
            "--seed": seed,
            "--confidence": confidence,
            "--predict": predict,
            "--figures": figures,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def surface(
    table: Table,
    *,
    response: Value | Sequence[Value],
    model: Value | Sequence[Value] | None = None,
    factor: Value | Sequence[Value] | None = None,
    range: Value | Sequence[Value] | None = None,
    block: Value | None = None,
    random: Value | Sequence[Value] | None = None,
    anova: Value | None = None,
    confidence: float | None = None,
    goal: Value | Sequence[Value] | None = None,
    hold: Value | Sequence[Value] | None = None,
    along: Value | None = None,
    members: int | None = None,
    grid: Value | None = None,
    grid_points: int | None = None,
    figures: Path | None = None,
    theme: Literal["light", "dark"] | None = None,
    width: Value | None = None,
    figure_format: Literal["svg", "png", "pdf"] | Sequence[Literal["svg", "png", "pdf"]] | None = None,
    missing: Value | Sequence[Value] | None = None,
    levels: Value | Sequence[Value] | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Fit response surfaces to a table of runs, and find the best settings.

    The command `windfall surface`.

    * `table`: Table of runs with a header line (CSV, Parquet or Arrow)
    * `response`: A response: a column, or a function of columns; may be repeated, each with its
      --model
    * `model`: Its model; one for all responses, or one for each in their order [default:
      quadratic]
    * `factor`: A factor; repeated in the order of the letters A, B, C …
    * `range`: Actual values of coded -1 and 1 of a factor: k=0.44..0.86; may be repeated
    * `block`: Column of the blocks that the runs were made in; "block" where there is such a
      column and this is left out; "none" for none
    * `random`: Groups of runs whose means vary at random: 'day', 'day/whole_plot' (whole plots
      within days); "whole_plot" where there is such a column and this is left out; "none" for none;
      may be repeated
    * `anova`: Type of the analysis of variance, in coded units: 1 in order, 2 after all that do
      not contain the term (AB and A^2 contain A), 3 after all others [default: 3]
    * `confidence`: Level of the intervals [default: 0.95]
    * `goal`: What is wanted of a response; may be repeated
    * `hold`: Hold a factor at a value: k=0.868; may be repeated
    * `along`: Factor at whose values settings as good as the best are listed
    * `members`: How many of these values [default: 15]
    * `grid`: Two factors for a grid of predictions: k,e (in --format json and csv)
    * `grid_points`: Points of the grid along each factor [default: 41]
    * `figures`: Write figures into this directory: each as SVG, PNG (300 dots per inch) and its
      data as CSV
    * `theme`: Colours of the figures [default: light]
    * `width`: Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that
      size
    * `figure_format`: Formats of the figures in place of SVG and PNG; the data are always CSV
    * `missing`: Words that stand for a missing value, separated by commas; a blank cell always
      does [default: NA]
    * `levels`: The levels of a column in their order, the reference first:
      'dose=low,medium,high'; may be repeated; a level with a comma stands in backticks; as the
      header of a design says if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "surface",
        [table],
        {
            "--response": response,
            "--model": model,
            "--factor": factor,
            "--range": range,
            "--block": block,
            "--random": random,
            "--anova": anova,
            "--confidence": confidence,
            "--goal": goal,
            "--hold": hold,
            "--along": along,
            "--members": members,
            "--grid": grid,
            "--grid-points": grid_points,
            "--figures": figures,
            "--theme": theme,
            "--width": width,
            "--figure-format": figure_format,
            "--missing": missing,
            "--levels": levels,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def radius(
    *,
    chord: Value | None = None,
    sagitta: Value | None = None,
    diameters: Value | None = None,
    against: Value | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Radius of curvature from a chord gauge or three diameters.

    The command `windfall radius`.

    * `chord`: Distance between the feet of a chord gauge
    * `sagitta`: Height of the surface above the chord
    * `diameters`: Three diameters; the first along the axis that is struck or pressed
    * `against`: Radius of the other body, or "plane": gives R*
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "radius",
        [],
        {
            "--chord": chord,
            "--sagitta": sagitta,
            "--diameters": diameters,
            "--against": against,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def bounces(
    tables: Table | Sequence[Table] | None = None,
    *,
    intervals: Value | Sequence[Value] | None = None,
    each_column: bool = False,
    height: Value | None = None,
    height_sd: Value | None = None,
    resolution: Value | None = None,
    trigger_sd: Value | None = None,
    contact: Value | None = None,
    gravity: Value | None = None,
    confidence: float | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Restitution from the times between successive impacts of a bouncing fruit.

    The command `windfall bounces`.

    * `tables`: Tables of intervals (CSV): a drop in each row, its intervals in columns whose
      names say a unit of time, such as t1_ms and t2_ms
    * `intervals`: Intervals between the impacts of one drop, such as '547, 412, 314 ms'; may be
      repeated
    * `each_column`: The tables have a drop in each column, its intervals below each other
    * `height`: Height of all drops, for the restitution of the first impact; a column such as
      drop_height_cm gives each its own
    * `height_sd`: Standard uncertainty of the drop heights; none if left out
    * `resolution`: Step of the stopwatch; if left out, one unit of the last digit that is written
      anywhere
    * `trigger_sd`: Standard uncertainty of the instant at which an impact is noticed, besides the
      step; none if left out
    * `contact`: How long a contact lasts: it is taken off every interval; nothing if left out
    * `gravity`: Acceleration of gravity, or along a track; 9.80665 m/s^2 if left out
    * `confidence`: Level of the intervals of means [default: 0.95]
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "bounces",
        [tables],
        {
            "--intervals": intervals,
            "--each-column": each_column,
            "--height": height,
            "--height-sd": height_sd,
            "--resolution": resolution,
            "--trigger-sd": trigger_sd,
            "--contact": contact,
            "--gravity": gravity,
            "--confidence": confidence,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def bruise(
    *,
    widths: Value | None = None,
    depth: Value | None = None,
    radius: Value | None = None,
    table: Table | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Volumes of bruises from their measured widths and depths.

    The command `windfall bruise`.

    * `widths`: Its widths across; one where it is round
    * `depth`: Its depth below the plane through its edge
    * `radius`: Radius of the fruit there, for the cap above that plane
    * `table`: A table of bruises (CSV)
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "bruise",
        [],
        {
            "--widths": widths,
            "--depth": depth,
            "--radius": radius,
            "--table": table,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def card_show(
    *,
    laws: Path | bool | None = None,
    law: Value | None = None,
    file: Path | None = None,
    library: Value | bool | None = None,
    fruit: Value | None = None,
    at: Value | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Show the force laws, or published values: parameters, units, source.

    The command `windfall card show`.

    * `laws`: List all laws, or the own laws of a file ([laws.NAME] tables, as in campaign.toml)
    * `law`: Show one law, with all its parameters
    * `file`: Show a law card: a calibrated law with its uncertainty, range and origin
    * `library`: Published values and models, or the entry of this name, with source and cautions
    * `fruit`: Of the library, only this fruit or variety
    * `at`: Evaluate regressions of the library: NAME=VALUE with units, separated by commas
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "card show",
        [],
        {
            "--laws": laws,
            "--law": law,
            "--file": file,
            "--library": library,
            "--fruit": fruit,
            "--at": at,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def card_transfer(
    *,
    law: Value | None = None,
    file: Path | None = None,
    from_: Value,
    from_plates: int | None = None,
    from_other: Value | None = None,
    to: Value,
    to_plates: int | None = None,
    to_other: Value | None = None,
    to_fruit: bool = False,
    card: Path | None = None,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Take a law from one geometry to another by R* and E*.

    The command `windfall card transfer`.

    * `law`: The law with its parameters, as it was found
    * `file`: The law card of the law as it was found
    * `from_`: Where it was found: radius of the fruit, radius of the other body or "plane"
    * `from_plates`: Plates that deformed the fruit where it was found: 1 or 2 [default: 1]
    * `from_other`: The other body where it was found: rigid, fruit, or its modulus and Poisson's
      ratio
    * `to`: Where it is wanted: radius of the fruit, radius of the other body or "plane"
    * `to_plates`: Plates that deform the fruit where it is wanted: 1 or 2 [default: 1]
    * `to_other`: The other body where it is wanted: rigid, fruit, or its modulus and Poisson's
      ratio
    * `to_fruit`: Where it is wanted, the other body is a fruit of the same modulus
    * `card`: Write the law card of the law where it is wanted
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "card transfer",
        [],
        {
            "--law": law,
            "--file": file,
            "--from": from_,
            "--from-plates": from_plates,
            "--from-other": from_other,
            "--to": to,
            "--to-plates": to_plates,
            "--to-other": to_other,
            "--to-fruit": to_fruit,
            "--card": card,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def explain(
    codes: Value | Sequence[Value] | None = None,
    *,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Explain findings: what they mean and what to do.

    The command `windfall explain`.

    * `codes`: Codes of findings; all if left out
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "explain",
        [codes],
        {
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def schema(
    kind: Literal["pendulum", "carriage", "compression", "relaxation", "acoustic", "repeats", "drop", "scene", "scene-study", "add", "bounces", "bruise", "calibrate", "card", "card-laws", "card-library", "card-transfer", "compare", "compare-agreement", "design", "explain", "fit", "fit-shard", "inspect", "inspect-presets", "laws", "licences", "written", "new-from", "plan", "plan-achieved", "population", "radius", "regress", "report", "scene-contacts", "scene-deck", "scene-picture", "scene-run", "scene-study/1", "scene-table", "scene-vtk", "simulate-drop", "simulate-eccentric-drop", "simulate-impact", "simulate-motion", "simulate-recordings", "summary", "surface"],
    *,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Write the JSON Schema of a campaign.toml or scene.toml, for editors, or of the JSON that a
    command answers.

    The command `windfall schema`.

    * `kind`: What to describe: a file, by the kind of rig, as a scene or as a study of scenes; or
      the JSON of a command, by the name in its key "schema", with or without the number
    * `out`: Write it into this file
    """
    return call(
        "schema",
        [kind],
        {
            "--out": out,
        },
        json=False,
        force=force,
        also_read=also_read,
        progress=progress,
    )


def licences(
    *,
    texts: bool = False,
    out: Path | None = None,
    force: bool = False,
    also_read: Path | Sequence[Path] = (),
    progress: bool = False,
) -> Result:
    """Show what windfall is made of: crates and other parts with their licences.

    The command `windfall licences`.

    * `texts`: Show the texts of the licences, too
    * `out`: Write the result into a file, too: .csv, .json or .txt
    """
    return call(
        "licences",
        [],
        {
            "--texts": texts,
            "--out": out,
        },
        json=True,
        force=force,
        also_read=also_read,
        progress=progress,
    )
