//! A scene as a deck for LIGGGHTS.

use crate::deck::{Deck, FRAMES, Task, density, variables};
use crate::law::PairNumbers;
use crate::liggghts::model::{Model, Types, model_of, words};
use crate::liggghts::walls::{Walls, walls};
use std::collections::BTreeSet;
use std::fmt::Write;
use windfall_contact::granular_law::Damping;
use windfall_files::text::quote::comment_text;

/// A deck for LIGGGHTS-PUBLIC 3.8.
///
/// # Errors
/// What the engine cannot represent, each with its reason.
pub fn liggghts_deck(task: &Task) -> Result<Deck, Vec<String>> {
    let scene = task.scene;
    let materials: BTreeSet<usize> = scene.walls.iter().map(|own| own.material).collect();
    let types = Types {
        walls: materials.into_iter().collect(),
    };
    let mut reasons = task.lawless();
    if !reasons.is_empty() {
        return Err(reasons);
    }
    let pairs = fruit_model(task);
    let walls = walls(task, &types);
    reasons.extend(pairs.as_ref().err().cloned());
    reasons.extend(walls.as_ref().err().cloned().into_iter().flatten());
    let coefficients = coefficients(task, &types);
    reasons.extend(coefficients.as_ref().err().cloned());
    let (true, Ok(model), Ok(walls), Ok(coefficients)) =
        (reasons.is_empty(), pairs, walls, coefficients)
    else {
        return Err(reasons);
    };
    let first = task.first();
    let text = head(task, &types) + &coefficients + &forces(task, model, &walls);
    let mut files = vec![("in.scene".to_owned(), text + &run(task, &types))];
    if first > 0 {
        let data = task.data(bounds(task), types.walls.len(), "Atoms");
        files.push(("fruit.data".to_owned(), data));
    }
    files.push(("go.in".to_owned(), go(task)));
    if first < scene.fruit.len() {
        files.push(("come.in".to_owned(), COME.to_owned()));
    }
    files.extend(walls.meshes);
    Ok(Deck {
        files,
        steps: task.steps,
        findings: task.finding_of_classes().into_iter().collect(),
    })
}

/// The form that all contacts of fruit have.
fn fruit_model(task: &Task) -> Result<Model, String> {
    let classes = &task.classes.classes;
    let mut found = None;
    for a in classes {
        for b in classes {
            let interaction = task.interaction(a.material, b.material)?;
            let model = model_of(interaction).map_err(|reason| format!("fruit: {reason}"))?;
            if *found.get_or_insert(model) != model {
                return Err(
                    "fruit: all their contacts need one form of law, k d or k d^1.5".into(),
                );
            }
        }
    }
    found.ok_or_else(|| "there are no fruit".to_owned())
}

fn head(task: &Task, types: &Types) -> String {
    let count = types.walls.len() + task.classes.classes.len();
    let space = task.space(bounds(task), count);
    let mut text = format!(
        "# {}\n# A scene of windfall for LIGGGHTS-PUBLIC 3.8: liggghts -in in.scene\n\
         # Frames go to {FRAMES} every {} steps: `windfall scene run FILE --engine liggghts\n\
         # --frames {FRAMES}` makes contacts, fruit and bruises of them.\n\
         units si\natom_style granular\natom_modify map array sort 1000 {}\nboundary f f f\n\
         newton off\ncommunicate single vel yes\nprocessors * * 1\n{space}\n\
         fix fruit all property/atom fruit scalar yes no no 0.0\n",
        comment_text(task.title),
        task.frame_steps,
        2.2 * task.largest(),
    );
    for (number, material) in types.walls.iter().enumerate() {
        let name = comment_text(&task.scene.materials[*material]);
        let _ = writeln!(text, "# type {}: {name} of walls", number + 1);
    }
    for (number, class) in task.classes.classes.iter().enumerate() {
        let name = comment_text(&task.scene.materials[class.material]);
        let _ = writeln!(
            text,
            "# type {}: {name}, about {} m across, {} kg",
            types.walls.len() + number + 1,
            2.0 * class.radius,
            class.mass
        );
    }
    text
}

/// Fruit that leave this box are lost; m.
fn bounds(task: &Task) -> [[f64; 3]; 2] {
    const ROOM: f64 = 1.0;
    let [low, high] = task.bounds();
    [low.map(|own| own - ROOM), high.map(|own| own + ROOM)]
}

/// Coefficients of every pair of types.
fn coefficients(task: &Task, types: &Types) -> Result<String, String> {
    const NAMES: [&str; 8] = [
        "coefficientFriction",
        "coefficientRollingFriction",
        "kn",
        "kt",
        "gamman",
        "gammat",
        "gamman_abs",
        "gammat_abs",
    ];
    let classes = &task.classes.classes;
    let walls = types.walls.len();
    let count = walls + classes.len();
    let mut values = vec![String::new(); NAMES.len()];
    for a in 0..count {
        for b in 0..count {
            let numbers = match (a.checked_sub(walls), b.checked_sub(walls)) {
                (None, None) => [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
                (Some(own), None) | (None, Some(own)) => {
                    let own = classes[own];
                    let wall = types.walls[a.min(b)];
                    of_pair(task, (own.material, wall), own.radius, own.mass)?
                }
                (Some(a), Some(b)) => {
                    let (a, b) = (classes[a], classes[b]);
                    let (radius, mass) = a.effective(&b);
                    of_pair(task, (a.material, b.material), radius, mass)?
                }
            };
            for (text, value) in values.iter_mut().zip(numbers) {
                let _ = write!(text, " {value}");
            }
        }
    }
    let each = |value: &str| vec![value; count].join(" ");
    let mut text = format!(
        "fix youngs all property/global youngsModulus peratomtype {}\n\
         fix poisson all property/global poissonsRatio peratomtype {}\n",
        each("1e6"),
        each("0.3")
    );
    for (name, values) in NAMES.iter().zip(values) {
        let _ = writeln!(
            text,
            "fix p_{name} all property/global {name} peratomtypepair {count}{values}"
        );
    }
    Ok(text)
}

fn of_pair(
    task: &Task,
    (a, b): (usize, usize),
    radius: f64,
    mass: f64,
) -> Result<[f64; 8], String> {
    let interaction = task.interaction(a, b)?;
    let pair = PairNumbers::of(interaction, radius, mass)?;
    let (relative, absolute) = match pair.law.damping {
        Damping::Root(c) => (pair.viscoelastic(c), 0.0),
        Damping::Constant(c) => (0.0, c),
        _ => (0.0, 0.0),
    };
    let share = interaction.tangential_damping;
    Ok([
        interaction.friction,
        interaction.rolling,
        pair.stiffness(),
        pair.tangential(interaction.tangential_ratio),
        relative,
        share * relative,
        absolute,
        share * absolute,
    ])
}

fn forces(task: &Task, model: Model, walls: &Walls) -> String {
    let (form, options) = words(model, task.rolls());
    let mut text = format!(
        "pair_style gran {form} {options}\npair_coeff * *\n{}",
        walls.text
    );
    text += &task.fields();
    for number in 0..task.scene.sinks.len() {
        text += &task.sink(number);
    }
    text + "fix move all nve/sphere\n"
}

/// Time between looks at sinks; s.
const LOOK: f64 = 4e-3;

/// How steps are made: with looks at the sinks between them.
fn go(task: &Task) -> String {
    let looks = (LOOK / task.scene.time_step).round().max(1.0);
    let sinks = (0..task.scene.sinks.len())
        .map(|number| format!(" \"delete_atoms region sink{number} compress no\""))
        .collect::<String>();
    match sinks.is_empty() {
        true => "run ${to} upto\n".to_owned(),
        false => format!("run ${{to}} upto every {looks}{sinks}\n"),
    }
}

fn run(task: &Task, types: &Types) -> String {
    let steps = task.steps;
    // It sets properties only after a run.
    let mut numbers = "run 0\n".to_owned();
    for number in 1..=task.first() {
        let _ = writeln!(numbers, "set atom {number} property/atom fruit {number}");
    }
    let mut text = format!(
        "{}{numbers}dump frames all custom {} {FRAMES} f_fruit x y z vx vy vz omegax omegay omegaz\n\
         variable reach equal {}\nvariable wait equal {}\nvariable end equal {steps}\n",
        task.stepping(),
        task.frame_steps,
        2.0 * task.largest(),
        task.wait()
    );
    for (number, fruit) in task.coming() {
        let [low, high] = fruit.elsewhere.unwrap_or([fruit.place; 2]);
        let _ = write!(
            text,
            "variable to string {}\nvariable fruit string {}\nvariable type string {}\n\
             variable diameter string {}\nvariable density string {}\n\
             variable attempts string {}\n{}include come.in\n",
            task.step_of(fruit.time),
            number + 1,
            types.walls.len() + task.classes.of_fruit[number] + 1,
            2.0 * fruit.radius,
            density(fruit),
            if fruit.elsewhere.is_some() { 8 } else { 0 },
            variables(&[
                ("", fruit.place),
                ("v", fruit.velocity),
                ("l", low),
                ("h", high)
            ])
        );
    }
    text + &format!(
        "variable now equal step\nvariable to string {steps}\n\
         if \"${{now}} >= ${{to}}\" then \"jump SELF over\"\ninclude go.in\nlabel over\n"
    )
}

/// How a fruit comes, as in the deck for LAMMPS.
const COME: &str = r#"variable now equal step
if "${now} >= ${to}" then "jump SELF again"
include go.in
label again
variable attempt delete
variable attempt loop 0 ${attempts}
label try
variable n equal (${now}%65536)*8+${attempt}-1
variable px string ${x}
variable py string ${y}
variable pz string ${z}
variable ax equal ${lx}+(${hx}-${lx})*(v_n*0.8191725133961644-floor(v_n*0.8191725133961644))
variable ay equal ${ly}+(${hy}-${ly})*(v_n*0.6710436067037893-floor(v_n*0.6710436067037893))
variable az equal ${lz}+(${hz}-${lz})*(v_n*0.5497004779019703-floor(v_n*0.5497004779019703))
if "${attempt} > 0" then "variable px string ${ax}" "variable py string ${ay}" "variable pz string ${az}"
region spot sphere ${px} ${py} ${pz} ${reach} units box
variable busy equal count(all,spot)
variable taken string ${busy}
region spot delete
if "${taken} == 0" then "jump SELF free"
next attempt
jump SELF try
variable later equal step+${wait}
if "${later} > ${end}" then "jump SELF done"
variable to string ${later}
include go.in
jump SELF again
label free
create_atoms ${type} single ${px} ${py} ${pz} units box
region spot sphere ${px} ${py} ${pz} ${reach} units box
set region spot diameter ${diameter} density ${density}
set region spot property/atom fruit ${fruit}
set region spot vx ${vx} vy ${vy} vz ${vz}
region spot delete
label done
"#;
