//! Set-ups: the built-in ones read, say what they should and are strung in tune on paper; wrong ones are
//! refused in one line that names the key, its value and what is accepted. What is written is read again bit for bit.

use low_action_dsp::intonation::{finger_place, intonate};
use low_action_dsp::setup::{Bridge, Intonation, Pickup, frequency};
use low_action_dsp::{Instrument, Model, Quality, Setup, SolverSettings, Stencil};
use low_action_tests::numbers::largest;

const RATE: f64 = 48_000.0;

fn builtin(name: &str) -> Setup {
    Setup::builtin(name).unwrap()
}

/// The built-in electric set-up with some text replaced.
fn changed(from: &str, to: &str) -> String {
    let text = include_str!("../../../dsp/instruments/electric.toml");
    assert!(text.contains(from), "`{from}` is not in the file");
    text.replacen(from, to, 1)
}

#[test]
fn built_in_setups_read() {
    for name in Setup::BUILTIN {
        let setup = builtin(name);
        assert_eq!(setup.name, name);
        assert_eq!(setup.intonation, Intonation::Compensated);
        assert!(!setup.description.is_empty() && !setup.description.contains('\n'));
    }
    assert_eq!(Setup::BUILTIN[0], "electric");
    assert_eq!(builtin("electric").neck.frets, 22);
    assert!(matches!(builtin("electric").pickup, Pickup::Magnetic { .. }));
    assert!(matches!(builtin("steel").pickup, Pickup::Microphone {}));
    assert!(Setup::builtin("banjo").is_none());
}

#[test]
fn what_is_written_is_read_again() {
    for name in Setup::SHIPPED {
        let setup = Setup::shipped(name).unwrap();
        let text = setup.to_toml().unwrap();
        assert_eq!(Setup::from_toml(&text).unwrap(), setup, "{text}");
    }
}

#[test]
fn built_in_setups_are_in_standard_tuning() {
    let guitar = [64.0, 59.0, 55.0, 50.0, 45.0, 40.0];
    for name in ["electric", "classical", "steel"] {
        let pitches: Vec<f64> = builtin(name).string.iter().map(|string| string.pitch).collect();
        assert_eq!(pitches, guitar, "{name}");
    }
    let bass: Vec<f64> = builtin("bass").string.iter().map(|string| string.pitch).collect();
    assert_eq!(bass, [43.0, 38.0, 33.0, 28.0]);
}

/// Tensions within 2 % of the manufacturer's chart (or of the paper the strings come from), N.
#[test]
fn tensions_match_their_sources() {
    const POUND: f64 = 4.4482;
    let sources: [(&str, &[f64]); 4] = [
        // D'Addario EXL110, 25.5 in.
        ("electric", &[16.2, 15.4, 16.6, 18.4, 19.5, 17.5].map(|pounds| pounds * POUND)),
        // Woodhouse 2004.
        ("classical", &[70.3, 53.4, 58.3, 71.2, 73.9, 71.6]),
        // D'Addario EJ17, 25.5 in.
        ("steel", &[27.4, 26.3, 35.3, 36.8, 34.0, 29.0].map(|pounds| pounds * POUND)),
        // D'Addario EXL170, 34 in.
        ("bass", &[42.8, 51.3, 42.0, 36.5].map(|pounds| pounds * POUND)),
    ];
    for (name, tensions) in sources {
        let setup = builtin(name);
        for (string, tension) in setup.string.iter().zip(tensions) {
            let found = intonate(&setup, string, Stencil::Wide, RATE).unwrap().string.tension;
            assert!(
                (found / tension - 1.0).abs() < 0.02,
                "{name} {}: {found} N instead of {tension} N",
                string.name
            );
        }
    }
}

#[test]
fn frets_stay_in_order_and_near_equal_temperament() {
    for name in Setup::BUILTIN {
        let setup = builtin(name);
        let equal = setup.neck.equal_places();
        for string in &setup.string {
            let found = intonate(&setup, string, Stencil::Wide, RATE).unwrap();
            assert_eq!(found.frets.len(), setup.neck.frets);
            assert!(found.frets.windows(2).all(|pair| pair[0] < pair[1]), "{name} {}", string.name);
            for (fret, (place, equal)) in found.frets.iter().zip(&equal).enumerate() {
                let moved = place - equal;
                // A luthier moves a saddle by as much.
                assert!(moved.abs() < 5.5e-3, "{name} {} fret {}: {moved} m", string.name, fret + 1);
                let finger = finger_place(&found.frets, fret, setup.behind());
                assert!(finger > 0.0 && finger < *place);
                // A fingertip never lies on its fret, nor on the one before.
                let space = place - fret.checked_sub(1).map_or(0.0, |below| found.frets[below]);
                let distance = place - finger;
                // (Why on steel strings it is less: `pressed.rs`.)
                let half_a_fingertip = if name == "steel" { 0.006 } else { 0.007_f64 };
                let least = half_a_fingertip.min(0.65 * space) - 1e-12;
                assert!(distance >= least, "{name} fret {}: {distance} m", fret + 1);
                assert!(distance < 0.66 * space, "{name} fret {}: {distance} m", fret + 1);
            }
        }
    }
}

/// Grids of every rate and stencil take the built-in instruments, and the same twice.
#[test]
fn every_rate_can_be_intonated() {
    for name in Setup::BUILTIN {
        let setup = builtin(name);
        for rate in [22_050.0, 44_100.0, 96_000.0, 192_000.0] {
            for stencil in [Stencil::Paper, Stencil::Corrected, Stencil::Wide] {
                let string = &setup.string[0];
                let found = intonate(&setup, string, stencil, rate).unwrap();
                assert_eq!(found, intonate(&setup, string, stencil, rate).unwrap());
                let barrier = setup.neck.barrier(&found.frets).unwrap();
                let settings = SolverSettings { stencil, ..Default::default() };
                Model::new(found.string, Some(&barrier), 4, settings, rate).unwrap();
            }
        }
    }
}

#[test]
fn raw_intonation_keeps_equal_temperament() {
    let setup = Setup::from_toml(&changed("\"compensated\"", "\"physical\"")).unwrap();
    let found = intonate(&setup, &setup.string[0], Stencil::Wide, RATE).unwrap();
    assert_eq!(found.frets, setup.neck.equal_places());
}

#[test]
fn the_neck_has_the_clearances_it_names() {
    for name in Setup::BUILTIN {
        let neck = builtin(name).neck;
        let first = neck.crown_height(neck.equal_place(1.0));
        let twelfth = neck.crown_height(neck.equal_place(12.0));
        assert!((first + neck.nut_clearance).abs() < 1e-12);
        assert!((twelfth + neck.action).abs() < 1e-12);
        // Relief: the crowns dip below the chord from the first to the last by no more than it.
        let (from, to) = (neck.equal_place(1.0), neck.equal_place(neck.frets as f64));
        let middle = 0.5 * (from + to);
        let chord = 0.5 * (neck.crown_height(from) + neck.crown_height(to));
        assert!((chord - neck.crown_height(middle) - neck.relief).abs() < 1e-12);
        assert!(neck.board_height(neck.board_end()).is_some());
        assert!(neck.board_height(neck.board_end() + 1e-6).is_none());
    }
}

#[test]
fn frequencies_follow_the_midi_tuning_standard() {
    assert!((frequency(69.0) - 440.0).abs() < 1e-12);
    assert!((frequency(57.0) - 220.0).abs() < 1e-12);
    assert!((frequency(40.0) - 82.406_889_228_217).abs() < 1e-9);
}

#[test]
fn wrong_setups_are_refused_in_one_line() {
    let cases: [(&str, &str, &[&str]); 31] = [
        ("name = \"electric\"", "name = \"  \"", &["name = \"  \" is refused: it must not be blank"]),
        ("frets = 22", "frets = 99", &["neck.frets", "99"]),
        ("frets = 22", "frets = 22\nworn = [[23, 1e-4]]", &["fret of neck.worn[1] = 23", "between 1 and 22"]),
        (
            "frets = 22",
            "frets = 22\nworn = [[5, 0.015], [3, 1e-4], [5, 0.015]]",
            &["fret of neck.worn[3] = 5 is refused: that fret is there already, and may be named once"],
        ),
        (
            "frets = 22",
            "frets = 0\nworn = [[3, 1e-4]]",
            &["fret of neck.worn[1] = 3 is refused: there are no frets, neck.frets is 0"],
        ),
        ("frets = 22", "fretz = 22", &["fretz"]),
        (
            "action = 0.0016",
            "action = 0.0001",
            &["neck.action", "1e-4", "neck.nut_clearance, 4e-4, and 0.05 m"],
        ),
        ("action = 0.0016", "action = nan", &["neck.action", "NaN"]),
        ("relief = 0.0002", "relief = 0.0018", &["neck.relief = 0.0018", "0.00165 m", "above the strings"]),
        ("\ndamping = 0.3", "\ndamping = -0.3", &["neck.damping", "-0.3", "100000 s/m"]),
        ("\ndamping = 0.3", "\ndamping = 1e6", &["neck.damping", "1e6", "100000 s/m"]),
        ("scale_length = 0.6477", "scale_length = -1.0", &["neck.scale_length", "-1"]),
        ("max_bend = 3.0", "max_bend = 13", &["max_bend", "13", "semitones"]),
        ("gain = 0.22", "gain = 0.0", &["gain", "0"]),
        ("pitch = 64.0", "pitch = 640.0", &["string[1].pitch", "640"]),
        ("level = 0.24", "level = -1.0", &["string[1].level", "-1"]),
        ("linear_density = 3.956e-4", "linear_density = 0.0", &["string[1].linear_density"]),
        ("loss_0 = 0.757", "loss_0 = -1.0", &["string[1].loss_0", "-1"]),
        ("pan = 0.25", "pan = 2", &["string[1].pan", "2"]),
        ("behind = 0.4", "behind = 1.5", &["player.fretting.behind", "1.5"]),
        ("nearest = 0.007", "nearest = 0.5", &["player.fretting.nearest", "0.5", "0.03 m"]),
        ("pluck_position = 0.12", "pluck_position = 0.7", &["player.pluck_position", "0.7", "0.6477"]),
        ("position = 0.162", "position = 0.001", &["pickup.aperture", "0.02"]),
        ("kind = \"magnetic\"", "kind = \"laser\"", &["laser"]),
        ("\"compensated\"", "\"just\"", &["unknown choice `just`", "physical"]),
        // What else is wrong with a text is said with its line, in words of the file.
        (
            "\"compensated\"",
            "3",
            &["line 5, intonation: invalid type: integer `3`, expected `compensated` or `physical`"],
        ),
        ("\"compensated\"", "[]", &["line 5, intonation: invalid type: list, expected `compensated`"]),
        ("kind = \"magnetic\"", "kind = 3", &["kind: invalid type: integer `3`, expected a text"]),
        (
            "kind = \"magnetic\"",
            "kind = \"bridge\"",
            &["unknown key `aperture`, there are no others beside `kind`"],
        ),
        ("[neck]", "neck = 1\n[nock]", &["neck: invalid type: integer `1`, expected a table"]),
        ("[neck]", "[[neck]]", &["line 9, [[neck]]: there is only one: write [neck]"]),
    ];
    for (from, to, mentioned) in cases {
        let error = Setup::from_toml(&changed(from, to)).unwrap_err().to_string();
        assert!(!error.contains('\n'), "{to}: {error}");
        for word in mentioned {
            assert!(error.contains(word), "{to}: `{word}` is missing in `{error}`");
        }
    }
}

#[test]
fn a_setup_without_strings_is_refused() {
    let text = include_str!("../../../dsp/instruments/electric.toml");
    let (head, _) = text.split_once("[[string]]").unwrap();
    assert!(Setup::from_toml(head).is_err());
    assert!(Setup::from_toml("").is_err());
    assert!(Setup::from_toml("name = ").is_err());
}

#[test]
fn a_string_too_short_for_its_grid_is_refused() {
    let setup = Setup::from_toml(&changed("pitch = 64.0", "pitch = 127.0")).unwrap();
    let error = intonate(&setup, &setup.string[0], Stencil::Wide, 22_050.0).unwrap_err().to_string();
    assert!(error.starts_with("neck.scale_length = 0.6477 is refused"), "{error}");
    assert!(["sample rate", "pitch", "must be less"].iter().all(|word| error.contains(word)), "{error}");
    // The same in the instrument, where every string has a rate that suits it.
    let setup = Setup::from_toml(&changed("core_radius = 1.270e-4", "core_radius = 0.1")).unwrap();
    let error = Instrument::new(&setup, &Quality::Live.settings(RATE)).unwrap_err().to_string();
    assert!(error.starts_with("neck.scale_length = 0.6477") && error.contains("string[1]"), "{error}");
}

/// What is too stiff for the sample rate is named by the set-up's own keys, with the value in the file and a limit that
/// can be written there in its place.
#[test]
fn what_is_too_stiff_is_named_as_in_the_file() {
    let electric = include_str!("../../../dsp/instruments/electric.toml");
    let keys = [
        ("neck.stiffness", "stiffness = 1e10", "under string[1]"),
        ("player.fretting.stiffness", "stiffness = 1e7", "on string[1]"),
        ("player.damper.stiffness", "stiffness = 1.5e4", "on string[1]"),
    ];
    for intonation in ["\"compensated\"", "\"physical\""] {
        for (key, line, place) in keys {
            assert!(electric.contains(line), "`{line}` is not in the file");
            let text = electric.replacen("\"compensated\"", intonation, 1);
            let with = |stiffness: &str| text.replacen(line, &format!("stiffness = {stiffness}"), 1);
            for quality in [Quality::Live, Quality::Studio] {
                let build = |stiffness: &str| {
                    let setup = Setup::from_toml(&with(stiffness)).unwrap();
                    Instrument::new(&setup, &quality.settings(RATE))
                };
                let error = build("1e30").unwrap_err().to_string();
                assert!(error.starts_with(&format!("{key} = 1e30 is refused: ")), "{error}");
                assert!(error.ends_with(&format!(" N/m^exponent ({place})")), "{error}");
                if intonation == "\"physical\"" {
                    let limit = error.split("at most ").nth(1).unwrap().split(' ').next().unwrap();
                    let limit: f64 = limit.parse().unwrap();
                    // Each string has a limit of its own, and its last digits depend on its tension.
                    let built = build(&format!("{:e}", 0.1 * limit));
                    assert!(built.is_ok(), "{key} = {limit}: {:?}", built.err());
                }
            }
        }
    }
}

/// A string so stiff that it sounds higher than it should however slack it is cannot be tuned; and no string is so near to
/// silence that the other pickup, brought to its scale, would blow up.
#[test]
fn a_string_too_stiff_for_its_pitch_is_refused() {
    let text = "based_on = \"bass\"\nblend = 0.5\n[[string]]\ncore_radius = 4e-3\n[[string]]\n[[string]]\n[[string]]\n";
    let setup = Setup::from_toml(text).unwrap();
    let error = Instrument::new(&setup, &Quality::Live.settings(RATE)).unwrap_err().to_string();
    assert!(error.starts_with("string[1].pitch = 43 is refused: "), "{error}");
    assert!(!error.contains('\n') && error.contains("core_radius"), "{error}");
    // The pitch in the file, and not what it is tuned to.
    let setup = Setup::from_toml(&format!("tuning = -0.1\n{text}")).unwrap();
    let error = Instrument::new(&setup, &Quality::Live.settings(RATE)).unwrap_err().to_string();
    assert!(error.starts_with("string[1].pitch = 43 is refused: "), "{error}");
    assert!(error.contains("and tuning = -0.1, the string cannot sound so low"), "{error}");
}

/// What its pitch takes too much tension for is named by the number that can be changed in the file, with limits that can
/// be written there.
#[test]
fn a_string_too_heavy_for_its_pitch_is_refused() {
    let with = |density: &str| {
        let text = changed("pitch = 64.0", "pitch = 57.0");
        let text = text.replacen("linear_density = 3.956e-4", &format!("linear_density = {density}"), 1);
        let setup = Setup::from_toml(&text.replacen("\"compensated\"", "\"physical\"", 1)).unwrap();
        Instrument::new(&setup, &Quality::Live.settings(RATE)).map(drop)
    };
    let error = with("13").unwrap_err().to_string();
    assert!(error.starts_with("string[1].linear_density = 13 is refused: "), "{error}");
    let limit = error.rsplit(" and ").next().unwrap().split(' ').next().unwrap();
    assert!(limit.parse::<f64>().unwrap() > 10.0, "{error}");
    assert_eq!(with(limit), Ok(()));
}

/// Whatever the relief and wherever compensation moves the frets: board and crowns begin below the strings at rest.
#[test]
fn nothing_stands_above_the_strings() {
    let bows = "based_on = \"bass\"\n[neck]\nfret_height = 1e-4\nrelief = 2e-3\n";
    let tilts = "based_on = \"electric\"\n[neck]\naction = 0.004\nrelief = 0.00436\n";
    for text in [bows, tilts] {
        let setup = Setup::from_toml(text).unwrap();
        let instrument = Instrument::new(&setup, &Quality::Live.settings(RATE)).unwrap();
        for string in 0..setup.string.len() {
            let highest = instrument.model(string).contacts.iter().map(|contact| contact.height);
            assert!(largest(highest) <= -1e-5, "{text}");
        }
    }
}

/// However far a luthier or a player goes, and where that is no number: what is limited is what is accepted, and what is accepted
/// is left as it is.
#[test]
fn what_is_limited_is_accepted() {
    type Number = fn(&mut Setup) -> &mut f64;
    let numbers: [Number; 20] = [
        |setup| &mut setup.neck.nut_clearance,
        |setup| &mut setup.neck.action,
        |setup| &mut setup.neck.relief,
        |setup| &mut setup.neck.fret_height,
        |setup| &mut setup.tuning,
        |setup| &mut setup.blend,
        |setup| &mut setup.string[0].pitch,
        |setup| &mut setup.string[1].loss_0,
        |setup| &mut setup.string[2].loss_1,
        |setup| &mut setup.player.pluck_duration,
        |setup| &mut setup.player.pluck_release,
        |setup| &mut setup.player.idle_loss,
        |setup| &mut setup.player.pluck_force,
        |setup| &mut setup.player.fretting.force,
        |setup| &mut setup.player.fretting.hover,
        |setup| &mut setup.player.fretting.touch.mass,
        |setup| &mut setup.player.fretting.touch.stiffness,
        |setup| &mut setup.player.fretting.touch.exponent,
        |setup| &mut setup.player.fretting.touch.damping,
        |setup| &mut setup.player.fretting.touch.hand_damping,
    ];
    let limit = |setup: &mut Setup| {
        setup.limit();
        setup.player.limit();
    };
    for name in Setup::SHIPPED {
        let shipped = Setup::shipped(name).unwrap();
        let mut same = shipped.clone();
        limit(&mut same);
        assert_eq!(same, shipped, "{name}");
        for number in numbers {
            for end in [f64::NEG_INFINITY, f64::INFINITY, f64::NAN] {
                let mut setup = shipped.clone();
                *number(&mut setup) = end;
                assert!(setup.check().is_err(), "{name}");
                limit(&mut setup);
                assert_eq!(setup.check(), Ok(()), "{name}");
            }
        }
    }
}

/// Between board and bridge both drop, and what is too long for that is refused by its own name, before anything is built.
#[test]
fn a_bridge_leaves_room_for_the_edges_of_both() {
    let setup = builtin("bass");
    let room = setup.neck.scale_length - setup.neck.board_end();
    let with = |length: f64| Setup { bridge: Some(Bridge { length, radius: 1.0 }), ..setup.clone() };
    for length in [room, room - 1e-6, room - 2e-6] {
        let error = with(length).check().expect_err("it is too long").to_string();
        assert!(error.starts_with("bridge.length"), "{error}");
    }
    let longest = with(room - 3.1e-6);
    longest.check().expect("there is room");
    Instrument::new(&longest, &Quality::Draft.settings(RATE)).expect("it can be built");
}

/// One that is curved so much that it ends beyond where a barrier may be is refused where it stands in the file; the radius that is
/// named as the least can be built.
#[test]
fn a_bridge_that_falls_too_far_is_refused_by_its_radius() {
    let read = |length: &str, radius: &str| {
        let bridge =
            format!("name = \"x\"\nbased_on = \"electric\"\n[bridge]\nlength = {length}\nradius = {radius}");
        Setup::from_toml(&bridge).map_err(|error| error.to_string())
    };
    // 17²/2 mm below the string, in cm.
    let error = read("0.17", "1e-3").expect_err("it falls 14 m");
    let least = error
        .strip_prefix("bridge.radius = 0.001 is refused: of a bridge.length of 0.17 m it must lie between ")
        .and_then(|rest| rest.split(' ').next())
        .unwrap_or_else(|| panic!("{error}"));
    let mut setup = read("0.17", least).expect("it is named as the least");
    setup.string.truncate(1);
    assert!(Instrument::new(&setup, &Quality::Draft.settings(RATE)).is_ok(), "{least} m");
    // 10 m, but for a part in thousands.
    assert!(read("0.14", "1e-3").is_ok() && read("0.1415", "1e-3").is_err());
}

/// A name may be anything that fits between quotes: what is said of it is one short line all the same.
#[test]
fn a_base_of_any_name_is_refused_in_one_line() {
    for name in ["a\\nb", "\\u001B[2J", "a\\r\\u0000\\tb", &"x".repeat(100_000)] {
        let error = Setup::from_toml(&format!("based_on = \"{name}\"")).unwrap_err().to_string();
        assert!(error.starts_with("based_on = ") && error.contains("electric"), "{error:?}");
        assert!(!error.chars().any(char::is_control) && error.len() < 1000, "{error:?}");
    }
}

/// A bridge that no grid point is over would be none: grids are fine enough for a short one, and what is too short for any is
/// refused. One that is as long as a tanpura's costs nothing; a sitar's flat, short one has its strings on finer grids.
#[test]
fn a_bridge_is_touched_or_refused() {
    let setup = builtin("electric");
    let with = |length: f64| Setup { bridge: Some(Bridge { length, radius: 1.0 }), ..setup.clone() };
    for quality in [Quality::Draft, Quality::Live] {
        let settings = quality.settings(RATE);
        let instrument = Instrument::new(&with(5e-3), &settings).expect("it can be built");
        for string in 0..instrument.string_count() {
            let model = instrument.model(string);
            let touched = model.contacts.iter().any(|contact| contact.place >= model.grid.length - 5e-3);
            assert!(touched, "{quality}, string {string}");
        }
        let error = Instrument::new(&with(1e-4), &settings).expect_err("it is too short").to_string();
        assert!(error.starts_with("bridge.length = 1e-4 is refused: points of the grid are "), "{error}");
        assert!(error.ends_with("(under string[1])") && !error.contains('\n'), "{error}");
        for (name, costs) in [("sitar", true), ("tanpura", false)] {
            let shipped = Setup::shipped(name).expect("it comes with the program");
            let longer = shipped.bridge.map(|bridge| Bridge { length: 2.0 * bridge.length, ..bridge });
            let longer = Setup { bridge: longer, ..shipped.clone() };
            let same = |string| settings.ratio(&shipped, string) == settings.ratio(&longer, string);
            assert_eq!(!shipped.string.iter().all(same), costs, "{name}");
        }
    }
}
