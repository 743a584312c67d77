//! Figures as a journal prints them: every kind of figure at the widths of one and two columns.

use assert_cmd::Command;
use resvg::tiny_skia::Rect;
use resvg::usvg::{Group, Node, Options, Text, Tree};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Sizes of letters, and the least width of lines, in pt; a px of a drawing is 0.75 pt.
const LETTERS: f32 = 8.0;
const LEAST_RAISED: f32 = 5.5;
const LEAST_LINE: f32 = 0.5;
const POINT: f32 = 0.75;

/// How far letters may reach into each other's boxes, such as those of a raised part; px.
const TOUCH: f32 = 0.5;

fn windfall(folder: &Path, arguments: &[&str]) {
    let mut command = Command::cargo_bin("windfall").unwrap();
    let output = command
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {told}");
}

/// A line of words; "~" stands for a blank within one.
fn run(folder: &Path, line: &str) {
    let words: Vec<String> = line
        .split_whitespace()
        .map(|w| w.replace('~', " "))
        .collect();
    windfall(
        folder,
        &words.iter().map(String::as_str).collect::<Vec<_>>(),
    );
}

fn options() -> Options<'static> {
    let font = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../draw/fonts/LiberationSans-Regular.ttf"
    );
    let mut options = Options {
        font_family: "Liberation Sans".to_owned(),
        ..Options::default()
    };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(std::fs::read(font).unwrap());
    fonts.set_sans_serif_family("Liberation Sans");
    options
}

/// Texts of a drawing, and widths of its lines; px.
fn collect<'a>(group: &'a Group, texts: &mut Vec<&'a Text>, lines: &mut Vec<f32>) {
    for node in group.children() {
        match node {
            Node::Group(own) => collect(own, texts, lines),
            Node::Text(own) => texts.push(own),
            Node::Path(own) => lines.extend(own.stroke().map(|own| own.width().get())),
            Node::Image(_) => panic!("a figure has no image"),
        }
    }
}

fn words(text: &Text) -> String {
    text.chunks().iter().map(|own| own.text()).collect()
}

/// Whether two boxes share more than letters may.
fn overlap(a: Rect, b: Rect) -> bool {
    let across = a.right().min(b.right()) - a.left().max(b.left());
    let down = a.bottom().min(b.bottom()) - a.top().max(b.top());
    across > TOUCH && down > TOUCH
}

/// What a printer would object to.
fn faults(svg: &str, mm: f32) -> Vec<String> {
    let tree = Tree::from_str(svg, &options()).unwrap();
    let mut faults = Vec::new();
    if !svg.contains(&format!(" width=\"{mm}mm\" height=\"")) {
        faults.push("its width is not given in mm".to_owned());
    }
    let (width, height) = (tree.size().width(), tree.size().height());
    if (width * 25.4 / 96.0 - mm).abs() > 0.01 {
        faults.push(format!("{width} px wide"));
    }
    let (mut texts, mut lines) = (Vec::new(), Vec::new());
    collect(tree.root(), &mut texts, &mut lines);
    if lines.iter().any(|own| own * POINT < LEAST_LINE) {
        faults.push("a line is too thin".to_owned());
    }
    let mut boxes: Vec<(Rect, String)> = Vec::new();
    for text in texts {
        let own = words(text);
        for span in text.layouted() {
            let size = POINT * span.font_size.get();
            if (size - LETTERS).abs() > 0.01 && !(LEAST_RAISED..LETTERS).contains(&size) {
                faults.push(format!("{own:?} has letters of {size} pt"));
            }
        }
        let found = text.flattened().abs_bounding_box();
        let inside = found.left() > -TOUCH
            && found.right() < width + TOUCH
            && found.top() > -TOUCH
            && found.bottom() < height + TOUCH;
        if !inside {
            faults.push(format!("{own:?} lies outside: {found:?}"));
        }
        for (other, their) in &boxes {
            if overlap(found, *other) {
                faults.push(format!("{own:?} lies over {their:?}"));
            }
        }
        boxes.push((found, own));
    }
    faults
}

/// Every SVG below a folder.
fn pictures(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(pictures(&path));
        } else if path.extension() == Some("svg".as_ref()) {
            found.push(path);
        }
    }
    found
}

/// Impacts on fruit of four varieties with long names.
fn fruit() -> String {
    let varieties = [
        "Golden Delicious (lot 1)",
        "Royal Gala",
        "Fuji",
        "Granny Smith of the north",
    ];
    let mut text = "fruit,variety,V_m_s,mass_g,k_N_m,predicted_N_m\n".to_owned();
    for fruit in 0..24 {
        for impact in 0..3 {
            let (f, i) = (f64::from(fruit), f64::from(impact));
            let velocity = 0.3 + 0.4 * i + 0.02 * (f * 2.3).sin();
            let own = 7e5 + 6e4 * f64::from(fruit % 4) + 1e5 * velocity;
            let k = own + 4e4 * (f * 1.7).sin() + 2e4 * (f * 3.1 + i * 2.9).cos();
            let mass = 150.0 + 20.0 * (f * 0.9).sin();
            let variety = varieties[fruit as usize % 4];
            text += &format!("f{fruit},{variety},{velocity:.3},{mass:.1},{k:.0},{own:.0}\n");
        }
    }
    text
}

/// The published design of the drop study (Kang et al. 2023, table 3), a part of it.
const RUNS: &str = "run,k,e,c,force_N,interval_ms
1,1,2.25,3.5E-4,14.9,334\n2,0.44,1.8,2E-4,9.4,380\n3,0.65,2.25,6E-4,11.8,275
4,0.86,1.8,5E-4,11.2,310\n5,0.44,2.7,5E-4,13.6,282\n6,0.65,2.25,1E-4,13.6,385
7,0.44,1.8,5E-4,7.6,276\n8,0.3,2.25,3.5E-4,9.7,328\n9,0.86,2.7,2E-4,18.3,334
10,0.86,2.7,5E-4,15.1,287\n11,0.65,2.25,3.5E-4,13.1,326\n12,0.44,2.7,2E-4,14.3,362
13,0.65,1.5,3.5E-4,8.4,323\n14,0.65,3,3.5E-4,17.7,301\n15,0.86,1.8,2E-4,12.4,372\n";

/// What draws from tables, and what each picture is called or where it goes.
const OF_TABLES: [&str; 8] = [
    "surface runs.csv --response force_N --response interval_ms --factor k --factor e --factor c \
     --goal force_N~=~target~11.3 --goal interval_ms~=~target~299 --figures surface",
    "regress fruit.csv --response k_N_m --terms V_m_s+variety+mass_g --figures regress",
    "regress fruit.csv --response k_N_m --terms V_m_s+variety --random fruit --figures mixed",
    "compare fruit.csv --value k_N_m --by variety --specimen fruit --figures compare",
    "compare fruit.csv --measured k_N_m --predicted predicted_N_m --figures agreement",
    "summary fruit.csv --value k_N_m --by variety --figures summary",
    "plan mean --sd 1 --half-width 0.2 --figure plan/plan.svg",
    "simulate impact --law hertz(k=753599) --mass 0.2~kg --velocity 0.5~m/s --plot hertz/one.svg",
];

/// Campaigns, and what draws them.
const CAMPAIGNS: [&str; 6] = [
    "simulate pendulum --law kuwabara-kono(k=394931,c=681) --specimens 6 --repeats 2 --spread \
     k=40000 --recordings impacts",
    "simulate compression press --law kuwabara-kono(k=300000,c=20000) --yield-force 30~N",
    "simulate tap taps",
    "simulate repeats again",
    "simulate drop drops --law hertz(k=170000) --mass 4.8~g --height 500~mm",
    "fit impacts",
];
const OF_CAMPAIGNS: [&str; 7] = [
    "fit impacts --law kuwabara-kono --law hertz --law hunt-crossley --figures fit",
    "laws impacts --law kuwabara-kono --law hertz --law hunt-crossley --figures laws",
    "fit press --figures press-figures",
    "fit taps --figures taps-figures",
    "fit again --figures again-figures",
    "fit drops --figures drops-figures",
    "report impacts --intervals profile --out report-files",
];

/// At both widths every figure is as wide as asked for, its letters are 8 pt and none of them lies
/// outside or over others, and no line is thinner than half a point.
#[test]
fn closed_form_every_kind_of_figure_can_be_printed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("runs.csv"), RUNS).unwrap();
    std::fs::write(folder.join("fruit.csv"), fruit()).unwrap();
    CAMPAIGNS.iter().for_each(|line| run(folder, line));
    for (width, mm) in [("84mm", 84.0), ("17.4cm", 174.0)] {
        for place in ["plan", "hertz", "inspect"] {
            std::fs::create_dir_all(folder.join(place)).unwrap();
        }
        for line in OF_TABLES.iter().chain(&OF_CAMPAIGNS) {
            run(folder, &format!("{line} --width {width}"));
        }
        let raw = std::fs::read_dir(folder.join("impacts/raw")).unwrap();
        let raw = raw.map(|own| own.unwrap().path()).min().unwrap();
        let plot = ["--plot", "inspect/one.svg", "--width", width];
        windfall(
            folder,
            &[&["inspect", raw.to_str().unwrap()], &plot[..]].concat(),
        );

        let found = pictures(folder);
        let wrong = found.iter().filter_map(|path| {
            let svg = std::fs::read_to_string(path).unwrap();
            let faults = faults(&svg, mm);
            (!faults.is_empty()).then(|| format!("{}: {}", path.display(), faults.join("; ")))
        });
        let wrong: Vec<String> = wrong.collect();
        assert!(wrong.is_empty(), "at {width}:\n{}", wrong.join("\n"));
        assert!(found.len() > 60, "{}", found.len());
    }
}

/// The check finds what it is for: letters of another size, outside, over each other, thin lines.
#[test]
fn rejects_what_cannot_be_printed() {
    let figure = |inner: &str| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"84mm\" height=\"40mm\" \
             viewBox=\"0 0 317.48 151.18\">{inner}</svg>"
        )
    };
    let text = |x: f64, size: f64, words: &str| {
        format!("<text x=\"{x}\" y=\"30\" font-size=\"{size}\">{words}</text>")
    };
    let good = figure(&(text(10.0, 10.667, "force") + &text(60.0, 10.667, "N")));
    assert_eq!(faults(&good, 84.0), Vec::<String>::new());
    let line = "<line x1=\"1\" y1=\"1\" x2=\"9\" y2=\"9\" stroke=\"#000\" stroke-width=\"0.5\"/>";
    for (wrong, word) in [
        (
            figure(&text(10.0, 9.0, "force")).replace("9", "6"),
            "letters of",
        ),
        (figure(&text(310.0, 10.667, "force")), "outside"),
        (
            figure(&(text(10.0, 10.667, "force") + &text(20.0, 10.667, "N"))),
            "lies over",
        ),
        (figure(line), "too thin"),
        (good.replace("84mm", "317"), "not given in mm"),
    ] {
        let found = faults(&wrong, 84.0).join("; ");
        assert!(found.contains(word), "{word}: {found}");
    }
}

/// A PDF is a page of the width asked for, with a part of the font and no other picture of letters;
/// it has the same bits every time.
#[test]
fn closed_form_pdf_of_the_width_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("fruit.csv"), fruit()).unwrap();
    let command = |formats: &str, out: &str| {
        let own = [
            "summary",
            "fruit.csv",
            "--value",
            "k_N_m",
            "--by",
            "variety",
            "--width",
            "84mm",
        ];
        let files = ["--figures", out, "--figure-format", formats];
        windfall(folder, &[&own[..], &files[..]].concat());
    };
    command("pdf", "once");
    command("pdf,svg", "twice");
    let names = |out: &str| {
        let files = std::fs::read_dir(folder.join(out)).unwrap();
        let names = files.map(|own| own.unwrap().file_name());
        let shown = |own: &std::ffi::OsString| !own.to_string_lossy().starts_with('.');
        let mut names: Vec<_> = names.filter(shown).collect();
        names.sort();
        names
    };
    assert_eq!(names("once"), ["summary-k_N_m.csv", "summary-k_N_m.pdf"]);
    assert_eq!(names("twice").len(), 3);
    let pdf = std::fs::read(folder.join("once/summary-k_N_m.pdf")).unwrap();
    assert_eq!(
        pdf,
        std::fs::read(folder.join("twice/summary-k_N_m.pdf")).unwrap()
    );
    let text = String::from_utf8_lossy(&pdf);
    assert!(
        text.starts_with("%PDF-") && text.contains("/MediaBox [0 0 238.11"),
        "{text}"
    );
    assert!(text.contains("+LiberationSans") && text.contains("/FontFile2"));
    assert!(text.contains("/ToUnicode") && !text.contains("/Image"));
}

/// Widths that leave no room, or have no unit, are refused with what is possible.
#[test]
fn rejects_widths_that_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("fruit.csv"), fruit()).unwrap();
    for (width, words) in [
        ("84", "60 mm to 400 mm"),
        ("20mm", "60 mm to 400 mm"),
        ("84 N", "N"),
    ] {
        let mut command = Command::cargo_bin("windfall").unwrap();
        command.args(["summary", "fruit.csv", "--figures", "f", "--width", width]);
        let output = command.current_dir(folder.path()).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(words) && told.contains("--width"), "{told}");
    }
}
