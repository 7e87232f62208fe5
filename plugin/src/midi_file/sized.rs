//! Events that say how many bytes they have: texts and other meta events, and system-exclusive messages.

/// Whether the event that the rest of a track begins with announces more bytes than there are.
pub(super) fn announces_more(rest: &[u8]) -> bool {
    let announced = number(rest).and_then(|(_, event)| match event {
        [0xff, _, length @ ..] | [0xf0 | 0xf7, length @ ..] => Some(length),
        _ => None,
    });
    announced.is_some_and(|length| number(length).is_none_or(|(expected, found)| expected > found.len()))
}

/// The ticks before the meta event that the rest of a track begins with, and what follows all of its bytes, if that is what it
/// begins with. Whatever they say, such an event can be passed over.
pub(super) fn meta(rest: &[u8]) -> Option<(u64, &[u8])> {
    let (ticks, event) = number(rest)?;
    let [0xff, _, length @ ..] = event else { return None };
    let (length, data) = number(length)?;
    Some((ticks as u64, data.get(length..)?))
}

/// A number of seven bits a byte, the last one below 128, and what follows it.
fn number(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let last = bytes.iter().take(4).position(|byte| *byte < 0x80)?;
    let value = bytes[..=last].iter().fold(0, |value, byte| value << 7 | usize::from(byte & 0x7f));
    Some((value, &bytes[last + 1..]))
}
