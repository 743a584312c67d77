//! Figures of `regress`, `compare` and `summary`: the numbers beside them against R, and tables
//! of which little can be drawn.

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::path::Path;
use tempfile::TempDir;

/// Rows of a table beside a figure, by the names of its columns.
type Rows = Vec<BTreeMap<String, String>>;

/// Runs a command on a table, called `t.csv`, with figures in the folder `figures`.
fn run(table: &str, arguments: &[&str]) -> (TempDir, Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.csv"), table).unwrap();
    let mut command = Command::cargo_bin("windfall").unwrap();
    let command = command.args(arguments).args(["--figures", "figures"]);
    let output = command.current_dir(folder.path()).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    (folder, output.status.code(), told)
}

/// The folder of figures of a command that succeeds. No picture holds what is no number.
fn drawn(table: &str, arguments: &[&str]) -> TempDir {
    let (folder, status, told) = run(table, arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {told}");
    let mut pictures = 0;
    for file in std::fs::read_dir(folder.path().join("figures")).unwrap() {
        let path = file.unwrap().path();
        if path.extension() == Some("svg".as_ref()) {
            let svg = std::fs::read_to_string(&path).unwrap();
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{path:?}");
            assert!(path.with_extension("csv").exists() && path.with_extension("png").exists());
            pictures += 1;
        }
    }
    assert!(pictures > 0);
    folder
}

fn text(folder: &TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join("figures").join(Path::new(name))).unwrap()
}

fn rows(folder: &TempDir, name: &str) -> Rows {
    let text = text(folder, name);
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines
        .map(|line| {
            // A comma within quotes ends no cell.
            let pieces = line.split('"').enumerate();
            let pieces = pieces.map(|(place, piece)| match place % 2 {
                0 => piece.replace(',', "\n"),
                _ => piece.to_owned(),
            });
            let cells: String = pieces.collect();
            let cells = header.iter().zip(cells.split('\n'));
            cells
                .map(|(name, cell)| ((*name).to_owned(), cell.to_owned()))
                .collect()
        })
        .collect()
}

/// The only row in which columns have these values.
fn row<'a>(rows: &'a Rows, wanted: &[(&str, &str)]) -> &'a BTreeMap<String, String> {
    let fits = |row: &&BTreeMap<String, String>| wanted.iter().all(|(k, v)| row[*k] == *v);
    let found: Vec<_> = rows.iter().filter(fits).collect();
    assert_eq!(found.len(), 1, "{wanted:?}");
    found[0]
}

/// Numbers of a row, within a relative error.
fn check(row: &BTreeMap<String, String>, columns: &[&str], expected: &[f64], limit: f64) {
    for (column, expected) in columns.iter().zip(expected) {
        let found: f64 = row[*column].parse().unwrap();
        let error = (found - expected).abs() / expected.abs().max(1e-3);
        assert!(error < limit, "{column}: {found}, not {expected}: {row:?}");
    }
}

/// Six fruit of two varieties at four velocities, made by a rule; the same stands in R's script
/// whose numbers are below (R 4.2, lme4 1.1, emmeans 1.8).
fn fruit() -> String {
    let mut table = "fruit,variety,V,R,k\n".to_owned();
    let own = [12.0, -9.0, 4.0, -15.0, 7.0, 1.0];
    for i in 0..24_usize {
        let fruit = i / 4;
        let (variety, more) = if fruit % 2 == 0 {
            ("Gala", 0.0)
        } else {
            ("Fuji", 20.0)
        };
        let (v, r) = ([0.1, 0.3, 0.5, 0.7][i % 4], (30 + (7 * i) % 11) as f64);
        let noise = 1.5 * (((37 * i) % 17) as f64 - 8.0);
        let k = 500.0 - 200.0 * v + 3.0 * r + more + own[fruit] + noise;
        table += &format!("f{},{variety},{v},{r},{k}\n", fruit + 1);
    }
    table
}

/// R: rstandard, rstudent, hatvalues, cooks.distance, qnorm(ppoints(24, 3/8)) by rank, lowess;
/// the band by qt(qbeta()) at the level of an R program of the same sweep.
#[test]
fn reference_diagnostics_of_a_linear_model() {
    let folder = drawn(
        &fruit(),
        &["regress", "t.csv", "--formula", "k ~ V * variety + R"],
    );
    let found = rows(&folder, "diagnostics.csv");
    assert_eq!(found.len(), 24);
    let columns = [
        "standardised",
        "studentised",
        "leverage",
        "cook",
        "normal_score",
        "smooth_residual",
    ];
    for (line, expected) in [
        (
            "2",
            [
                -0.962_734_105_827,
                -0.960_784_010_851,
                0.287_658_362_989,
                0.074_856_821_940_8,
                -1.038_646_712_97,
                0.794_168_333_407,
            ],
        ),
        (
            "8",
            [
                -0.862_042_843_828,
                -0.855_956_703_695,
                0.149_366_548_043,
                0.026_097_480_640_6,
                -0.875_240_062_59,
                0.178_674_182_814,
            ],
        ),
        (
            "25",
            [
                0.242_673_479_551,
                0.236_567_925_497,
                0.241_309_608_541,
                0.003_746_145_673_27,
                0.155_675_690_374,
                -0.384_786_078_857,
            ],
        ),
    ] {
        check(row(&found, &[("line", line)]), &columns, &expected, 1e-8);
    }
    for (line, low, high) in [
        ("2", -2.137_105_637, -0.213_087_215_2),
        ("8", -1.863_560_56, -0.083_152_094_62),
        ("25", -0.578_169_302_1, 0.912_565_169_4),
    ] {
        let own = row(&found, &[("line", line)]);
        check(own, &["band_low", "band_high"], &[low, high], 2e-4);
    }
}

/// emmeans(f, ~ variety | V) at the 10, 50 and 90 % quantiles of V, and emmeans(f, ~ R).
#[test]
fn reference_effects_of_a_linear_model() {
    let folder = drawn(
        &fruit(),
        &["regress", "t.csv", "--formula", "k ~ V * variety + R"],
    );
    let found = rows(&folder, "effects.csv");
    let columns = ["value", "low", "high"];
    for (level, v, expected) in [
        (
            "Fuji",
            "0.1",
            [599.719_661_328_6, 590.387_674_245_6, 609.051_648_411_6],
        ),
        (
            "Gala",
            "0.4",
            [530.401_313_760_4, 524.775_412_151_9, 536.027_215_368_9],
        ),
        (
            "Gala",
            "0.7",
            [473.974_612_692_8, 464.678_419_916_7, 483.270_805_468_8],
        ),
    ] {
        let wanted = [("kind", "effect"), ("variable", "variety"), ("at", level)];
        let near = |own: &&BTreeMap<String, String>| {
            let at = own["partner_at"].parse::<f64>();
            at.is_ok_and(|at| (at - v.parse::<f64>().unwrap()).abs() < 1e-9)
        };
        let own: Rows = found.iter().filter(near).cloned().collect();
        check(row(&own, &wanted), &columns, &expected, 1e-8);
    }
    for (r, expected) in [
        (
            "30",
            [524.642_428_825_6, 517.361_677_395_5, 531.923_180_255_8],
        ),
        (
            "40",
            [543.837_446_619_2, 536.290_089_530_9, 551.384_803_707_5],
        ),
    ] {
        let wanted = [("kind", "effect"), ("variable", "R"), ("at", r)];
        check(row(&found, &wanted), &columns, &expected, 1e-8);
    }
    // A partial residual is what the effect predicts at the row plus its residual: for the
    // variable R, whose effect is a line, and row 2 with R = 30.
    let residuals = rows(&folder, "diagnostics.csv");
    let residual: f64 = row(&residuals, &[("line", "2")])["residual"]
        .parse()
        .unwrap();
    let wanted = [
        ("kind", "partial residual"),
        ("variable", "R"),
        ("line", "2"),
    ];
    check(
        row(&found, &wanted),
        &["value"],
        &[524.642_428_825_6 + residual],
        1e-9,
    );
}

/// lme4 by maximum likelihood: ranef with condVar, scaled residuals; ζ at a standard deviation of
/// zero is the signed root of the deviance of lm less that of lmer.
#[test]
fn reference_figures_of_a_mixed_model() {
    let arguments = [
        "regress",
        "t.csv",
        "--formula",
        "k ~ V + R + variety",
        "--random",
        "fruit",
        "--likelihood",
        "ml",
    ];
    let folder = drawn(&fruit(), &arguments);
    let effects = rows(&folder, "random-effects.csv");
    let order: Vec<&str> = effects.iter().map(|own| own["group"].as_str()).collect();
    assert_eq!(order, ["f4", "f5", "f2", "f1", "f3", "f6"]);
    let sd = 2.771_364_744_47;
    for (group, value) in [("f4", -4.951_185_157_762), ("f6", 5.683_104_816_207)] {
        let expected = [
            value,
            sd,
            value - 1.959_963_985 * sd,
            value + 1.959_963_985 * sd,
        ];
        let own = row(&effects, &[("group", group)]);
        check(own, &["value", "sd", "low", "high"], &expected, 1e-5);
    }
    let residuals = rows(&folder, "diagnostics.csv");
    for (line, scaled, fitted) in [
        ("2", -1.368_298_988, 580.031_948_1),
        ("8", -1.122_677_834, 525.731_129_2),
        ("25", -0.930_114_858_5, 488.319_316_6),
    ] {
        let own = row(&residuals, &[("line", line)]);
        check(own, &["studentised", "fitted"], &[scaled, fitted], 1e-5);
        assert!(own["cook"].is_empty() && own["leverage"].is_empty());
    }
    let profiles = rows(&folder, "profiles.csv");
    let zero = row(
        &profiles,
        &[("parameter", "sd of (Intercept), fruit"), ("value", "0")],
    );
    check(zero, &["signed_root"], &[-1.314_645_581_76], 1e-5);
    let sigma = profiles
        .iter()
        .filter(|own| own["parameter"] == "residual sd");
    let roots: Vec<f64> = sigma
        .map(|own| own["signed_root"].parse().unwrap())
        .collect();
    assert!(
        roots.len() > 20 && roots.windows(2).all(|pair| pair[0] < pair[1]),
        "{roots:?}"
    );
    assert!(
        text(&folder, "random-effects-quantiles.csv")
            .lines()
            .count()
            == 7
    );
}

/// R: mean and t.test(x)$conf.int of each variety, quantile() of type 7.
#[test]
fn reference_groups_and_summaries() {
    let folder = drawn(
        &fruit(),
        &["compare", "t.csv", "--value", "k", "--by", "variety"],
    );
    let groups = rows(&folder, "groups.csv");
    assert_eq!(groups.iter().filter(|own| own["kind"] == "row").count(), 24);
    let columns = ["value", "low", "high"];
    let fuji = [538.958_333_333, 507.642_025_471, 570.274_641_196];
    let wanted = [("kind", "mean"), ("group", "Fuji")];
    check(row(&groups, &wanted), &columns, &fuji, 1e-9);
    assert_eq!(row(&groups, &wanted)["letters"], "a");
    // Rows know their fruit.
    assert_eq!(row(&groups, &[("line", "6")])["specimen"], "f2");
    let folder = drawn(
        &fruit(),
        &["summary", "t.csv", "--value", "k", "--by", "variety"],
    );
    let summary = rows(&folder, "summary-k.csv");
    check(row(&summary, &wanted), &columns, &fuji, 1e-9);
    let wanted = [("kind", "median"), ("group", "Gala")];
    check(
        row(&summary, &wanted),
        &columns,
        &[532.75, 501.75, 563.25],
        1e-12,
    );
    let bins = summary.iter().filter(|own| own["kind"] == "bin");
    let counted: usize = bins.map(|own| own["value"].parse::<usize>().unwrap()).sum();
    assert_eq!(counted, 24);
}

/// With specimens their means are drawn, and with pairs they are joined.
#[test]
fn closed_form_means_of_specimens() {
    let table = "fruit,side,k\na,red,1\na,red,3\nb,red,5\na,green,2\nb,green,8\nb,green,10\n";
    for option in ["--specimen", "--paired"] {
        let arguments = [
            "compare", "t.csv", "--value", "k", "--by", "side", option, "fruit",
        ];
        let folder = drawn(table, &arguments);
        let groups = rows(&folder, "groups.csv");
        let wanted = [("kind", "specimen"), ("group", "red"), ("specimen", "a")];
        check(row(&groups, &wanted), &["value"], &[2.0], 1e-15);
        let svg = text(&folder, "groups.svg");
        assert_eq!(
            svg.contains("Thin lines join"),
            option == "--paired",
            "{svg}"
        );
    }
}

#[test]
fn closed_form_predictions_over_measured_values() {
    let table = "m,p\n1,1.5\n2,2.5\n3,\n4,3\n";
    let arguments = ["compare", "t.csv", "--measured", "m", "--predicted", "p"];
    let folder = drawn(table, &arguments);
    let found = rows(&folder, "agreement.csv");
    assert_eq!(found.len(), 3);
    check(
        row(&found, &[("line", "5")]),
        &["difference"],
        &[-1.0],
        1e-15,
    );
}

/// What cannot be drawn says why, and is never drawn of what is no number.
#[test]
fn closed_form_tables_of_which_little_can_be_drawn() {
    // Two rows and two coefficients: nothing is left.
    let folder = drawn(
        "x,y\n1,2\n2,3\n",
        &["regress", "t.csv", "--formula", "y ~ x"],
    );
    assert!(text(&folder, "diagnostics.svg").contains("no degrees of"));
    // One degree of freedom: no row against the others.
    let three = "x,y\n1,2\n2,3\n3,5\n";
    let folder = drawn(three, &["regress", "t.csv", "--formula", "y ~ x"]);
    assert!(text(&folder, "diagnostics.svg").contains("one degree of freedom"));
    // Fewer rows than groups of a category, a level with one row: leverage 1.
    let alone = "g,y\na,1\na,2\na,4\nb,7\n";
    let folder = drawn(alone, &["regress", "t.csv", "--formula", "y ~ g"]);
    assert!(text(&folder, "diagnostics.svg").contains("1 row has leverage 1"));
    let found = rows(&folder, "diagnostics.csv");
    assert_eq!(row(&found, &[("line", "5")])["standardised"], "");
    // A line without any noise, and a mean only.
    let exact = "x,y\n1,2\n2,4\n3,6\n4,8\n5,10\n";
    let folder = drawn(exact, &["regress", "t.csv", "--formula", "y ~ x"]);
    assert!(text(&folder, "diagnostics.svg").contains("fits exactly"));
    let folder = drawn(exact, &["regress", "t.csv", "--formula", "y ~ 1"]);
    assert!(!folder.path().join("figures/effects.svg").exists());
    // Columns that depend on each other, one that is constant, and a missing cell.
    let aliased = "x,z,c,y\n1,2,1,3\n2,4,1,5\n3,6,1,6\n4,8,1,9\n5,10,1,\n6,12,1,11\n";
    drawn(aliased, &["regress", "t.csv", "--formula", "y ~ x + z + c"]);
    // Groups of one value, of equal values, and one without any.
    let few = "g,y\na,1\na,1\na,1\nb,2\nb,4\nc,\nd,3\n";
    drawn(few, &["compare", "t.csv", "--value", "y", "--by", "g"]);
    drawn(few, &["summary", "t.csv", "--by", "g"]);
    drawn("y\n3\n", &["summary", "t.csv"]);
    drawn("y,z\n,1\n,2\n", &["summary", "t.csv", "--value", "z"]);
    // Groups that do not differ: the standard deviation between them is zero.
    let mut equal = "g,y\n".to_owned();
    for i in 0..24 {
        equal += &format!("g{},{}\n", i / 4, [1.0, 2.0, 3.5, 5.0][i % 4]);
    }
    let arguments = ["regress", "t.csv", "--formula", "y ~ 1", "--random", "g"];
    let folder = drawn(&equal, &arguments);
    assert!(text(&folder, "random-effects-quantiles.svg").contains("do not differ"));
}

/// Effects are drawn with the intervals that marginal means have, whatever tells the variances.
#[test]
fn conserves_the_intervals_of_marginal_means() {
    let table = "g,w,y\na,1,2.1\na,2,3.4\na,1,1.9\na,4,2.2\nb,2,5.1\nb,1,7.9\nb,3,3.2\nb,1,6.6\n\
                 b,2,9.4\nc,1,6.1\nc,2,6.6\nc,2,6.2\n";
    let formula = ["regress", "t.csv", "--formula", "y ~ g"];
    for how in [
        &[][..],
        &["--variance", "g"],
        &["--variance", "g", "--likelihood", "ml"],
        &["--weights", "w"],
        &["--robust"],
    ] {
        let arguments = [&formula[..], how].concat();
        let effects = rows(&drawn(table, &arguments), "effects.csv");
        let asked = [&arguments[..], &["--means", "g"]].concat();
        let found = crate::on_table::json(table, &asked);
        for mean in found["means"][0]["means"].as_array().unwrap() {
            let level = mean["levels"][0].as_str().unwrap();
            let own = row(&effects, &[("kind", "effect"), ("at", level)]);
            for (name, column) in [("mean", "value"), ("low", "low"), ("high", "high")] {
                crate::on_table::close(&mean[name], own[column].parse().unwrap(), 1e-10);
            }
        }
    }
}

/// A column without an estimate of its own: the effect is not drawn where no row tells it.
#[test]
fn rejects_effects_that_cannot_be_estimated() {
    let mut table = "f,g,y\n".to_owned();
    for i in 0..12 {
        let (f, g) = [("a", "u"), ("a", "v"), ("b", "u")][i % 3];
        table += &format!("{f},{g},{}\n", (7 * i) % 5);
    }
    let folder = drawn(&table, &["regress", "t.csv", "--formula", "y ~ f * g"]);
    let found = rows(&folder, "effects.csv");
    let wanted = [
        ("kind", "effect"),
        ("variable", "f"),
        ("at", "b"),
        ("partner_at", "v"),
    ];
    assert_eq!(row(&found, &wanted)["value"], "");
    let wanted = [
        ("kind", "effect"),
        ("variable", "f"),
        ("at", "a"),
        ("partner_at", "v"),
    ];
    assert!(!row(&found, &wanted)["value"].is_empty());
}

/// Many rows are thinned by a rule that keeps the extremes, and the figure says so; of many
/// columns the first are drawn, and a finding names the others.
#[test]
fn closed_form_large_tables_are_thinned() {
    let mut table = "x,y\n".to_owned();
    for i in 0..12_000 {
        let y = if i == 6_001 {
            900.0
        } else {
            f64::from((i * 37) % 101)
        };
        table += &format!("{i},{y}\n");
    }
    let folder = drawn(
        &table,
        &["regress", "t.csv", "--formula", "y ~ x", "--folds", "0"],
    );
    let found = rows(&folder, "diagnostics.csv");
    assert!((4_000..4_200).contains(&found.len()), "{}", found.len());
    assert!(found.iter().any(|own| own["line"] == "6003"));
    let svg = text(&folder, "diagnostics.svg");
    assert!(svg.contains("of 12000 rows are drawn: one in 3,"), "{svg}");
    let names: Vec<String> = (0..26).map(|i| format!("c{i}")).collect();
    let wide = format!("{}\n{}\n", names.join(","), vec!["1"; 26].join(","));
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.csv"), wide).unwrap();
    let mut command = Command::cargo_bin("windfall").unwrap();
    let arguments = [
        "summary",
        "t.csv",
        "--figures",
        "figures",
        "--format",
        "json",
    ];
    let output = command.args(arguments).current_dir(folder.path()).output();
    let json: serde_json::Value = serde_json::from_slice(&output.unwrap().stdout).unwrap();
    let told = json["findings"].as_array().unwrap().iter();
    let mut told = told.filter(|own| own["code"] == "not-drawn" || own["key"] == "not-drawn");
    assert!(
        told.next().unwrap().to_string().contains("c24, c25"),
        "{json}"
    );
    let files = std::fs::read_dir(folder.path().join("figures")).unwrap();
    let drawn = files.filter(|file| {
        let path = file.as_ref().unwrap().path();
        path.extension() == Some("svg".as_ref())
    });
    assert_eq!(drawn.count(), 24);
}

/// A figure that was changed since is not replaced, nor is any beside it.
#[test]
fn conserves_all_figures_where_one_was_changed() {
    let folder = drawn(
        &fruit(),
        &["regress", "t.csv", "--formula", "k ~ V", "--folds", "0"],
    );
    let path = |name: &str| folder.path().join("figures").join(name);
    let before = text(&folder, "diagnostics.csv");
    std::fs::write(path("effects.csv"), "mine\n").unwrap();
    let arguments = [
        "regress",
        "t.csv",
        "--formula",
        "k ~ V + variety",
        "--folds",
        "0",
    ];
    let mut command = Command::cargo_bin("windfall").unwrap();
    let command = command.args(arguments).args(["--figures", "figures"]);
    let output = command.current_dir(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(text(&folder, "effects.csv"), "mine\n");
    assert_eq!(text(&folder, "diagnostics.csv"), before);
}
