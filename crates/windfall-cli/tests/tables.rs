//! How the commands for tables read them, and what they say of rows that are left out; the
//! certified analyses of variance of NIST through both commands that make them.

#![allow(clippy::unwrap_used)]

use crate::on_table;
use serde_json::Value;

/// [`on_table::run`] with arguments between `~`.
fn run(table: &str, arguments: &str) -> (Option<i32>, String, String) {
    on_table::run(table, &arguments.split('~').collect::<Vec<_>>())
}

fn json(table: &str, arguments: &str) -> Value {
    on_table::json(table, &arguments.split('~').collect::<Vec<_>>())
}

fn codes(outcome: &Value) -> Vec<&str> {
    let found = outcome["findings"].as_array().unwrap();
    found
        .iter()
        .map(|own| own["code"].as_str().unwrap())
        .collect()
}

const PADS: &str = "pad,k\nnone,1.0\nnone,1.3\nnone,1.2\nfoam,2.0\nfoam,2.2\nfoam,2.1\n";

#[test]
fn closed_form_a_group_called_none_is_a_group() {
    let found = json(PADS, "compare~t.csv~--value~k~--by~pad");
    let groups: Vec<&str> = found["groups"]
        .as_array()
        .unwrap()
        .iter()
        .map(|own| own["group"].as_str().unwrap())
        .collect();
    assert_eq!(groups, ["foam", "none"]);
    let told = json(PADS, "summary~t.csv~--value~k~--by~pad~--missing~none");
    let [value] = &told["values"].as_array().unwrap()[..] else {
        panic!("{told}")
    };
    assert_eq!(value["groups"].as_array().unwrap().len(), 1);
    assert_eq!((&value["rows"], &value["left_out"]), (&3.into(), &3.into()));
}

#[test]
fn closed_form_missing_codes_are_those_that_are_told() {
    let table = "v,k\n1,5\n2,-999\n3,7\n4,8\n5,9.5\n6,NA\n7,\n";
    let plain = json(table, "regress~t.csv~--response~k~--terms~v");
    assert_eq!(plain["rows"], 5);
    let told = json(
        table,
        "regress~t.csv~--response~k~--terms~v~--missing~NA,-999",
    );
    assert_eq!((&told["rows"], &told["left_out"]), (&4.into(), &3.into()));
    let table = "v,k\n1,5\n2,null\n3,7\n4,8\n5,9.5\n";
    let (status, _, said) = run(table, "regress~t.csv~--response~k~--terms~v");
    assert_eq!(status, Some(2));
    assert!(
        said.contains("line 3") && said.contains("--missing \"null\""),
        "{said}"
    );
    let (status, _, said) = run(table, "regress~t.csv~--response~v~--terms~k");
    assert_eq!(status, Some(2));
    assert!(said.contains("holds numbers but for \"null\""), "{said}");
}

#[test]
fn closed_form_rows_that_are_left_out_stand_first() {
    let table = "variety,v,k\nGala,1,5\nGala,2,\nGala,3,7.1\nFuji,1,8\nFuji,2,9.5\nFuji,3,10\n";
    let (_, text, _) = run(table, "regress~t.csv~--response~k~--terms~variety + v");
    let first = text.lines().next().unwrap();
    assert_eq!(first, "5 of 6 rows, 1 left out (Gala: 1 of 3)");
    for command in ["summary", "compare"] {
        let (_, text, _) = run(table, &format!("{command}~t.csv~--value~k~--by~variety"));
        let first = text.lines().next().unwrap();
        assert_eq!(
            first, "k: 5 of 6 rows, 1 left out (Gala: 1 of 3)",
            "{command}"
        );
    }
}

const DOSES: &str = "dose,k\nlow,1\nlow,1.2\nmedium,2\nmedium,2.3\nhigh,2.9\nhigh,3.1\n";

#[test]
fn closed_form_levels_have_the_order_that_was_declared() {
    let levels = "--levels~dose=low,medium,high";
    let terms = |outcome: &Value| -> Vec<String> {
        let terms = outcome["terms"].as_array().unwrap().iter();
        terms
            .map(|own| own["term"].as_str().unwrap().to_owned())
            .collect()
    };
    let plain = json(DOSES, "regress~t.csv~--response~k~--terms~dose");
    assert_eq!(terms(&plain)[1..], ["dose[low]", "dose[medium]"]);
    let told = json(
        DOSES,
        &format!("regress~t.csv~--response~k~--terms~dose~{levels}"),
    );
    assert_eq!(terms(&told)[1..], ["dose[medium]", "dose[high]"]);
    let found = json(
        DOSES,
        &format!("compare~t.csv~--value~k~--by~dose~{levels}"),
    );
    assert_eq!(found["groups"][0]["group"], "low");
    // Polynomials over 1.1, 2.15 and 3: slope (3 − 1.1)/√2.
    let poly = format!("regress~t.csv~--response~k~--terms~dose~--contrasts~poly~{levels}");
    let linear = json(DOSES, &poly)["terms"][1]["estimate"].as_f64().unwrap();
    assert!((linear - 1.9 / 2f64.sqrt()).abs() < 1e-12, "{linear}");
    // A column of numbers becomes one of levels.
    let days = "day,k\n1,1\n2,2\n3,9\n1,1.1\n2,2.2\n3,9.1\n";
    let told = json(
        days,
        "regress~t.csv~--response~k~--terms~day~--levels~day=3,1,2",
    );
    assert_eq!(terms(&told)[1..], ["day[1]", "day[2]"]);
    // The header of a design declares too.
    let design = format!("# factor A: dose = one of low | medium | high\n{DOSES}");
    let told = json(&design, "regress~t.csv~--response~k~--terms~dose");
    assert_eq!(terms(&told)[1..], ["dose[medium]", "dose[high]"]);
}

/// Names and levels with a comma or a bar stand in backticks, as in formulas.
#[test]
fn repeats_names_in_backticks() {
    let plain = "pad,size,k\nu,a,1\nu,a,1.2\nu,b,2\nv,b,2.3\nv,a,2.9\nv,b,3.1\n";
    let odd = plain
        .replace(",a,", ",\"1,5 cm\",")
        .replace(",b,", ",\"2,5 cm\",");
    let odd = odd.replace("pad,size", "p|ad,\"size,cm\"");
    let means = |table: &str, names: [&str; 4]| {
        let [pad, size, a, b] = names;
        let terms = format!("{pad} * {size}");
        let (asked, levels) = (format!("{size} | {pad}"), format!("{size}={b},{a}"));
        let found = on_table::json(
            table,
            &[
                "regress",
                "t.csv",
                "--response",
                "k",
                "--terms",
                &terms,
                "--means",
                &asked,
                "--levels",
                &levels,
            ],
        );
        found["means"][0]["means"].clone()
    };
    let expected = means(plain, ["pad", "size", "a", "b"]);
    let found = means(&odd, ["`p|ad`", "`size,cm`", "`1,5 cm`", "`2,5 cm`"]);
    assert_eq!(found[0]["levels"], serde_json::json!(["u", "2,5 cm"]));
    for (own, other) in found
        .as_array()
        .unwrap()
        .iter()
        .zip(expected.as_array().unwrap())
    {
        assert_eq!(own["mean"], other["mean"]);
    }
}

#[test]
fn rejects_levels_without_order_or_rows() {
    for (arguments, said) in [
        (
            "--contrasts~poly",
            "--levels 'dose=high,low,medium' with the levels from the lowest to the highest",
        ),
        (
            "--levels~dose=low,high",
            "\"medium\" is none of the levels declared",
        ),
        (
            "--levels~dose=low,medium,high,huge",
            "no row of t.csv has the level \"huge\"",
        ),
        ("--levels~doze=low,high", "did you mean \"dose\"?"),
        ("--levels~dose", "expected a column and its levels"),
        ("--levels~dose=low", "two levels or more"),
        ("--levels~dose=low,low", "stands there twice"),
    ] {
        let all = format!("regress~t.csv~--response~k~--terms~dose~{arguments}");
        let (status, _, told) = run(DOSES, &all);
        assert_eq!(status, Some(2), "{arguments}: {told}");
        assert!(told.contains(said), "{arguments}: {told}");
    }
}

#[test]
fn says_what_numbers_and_repeats_tell() {
    let blocks = "block,k\n1,1\n2,3\n3,2\n1,1.2\n2,3.1\n3,2.2\n";
    let found = json(blocks, "regress~t.csv~--response~k~--terms~block");
    assert!(codes(&found).contains(&"codes"), "{found}");
    let found = json(blocks, "regress~t.csv~--response~k~--terms~C(block)");
    assert!(!codes(&found).contains(&"codes"), "{found}");
    // A straight line through a bend, each point twice.
    let bend = "v,k\n1,1\n1,1.1\n2,4\n2,4.1\n3,9\n3,9.1\n4,16\n4,16.1\n";
    let found = json(bend, "regress~t.csv~--response~k~--terms~v");
    assert!(codes(&found).contains(&"lack-of-fit"), "{found}");
    let found = json(bend, "regress~t.csv~--response~k~--terms~v + v^2");
    assert!(!codes(&found).contains(&"lack-of-fit"), "{found}");
    let (_, text, _) = run(bend, "regress~t.csv~--response~k~--terms~C(v)");
    assert!(text.contains("a coefficient for every setting"), "{text}");
}

#[test]
fn closed_form_a_single_value_does_not_stop_the_other_groups() {
    let table = format!("{PADS}gel,3.3\nair,0.5\nair,0.7\n");
    for (method, pairs) in [("games-howell", 3), ("holm", 3), ("tukey", 6)] {
        let found = json(
            &table,
            &format!("compare~t.csv~--value~k~--by~pad~--pairs~{method}"),
        );
        assert_eq!(found["pairs"].as_array().unwrap().len(), pairs, "{method}");
        assert!(found["welch"]["f"].as_f64().unwrap() > 1.0, "{method}");
        assert!(codes(&found).contains(&"single"), "{method}");
    }
}

/// Each fruit predicted from the others, against a loop over `lm` in R 4.2.
#[test]
fn reference_cross_validation_by_fruit() {
    let table = "fruit,v,k\na,0.1,870\na,0.3,805\na,0.5,760\nb,0.1,910\nb,0.3,841\nb,0.5,803\n\
                 c,0.1,955\nc,0.3,902\nc,0.5,850\nd,0.1,840\nd,0.3,781\nd,0.5,722\n";
    let plain = "regress~t.csv~--response~k~--terms~v";
    let found = json(table, &format!("{plain}~--fold-by~fruit"));
    let validation = &found["cross_validation"];
    assert_eq!(
        (&validation["folds"], &found["fold_by"]),
        (&4.into(), &"fruit".into())
    );
    for (name, expected) in [("rms", 60.7723184629155), ("r2", 0.352825215036085)] {
        let own = validation[name].as_f64().unwrap();
        assert!((own / expected - 1.0).abs() < 1e-12, "{name}: {own}");
    }
    assert_eq!(json(table, plain)["cross_validation"]["folds"], 10);
    let (_, text, _) = run(table, &format!("{plain}~--fold-by~fruit"));
    assert!(
        text.contains("in 4 parts that keep each fruit together"),
        "{text}"
    );
    for (arguments, said) in [
        ("--fold-by~tree", "there is no column \"tree\""),
        ("--fold-by~fruit~--random~fruit", "cannot be used with"),
    ] {
        let (status, _, told) = run(table, &format!("{plain}~{arguments}"));
        assert_eq!(status, Some(2), "{told}");
        assert!(told.contains(said), "{told}");
    }
    let one = table.replace(['b', 'c', 'd'], "a");
    let (status, _, told) = run(&one, &format!("{plain}~--fold-by~fruit"));
    assert_eq!(status, Some(2));
    assert!(told.contains("there is no other to predict"), "{told}");
}

/// Sets of analysis of variance whose values share up to 13 leading digits.
const ANOVA: [&str; 11] = [
    "SiRstv", "SmLs01", "SmLs02", "SmLs03", "AtmWtAg", "SmLs04", "SmLs05", "SmLs06", "SmLs07",
    "SmLs08", "SmLs09",
];

#[test]
fn reference_nist_analysis_of_variance_through_both_commands() {
    for name in ANOVA {
        let file = windfall_test_data::find(&format!("nist/{name}.dat")).unwrap();
        let text = String::from_utf8_lossy(&std::fs::read(file).unwrap()).into_owned();
        let lines: Vec<&str> = text.lines().collect();
        let numbers = |line: &str| -> Vec<f64> {
            let words = line.split_whitespace();
            words.filter_map(|word| word.parse().ok()).collect()
        };
        let row = |start: &str| {
            let line = lines.iter().find(|line| line.starts_with(start));
            numbers(line.unwrap())
        };
        // Degrees of freedom, sum of squares, mean square, F.
        let (between, within) = (row("Between "), row("Within "));
        let data = lines.iter().rposition(|line| line.starts_with("Data:"));
        let mut table = "g,y\n".to_owned();
        for line in &lines[data.unwrap() + 1..] {
            if let [group, value] = &line.split_whitespace().collect::<Vec<_>>()[..] {
                table += &format!("g{group},{value}\n");
            }
        }
        let model = json(&table, "regress~t.csv~--response~y~--terms~g~--folds~0");
        let compared = json(&table, "compare~t.csv~--value~y~--by~g");
        for (what, found, certified) in [
            ("regress", &model["anova"][0]["ss"], between[1]),
            ("regress", &model["residual"]["ss"], within[1]),
            ("regress", &model["anova"][0]["f"], between[3]),
            ("compare", &compared["anova"]["between_ss"], between[1]),
            ("compare", &compared["anova"]["within_ss"], within[1]),
            ("compare", &compared["anova"]["f"], between[3]),
        ] {
            let found = found
                .as_f64()
                .unwrap_or_else(|| panic!("{name} {what}: {compared}"));
            let digits = -(found / certified - 1.0).abs().log10();
            assert!(digits > 9.0, "{name} {what}: {found} {certified}");
        }
    }
}

/// A polynomial of degree ten, whose powers depend on each other to the last digit of doubles.
#[test]
fn reference_nist_polynomial_of_degree_ten_through_regress() {
    let file = windfall_test_data::find("nist/Filip.dat").unwrap();
    let text = std::fs::read_to_string(file).unwrap();
    let words =
        |line: &str| -> Vec<String> { line.split_whitespace().map(str::to_owned).collect() };
    let lines: Vec<Vec<String>> = text.lines().map(words).collect();
    let data = lines
        .iter()
        .rposition(|own| own.first().is_some_and(|word| word == "Data:"));
    let mut table = "y,x\n".to_owned();
    for own in &lines[data.unwrap() + 1..] {
        if let [y, x] = &own[..] {
            table += &format!("{y},{x}\n");
        }
    }
    let powers: Vec<String> = (1..=10).map(|power| format!("x^{power}")).collect();
    let terms = powers.join(" + ");
    let arguments = format!("regress~t.csv~--response~y~--terms~{terms}~--folds~0");
    let found = json(&table, &arguments);
    let close = |found: &Value, certified: &str| {
        let (found, certified) = (found.as_f64().unwrap(), certified.parse::<f64>().unwrap());
        let digits = -(found / certified - 1.0).abs().max(1e-16).log10();
        assert!(digits > 9.0, "{found} {certified}");
    };
    let mut known = 0;
    for own in &lines {
        let power = own.first().and_then(|own| own.strip_prefix('B'));
        if let (Some(power), [_, estimate, se]) = (power, &own[..]) {
            let term = &found["terms"][power.parse::<usize>().unwrap()];
            close(&term["estimate"], estimate);
            close(&term["se"], se);
            known += 1;
        }
    }
    assert_eq!(known, 11);
    close(&found["residual"]["ss"], "0.795851382172941E-03");
    close(&found["model"]["f"], "2162.43954511489");
}
