//! The memory that a host gives to be played into. The framework (nice-plug 0.4.2) leaves out a block in which a channel is missing, with
//! all notes that come in it, follows every address, panics where there are more channels than there should be, and looks for
//! one port more than there is. Here what is missing is played into memory of the plugin's own that nobody hears, so that a key which
//! goes up meanwhile is up, and what is too much is silent.

use clap_sys::audio_buffer::clap_audio_buffer;
use clap_sys::process::clap_process;

use crate::plugin::STRING_OUTPUTS;

/// Channels of the first port; all others have one.
const CHANNELS: usize = 2;
const MOST_PORTS: usize = 1 + STRING_OUTPUTS;
/// The longest block for which there is memory; nobody has longer ones.
const MOST_FRAMES: usize = 65_536;

/// What is played into where a host has nothing.
#[derive(Default)]
pub(super) struct Outputs {
    ports: usize,
    frames: usize,
    /// Channel after channel.
    memory: Vec<f32>,
}

impl Outputs {
    /// There are so many ports, and so long blocks; allocates.
    pub(super) fn make_room(&mut self, ports: usize, frames: usize) {
        self.ports = ports.min(MOST_PORTS);
        self.frames = frames.min(MOST_FRAMES);
        self.memory.clear();
        self.memory.resize((CHANNELS + self.ports.saturating_sub(1)) * self.frames, 0.0);
    }

    /// Plays into what a host gives, whole; nothing if there is no memory for so long a block.
    ///
    /// # Safety
    /// What is given must be what a host has to give, but for what is missing of outputs, and the addresses of channels, which may
    /// be null.
    pub(super) unsafe fn within<T>(
        &mut self,
        given: &clap_process,
        play: impl FnOnce(&clap_process) -> T,
    ) -> Option<T> {
        let frames = given.frames_count as usize;
        let count = if given.audio_outputs.is_null() { 0 } else { given.audio_outputs_count as usize };
        let mut channels = [[std::ptr::null_mut::<f32>(); CHANNELS]; MOST_PORTS];
        let mut ports = channels.each_mut().map(|channels| clap_audio_buffer {
            data32: channels.as_mut_ptr(),
            data64: std::ptr::null_mut(),
            channel_count: 1,
            latency: 0,
            constant_mask: 0,
        });
        ports[0].channel_count = CHANNELS as u32;
        let mut room = self.memory.chunks_exact_mut(self.frames.max(1));
        for (index, port) in ports.iter_mut().enumerate().take(self.ports) {
            // SAFETY: a host has as many ports as it says.
            let host = (index < count).then(|| unsafe { &*given.audio_outputs.add(index) });
            let there =
                host.map_or(0, |host| if host.data32.is_null() { 0 } else { host.channel_count as usize });
            let wanted = port.channel_count as usize;
            for at in 0..wanted.max(there) {
                let host = host.filter(|_| at < there);
                // SAFETY: there is an address of each channel.
                let address = host.map_or(std::ptr::null_mut(), |host| unsafe { *host.data32.add(at) });
                if at >= wanted {
                    if !address.is_null() {
                        // SAFETY: there is memory behind an address.
                        unsafe { address.write_bytes(0, frames) };
                    }
                    continue;
                }
                let own = room.next().filter(|own| own.len() >= frames);
                let address = if address.is_null() { own?.as_mut_ptr() } else { address };
                // SAFETY: there is room for as many addresses as there are channels of a port.
                unsafe { *port.data32.add(at) = address };
            }
        }
        let (audio_outputs, audio_outputs_count) = (ports.as_mut_ptr(), self.ports as u32);
        Some(play(&clap_process { audio_outputs, audio_outputs_count, ..*given }))
    }
}

#[cfg(test)]
mod tests {
    use std::ptr::null_mut;

    use super::*;

    const FRAMES: usize = 8;

    fn port(channels: &mut [*mut f32]) -> clap_audio_buffer {
        let (data32, channel_count) = (channels.as_mut_ptr(), channels.len() as u32);
        clap_audio_buffer { data32, data64: null_mut(), channel_count, latency: 0, constant_mask: 0 }
    }

    /// Has ones played into all channels of so many ports that are played; says of how many, if any.
    fn played(ports: usize, frames: usize, given: &mut [clap_audio_buffer]) -> Option<usize> {
        let process = clap_process {
            steady_time: 0,
            frames_count: frames as u32,
            transport: null_mut(),
            audio_inputs: null_mut(),
            audio_outputs: if given.is_empty() { null_mut() } else { given.as_mut_ptr() },
            audio_inputs_count: 0,
            audio_outputs_count: given.len() as u32,
            in_events: null_mut(),
            out_events: null_mut(),
        };
        let mut outputs = Outputs::default();
        outputs.make_room(ports, FRAMES);
        // SAFETY: all of it is alive.
        unsafe {
            outputs.within(&process, |process| {
                let mut channels = Vec::new();
                for port in 0..process.audio_outputs_count as usize {
                    let port = &*process.audio_outputs.add(port);
                    channels.extend((0..port.channel_count as usize).map(|at| *port.data32.add(at)));
                }
                for (index, channel) in channels.iter().enumerate() {
                    assert!(!channels[..index].contains(channel), "two are one");
                    std::slice::from_raw_parts_mut(*channel, process.frames_count as usize).fill(1.0);
                }
                channels.len()
            })
        }
    }

    #[test]
    fn what_is_missing_is_played_where_nobody_hears_it() {
        for ports in [1, MOST_PORTS] {
            let all = CHANNELS + ports - 1;
            assert_eq!(played(ports, FRAMES, &mut []), Some(all), "no port");
            let mut nowhere = clap_audio_buffer { data32: null_mut(), ..port(&mut [null_mut(); 2]) };
            assert_eq!(played(ports, FRAMES, std::slice::from_mut(&mut nowhere)), Some(all), "no channels");
            let mut sound = [f32::NAN; FRAMES];
            let mut one = [sound.as_mut_ptr()];
            assert_eq!(played(ports, FRAMES, &mut [port(&mut one)]), Some(all), "one channel");
            assert_eq!(sound, [1.0; FRAMES]);
            let mut right = [f32::NAN; FRAMES];
            let mut second = [null_mut(), right.as_mut_ptr()];
            assert_eq!(played(ports, FRAMES, &mut [port(&mut second)]), Some(all), "an address of nothing");
            assert_eq!(right, [1.0; FRAMES]);
        }
        assert_eq!(played(1, FRAMES + 1, &mut []), None, "there is no memory for that");
    }

    #[test]
    fn what_is_given_is_played_into_and_what_is_too_much_is_silent() {
        let mut sounds = [[f32::NAN; FRAMES]; 3];
        let mut channels = sounds.each_mut().map(|sound| sound.as_mut_ptr());
        assert_eq!(played(1, FRAMES, &mut [port(&mut channels)]), Some(2));
        assert_eq!(sounds, [[1.0; FRAMES], [1.0; FRAMES], [0.0; FRAMES]]);
        // Longer blocks, too, where nothing is missing.
        let mut sounds = [[f32::NAN; 2 * FRAMES]; 2];
        let mut channels = sounds.each_mut().map(|sound| sound.as_mut_ptr());
        assert_eq!(played(1, 2 * FRAMES, &mut [port(&mut channels)]), Some(2));
        assert_eq!(sounds, [[1.0; 2 * FRAMES]; 2]);
    }
}
