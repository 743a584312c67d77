//! Every argument of windfall that names a file or a folder: those that it writes to, with a
//! command line for each, and those that it only reads.
//!
//! A test of the program compares these lists with its arguments, so that an output option
//! that nobody thought of fails. The generated tests of outputs go through the first list.

/// What is written there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A file of any name.
    File,
    /// A file whose name has one of these endings.
    Ending(&'static [&'static str]),
    /// A picture (SVG or PNG), and a table of the same name beside it.
    Picture,
    /// Files in a folder.
    Folder,
    /// A folder that is not there yet, or empty.
    NewFolder,
}

/// An output: the command, the option or argument, what it is, a command line in which "{}"
/// stands for it, and the files that this line reads.
pub type Output = (
    &'static str,
    &'static str,
    Kind,
    &'static str,
    &'static [&'static str],
);

/// Files of the campaign, which every command reads that takes it; and its store.
const CAMPAIGN: &[&str] = &[
    "campaign/campaign.toml",
    "campaign/specimens.csv",
    "campaign/impacts.csv",
    "campaign/results.sqlite",
    "campaign/raw/specimen-01.csv",
    "campaign/raw/unlisted.csv",
];
/// The same of the campaign of drops.
const DROPS: &[&str] = &[
    "drops/campaign.toml",
    "drops/specimens.csv",
    "drops/impacts.csv",
    "drops/results.sqlite",
    "drops/raw/drop-100-1.csv",
];
const SCENE: &[&str] = &["scene/scene.toml"];
const RUN: &[&str] = &["scene/scene.run/frames.bin"];

/// Of options that several commands share the line is that of one of them.
pub const WRITTEN: &[Output] = &[
    ("new", "directory", Kind::NewFolder, "new pendulum {}", &[]),
    (
        "inspect",
        "--plot",
        Kind::Picture,
        "inspect impact.csv --plot {}",
        &["impact.csv"],
    ),
    (
        "inspect",
        "--export",
        Kind::Ending(&["csv", "npy"]),
        "inspect impact.csv --export {}",
        &["impact.csv"],
    ),
    (
        "fit",
        "--figures",
        Kind::Folder,
        "fit campaign --figures {}",
        CAMPAIGN,
    ),
    (
        "fit",
        "--detail",
        Kind::Folder,
        "fit campaign --detail {}",
        CAMPAIGN,
    ),
    (
        "fit",
        "--card",
        Kind::File,
        "fit campaign --card {}",
        CAMPAIGN,
    ),
    (
        "laws",
        "--figures",
        Kind::Folder,
        "laws campaign --figures {}",
        CAMPAIGN,
    ),
    (
        "population",
        "--detail",
        Kind::File,
        "population campaign --posterior --draws 100 --detail {}",
        CAMPAIGN,
    ),
    (
        "population",
        "--card",
        Kind::File,
        "population campaign --card {}",
        CAMPAIGN,
    ),
    (
        "report",
        "--out",
        Kind::Folder,
        "report campaign --out {}",
        CAMPAIGN,
    ),
    (
        "calibrate",
        "--figures",
        Kind::Folder,
        "calibrate drops --figures {}",
        DROPS,
    ),
    (
        "calibrate",
        "--tables",
        Kind::Folder,
        "calibrate drops --tables {}",
        DROPS,
    ),
    (
        "calibrate",
        "--card",
        Kind::File,
        "calibrate drops --card {}",
        DROPS,
    ),
    (
        "plan mean",
        "--figure",
        Kind::Picture,
        "plan mean --sd 1 --half-width 1 --figure {}",
        &[],
    ),
    (
        "plan difference",
        "--figure",
        Kind::Picture,
        "plan difference --sd 1 --difference 1 --power 0.8 --figure {}",
        &[],
    ),
    (
        "plan groups",
        "--figure",
        Kind::Picture,
        "plan groups --means 1,2 --sd 1 --power 0.8 --figure {}",
        &[],
    ),
    (
        "plan slope",
        "--figure",
        Kind::Picture,
        "plan slope --slope 1 --x 1,2 --sd 1 --power 0.8 --figure {}",
        &[],
    ),
    (
        "plan model",
        "--figure",
        Kind::Picture,
        "plan model fruit.csv --formula k~V+(1|fruit) --fruit 4 --simulations 50 --figure {}",
        &["fruit.csv"],
    ),
    (
        "plan surface",
        "--figure",
        Kind::Picture,
        "plan surface design.csv --factor A --factor B --model A+B --coefficients A=1 --sd 1 --fruit 2 --figure {}",
        &["design.csv"],
    ),
    (
        "plan population",
        "--figure",
        Kind::Picture,
        "plan population card.toml --parameter k --within 0.05 --fruit 4 --figure {}",
        &["card.toml"],
    ),
    (
        "plan critical-energy",
        "--figure",
        Kind::Picture,
        "plan critical-energy --median 1 --spread 0.5 --energies 0.5,1,2 --fruit 8 --simulations 50 --figure {}",
        &[],
    ),
    (
        "design factorial",
        "--out",
        Kind::File,
        "design factorial --factor A=0..1 --factor B=0..1 --out {}",
        &[],
    ),
    (
        "design plackett-burman",
        "--out",
        Kind::File,
        "design plackett-burman --factor A=0..1 --factor B=0..1 --out {}",
        &[],
    ),
    (
        "design ccd",
        "--out",
        Kind::File,
        "design ccd --factor A=0..1 --factor B=0..1 --out {}",
        &[],
    ),
    (
        "design box-behnken",
        "--out",
        Kind::File,
        "design box-behnken --factor A=0..1 --factor B=0..1 --factor C=0..1 --out {}",
        &[],
    ),
    (
        "design latin-hypercube",
        "--out",
        Kind::File,
        "design latin-hypercube --factor A=0..1 --factor B=0..1 --runs 5 --out {}",
        &[],
    ),
    (
        "design sobol",
        "--out",
        Kind::File,
        "design sobol --factor A=0..1 --factor B=0..1 --runs 8 --out {}",
        &[],
    ),
    (
        "design d-optimal",
        "--out",
        Kind::File,
        "design d-optimal --factor A=0..1 --factor B=0..1 --model A+B --runs 6 --augment design.csv --out {}",
        &["design.csv"],
    ),
    (
        "design i-optimal",
        "--out",
        Kind::File,
        "design i-optimal --factor A=0..1 --factor B=0..1 --model A+B --runs 4 --candidates design.csv --out {}",
        &["design.csv"],
    ),
    (
        "design split-plot",
        "--out",
        Kind::File,
        "design split-plot --factor A=0..1 --factor B=0..1 --hard A --whole-plots 4 --model A+B --runs 8 --out {}",
        &[],
    ),
    (
        "simulate impact",
        "--plot",
        Kind::Picture,
        "simulate impact --laws laws.toml --law own(k=9e5) --mass 0.2kg --velocity 1m/s --plot {}",
        &["laws.toml"],
    ),
    (
        "simulate pendulum",
        "--example",
        Kind::NewFolder,
        "simulate pendulum --example {}",
        &[],
    ),
    (
        "simulate pendulum",
        "--recordings",
        Kind::NewFolder,
        "simulate pendulum --law hertz(k=9e5) --specimens 1 --recordings {}",
        &[],
    ),
    (
        "simulate carriage",
        "--recordings",
        Kind::NewFolder,
        "simulate carriage --law hertz(k=9e5) --mass 0.2kg --velocity 1m/s --specimens 1 --recordings {}",
        &[],
    ),
    (
        "simulate compression",
        "directory",
        Kind::NewFolder,
        "simulate compression {} --law hertz(k=9e5)",
        &[],
    ),
    (
        "simulate tap",
        "directory",
        Kind::NewFolder,
        "simulate tap {}",
        &[],
    ),
    (
        "simulate repeats",
        "directory",
        Kind::NewFolder,
        "simulate repeats {}",
        &[],
    ),
    (
        "simulate drop",
        "directory",
        Kind::NewFolder,
        "simulate drop {} --law hertz(k=9e5) --mass 5g --height 100mm",
        &[],
    ),
    (
        "scene run",
        "--out",
        Kind::Folder,
        "scene run scene/scene.toml --restart --out {}",
        SCENE,
    ),
    (
        "scene study",
        "--out",
        Kind::Folder,
        "scene study scene/study.toml --out {}",
        &["scene/scene.toml", "scene/study.toml"],
    ),
    (
        "scene picture",
        "--out",
        Kind::Ending(&["svg", "png"]),
        "scene picture scene/scene.run --out {}",
        RUN,
    ),
    (
        "scene vtk",
        "--out",
        Kind::Folder,
        "scene vtk scene/scene.run --out {}",
        RUN,
    ),
    (
        "scene export",
        "--out",
        Kind::Folder,
        "scene export scene/scene.toml --engine yade --out {}",
        SCENE,
    ),
    (
        "regress",
        "--figures",
        Kind::Folder,
        "regress design.csv --response y --terms A+B --figures {}",
        &["design.csv"],
    ),
    (
        "compare",
        "--figures",
        Kind::Folder,
        "compare design.csv --value y --by A --figures {}",
        &["design.csv"],
    ),
    (
        "summary",
        "--figures",
        Kind::Folder,
        "summary design.csv --value y --figures {}",
        &["design.csv"],
    ),
    (
        "surface",
        "--figures",
        Kind::Folder,
        "surface design.csv --factor A --factor B --response y --model A+B --figures {}",
        &["design.csv"],
    ),
    (
        "card transfer",
        "--card",
        Kind::File,
        "card transfer --file card.toml --from 40mm,plane --to 40mm,20mm --card {}",
        &["card.toml"],
    ),
];

/// Command and option or argument of what is only read.
pub const READ: &[(&str, &str)] = &[
    ("", "--also-read"),
    // Recordings are copied out of it.
    ("new", "--from"),
    // Rows are added to the tables of the campaign, which is what was asked for.
    ("add", "directory"),
    ("add", "files"),
    ("inspect", "files"),
    ("fit", "directory"),
    ("fit", "--laws"),
    ("laws", "directory"),
    ("population", "directory"),
    ("report", "directory"),
    // What the page writes stays in this directory.
    ("serve", "directory"),
    ("calibrate", "directory"),
    ("plan mean", "--from"),
    ("plan difference", "--from"),
    ("plan groups", "--from"),
    ("plan slope", "--from"),
    ("plan model", "table"),
    ("plan surface", "table"),
    ("plan surface", "--from"),
    ("plan population", "card"),
    ("plan achieved", "table"),
    ("design d-optimal", "--candidates"),
    ("design d-optimal", "--augment"),
    ("design i-optimal", "--candidates"),
    ("design i-optimal", "--augment"),
    ("simulate impact", "--laws"),
    ("simulate pendulum", "--laws"),
    ("simulate carriage", "--laws"),
    ("simulate compression", "--laws"),
    ("simulate drop", "--laws"),
    ("scene run", "file"),
    ("scene run", "--engine-program"),
    ("scene run", "--engine-library"),
    ("scene run", "--pulses"),
    // Ranks of one run fill the directory of its deck together.
    ("scene rank", "file"),
    ("scene rank", "--deck"),
    ("scene rank", "--library"),
    ("scene run", "--frames"),
    ("scene study", "file"),
    ("scene picture", "run"),
    ("scene vtk", "run"),
    ("scene export", "file"),
    ("summary", "table"),
    ("compare", "table"),
    ("regress", "table"),
    ("regress", "--predict"),
    ("surface", "table"),
    ("bounces", "tables"),
    ("bruise", "--table"),
    ("card show", "--laws"),
    ("card show", "--file"),
    ("card transfer", "--file"),
];
