//! What a host and a player notice of an engine at work.

use std::time::Duration;

use nice_plug::midi::{Channel, Key, VoiceID};

use super::*;
use crate::engine::INAUDIBLE;
#[cfg(feature = "editor")]
use crate::params::Start;
use crate::pointer::pointer;

const RATE: f32 = 48_000.0;

fn order() -> Order {
    Order::of(&LowActionParams::default(), RATE, false)
}

fn playing(order: Order, offline: bool, meters: &Arc<Meters>) -> Playing {
    Playing::new(order, offline, Shelf::new(Vec::new()), meters.clone()).expect("it can be built")
}

#[test]
fn a_rendering_shows_no_load() {
    let meters = Arc::new(Meters::default());
    let busy = || meters.see_load(0.9, true);
    let rests = || meters.load() == 0.0 && !meters.relaxed();
    busy();
    let mut playing = playing(order(), true, &meters);
    assert!(rests(), "after it was built");
    busy();
    playing.reset(true);
    assert!(rests(), "after it was activated again");
}

#[test]
fn the_host_goes_on_while_the_editor_is_open() {
    let meters = Arc::new(Meters::default());
    let live = playing(order(), false, &meters);
    assert_eq!(live.status(false), ProcessStatus::Normal);
    assert_eq!(live.status(true), ProcessStatus::KeepAlive);
    // A rendering ends all the same.
    assert_eq!(playing(order(), true, &meters).status(true), ProcessStatus::Normal);
}

/// A hard chord, and a second in which every block is said to have taken so many times as long as it lasts.
fn chord(load: f64, may_relax: bool, meters: &Arc<Meters>) -> (Playing, Vec<f32>) {
    let mut playing = playing(order(), false, meters);
    for key in [40, 45, 50, 55, 59, 64] {
        playing.touch(PlayerEvent::NoteOn { channel: 0, key, velocity: 1.0 });
    }
    let mut sound = Vec::new();
    for _ in 0..100 {
        let (mut left, mut right) = ([0.0; 480], [0.0; 480]);
        playing.play(&LowActionParams::default(), &mut left, &mut right, &mut []);
        playing.spend(load * 0.01, 480, may_relax);
        sound.extend(left);
    }
    (playing, sound)
}

#[test]
fn what_takes_too_long_is_solved_less_exactly_if_it_may_be() {
    let meters = Arc::new(Meters::default());
    let (_, exact) = chord(0.1, true, &meters);
    assert!(!meters.relaxed());
    let (_, kept) = chord(2.0, false, &meters);
    assert!(kept == exact && !meters.relaxed(), "relaxed though it is not allowed");
    let (mut late, relaxed) = chord(2.0, true, &meters);
    assert!(relaxed != exact && meters.relaxed(), "never relaxed");
    // It is the same music, whole.
    let level = |sound: &[f32]| 10.0 * sound.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().log10();
    for (one, other) in exact.chunks(4800).zip(relaxed.chunks(4800)) {
        let [one, other] = [one, other].map(level);
        assert!((one - other).abs() < 1.0, "{one} and {other} dB");
    }
    // A second of ease, after the time in which the load comes down.
    (0..130).for_each(|_| late.spend(0.001, 480, true));
    assert!(!meters.relaxed(), "it never recovers");
    // And so it is at once where it is not allowed any more.
    let (mut late, _) = chord(2.0, true, &meters);
    late.spend(0.02, 480, false);
    assert!(!meters.relaxed());
}

#[test]
fn a_keyswitch_for_a_string_is_let_go_of_by_its_number() {
    let meters = Arc::new(Meters::default());
    let params = LowActionParams::default();
    let mut playing = playing(order(), false, &meters);
    // Keyswitches from key 1 on: that of the sixth string is 18.
    playing.touch(PlayerEvent::Controller { channel: 0, number: 27, value: 1.0 / 127.0 });
    // Plays a block, and gives back how many notes have ended.
    let mut block = |event| {
        playing.event(event, &params);
        let (mut left, mut right) = ([0.0; 480], [0.0; 480]);
        playing.play(&params, &mut left, &mut right, &mut []);
        let mut ended = 0;
        playing.end_voices(480, |_| {
            ended += 1;
            true
        });
        ended
    };
    let (timing, channel) = (0, Channel::Wildcard);
    let on = |id, key| NoteEvent::NoteOn {
        timing,
        voice_id: VoiceID::ID(id),
        channel: Channel::Number(0),
        key: Key::Number(key),
        velocity: 0.7,
    };
    let off = |id| NoteEvent::NoteOff {
        timing,
        voice_id: VoiceID::ID(id),
        channel,
        key: Key::Wildcard,
        velocity: 0.0,
    };
    assert_eq!(block(on(1, 18)), 0, "it is down");
    assert_eq!(block(off(1)), 1);
    // E3, which the sixth string has at its twelfth fret.
    block(on(2, 52));
    let fingers = |string| playing.engine.instrument().state(string).fingers().iter().flatten().count();
    assert_eq!(fingers(5), 0, "the keyswitch still asks for its string");
}

/// Under the finger that holds it a string moves on long after it is heard.
#[test]
fn a_reset_while_nothing_is_heard_changes_nothing() {
    let params = LowActionParams::default();
    let block = |playing: &mut Playing| {
        let (mut left, mut right) = ([0.0; 4800], [0.0; 4800]);
        playing.play(&params, &mut left, &mut right, &mut []);
        left
    };
    let meters = Arc::new(Meters::default());
    let [down, up] = [1.0, 0.0].map(|value| PlayerEvent::Controller { channel: 0, number: 64, value });
    let on = |key| PlayerEvent::NoteOn { channel: 0, key, velocity: 1.0 };
    let off = |key| PlayerEvent::NoteOff { channel: 0, key };
    let heard = |reset: bool, pedal: PlayerEvent| {
        let mut playing = playing(order(), false, &meters);
        playing.touch(on(48));
        // A pluck that nobody has heard yet will be.
        assert!(playing.engine.level() < INAUDIBLE && !playing.engine.is_inaudible(), "it has not begun");
        let blocks = (0..600).take_while(|_| {
            block(&mut playing);
            !playing.engine.is_inaudible()
        });
        let blocks = blocks.count();
        assert!((10..600).contains(&blocks), "it is heard for {blocks} tenths of a second");
        assert!(!playing.engine.is_silent(), "the string rests under the finger");
        playing.touch(pedal);
        block(&mut playing);
        if reset {
            assert!(!playing.begin_again(), "something was heard");
        }
        playing.touch(on(57));
        block(&mut playing);
        playing.touch(off(57));
        playing.touch(off(48));
        block(&mut playing);
        let sound = block(&mut playing);
        assert!(playing.begin_again() && playing.engine.is_silent(), "what sounds is not silenced");
        sound
    };
    let [held, damped] = [down, up].map(|pedal| heard(false, pedal));
    assert!(held != damped, "there is no pedal");
    assert!(heard(true, down) == held, "the pedal is up");
}

#[test]
fn what_is_done_in_the_editor_is_not_rendered() {
    let meters = Arc::new(Meters::default());
    for offline in [false, true] {
        let (pointer, played) = pointer();
        let mut playing = playing(order(), offline, &meters);
        assert!(pointer.play(PlayerEvent::NoteOn { channel: 0, key: 45, velocity: 1.0 }));
        playing.take_up(&played);
        assert!(played.next().is_none(), "it would be played later");
        let (mut left, mut right) = ([0.0; 4800], [0.0; 4800]);
        playing.play(&LowActionParams::default(), &mut left, &mut right, &mut []);
        assert_eq!(left.iter().all(|&sample| sample == 0.0), offline);
    }
}

/// As when it is saved over the file that plays, or that is taken back: its values come before it does.
#[cfg(feature = "editor")]
#[test]
fn nothing_is_built_of_a_file_that_is_on_its_way() {
    let shelf = Shelf::new(Vec::new());
    let number = shelf.keep("mine", "name = \"mine\"\nbased_on = \"electric\"\n");
    let file = shelf.held(number);
    let params = LowActionParams::new(shelf.clone(), &Start::default());
    let set = |param: ParamPtr, value: f32| {
        // SAFETY: the pointers lead into `params`.
        unsafe { param._internal_set_normalized_value(param.preview_normalized(value)) };
    };
    set(params.instrument.file.as_ptr(), number as f32);
    for (offline, waits) in [(false, true), (true, false)] {
        set(params.setup.action.as_ptr(), 1.0);
        let order = Order::of(&params, RATE, offline);
        let meters = Arc::new(Meters::default());
        let mut playing = Playing::new(order, offline, shelf.clone(), meters).expect("it can be built");
        let block = |playing: &mut Playing| {
            let (mut left, mut right) = ([0.0; 4800], [0.0; 4800]);
            playing.play(&params, &mut left, &mut right, &mut []);
            !playing.is(&order)
        };
        assert!(!block(&mut playing), "it plays already");
        shelf.promise(number, file.clone());
        set(params.setup.action.as_ptr(), 1.5);
        assert_eq!(block(&mut playing), !waits);
        // A host that lets it sleep would begin its next note on what it was before.
        assert_eq!(matches!(playing.status(false), ProcessStatus::Normal), !waits);
        if waits {
            // A window that was closed keeps no promise.
            assert_eq!((0..20).filter(|_| block(&mut playing)).count(), 1, "two seconds and a tenth");
        }
        shelf.keep_promise();
        assert!(block(&mut playing));
    }
}

#[test]
fn only_what_plays_in_real_time_looks_at_the_clock() {
    let meters = Arc::new(Meters::default());
    assert!(playing(order(), false, &meters).start_clock().is_some());
    assert!(playing(order(), true, &meters).start_clock().is_none());
}

/// What a clock says that was started a second ago, in no time: later than any block may be.
#[test]
fn a_block_that_took_too_long_by_the_clock_relaxes_what_comes_if_it_may() {
    for may_relax in [false, true] {
        let meters = Arc::new(Meters::default());
        let mut playing = playing(order(), false, &meters);
        let started = Instant::now().checked_sub(Duration::from_secs(1));
        assert!(started.is_some(), "the clock has run for a second");
        playing.stop_clock(started, 480, may_relax);
        assert_eq!(meters.relaxed(), may_relax);
        assert!(meters.load() > 1.0, "{}", meters.load());
        // Whoever has not started it has all the time there is.
        let meters = Arc::new(Meters::default());
        let mut playing = self::playing(order(), true, &meters);
        playing.stop_clock(None, 480, may_relax);
        assert!(!meters.relaxed() && meters.load() == 0.0);
    }
}
