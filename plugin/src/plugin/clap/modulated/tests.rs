use std::mem::size_of;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_MOD, clap_event_header, clap_event_param_mod,
    clap_input_events,
};
use nice_plug::prelude::*;

use super::*;

const ID: clap_id = 3;

fn param() -> FloatParam {
    FloatParam::new("", 0.0, FloatRange::Linear { min: 0.0, max: 2.0 })
}

fn modulated(param: &FloatParam) -> Modulated {
    let amount = AtomicU64::new(0.0_f64.to_bits());
    Modulated(vec![Added { id: ID, param: param.as_ptr(), amount }])
}

fn framework_sets(param: &FloatParam, value: f32) {
    // SAFETY: it is alive.
    unsafe { param.as_ptr()._internal_set_normalized_value(value) };
}

/// What the editor sets the framework has set already, when it comes by.
#[test]
fn what_was_set_under_what_is_added_is_set() {
    let (param, block) = (param(), Apart::new());
    let modulated = modulated(&param);
    let added = &modulated.0[0];
    modulated.note(ID, -1, 1.0);
    added.add(1.0);
    framework_sets(&param, 0.25);
    assert_eq!((param.unmodulated_plain_value(), param.value()), (0.0, 2.0), "the framework is mended");
    modulated.set(ID, 0.25, 0, &block);
    assert_eq!((param.unmodulated_plain_value(), param.value()), (0.5, 2.0));
    modulated.without(|| framework_sets(&param, 0.75));
    assert_eq!((param.unmodulated_plain_value(), param.value()), (1.5, 2.0));
    modulated.note(ID, -1, 0.0);
    added.add(0.0);
    assert_eq!(param.value(), 1.5);
}

unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
    // SAFETY: the test's own list.
    unsafe { (*(*list).ctx.cast::<Vec<clap_event_param_mod>>()).len() as u32 }
}

unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
    // SAFETY: as above.
    unsafe { &raw const (&(*(*list).ctx.cast::<Vec<clap_event_param_mod>>()))[index as usize].header }
}

/// Has a block begin in which the host adds so much from these times on.
fn begin(block: &mut Apart, modulated: &Modulated, changes: &[(u32, f64)]) {
    let event = |&(time, amount): &(u32, f64)| {
        let size = size_of::<clap_event_param_mod>() as u32;
        let (space_id, type_) = (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_MOD);
        let header = clap_event_header { size, time, space_id, type_, flags: 0 };
        let (param_id, cookie, note_id, port_index) = (ID, std::ptr::null_mut(), -1, -1);
        let (channel, key) = (-1, -1);
        clap_event_param_mod { header, param_id, cookie, note_id, port_index, channel, key, amount }
    };
    let mut events: Vec<_> = changes.iter().map(event).collect();
    let list = clap_input_events { ctx: (&raw mut events).cast(), size: Some(size), get: Some(get) };
    // SAFETY: all of it is alive.
    unsafe { Apart::put(block, &list, modulated) };
}

/// The framework takes in what comes until a time, then what the editor sets: what counts is what is added then.
#[test]
fn what_is_set_in_a_block_in_which_what_is_added_changes_is_set() {
    let (param, mut block) = (param(), Apart::new());
    let modulated = modulated(&param);
    let added = &modulated.0[0];
    begin(&mut block, &modulated, &[(0, 1.0)]);
    added.add(1.0);
    // It goes within the block, after the editor's value.
    begin(&mut block, &modulated, &[(100, 0.0)]);
    framework_sets(&param, 0.25);
    modulated.set(ID, 0.25, 0, &block);
    assert_eq!((param.unmodulated_plain_value(), param.value()), (0.5, 2.0));
    added.add(0.0);
    assert_eq!(param.value(), 0.5);
    // It comes within the block, after the value and before another.
    begin(&mut block, &modulated, &[(100, -0.5), (200, 1.0), (300, -1.0)]);
    framework_sets(&param, 1.0);
    modulated.set(ID, 1.0, 0, &block);
    assert_eq!(param.value(), 2.0, "it is added too early");
    added.add(-0.5);
    assert_eq!(param.value(), 1.0);
    added.add(1.0);
    framework_sets(&param, 0.75);
    modulated.set(ID, 0.75, 200, &block);
    assert_eq!((param.unmodulated_plain_value(), param.value()), (1.5, 2.0));
    added.add(-1.0);
    // Outside of blocks the host's events are all taken in first.
    begin(&mut block, &modulated, &[(7, 1.0)]);
    block.take_in_at_once();
    added.add(1.0);
    framework_sets(&param, 0.25);
    modulated.set(ID, 0.25, 0, &block);
    assert_eq!((param.unmodulated_plain_value(), param.value()), (0.5, 2.0));
}
