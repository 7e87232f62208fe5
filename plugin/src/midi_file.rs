//! Standard MIDI files: bytes in, a list of [`PlayerEvent`]s at exact times out.
//!
//! Times are kept as whole numbers over one common denominator, so that a tempo map an hour long
//! still lands every event on the right sample. Events are decoded by `midly`; the chunk structure
//! is walked here, because `midly` reads a truncated file as a shorter song and stumbles over some
//! impossible time divisions.

mod chunks;
mod messages;
mod sequences;
mod sized;
mod timing;
mod unplayed;

use midly::{EventIter, MetaMessage, MidiMessage, TrackEventKind};

use crate::performance::{Expression, PlayerEvent, announced_members, controller};
use crate::pitch_wheel;
use chunks::Chunks;
pub use messages::{CutOff, MidiFileError, SongWarning};
pub use timing::SongTime;
use timing::{Clock, Division};
use unplayed::unplayed;
pub use unplayed::{LeftOut, WhyLeftOut};

/// Largest MIDI file read, bytes. Ordinary songs take some tens of kilobytes.
pub const LARGEST_FILE: usize = 32 << 20;

/// The channel of percussion in General MIDI, counted from 0.
const DRUM_CHANNEL: u8 = 9;

/// The meta event that changes the tempo.
const TEMPO: u8 = 0x51;

/// Which of a file's notes are played. Tempo changes always count, and so do registered parameters: MPE and how far
/// wheels reach are announced on other channels than those of the notes, and often in another track.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Selection {
    /// Only this track, counted from 1.
    pub track: Option<usize>,
    /// Only this channel, counted from 1 to 16. Naming the drum channel plays it.
    pub channel: Option<u8>,
    /// Whether the drum channel is one like any other: a string's, or in MPE a note's. In a song that announces
    /// it as one of MPE it always is.
    pub tenth: bool,
    /// Whether what is there of a last track that is cut off is played, with a warning; else such a file is refused.
    pub truncated: bool,
}

/// An event at its exact time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SongEvent {
    /// When, counted from the start of the song.
    pub time: SongTime,
    /// What.
    pub event: PlayerEvent,
}

/// A song ready to play: events in order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Song {
    /// The events, in order of time; those at equal times in the order of the file. Before each sequence of format 2 but the
    /// first that has any stands what lets go of the one before, and of that [`PlayerEvent::AllNotesOff`] last: how far wheels
    /// reach is then whoever plays it to put back.
    pub events: Vec<SongEvent>,
    /// Notes that are not among them though they were read, sequence by sequence in order of time.
    pub left_out: Vec<LeftOut>,
    /// What the user should know.
    pub warnings: Vec<SongWarning>,
}

impl Song {
    /// Reads a whole MIDI file of any of the three formats; the sequences of format 2 follow one
    /// another, and leave nothing to each other.
    ///
    /// # Errors
    /// One line that says what is wrong with the file.
    pub fn from_midi(bytes: &[u8], selection: Selection) -> Result<Self, MidiFileError> {
        let chunks = Chunks::read(bytes)?;
        if let Some(asked) = selection.track
            && !(1..=chunks.tracks.len()).contains(&asked)
        {
            return Err(MidiFileError::NoSuchTrack { asked, count: chunks.tracks.len() });
        }
        let (division, song) = (chunks.division, Song::empty());
        let mut reader = Reader {
            selection,
            division,
            cut: chunks.cut,
            no_tempos: 0,
            programs: [0; 16],
            found: Vec::new(),
            song,
        };
        // Of a sequence that is not played nothing is missed.
        let missed = chunks.cut.filter(|cut| !chunks.sequential || reader.selects(cut.track - 1));
        reader.song.warnings.extend(missed.map(SongWarning::CutOff));
        if chunks.left_out > 0 {
            let (announced, left_out) = (chunks.tracks.len(), chunks.left_out);
            reader.song.warnings.push(SongWarning::TracksLeftOut { announced, left_out });
        }
        let mut start = SongTime::zero(chunks.division);
        if chunks.sequential {
            for (index, data) in chunks.tracks.iter().enumerate() {
                // Only the chosen sequence takes time: it does not wait for those before it.
                if reader.selects(index) {
                    let track = reader.track(index, data)?;
                    let end = reader.perform(start, vec![track]);
                    reader.take(start);
                    start = end;
                }
            }
        } else {
            let mut tracks = Vec::with_capacity(chunks.tracks.len());
            for (index, data) in chunks.tracks.iter().enumerate() {
                tracks.push(reader.track(index, data)?);
            }
            reader.perform(start, tracks);
            reader.take(start);
        }
        Ok(reader.finish())
    }

    /// A song without events.
    fn empty() -> Self {
        Self { events: Vec::new(), left_out: Vec::new(), warnings: Vec::new() }
    }

    /// Time of the last event, s; 0 without events.
    pub fn duration(&self) -> f64 {
        self.events.last().map_or(0.0, |event| event.time.seconds())
    }
}

/// One decoded event on the tick grid of its track.
struct Tick {
    at: u64,
    kind: TickKind,
}

enum TickKind {
    /// Microseconds a beat.
    Tempo(u32),
    /// Something for a player, and whether it is selected.
    Player(PlayerEvent, bool),
}

/// A decoded track: its events, and the tick at which it ends.
struct Track {
    ticks: Vec<Tick>,
    end: u64,
}

/// Gathers the song while tracks are decoded.
struct Reader {
    selection: Selection,
    division: Division,
    /// The track whose last bytes are not there, if there is one.
    cut: Option<CutOff>,
    /// Changes to a tempo that is none, passed over.
    no_tempos: usize,
    /// Program changes of each channel, passed over.
    programs: [usize; 16],
    /// Everything that is for a player in what plays together, in order of time, and whether it is selected.
    found: Vec<(SongEvent, bool)>,
    song: Song,
}

impl Reader {
    fn selects(&self, track_index: usize) -> bool {
        self.selection.track.is_none_or(|track| track == track_index + 1)
    }

    /// Decodes the events of one track.
    fn track(&mut self, index: usize, data: &[u8]) -> Result<Track, MidiFileError> {
        let mut track = Track { ticks: Vec::new(), end: 0 };
        let cut_off = self.cut.filter(|cut| cut.track == index + 1);
        let mut iterator = EventIter::new(data);
        let mut running_status = None;
        let mut ended = false;
        loop {
            let offset = data.len() - iterator.unread().len();
            if offset == data.len() {
                break;
            }
            let rest = &data[offset..];
            let read = iterator.next().and_then(Result::ok);
            let whole = |_: &_| !(iterator.unread().is_empty() && sized::announces_more(rest));
            let Some(event) = read.filter(whole) else {
                // `midly` reads some that nobody here asks about, and refuses what they say: hours that no day has, an empty key.
                if let Some((ticks, after)) = sized::meta(rest) {
                    track.end += ticks;
                    iterator = EventIter::new(after);
                    *iterator.running_status_mut() = running_status;
                    continue;
                }
                if cut_off.is_some() {
                    break;
                }
                return Err(MidiFileError::BadEvent { track: index + 1, offset });
            };
            // Many files carry running status across a meta event, though the standard ends it there.
            if iterator.running_status().is_some() {
                running_status = iterator.running_status();
            } else {
                *iterator.running_status_mut() = running_status;
            }
            track.end += u64::from(event.delta.as_int());
            let kind = match event.kind {
                TrackEventKind::Meta(MetaMessage::EndOfTrack) => {
                    ended = true;
                    break;
                }
                TrackEventKind::Meta(MetaMessage::Tempo(tempo)) => self.tempo(tempo.as_int()),
                // One of fewer than its three bytes.
                TrackEventKind::Meta(MetaMessage::Unknown(TEMPO, _)) => self.tempo(0),
                TrackEventKind::Midi { channel, message } => {
                    let chosen = |only| only == channel.as_int() + 1;
                    let selected = self.selects(index) && self.selection.channel.is_none_or(chosen);
                    if let MidiMessage::ProgramChange { .. } = message {
                        self.programs[usize::from(channel.as_int())] += usize::from(selected);
                    }
                    let event = player_event(channel.as_int(), message);
                    event.map(|event| TickKind::Player(event, selected))
                }
                _ => None,
            };
            track.ticks.extend(kind.map(|kind| Tick { at: track.end, kind }));
        }
        // A track that has its end announces too much, and nothing is missing.
        match cut_off {
            _ if ended => {}
            Some(cut) if !self.selection.truncated => return Err(MidiFileError::CutOff(cut)),
            Some(_) => {}
            None => self.song.warnings.push(SongWarning::NoEndOfTrack { track: index + 1 }),
        }
        Ok(track)
    }

    /// A change of tempo, microseconds a beat, 0 for one that says none. Beats that take no time would be played all at once.
    fn tempo(&mut self, tempo: u32) -> Option<TickKind> {
        if tempo == 0 {
            self.no_tempos += usize::from(self.division.follows_tempo());
            return None;
        }
        Some(TickKind::Tempo(tempo))
    }

    /// Puts tracks that play together on the song's clock, from `start`; returns where they end.
    fn perform(&mut self, start: SongTime, tracks: Vec<Track>) -> SongTime {
        let end = tracks.iter().map(|track| track.end).max().unwrap_or(0);
        let mut ticks: Vec<Tick> = tracks.into_iter().flat_map(|track| track.ticks).collect();
        // Stable: simultaneous events keep the order of tracks, and of events within them.
        ticks.sort_by_key(|tick| tick.at);
        let mut clock = Clock::new(self.division, start);
        for tick in ticks {
            clock.advance_to(tick.at);
            match tick.kind {
                TickKind::Tempo(tempo) => clock.set_tempo(tempo),
                TickKind::Player(event, selected) => {
                    self.found.push((SongEvent { time: clock.now(), event }, selected));
                }
            }
        }
        clock.advance_to(end);
        clock.now()
    }

    /// Takes over into the song what plays together, from `start` on.
    fn take(&mut self, start: SongTime) {
        let Self { selection, found, song: Song { events, left_out, .. }, .. } = self;
        let mut found = std::mem::take(found);
        let members = announced_members(found.iter().map(|(event, _)| event.event));
        let percussion = selection.channel.is_some() || selection.tenth || members.has(DRUM_CHANNEL);
        left_out.extend(unplayed(&found, !percussion));
        // What is announced when all that is selected is over makes the song no longer.
        let end = found.iter().rposition(|&(_, selected)| selected).map_or(0, |last| last + 1);
        found.truncate(end);
        let counts = |&(event, selected): &(SongEvent, bool)| selected || is_parameter(event.event);
        let mut found: Vec<_> = found.into_iter().filter(counts).map(|(event, _)| event).collect();
        if !percussion {
            found.retain(|event| event.event.channel() != Some(DRUM_CHANNEL));
        }
        if !events.is_empty() && !found.is_empty() {
            events.extend(sequences::let_go(start));
        }
        events.append(&mut found);
    }

    fn finish(self) -> Song {
        let Self { no_tempos, programs, song: Song { events, left_out, mut warnings }, .. } = self;
        let notes = left_out.iter().filter(|note| note.why == WhyLeftOut::Percussion).count();
        warnings.extend((no_tempos > 0).then_some(SongWarning::NoTempo { changes: no_tempos }));
        warnings.extend((notes > 0).then_some(SongWarning::DrumsSkipped { notes }));
        warnings.extend(messages::not_followed(&events));
        warnings.extend(messages::programs_not_followed(&events, &programs));
        warnings.extend(messages::tuning_not_followed(&events));
        warnings.extend(messages::upper_zone(&events));
        warnings.extend((count_notes(&events) == 0).then_some(SongWarning::NoNotes));
        Song { events, left_out, warnings }
    }
}

/// Whether it is part of setting a registered parameter.
fn is_parameter(event: PlayerEvent) -> bool {
    matches!(event, PlayerEvent::Controller { number, .. } if controller::is_of_parameters(number))
}

fn count_notes(events: &[SongEvent]) -> usize {
    events.iter().filter(|event| matches!(event.event, PlayerEvent::NoteOn { .. })).count()
}

/// A channel message in the player's words, if the player cares for it.
fn player_event(channel: u8, message: MidiMessage) -> Option<PlayerEvent> {
    let unit = |value: midly::num::u7| f32::from(value.as_int()) / 127.0;
    match message {
        MidiMessage::NoteOn { key, vel } if vel.as_int() > 0 => {
            Some(PlayerEvent::NoteOn { channel, key: key.as_int(), velocity: unit(vel) })
        }
        MidiMessage::NoteOn { key, .. } | MidiMessage::NoteOff { key, .. } => {
            Some(PlayerEvent::NoteOff { channel, key: key.as_int() })
        }
        MidiMessage::Controller { controller, value } => {
            Some(PlayerEvent::Controller { channel, number: controller.as_int(), value: unit(value) })
        }
        MidiMessage::PitchBend { bend } => {
            Some(PlayerEvent::PitchBend { channel, value: pitch_wheel::turn(f32::from(bend.0.as_int())) })
        }
        MidiMessage::Aftertouch { key, vel } => {
            let expression = Expression::Pressure(unit(vel));
            Some(PlayerEvent::Note { channel, key: key.as_int(), expression })
        }
        MidiMessage::ChannelAftertouch { vel } => {
            Some(PlayerEvent::ChannelPressure { channel, pressure: unit(vel) })
        }
        MidiMessage::ProgramChange { .. } => None,
    }
}
