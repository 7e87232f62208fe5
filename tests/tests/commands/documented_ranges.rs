//! The promise: what `docs/formats.md` says of the keys of scenes and set-ups is what is accepted: each range it has in a table up to
//! both ends and no farther, each word and no other, what is needed, and what stands for what is left out.

use std::collections::BTreeSet;
use std::str::FromStr;

use low_action_dsp::{Scene, Setup};
use toml::{Table, Value};

const PAGE: &str = include_str!("../../../docs/formats.md");

/// What the ends of ranges are called that are no numbers, in the descriptions below.
const WORDS: [(&str, f64); 2] = [("nut_clearance", 1e-3), ("the number of strings", 2.0)];
/// Keys whose upper end depends on more than a word can say.
const OPEN: [&str; 2] = ["bridge.length", "pickup.aperture"];
/// Keys of another form than the rest, which have a test of their own.
const OWN: [&str; 3] = ["string.t60", "fretboard.frets", "neck.worn"];
/// How long strings are, m.
const LENGTH: f64 = 0.5;

/// A scene that has every key, and room for those of its lengths that others are measured against.
const SCENE: &str = r#"
sample_rate = 48000.0
duration = 0.0
[solver]
max_iterations = 50
tolerance = 1e-15
stencil = "paper"
[[string]]
length = 0.5
linear_density = 5e-3
tension = 60.0
tension_modulation = true
[[string]]
length = 0.5
linear_density = 5e-3
tension = 60.0
[fretboard]
stiffness = 1e10
exponent = 2.0
board = -0.002
frets = 2
fret_top = -0.001
[[pluck]]
duration = 0.002
position = 1e-4
force = 1.0
[[finger]]
mass = 5e-3
stiffness = 1e10
exponent = 2.0
position = 1e-4
[output]
"#;

/// A set-up that has no key that may be left out.
const SETUP: &str = r#"
name = "any"
max_bend = 2.0
gain = 1.0
[neck]
scale_length = 0.5
frets = 2
nut_clearance = 1e-3
action = 0.04
relief = 0.0
fret_height = 1e-3
stiffness = 1e10
exponent = 1.5
board_reference_spacing = 5e-3
[player]
pluck_position = 0.01
pluck_duration = 3e-3
pluck_force = 1.0
[player.fretting]
mass = 5e-3
stiffness = 1e7
exponent = 2.0
damping = 0.1
hand_damping = 90.0
force = 6.0
landing = 4e-3
hover = 1e-4
behind = 0.4
[player.damper]
mass = 5e-3
stiffness = 1e7
exponent = 2.0
damping = 0.1
hand_damping = 90.0
force = 0.1
landing = 0.01
position = 0.01
[pickup]
kind = "magnetic"
position = 0.05
aperture = 0.02
resonance = 4e3
quality = 2.0
[[string]]
name = "E"
pitch = 40.0
linear_density = 5e-3
youngs_modulus = 2e11
core_radius = 2e-4
loss_0 = 0.5
loss_1 = 1e-3
"#;
const BRIDGE: &str = "[bridge]\nlength = 1e-4\nradius = 1.0\n";
const BODY: &str = "[body]\nfrequency = 100.0\nmass = 1.0\narea = 0.05\nquality = 20.0\nspacing = 50.0\n\
                    volume = 0.01\nhole = 0.005\n";

#[derive(Clone, Copy, PartialEq, Debug)]
enum Form {
    Scene,
    Setup,
}

impl Form {
    /// The part of the page.
    fn section(self) -> &'static str {
        let name = match self {
            Self::Scene => "\n## Scene file\n",
            Self::Setup => "\n## Set-up file\n",
        };
        let (_, rest) = PAGE.split_once(name).expect("the page has it");
        rest.split("\n## ").next().expect("there is always one")
    }

    /// A description that is accepted and has a table.
    fn with(self, table: &str) -> Table {
        let text = match (self, table) {
            (Self::Scene, "body") => [SCENE, BODY].concat(),
            (Self::Scene, _) => SCENE.to_owned(),
            (Self::Setup, "bridge") => [SETUP, BRIDGE].concat(),
            (Self::Setup, "body") => [SETUP, BODY].concat(),
            (Self::Setup, _) => SETUP.to_owned(),
        };
        let table: Table = text.parse().expect("TOML");
        table
    }

    /// All that comes of a description, spelt out, or why it is refused.
    fn read(self, table: &Table) -> Result<String, String> {
        let text = table.to_string();
        let spelt = match self {
            Self::Scene => Scene::from_toml(&text).map(|scene| format!("{scene:?}")),
            Self::Setup => Setup::from_toml(&text).map(|setup| format!("{setup:?}")),
        };
        spelt.map_err(|error| error.to_string())
    }
}

/// A key, as the page has it.
#[derive(Debug)]
struct Key {
    form: Form,
    /// As in the file, `player.fretting`; of several alike the first; nothing for what stands before all tables.
    table: String,
    key: String,
    unit: String,
    range: String,
    left_out: Option<String>,
    meaning: String,
}

impl Key {
    /// The key with its table.
    fn name(&self) -> String {
        if self.table.is_empty() { self.key.clone() } else { format!("{}.{}", self.table, self.key) }
    }

    /// What errors call it.
    fn told(&self) -> String {
        match self.table.as_str() {
            numbered @ ("string" | "pluck" | "finger") => format!("{numbered}[1].{}", self.key),
            _ => self.name(),
        }
    }

    fn is_loss(&self) -> bool {
        self.form == Form::Scene && self.key.starts_with("loss_")
    }

    /// The description with this key so, or without it.
    fn set(&self, value: Option<Value>) -> Table {
        self.with(&self.key, value)
    }

    /// The description with another key in its table.
    fn asking(&self, other: &str) -> Table {
        self.with(other, Some(0.into()))
    }

    fn with(&self, key: &str, value: Option<Value>) -> Table {
        let mut whole = self.form.with(&self.table);
        let mut table = &mut whole;
        for part in self.table.split('.').filter(|part| !part.is_empty()) {
            let within = table.entry(part).or_insert_with(|| Table::new().into());
            table = match within {
                Value::Array(tables) => tables[0].as_table_mut(),
                other => other.as_table_mut(),
            }
            .expect("a table");
        }
        match value {
            Some(value) => table.insert(key.to_owned(), value),
            None => table.remove(key),
        };
        whole
    }

    /// A value of it that has this number.
    fn value(&self, number: f64) -> Value {
        let points = |numbers: &[[f64; 2]]| {
            Value::Array(numbers.iter().map(|point| point.map(Value::Float).to_vec().into()).collect())
        };
        match self.name().as_str() {
            "string.shape" | "string.velocity" => points(&[[0.0, 0.0], [0.2, number], [0.4, 0.0]]),
            _ if is_counted(&self.key) => Value::Integer(number as i64),
            _ => Value::Float(number),
        }
    }

    /// Why it may not be this, in a message that names it.
    fn refusal(&self, value: Value) -> Option<String> {
        let said = self.form.read(&self.set(Some(value))).err()?;
        let (name, told) = (said.split(" = ").next()?, self.told());
        let is_part = |rest: &str| rest.is_empty() || rest.starts_with(['[', '.']);
        let names = name.strip_prefix(&told).is_some_and(is_part) || name.ends_with(&format!(" of {told}"));
        names.then_some(said)
    }

    /// That a number is accepted and the next one outward is not, in a message that has both ends, as far as they are known, and
    /// the unit. An open end is not accepted itself.
    fn check_end(&self, end: f64, outward: f64, open: bool, shown: &[f64]) {
        let counted = is_counted(&self.key);
        let next = |number: f64, up: bool| if up { number.next_up() } else { number.next_down() };
        let [inner, beyond] = match (counted, open) {
            (true, _) => [end, end + outward],
            (false, true) => [next(end, outward < 0.0), end],
            (false, false) => [end, next(end, outward > 0.0)],
        };
        assert_eq!(self.refusal(self.value(inner)), None, "{inner}: {self:?}");
        let others = [outward * 1e300, f64::NAN].into_iter().filter(|_| !counted);
        for beyond in others.chain([beyond]).filter(|&beyond| !counted || beyond >= 0.0) {
            let said = self.refusal(self.value(beyond)).unwrap_or_else(|| panic!("{beyond}: {self:?}"));
            let (_, accepted) =
                said.split_once(" is refused: ").unwrap_or_else(|| panic!("{said}: {self:?}"));
            let words: Vec<&str> = accepted.split([' ', ',']).collect();
            let numbers: Vec<f64> = words.iter().filter_map(|word| number(word)).collect();
            let says = |end: &f64| numbers.iter().any(|number| (number - end).abs() <= 1e-12 * end.abs());
            assert!(shown.iter().all(says), "{said}: {shown:?} of {self:?}");
            let unit = self.unit.split(' ').next().expect("there is always one");
            let has_unit = !["", "–", "MIDI"].contains(&unit);
            assert!(!has_unit || words.contains(&unit), "{said}: {unit}");
        }
    }

    /// That both ends of a range are as they are written.
    fn check(&self, range: &str) {
        let on_string = ["on the string", "on every string"].iter().any(|words| range.starts_with(words));
        let (low, high) = match ends(range) {
            _ if on_string => (Some(0.0), Some(LENGTH)),
            ends => ends.unwrap_or_else(|| panic!("no range: {self:?}")),
        };
        assert_eq!(high.is_none(), OPEN.contains(&self.name().as_str()), "{self:?}");
        let shown: Vec<f64> = low.into_iter().chain(high).collect();
        let low = low.unwrap_or_else(|| panic!("no lower end: {self:?}"));
        self.check_end(low, -1.0, on_string, &shown);
        if let Some(high) = high {
            self.check_end(high, 1.0, on_string, &shown);
        }
    }

    /// That all words are accepted, and no other.
    fn check_words(&self, words: &[Value]) {
        for word in words {
            let mut description = self.set(Some(word.clone()));
            if word.as_str() == Some("microphone") {
                description.extend(BODY.parse::<Table>().expect("TOML"));
            }
            // (What is heard by something else has no coil.)
            let coil = self.name() == "pickup.kind" && word.as_str() != Some("magnetic");
            if coil {
                description.insert("pickup".into(), Table::from_iter([("kind".into(), word.clone())]).into());
            }
            self.form.read(&description).unwrap_or_else(|said| panic!("{said}: {self:?}"));
        }
        for other in [Value::from("papers"), Value::Integer(3)] {
            let said = self.form.read(&self.set(Some(other))).expect_err("there is no such word");
            assert!(said.contains(&self.key), "{said}: {self:?}");
        }
    }

    /// What stands for it where it is left out, as the page says it; nothing where it is needed.
    fn usual(&self) -> Option<String> {
        match (&self.left_out, self.form) {
            (Some(usual), _) => (!usual.starts_with("needed")).then(|| usual.clone()),
            (None, _) => [&self.range, &self.meaning].into_iter().find_map(|said| {
                let Some((before, _)) = said.split_once("if left out") else {
                    return said.contains("may be left out").then(String::new);
                };
                before.trim_end_matches([' ', '(']).rsplit([' ', '(']).next().map(str::to_owned)
            }),
        }
    }
}

/// What is counted, and so a whole number.
fn is_counted(key: &str) -> bool {
    ["max_iterations", "frets", "string"].contains(&key)
}

fn number(word: &str) -> Option<f64> {
    word.replace('−', "-").parse().ok()
}

/// The ends of a range, as far as they are numbers or known words.
fn ends(range: &str) -> Option<(Option<f64>, Option<f64>)> {
    let end = |text: &str| {
        let text = text.trim().replace('`', "");
        let known = WORDS.iter().find(|(words, _)| *words == text).map(|(_, end)| *end);
        known.or_else(|| number(text.split(' ').next()?))
    };
    let plain = range.split([',', ';']).next()?;
    if let Some(low) = plain.strip_suffix(" and up") {
        return Some((end(low), None));
    }
    plain.split_once(" to ").map(|(low, high)| (end(low), end(high)))
}

/// What stands in backticks.
fn quoted(text: &str) -> Vec<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The number that follows some words.
fn number_after<T: FromStr>(form: Form, before: &str) -> T {
    let after = form.section().split_once(before).unwrap_or_else(|| panic!("{before}: not there")).1;
    let number = after.split([' ', ',', ':']).next().and_then(|number| number.parse().ok());
    number.unwrap_or_else(|| panic!("no number follows {before}"))
}

/// The words that a range is, if it is none of numbers.
fn words(range: &str) -> Option<Vec<Value>> {
    let word = |text: String| match text.as_str() {
        "true" => Some(Value::Boolean(true)),
        "false" => Some(Value::Boolean(false)),
        _ => Some(Value::from(text.strip_prefix('"')?.strip_suffix('"')?)),
    };
    range.starts_with('`').then(|| quoted(range).into_iter().map(word).collect())?
}

/// All keys of a form of files, in the order of the page.
fn keys_of(form: Form) -> Vec<Key> {
    let mut keys = Vec::new();
    // The tables that a paragraph says it is of, and what the columns are called.
    let (mut tables, mut columns) = (vec![String::new()], Vec::new());
    for paragraph in form.section().split("\n\n") {
        if paragraph.starts_with("**`[") {
            let names = quoted(paragraph).into_iter().filter(|name| name.starts_with('['));
            let headings = paragraph.matches("**`[").count();
            tables = names.take(headings).map(|name| name.replace(['[', ']'], "")).collect();
        }
        for line in paragraph.lines().filter(|line| line.starts_with('|')) {
            let line = line.strip_prefix('|').and_then(|line| line.strip_suffix('|')).expect("a row");
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            if ["key", "name"].contains(&cells[0]) {
                columns = cells;
            } else if !cells[0].starts_with('-') && columns.contains(&"range") {
                keys.extend(tables.iter().flat_map(|table| keys_in(form, table, &columns, &cells)));
            }
        }
    }
    keys
}

/// The keys in a row, if it is of that table.
fn keys_in(form: Form, table: &str, columns: &[&str], cells: &[&str]) -> Vec<Key> {
    let cell = |name| columns.iter().position(|column| *column == name).map(|at| cells[at].to_owned());
    let [unit, range, meaning] =
        ["unit", "range", "meaning"].map(|name| cell(name).expect("each table has it"));
    if cell("in").is_some_and(|only| only != "both" && !table.ends_with(&only)) {
        return Vec::new();
    }
    let keys = quoted(cells[0]);
    let units: Vec<&str> = unit.split(", ").collect();
    let unit = |place: usize| if units.len() == keys.len() { units[place] } else { &unit };
    let key = |(place, key): (usize, &String)| Key {
        form,
        table: table.to_owned(),
        key: key.clone(),
        unit: unit(place).to_owned(),
        range: range.clone(),
        left_out: cell("if left out"),
        meaning: meaning.clone(),
    };
    keys.iter().enumerate().map(key).collect()
}

/// One of them.
fn key_of(form: Form, name: &str) -> Key {
    keys_of(form).into_iter().find(|key| key.name() == name).unwrap_or_else(|| panic!("{name} is not there"))
}

#[test]
fn ranges_are_as_documented() {
    let all = [Form::Scene, Form::Setup].map(keys_of);
    let scene = |table: &str, key: &Key| {
        let same = all[0].iter().find(|other| (other.table.as_str(), &other.key) == (table, &key.key));
        same.unwrap_or_else(|| panic!("no such key of scenes: {key:?}"))
    };
    for key in all.iter().flatten().filter(|key| !OWN.contains(&key.name().as_str())) {
        let range = key.range.as_str();
        let of_scene = match (range, range.strip_prefix("as a scene's ")) {
            (_, Some(table)) => Some(scene(table, key)),
            ("as in a scene", _) => Some(scene("fretboard", key)),
            _ => None,
        };
        if let Some(other) = of_scene {
            key.check(&other.range);
        } else if let Some(words) = words(range) {
            key.check_words(&words);
        } else if let Some((usual, of_damper)) = range.split_once("; damper ") {
            key.check(if key.table == "player.damper" { of_damper } else { usual });
        } else if key.unit == "–" && (range.starts_with("text") || range == "not empty") {
            assert_eq!(key.refusal("x".into()), None);
            assert_eq!(key.refusal(" ".into()).is_some(), range == "not empty", "{key:?}");
        } else {
            key.check(range);
        }
    }
    // A scene has the body of a set-up.
    for key in all.into_iter().flatten().filter(|key| key.table == "body") {
        let range = key.range.clone();
        Key { form: Form::Scene, ..key }.check(&range);
    }
}

#[test]
fn every_key_that_is_read_is_documented() {
    for form in [Form::Scene, Form::Setup] {
        let keys = keys_of(form);
        let tables: BTreeSet<&str> = keys.iter().map(|key| key.table.as_str()).collect();
        for table in &tables {
            let asked = keys.iter().find(|key| key.table == *table).expect("it is there").asking("bogus");
            let said = form.read(&asked).expect_err("there is no such key");
            let (_, known) = said.split_once("expected ").unwrap_or_else(|| panic!("{said}"));
            // Tables are described by themselves, and that of a body with the set-ups.
            let is_table = |key: &String| {
                let name = if table.is_empty() { key.clone() } else { format!("{table}.{key}") };
                tables.contains(name.as_str()) || (form, name.as_str()) == (Form::Scene, "body")
            };
            let known: BTreeSet<String> = quoted(known).into_iter().filter(|key| !is_table(key)).collect();
            // (Which kind of pickup it is says which keys there are.)
            let own = keys.iter().filter(|key| key.table == *table && key.key != "kind");
            assert_eq!(known, own.map(|key| key.key.clone()).collect(), "{form:?} [{table}]");
        }
    }
}

/// Checks that a list of so many entries is accepted, and one of one more is refused by a name.
fn check_count(form: Form, most: usize, name: &str, with: impl Fn(usize) -> Table) {
    form.read(&with(most)).unwrap_or_else(|said| panic!("{said}: {most} of {name}"));
    let said = form.read(&with(most + 1)).expect_err("there are too many");
    assert!(said.starts_with(&format!("{name} = {} is refused: ", most + 1)), "{said}");
    let (_, accepted) = said.split_once(" is refused: ").expect("it says what is accepted");
    assert!(accepted.split(' ').any(|word| number(word) == Some(most as f64)), "{said}");
}

#[test]
fn counts_are_as_documented() {
    for (form, before, name) in [
        (Form::Scene, "**`[[string]]`**, 1 to ", "string"),
        (Form::Setup, "**`[[string]]`**, 1 to ", "string"),
        (Form::Scene, "**`[[pluck]]`**, up to ", "pluck"),
        (Form::Scene, "**`[[finger]]`**, up to ", "finger"),
    ] {
        let with = |count: usize| {
            let mut whole = form.with(name);
            let entry = whole[name].as_array().expect("a list")[0].clone();
            let mut entries = vec![entry; count];
            if name == "finger" {
                // No more on a string than it may have.
                let strings = whole["string"].as_array_mut().expect("a list");
                strings.resize(count.div_ceil(50), strings[0].clone());
                for (entry, place) in entries.iter_mut().zip(0..) {
                    entry.as_table_mut().expect("a table").insert("string".into(), (place / 50 + 1).into());
                }
            }
            whole.insert(name.into(), entries.into());
            whole
        };
        check_count(form, number_after(form, before), &format!("[[{name}]]"), with);
        if name == "string" {
            assert!(form.read(&with(0)).is_err_and(|said| said.starts_with("[[string]] = 0 is refused")));
        }
    }
    let on_one_string = number_after(Form::Scene, "up to 1000, and up to ");
    check_count(Form::Scene, on_one_string, "number of fingers on string[1]", |count| {
        let mut whole = Form::Scene.with("finger");
        let entry = whole["finger"].as_array().expect("a list")[0].clone();
        whole.insert("finger".into(), vec![entry; count].into());
        whole
    });
    let frets = key_of(Form::Scene, "fretboard.frets");
    let most = ends(&frets.range).and_then(|(_, most)| most).expect("a number") as usize;
    let place = |count: usize| move |fret| Value::Float(LENGTH * f64::from(fret) / (count + 1) as f64);
    let list = |count: usize| Value::Array((1..).take(count).map(place(count)).collect());
    let counted = number_after(Form::Scene, "a count in equal temperament (up to ");
    for (accepted, refused, words) in [
        (list(most), list(most + 1), format!("a list of at most {most} places")),
        (frets.value(counted), frets.value(counted + 1.0), format!("a count from 0 to {counted}")),
    ] {
        Form::Scene.read(&frets.set(Some(accepted))).unwrap_or_else(|said| panic!("{said}"));
        let said = Form::Scene.read(&frets.set(Some(refused))).expect_err("there are too many");
        assert!(said.contains("frets: ") && said.contains(&words), "{said}");
    }
}

#[test]
fn ranges_of_pairs_are_as_documented() {
    let pairs = |pairs: &[[Value; 2]]| {
        Some(Value::Array(pairs.iter().map(|pair| Value::Array(pair.to_vec())).collect()))
    };
    // Both frequencies, and the first time.
    let t60 = key_of(Form::Scene, "string.t60");
    let (frequencies, times) = t60.range.split_once("; the first time ").expect("both ranges");
    let ends_of = |range| match ends(range) {
        Some((Some(low), Some(high))) => [low, high],
        other => panic!("{range}: {other:?}"),
    };
    let decays = |point: [f64; 4]| {
        let [lower, first, upper, second] = point.map(Value::Float);
        t60.set(pairs(&[[lower, first], [upper, second]]))
    };
    let [[lowest, highest], [shortest, longest]] = [frequencies, times].map(ends_of);
    let of = |what, point| format!("{what} of point {point} of string[1].t60");
    let worn = key_of(Form::Setup, "neck.worn");
    let deepest = number_after(Form::Setup, "named once and worn by up to ");
    let wear = |depth: f64| worn.set(pairs(&[[1.into(), depth.into()]]));
    let (scene, setup) = (Form::Scene, Form::Setup);
    for (form, accepted, refused, name) in [
        (
            scene,
            decays([lowest, 1.0, 10.0, 1.0]),
            decays([lowest.next_down(), 1.0, 10.0, 1.0]),
            of("frequency", 1),
        ),
        (
            scene,
            decays([10.0, 1.0, highest, 1.0]),
            decays([10.0, 1.0, highest.next_up(), 1.0]),
            of("frequency", 2),
        ),
        (
            scene,
            decays([10.0, shortest, 20.0, shortest]),
            decays([10.0, shortest.next_down(), 20.0, shortest]),
            of("time", 1),
        ),
        (
            scene,
            decays([10.0, longest, 20.0, longest]),
            decays([10.0, longest.next_up(), 20.0, longest]),
            of("time", 1),
        ),
        (setup, wear(deepest), wear(deepest.next_up()), "depth of neck.worn[1]".to_owned()),
    ] {
        form.read(&accepted).unwrap_or_else(|said| panic!("{said}: {name}"));
        let said = form.read(&refused).expect_err("it is just beyond");
        assert!(said.starts_with(&format!("{name} = ")), "{said}: {name}");
    }
}

#[test]
fn what_may_be_left_out_is_as_documented() {
    for key in [Form::Scene, Form::Setup].into_iter().flat_map(keys_of) {
        let without = key.form.read(&key.set(None));
        let Some(usual) = key.usual() else {
            let said = without.err().unwrap_or_else(|| panic!("it is not needed: {key:?}"));
            assert!(said.contains(&format!("`{}`", key.key)), "{said}: {key:?}");
            continue;
        };
        let without = without.unwrap_or_else(|said| panic!("{said}: {key:?}"));
        let usual = number(&usual).map(|number| vec![key.value(number)]).or_else(|| words(&usual));
        // (Of losses the file keeps whether they were given.)
        for usual in usual.into_iter().flatten().filter(|_| !key.is_loss()) {
            assert_eq!(key.form.read(&key.set(Some(usual))), Ok(without.clone()), "{key:?}");
        }
    }
}
