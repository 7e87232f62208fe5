//! MIDI files made by hand, byte by byte, so that odd and broken ones can be made too, which no library writes.

/// A file from its header fields and the data of its tracks.
pub fn file(format: u16, division: u16, tracks: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = b"MThd\0\0\0\x06".to_vec();
    for field in [format, tracks.len() as u16, division] {
        bytes.extend(field.to_be_bytes());
    }
    for track in tracks {
        bytes.extend(b"MTrk");
        bytes.extend((track.len() as u32).to_be_bytes());
        bytes.extend(track);
    }
    bytes
}

/// A track from events (ticks since the last one, bytes), with its end.
pub fn track(events: &[(u32, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (delta, event) in events.iter().copied().chain([(0, END)]) {
        bytes.extend(variable_length(delta));
        bytes.extend(event);
    }
    bytes
}

/// The end of a track.
pub const END: &[u8] = &[0xFF, 0x2F, 0];

/// A change of tempo, microseconds a beat.
pub fn tempo(microseconds: u32) -> Vec<u8> {
    let [_, a, b, c] = microseconds.to_be_bytes();
    vec![0xFF, 0x51, 3, a, b, c]
}

/// A number in groups of seven bits, the way MIDI files write times.
pub fn variable_length(mut number: u32) -> Vec<u8> {
    let mut bytes = vec![(number & 0x7F) as u8];
    while number > 0x7F {
        number >>= 7;
        bytes.insert(0, (number & 0x7F) as u8 | 0x80);
    }
    bytes
}
