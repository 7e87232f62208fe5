use super::*;
use crate::params::Start;
use crate::performance::NEAREST_PLUCK;
use crate::setups::SHIPPED;

/// Checked as a set-up file would be: what is played so can be saved.
#[test]
fn hands_led_as_far_as_they_go_are_those_of_a_set_up() {
    let params = LowActionParams::new(Shelf::new(Vec::new()), &Start::default());
    let player = params.player.param_map();
    assert_eq!(player.len(), 14);
    for (id, param, _) in player {
        // SAFETY: the pointers lead into `params`.
        let set = |value| unsafe { param._internal_set_normalized_value(value) };
        for end in [0.0, 1.0] {
            set(end);
            for name in SHIPPED {
                let mut setup = Setup::shipped(name).expect("it comes with the program");
                Order::of(&params, 48_000.0, false).luthier.work_on(&mut setup);
                setup.player = touching(&params).hands(&setup.player, setup.neck.scale_length);
                assert_eq!(setup.check(), Ok(()), "{name} with {id} at {end}");
                // As near as fingers can be, and no nearer.
                assert!(setup.player.pluck_position >= NEAREST_PLUCK, "{name} with {id} at {end}");
            }
        }
        // SAFETY: as above.
        set(unsafe { param.default_normalized_value() });
    }
}

/// Only the file that cannot be played at all gives way to another instrument.
#[test]
fn a_file_that_bears_less_is_refused_and_not_replaced() {
    let shelf = Shelf::new(Vec::new());
    let text = "name = \"mine\"\nbased_on = \"electric\"\n";
    let number = shelf.keep("mine", text);
    let own = Setup::from_toml(text).expect("it is a set-up").neck.action;
    let params = LowActionParams::new(shelf.clone(), &Start::default());
    let plain = Order { file: (number, shelf.edition()), ..Order::of(&params, 48_000.0, false) };
    let low = Order { luthier: Luthier { action: 0.5, ..plain.luthier }, ..plain };
    // What is built is a name. The file bears no action lower than its own, or none at all.
    let built = |order: &Order, bears_its_own: bool| {
        order.build(&shelf, |EngineOptions { setup, .. }| {
            let bears_it = bears_its_own && setup.neck.action > 0.9 * own;
            match setup.name.as_str() {
                "mine" if !bears_it => Err(Error::range("neck.action", setup.neck.action, "more")),
                name => Ok(name.to_owned()),
            }
        })
    };
    let told = || shelf.message().unwrap_or_default();
    assert_eq!((built(&plain, true).as_deref(), told()), (Ok("mine"), String::new()));
    let refused = built(&low, true).expect_err("it bears no such action");
    assert!(refused.starts_with("neck.action"), "{refused}");
    assert_eq!(told(), "", "who asked for it says what is done about it");
    for order in [&plain, &low] {
        assert_eq!(built(order, false).as_deref(), Ok("electric"));
        assert!(told().ends_with("; electric is played instead"), "{}", told());
    }
}

/// As it is heard: not the file that another instrument takes the place of.
#[cfg(feature = "editor")]
#[test]
fn what_is_drawn_is_what_is_played() {
    let shelf = Shelf::new(Vec::new());
    let number = shelf.keep("mine", "name = \"mine\"\nbased_on = \"bass\"\n");
    let params = LowActionParams::new(shelf.clone(), &Start::default());
    let order = Order { file: (number, shelf.edition()), ..Order::of(&params, 48_000.0, false) };
    let build = |fails: bool| {
        order.build(&shelf, |EngineOptions { setup, .. }| match setup.name.as_str() {
            "mine" if fails => Err(Error::range("pitch", 0.0, "more")),
            name => Ok(name.to_owned()),
        })
    };
    let drawn = || order.planned(&shelf).expect("there is something").name;
    assert_eq!(drawn(), "mine", "nobody knows better yet");
    for fails in [true, false, true] {
        assert_eq!(build(fails), Ok(drawn()));
    }
}

#[cfg(feature = "editor")]
#[test]
fn what_a_host_adds_for_the_moment_is_not_saved() {
    let params = LowActionParams::new(Shelf::new(Vec::new()), &Start::default());
    let own = Setup::builtin("electric").expect("it is built in");
    let as_it_was = settled(&params, &own);
    let (action, force) = (Order::of(&params, 0.0, false).luthier.action, touching(&params).pluck_force);
    for (_, param, _) in params.param_map() {
        // SAFETY: the pointers lead into `params`.
        unsafe { param._internal_modulate_value(0.1) };
    }
    assert_ne!(Order::of(&params, 0.0, false).luthier.action, action);
    assert_ne!(touching(&params).pluck_force, force);
    assert_eq!(settled(&params, &own), as_it_was);
}

#[test]
fn what_is_no_number_is_the_usual() {
    let params = LowActionParams::new(Shelf::new(Vec::new()), &Start::default());
    let usual = (Order::of(&params, 48_000.0, false), touching(&params));
    for (_, param, _) in params.param_map() {
        // SAFETY: the pointers lead into `params`.
        unsafe { param._internal_set_normalized_value(f32::NAN) };
    }
    let (order, touching) = (Order::of(&params, 48_000.0, false), touching(&params));
    assert!(order == order && touching == touching, "or it would be built again and again");
    assert_eq!(
        (order.luthier.action, order.luthier.relief),
        (usual.0.luthier.action, usual.0.luthier.relief)
    );
    assert_eq!(touching.pluck_force, usual.1.pluck_force);
}

#[test]
fn the_pluck_stays_on_a_short_string() {
    let mut setup = Setup::builtin("electric").expect("it is built in");
    setup.neck.scale_length = 0.25;
    let hands = Touching { pluck_position: 0.2, ..Touching::default() };
    setup.player = hands.hands(&setup.player, setup.neck.scale_length);
    assert_eq!(setup.player.pluck_position, 0.25 - NEAREST_PLUCK);
}
