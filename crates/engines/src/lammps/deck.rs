//! A scene as a deck for LAMMPS.

use crate::deck::{Deck, FRAMES, Task, variables};
use crate::lammps::terms::terms;
use crate::lammps::walls::walls;
use std::fmt::Write;
use windfall_files::found::FindingOutcome;
use windfall_files::text::quote::comment_text;

/// Classes that LAMMPS can have at most: it has 32 groups.
const MOST_CLASSES: usize = 28;

/// A deck that every LAMMPS from 29 September 2021 on reads.
///
/// # Errors
/// What the engine cannot represent, each with its reason.
pub fn lammps_deck(task: &Task) -> Result<Deck, Vec<String>> {
    let mut reasons = task.lawless();
    if task.classes.classes.len() > MOST_CLASSES {
        reasons.push(format!(
            "{} classes of fruit: it can have {MOST_CLASSES}, ask for fewer with --classes",
            task.classes.classes.len()
        ));
    }
    let pairs = pairs(task);
    let walls = walls(task);
    reasons.extend(pairs.as_ref().err().cloned());
    reasons.extend(walls.as_ref().err().cloned().into_iter().flatten());
    let (true, Ok(pairs), Ok(walls)) = (reasons.is_empty(), pairs, walls) else {
        return Err(reasons);
    };
    let first = task.first();
    let mut files = vec![("in.scene".to_owned(), {
        let mut text = head(task);
        text += &format!("{pairs}\n{walls}\n{}", forces(task));
        text += &run(task);
        text
    })];
    if first > 0 {
        let data = task.data(task.bounds(), 0, "Atoms # sphere");
        files.push(("fruit.data".to_owned(), data));
    }
    if first < task.scene.fruit.len() {
        files.push(("come.in".to_owned(), COME.to_owned()));
    }
    files.push(("go.in".to_owned(), go()));
    let mut findings: Vec<FindingOutcome> = task.finding_of_classes().into_iter().collect();
    if task.rolls() {
        findings.push(FindingOutcome::new(
            "engine-rolling",
            "LAMMPS resists rolling with one stiffness at any load: the limit of the \
             moment is the scene's, its stiffness is right at five times the weight",
        ));
    }
    Ok(Deck {
        files,
        steps: task.steps,
        findings,
    })
}

fn head(task: &Task) -> String {
    let scene = task.scene;
    let down = (0..3).max_by(|&a, &b| scene.gravity[a].abs().total_cmp(&scene.gravity[b].abs()));
    let processors = match down {
        Some(0) => "1 * *",
        Some(1) => "* 1 *",
        _ => "* * 1",
    };
    let reach = 2.0 * task.largest() + task.skin();
    let space = task.space(task.bounds(), task.classes.classes.len());
    // An empty box has no fruit to number; a checkpoint has their numbers.
    let number = match task.first() {
        0 => "",
        _ => "variable id atom id\nif \"${first} == 0\" then \"set group all i_fruit v_id\"\n",
    };
    let mut text = format!(
        "# {}\n# A scene of windfall for LAMMPS of 29 September 2021 and newer: lmp -in in.scene\n\
         # Frames go to {FRAMES} every {} steps: `windfall scene run FILE --engine lammps --frames \
         {FRAMES}`\n# makes contacts, fruit and bruises of them.\n\
         {RESUME}variable time equal step*{}\nunits si\natom_style sphere\n\
         atom_modify map hash sort 1000 {}\nboundary m m m\nnewton off\n\
         comm_modify vel yes cutoff {reach}\nprocessors {processors}\n\
         if \"${{first}} == 0\" then {} else \"read_restart ${{from}}\"\n\
         fix fruit all property/atom i_fruit ghost yes\n{number}group old empty\ngroup new empty\n",
        comment_text(task.title),
        task.frame_steps,
        scene.time_step,
        2.2 * task.largest(),
        quoted(&space),
    );
    for (number, class) in task.classes.classes.iter().enumerate() {
        let kind = number + 1;
        let material = comment_text(&scene.materials[class.material]);
        let _ = writeln!(
            text,
            "# type {kind}: {material}, about {} m across, {} kg\ngroup t{kind} type {kind}",
            2.0 * class.radius,
            class.mass
        );
    }
    text
}

/// Lines as commands of an `if`.
fn quoted(lines: &str) -> String {
    let lines: Vec<String> = lines.lines().map(|own| format!("\"{own}\"")).collect();
    lines.join(" ")
}

/// Variables that may be set before the deck: steps between checkpoints; and for a run that resumes,
/// the restart file, the next fruit (from 1), and the step at which it is tried.
pub(crate) const RESUME: &str = "variable keep index 0\nvariable from index none\nvariable first index 0\n\
                      variable next index 0\n";

fn pairs(task: &Task) -> Result<String, String> {
    let classes = &task.classes.classes;
    let mut text = "pair_style granular\n".to_owned();
    for (first, a) in classes.iter().enumerate() {
        for (second, b) in classes.iter().enumerate().skip(first) {
            let (radius, mass) = a.effective(b);
            let interaction = task.interaction(a.material, b.material)?;
            let terms = terms(task, interaction, radius, mass)?;
            let _ = writeln!(text, "pair_coeff {} {} {terms}", first + 1, second + 1);
        }
    }
    Ok(text)
}

/// Gravity, air, sinks; how fruit move.
fn forces(task: &Task) -> String {
    let mut text = task.fields();
    for number in 0..task.scene.sinks.len() {
        let _ = writeln!(
            text,
            "{}fix sink{number} all evaporate {SINK_STEPS} 1000000000 sink{number} 1",
            task.sink(number)
        );
    }
    text + "fix move all nve/sphere\n"
}

/// Steps between looks at sinks.
const SINK_STEPS: u64 = 32;

fn run(task: &Task) -> String {
    let steps = task.steps;
    let mut text = format!(
        "{}compute_modify thermo_temp dynamic/dof yes\n\
         dump frames all custom {} {FRAMES} i_fruit x y z vx vy vz omegax omegay omegaz\n\
         if \"${{first}} > 0\" then \"run 0 post no\"\nvariable end equal {steps}\n",
        task.stepping(),
        task.frame_steps,
    );
    for (place, (number, fruit)) in task.coming().enumerate() {
        if place == 0 {
            let _ = writeln!(
                text,
                "variable reach equal {}\nvariable wait equal {}",
                2.0 * task.largest(),
                task.wait()
            );
        }
        let [low, high] = fruit.elsewhere.unwrap_or([fruit.place; 2]);
        let _ = write!(
            text,
            "variable at string {}\nvariable fruit string {}\nvariable type string {}\n\
             variable diameter string {}\nvariable mass string {}\n{}\
             variable attempts string {}\n{}include come.in\n",
            task.step_of(fruit.time),
            number + 1,
            task.classes.of_fruit[number] + 1,
            2.0 * fruit.radius,
            fruit.mass,
            variables(&[("", fruit.place), ("v", fruit.velocity)]),
            if fruit.elsewhere.is_some() { "8" } else { "0" },
            variables(&[("l", low), ("h", high)])
        );
    }
    let none = task.scene.fruit.len() + 1;
    text + &format!("variable coming equal {none}\nvariable to equal {steps}\ninclude go.in\n")
}

/// How it goes on to a step, with a checkpoint where one is due. A run goes on from it as if it
/// had read it: forces are calculated anew from velocities of whole steps.
fn go() -> String {
    format!(
        r#"label on
if "$(step) >= ${{to}}" then "jump SELF there"
variable stop equal ${{to}}
if "${{keep}} > 0" then "variable stop equal $((floor(step/v_keep)+1)*v_keep)"
if "${{stop}} > ${{to}}" then "variable stop equal ${{to}}"
run ${{stop}} upto
if "${{keep}} == 0" then "jump SELF on"
if "$(step%v_keep) > 0" then "jump SELF on"
if "$(step) < ${{end}}" then "write_restart {}" "run 0 post no"
jump SELF on
label there
"#,
        restart_name("$(round(step/v_keep)%2)")
    )
}

/// Name of LAMMPS's own part of a checkpoint.
///
/// * `turn`: 0 or 1, in turn, so that the one of before stays whole
pub(crate) fn restart_name(turn: impl std::fmt::Display) -> String {
    format!("checkpoint.{turn}.lammps")
}

/// How a fruit comes, unless it came before a checkpoint: at its step; where its place is taken
/// elsewhere in its box, on places that are spread over it, and where there is no room it waits.
const COME: &str = r#"if "${fruit} < ${first}" then "jump SELF done"
if "${fruit} == ${first}" then "variable at string ${next}"
variable coming equal ${fruit}
variable to equal ${at}
include go.in
label again
variable attempt delete
variable attempt loop 0 ${attempts}
label try
variable n equal $((step%65536)*8+v_attempt-1)
if "${attempt} == 0" then "variable px string ${x}" "variable py string ${y}" "variable pz string ${z}" else "variable px string $(v_lx+(v_hx-v_lx)*(v_n*0.8191725133961644-floor(v_n*0.8191725133961644)))" "variable py string $(v_ly+(v_hy-v_ly)*(v_n*0.6710436067037893-floor(v_n*0.6710436067037893)))" "variable pz string $(v_lz+(v_hz-v_lz)*(v_n*0.5497004779019703-floor(v_n*0.5497004779019703)))"
region spot sphere ${px} ${py} ${pz} ${reach} units box
variable taken string $(count(all,spot))
region spot delete
if "${taken} == 0" then "jump SELF free"
next attempt
jump SELF try
if "$(step+v_wait) > ${end}" then "jump SELF done"
variable to equal $(step+v_wait)
include go.in
jump SELF again
label free
group old clear
group old union all
create_atoms ${type} single ${px} ${py} ${pz} units box
group new clear
group new subtract all old
set group new diameter ${diameter}
set group new mass ${mass}
set group new i_fruit ${fruit}
velocity new set ${vx} ${vy} ${vz} units box
group t${type} union new
label done
"#;
