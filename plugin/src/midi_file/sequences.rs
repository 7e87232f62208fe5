//! Between the sequences of format 2: each is played as if there were no other.

use super::{SongEvent, SongTime};
use crate::performance::controller::{BRIGHTNESS, DATA_ENTRY, PARAMETER_LOWER, PARAMETER_UPPER, RESET};
use crate::performance::{ChosenParameter, MPE_MANAGER, MPE_UPPER_MANAGER, PlayerEvent};

/// What a player is told between two sequences: no channel is a note of MPE any more, controllers, pedals, wheels and the capo go
/// back, and hands let go of everything. The last of it is [`PlayerEvent::AllNotesOff`], which no file has in it. (There is no
/// message by which wheels reach as far as they did before any was announced.)
pub(super) fn let_go(time: SongTime) -> impl Iterator<Item = SongEvent> {
    let send = |channel, number, value: u8| PlayerEvent::Controller {
        channel,
        number,
        value: f32::from(value) / 127.0,
    };
    let zones = [MPE_MANAGER, MPE_UPPER_MANAGER].into_iter().flat_map(move |channel| {
        let members =
            [(PARAMETER_UPPER, 0), (PARAMETER_LOWER, ChosenParameter::MEMBERS as u8), (DATA_ENTRY, 0)];
        members.map(|(number, value)| send(channel, number, value))
    });
    let resets = (0..16).map(move |channel| send(channel, RESET, 0));
    // Which a reset leaves where it is.
    let places = (0..16).map(move |channel| send(channel, BRIGHTNESS, 64));
    let events = zones.chain(resets).chain(places).chain([PlayerEvent::AllNotesOff]);
    events.map(move |event| SongEvent { time, event })
}
