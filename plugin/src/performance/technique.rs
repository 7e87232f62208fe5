//! How the player moves: the constants of playing that no set-up changes.

mod coming_and_going;
mod hammering;
mod slots;
mod striking;

use low_action_dsp::{FingerSlot, Touch};

use super::hand::LARGEST_CHORD;
pub(crate) use coming_and_going::*;
pub(crate) use hammering::*;
pub(crate) use slots::*;
pub(crate) use striking::*;

/// Where another damper rests behind a fretting finger, as a part of the way from the nut: what rings
/// there is hardly heard until the finger leaves and lets it out.
pub(crate) const BEHIND_FINGER: f64 = 0.62;
/// Nearest to the nut that one rests, m; shorter ends ring far above what is heard.
pub(crate) const NEAREST_NUT: f64 = 0.04;
/// Farthest from the saddle a damper rests, as a part of the sounding length.
pub(crate) const FARTHEST_DAMPER: f64 = 0.6;

/// How force follows velocity: its power of 1.5, so that velocity 64 is 9 dB and 32 is 18 dB below
/// the hardest. The square that General MIDI level 2 recommends for synthesizers would put soft notes
/// below the sound of the finger that stops them.
pub const VELOCITY_CURVE: f64 = 1.5;
/// A string slips off a plectrum or a fingertip at a speed that goes with its force, so softer strokes let go more slowly, down to
/// this part of the hardest pluck's force. (Softer ones would lose their fundamentals, too: half a millisecond takes 1 dB of
/// those at 660 Hz, and half of the brightness of an electric guitar's high strings.)
pub(crate) const SLOWEST_STROKE: f64 = 0.25;
/// Farthest from the saddle a pluck may be, as a part of the sounding length: past the middle it
/// sounds the same mirrored, and the hands would meet.
pub(crate) const FARTHEST_PLUCK: f64 = 0.45;
/// Nearest to the saddle a pluck may be, m: a fingertip's half width.
pub(crate) const NEAREST_PLUCK: f64 = 0.006;
/// How a hand stills a string that still sounds before it plucks it: for how much of a period, and by how much it raises the loss,
/// as a multiple of a period's inverse. So the lowest partial is 7.9 dB down or more, all others 13.7 dB: 0.8 of what would
/// just keep the lowest one from swinging takes most out of it in so short a time.
pub(crate) const STILLING: (f64, f64) = (0.4, 5.0);
/// At least for so long, s: until hands that rested there are off the string.
pub(crate) const STILLED_AT_LEAST: f64 = 0.003;
/// How much longer it does for a harmonic, s: until a finger or a bar that let the string up is surely off it. What still touches it would
/// take up a harmonic, and what it still does is not covered by other partials.
pub(crate) const STILLED_LONGER: f64 = 0.003;
/// The hand may still be there while the plectrum begins to push, for this part of it: most of a push is at its end.
pub(crate) const STILLED_PUSH: f64 = 0.7;
/// Longest time by which a stroke may come later for that, s.
pub(crate) const LONGEST_LEAD: f64 = 0.01;
/// Shortest note, s from pluck to damping. It ends the push of any pluck and lets a note of no
/// length at all be heard as a staccato.
pub(crate) const SHORTEST_NOTE: f64 = 0.03;

/// Fastest change of pitch by tension, semitones a second; strong fingers bend a tone in 20 ms.
pub(crate) const BEND_SPEED: f64 = 100.0;
/// Shortest ramp of a bend, s: longer than the steps of most wheels, so that they do not show.
pub(crate) const BEND_RAMP: f64 = 0.012;
/// Least time between two changes of a bend's goal, s.
pub(crate) const BEND_INTERVAL: f64 = 0.003;
/// How far off a bend is out of tune, semitones: a hundredth of a fret is less than anybody hears.
pub(crate) const OUT_OF_TUNE: f64 = 0.01;
/// A finger that stops the string no farther than so from a place is there, frets: where nothing keeps it on any it has no other place
/// so near.
pub(crate) const SAME_FRET: f64 = 0.5;
/// How far pulling goes from where a wheel has slid a finger before that slides on, or back, semitones.
pub(crate) const SLID_STAYS: f64 = 0.75;
/// A wheel that is turned by no more than so much at once is followed without a break where a finger slides for it, semitones.
pub(crate) const FOLLOWED: f64 = 1.0;
/// How fast a finger's force follows the pressure on a key, s.
pub(crate) const PRESSURE_RAMP: f64 = 0.012;
/// A vibrato of the fretting hand: turns a second, and how far it goes at its deepest, semitones. Guitarists
/// keep to 4 to 7 Hz and a quarter to half a semitone.
pub(crate) const VIBRATO: (f64, f64) = (5.5, 0.5);
/// Time between two goals of a vibrato, s: fifteen to a turn.
pub(crate) const VIBRATO_STEP: f64 = 0.012;
/// How many times its usual force a finger presses at full pressure.
pub(crate) const FIRMEST: f64 = 2.5;
/// How far brightness moves the pluck from its usual place, m: towards the saddle at full, away at none.
pub(crate) const BRIGHTNESS_REACH: f64 = 0.08;

/// How hard a finger comes down where somebody points, 0 to 1, and how fast it slides after them, s: from one picture
/// of a screen to the next.
pub(crate) const POINTED: f64 = 0.6;
pub(crate) const POINTING: f64 = 0.016;
/// Hardest pluck of somebody who points, N.
pub(crate) const HARDEST_POINTED: f64 = 50.0;

/// How long a string rings after such a pluck, s, before it is as good as silent; under a capo hands damp it then.
pub(crate) const POINTED_RINGING: f64 = 30.0;

/// How long a light finger stays at a node after the stroke, or the last one of a tremolo, s, and how it leaves.
pub(crate) const AT_NODE: f64 = 0.12;
/// How light: the damping of its pad as a multiple of a match with the string.
pub(crate) const NODE_TOUCH: f64 = 1.0;
/// How a finger leaves that another one has just landed before: when that stops the string, and no sooner.
pub(crate) const BEHIND_LIFT: Leaving = Leaving { speed: 0.01, turning: 0.15 };
/// How a finger leaves that hardly bends the string.
pub(crate) const NODE_LIFT: Leaving = Leaving { speed: 0.02, turning: 0.05 };
/// How long a finger that leaves may still touch the string, as a multiple of the time in which its force turns.
pub(crate) const LINGERING: f64 = 2.0;
/// Semitones by which a natural harmonic may be off the key that asks for it.
pub(crate) const NEAR_ENOUGH: f64 = 0.2;
/// The highest partial played as a natural harmonic.
pub(crate) const HIGHEST_HARMONIC: u32 = 8;
/// Part of its largest motion under which a pickup hardly hears a partial.
pub(crate) const DEAF: f64 = 0.2;
/// How a resting finger mutes, and keeps quiet what is behind a bar: a match with the string.
pub(crate) const MUTE: f64 = 1.0;

/// A steel bar of 250 g, and half a kilogram of the hand that holds it and lets it come to rest on a string without a
/// bounce. An end that gives way like a mass m shortens the string by T/(mω²), which its place makes up for: 6 cents for the
/// lowest notes of a bass, and 19 under the bar alone.
pub(crate) const BAR: Touch =
    Touch { mass: 0.75, stiffness: 1e8, exponent: 1.5, damping: 0.05, hand_damping: 45.0 };
/// How it leaves when the next note is about to sound: no hand throws it up faster.
pub(crate) const BAR_LIFT: Leaving = Leaving { speed: 0.3, turning: 0.003 };
/// How fast it comes down on a string, m/s.
pub(crate) const BAR_SPEED: f64 = 0.05;
/// Slot of the finger that rests on the string behind a bar: a damper's, which takes that of the other fretting finger then.
pub(crate) const BEHIND_BAR: FingerSlot = DAMPERS[1].0;
/// How far behind the bar it rests: so far, m, but no more than this part of the way to the nut or the capo.
pub(crate) const BEHIND_BAR_REACH: (f64, f64) = (0.04, 0.4);
/// Its weight on one string, N; and the largest part of what brings the string to the fret that may be used.
pub(crate) const BAR_WEIGHT: f64 = 0.25;
pub(crate) const BAR_SHARE: f64 = 0.5;

/// Notes that begin within so long of one another while their keys are down are one chord for the left hand, s. The notes of chords
/// that pianists play come some 10 to 30 ms apart; those of the fastest runs, 40.
pub(crate) const TOGETHER: f64 = 0.03;
/// How long a chord can take whose notes each come in that time, s: six strings 25 ms apart.
pub(crate) const LONGEST_CHORD: f64 = 0.15;
/// How long the rest of a chord waits that has more notes than strings, s from note to note.
pub(crate) const ARPEGGIO: f64 = 0.07;
/// How long the last note of the largest chord waits on a single string, s.
pub(crate) const LONGEST_WAIT: f64 = LARGEST_CHORD as f64 * ARPEGGIO;
/// Where a hand mutes an open string, as a part of its length from the nut, and how far on its next finger lies, as a part of what
/// is left to the saddle: some three frets. No partial up to the sixteenth has a node near both.
pub(crate) const MUTED_OPEN: f64 = 0.36;
pub(crate) const MUTED_BESIDE: f64 = 0.184;

/// Largest part by which a strum grows or falls on its way.
pub(crate) const STRUM_ACCENT: f64 = 0.7;
