//! The memory that a host gives to be played into. One that has switched the output off may give addresses that lead nowhere, and
//! another more channels than there are; the framework (nice-plug 0.4.2) follows every address, and counts on two.

use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{AudioBusBuffers, ProcessData};
use nice_plug::wrapper::vst3::vst3::Steinberg::int32;

/// Channels that are played.
const CHANNELS: int32 = 2;

/// Plays with what a host gives: into the first two channels with all others silent, or into nothing where one of the two is
/// nowhere.
///
/// # Safety
/// What is given must be what a host has to give, but for the addresses of channels, which may be null.
pub(super) unsafe fn within<T>(given: &ProcessData, play: impl FnOnce(&mut ProcessData) -> T) -> T {
    let mut data = *given;
    // SAFETY: a host has as many buses as it says.
    let bus = unsafe { given.outputs.as_ref() }.filter(|_| given.numOutputs > 0);
    // SAFETY: as the caller promises.
    let bus = bus.copied().filter(|bus| unsafe { leads_somewhere(bus) });
    let Some(mut bus) = bus else {
        (data.numOutputs, data.outputs) = (0, std::ptr::null_mut());
        return play(&mut data);
    };
    // SAFETY: as above.
    unsafe { silence_others(&bus, given.numSamples) };
    bus.numChannels = bus.numChannels.min(CHANNELS);
    (data.numOutputs, data.outputs) = (1, &raw mut bus);
    play(&mut data)
}

/// Whether there is memory behind all channels that are played into.
///
/// # Safety
/// There must be as many addresses as there are channels, if any.
unsafe fn leads_somewhere(bus: &AudioBusBuffers) -> bool {
    // SAFETY: both kinds of memory are arrays of addresses.
    let channels = unsafe { bus.__field0.channelBuffers32 };
    // SAFETY: as above.
    !channels.is_null()
        && (0..bus.numChannels.clamp(0, CHANNELS) as usize)
            .all(|at| unsafe { !(*channels.add(at)).is_null() })
}

/// Makes all channels silent that are not played into.
///
/// # Safety
/// As above, and there must be so many samples behind each address that leads somewhere.
unsafe fn silence_others(bus: &AudioBusBuffers, samples: int32) {
    // SAFETY: as above.
    unsafe {
        let channels = bus.__field0.channelBuffers32;
        for at in CHANNELS..bus.numChannels {
            let channel = *channels.add(at as usize);
            if !channel.is_null() {
                channel.write_bytes(0, samples.max(0) as usize);
            }
        }
    }
}
