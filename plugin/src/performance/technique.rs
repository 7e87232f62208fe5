//! How the player moves: the constants of playing that no set-up changes.

use low_action_dsp::{FingerSlot, Touch};

use super::hand::LARGEST_CHORD;

/// Slots the fretting fingers take in turn: a new finger lands in one while the last is being lifted
/// from the other, and the free one damps behind the finger when the note ends.
pub(crate) const FRETTING_SLOTS: usize = 2;
/// Slots of the edge of the hand that damps, and how far from the saddle each part of it rests, as
/// part of the set-up's damper position. One point alone would leave the partials ringing that have
/// a node there; a hand is wide, and a partial with nodes at both places is high and dies by itself.
pub(crate) const DAMPERS: [(FingerSlot, f64); 2] = [(2, 1.0), (3, 0.37)];
/// Slot of a light finger on a string that another one stops: a damper's.
pub(crate) const LIGHT: FingerSlot = DAMPERS[1].0;
/// Slot of the palm, or the thumb, of the hand that plucks.
pub(crate) const RIGHT_HAND: FingerSlot = 4;
/// Slot of a capo.
pub(crate) const CAPO: FingerSlot = 5;
/// Slots of the parts of a palm, how far from the saddle each rests as a part of how far the palm reaches, and its part of the palm's
/// force. One part alone would leave the partials ringing that have a node there, high ones and for seconds: there the second is
/// three fifths of a half wave from the saddle, or as far from a node. Both together brake the lowest partials as one with all
/// of the force would: 0.735 · (1² + 0.6²) = 1.
pub(crate) const PALM: [(FingerSlot, f64, f64); 2] = [(RIGHT_HAND, 1.0, 0.735), (6, 0.6, 0.735)];
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
/// The hand may still be there while the plectrum begins to push, for this part of it: most of a push is at its end.
pub(crate) const STILLED_PUSH: f64 = 0.7;
/// Longest time by which a stroke may come later for that, s.
pub(crate) const LONGEST_LEAD: f64 = 0.01;
/// Shortest note, s from pluck to damping. It ends the push of any pluck and lets a note of no
/// length at all be heard as a staccato.
pub(crate) const SHORTEST_NOTE: f64 = 0.03;

/// How a finger leaves a string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Leaving {
    /// Speed it reaches, m/s.
    pub speed: f64,
    /// Time in which its force turns from pressing to lifting, s.
    pub turning: f64,
}

/// How it leaves when the next note is about to sound, at the hardest: 1 mm away after 3 ms.
pub(crate) const QUICK_LIFT: Leaving = Leaving { speed: 0.5, turning: 0.001 };
/// How far the finger of the softest note lets the string rise in one of its periods, in which its force turns, m: what takes
/// a period the string hardly answers. The harder a note, the quicker the finger before it goes.
pub(crate) const RISE: f64 = 0.001;
/// How much faster a finger is in haste: its hand brakes it this many times less, and one. Setting a string down slowly lets
/// what is plucked meanwhile leak past the finger: held that lightly at fret 12, up to 9 dB of it in 20 ms.
pub(crate) const HASTE: f64 = 9.0;
/// Time in which a finger that is in no hurry has set its string down, s: over the 1 mm of most frets at 0.04 m/s.
pub(crate) const SETTLING: f64 = 0.03;
/// How much more slowly a finger lands for a soft note, whose pluck its landing would drown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SoftLanding {
    /// For notes as hard as this it lands as fast as it can (velocity 45), for softer ones more slowly by the square.
    pub from: f64,
    /// How many times more slowly at most: in more time most of what was plucked would leak past it at fret 12.
    pub most: f64,
    /// Notes softer than this (velocity 23) would be drowned even so, and have a finger that is slower, whatever leaks.
    pub drowned: f64,
    /// The slowest of all, as a multiple of what the hand's own damping gives.
    pub slowest: f64,
}

/// The usual. (Fitted to landings on seven frets of sixteen strings of nine instruments.)
pub(crate) const SOFT_LANDING: SoftLanding =
    SoftLanding { from: 0.21, most: 1.6, drowned: 0.077, slowest: 2.0 };
/// How a finger comes down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coming {
    /// Strength of the note that it comes for, 0 to 1.
    pub strength: f64,
    /// In what haste it is, 0 (none) to 1.
    pub haste: f64,
}

/// As fast as it can.
pub(crate) const AT_ONCE: Coming = Coming { strength: 1.0, haste: 1.0 };
/// By how much a finger is to be slower than the way to the fret asks for: the string hardly moves before the finger's pad has been
/// pressed in. Fitted: from 1.08 to 1.17 would be best on frets 3 to 12 of seven strings of four instruments.
pub(crate) const LANDING_LAG: f64 = 1.13;
/// Longest time in which the force of a finger that lands rises, as a part of the period: speed is to be constant.
pub(crate) const LANDING_RISE: f64 = 0.25;
/// Least way down to a fret that is reckoned with, m.
pub(crate) const LEAST_WAY: f64 = 1e-5;
/// The most that a hand brakes a finger that lands, N s/m: what lets go quickly then has to pull with 180 N already.
pub(crate) const MOST_DAMPING: f64 = 350.0;
/// How the finger of a note that is over goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Parting {
    /// How long the dampers rest before it begins to leave, s, while it relaxes.
    pub relaxing: f64,
    /// How it leaves then.
    pub easing: Leaving,
}

/// The usual: 40 dB take 0.15 s, and a hand that relaxes as fast as that is itself heard through a bridge; and so slowly that
/// the string rises from the fret without a sound.
pub(crate) const RESTING: Parting = Parting { relaxing: 0.4, easing: FINGER_EASING };
/// Of a finger that has tapped, and is to be off the string before it taps again; but no sooner than the dampers have come to rest,
/// in whose 10 ms a string that hangs high over its fret would sound by being let up.
pub(crate) const TAPPING: Parting =
    Parting { relaxing: 0.004, easing: Leaving { speed: 0.05, turning: 0.036 } };
/// What a fretting finger goes on pressing with when a note has ended, as a multiple of the force at
/// which the string would leave the fret.
pub(crate) const HOLDING: f64 = 1.25;
/// How a finger leaves a quiet string.
pub(crate) const FINGER_EASING: Leaving = Leaving { speed: 0.005, turning: 0.5 };
/// How the dampers leave after it; they bend the string much less.
pub(crate) const DAMPER_EASING: Leaving = Leaving { speed: 0.01, turning: 0.2 };

/// What a hand takes of a string that its fingers have left, 1/s, and for how long, s: 156 dB, so that nothing is left to ring where
/// nobody would hear it for half a minute.
pub(crate) const LAID_ALONG: (f64, f64) = (60.0, 0.3);

/// Fastest change of pitch by tension, semitones a second; strong fingers bend a tone in 20 ms.
pub(crate) const BEND_SPEED: f64 = 100.0;
/// Shortest ramp of a bend, s: longer than the steps of most wheels, so that they do not show.
pub(crate) const BEND_RAMP: f64 = 0.012;
/// Least time between two changes of a bend's goal, s.
pub(crate) const BEND_INTERVAL: f64 = 0.003;
/// How far off a bend is out of tune, semitones: a hundredth of a fret is less than anybody hears.
pub(crate) const OUT_OF_TUNE: f64 = 0.01;
/// How far pulling goes from where a wheel has slid a finger before that slides on, or back, semitones.
pub(crate) const SLID_STAYS: f64 = 0.75;
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

/// How fast a finger comes that is to make a string sound by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hammer {
    /// How much of the speed that makes the first partial as loud as a pluck does.
    pub part: f64,
    /// Speed of the softest, m/s; that of the others is added to it.
    pub slowest: f64,
    /// What is added stays below it however thin the string is if the note is as hard as can be, m/s; where that would ask for as much,
    /// it is half of it.
    pub limit: f64,
    /// Softer notes stay below less, by this power of their force: or those of thin strings would all be as fast as fingers are.
    pub effort: f64,
}

/// The usual. Fingertips reach 1 to 2 m/s. (Fitted to taps on five frets of nine strings of five instruments, and to runs of hammers.)
pub(crate) const HAMMER: Hammer = Hammer { part: 1.35, slowest: 0.1, limit: 2.7, effort: 0.6 };
/// Time in which a string comes up from a fret that its finger leaves, s, before another can strike it there.
pub(crate) const RISING: f64 = 0.003;
/// How much of the landing speed the hand behind it would keep up by its force alone: the finger is thrown,
/// and held back enough not to bounce.
pub(crate) const HAMMER_GRIP: f64 = 0.5;
/// How a finger gathers force and speed on its way, if that takes long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gathering {
    /// On ways that take no longer it gathers nothing, as a part of the period of what sounds.
    pub from: f64,
    /// On those that take as long, or longer, it gathers most, as a part of that.
    pub to: f64,
    /// How much of both it gathers then: as little is left at first as has the string moving within 3 ms.
    pub most: f64,
}

/// The usual. On a way of x periods the speed at the end is (1 + what is gathered) / x of a constant one: gathered from half a period
/// to nine tenths of one, it would be the same for all fingers that take so long.
pub(crate) const GATHERING: Gathering = Gathering { from: 0.2, to: 0.7, most: 0.8 };
/// Time in which it comes to press if it is thrown, s.
pub(crate) const HAMMER_LANDING: f64 = 0.001;
/// How fast a finger that is only held down behind another relaxes, and presses again, s: pressed on, it would
/// stretch the string and raise the note.
pub(crate) const ANCHOR_RAMP: (f64, f64) = (0.02, 0.003);
/// How fast a finger is set down behind another, m/s: before that one has left.
pub(crate) const BEHIND_SPEED: f64 = 0.5;
/// How fast one that is behind another already is at another fret, s, and how far off that may be, frets: where more go by under it
/// they are heard, and another comes down.
pub(crate) const BEHIND_SLIDE: f64 = 0.002;
pub(crate) const BEHIND_REACH: f64 = 2.0;
/// How a finger plucks the string that it pulls off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pull {
    /// How far it takes the string along, as a part of the usual pluck.
    pub part: f64,
    /// The most force that may take, as a multiple of what takes the string as far at the usual place.
    pub hardest: f64,
    /// How long it pulls, s: most of that is at its end, when the finger has ceased to press.
    pub duration: f64,
    /// How long the flesh takes to let go, s.
    pub release: f64,
}

/// The usual. (Fitted to notes plucked as hard, in runs of pull-offs from fret 12 to the open string on eight strings of five
/// instruments. Let go of at once so near to the fret, the string would be up to 14 dB brighter than it is plucked.)
pub(crate) const PULL_OFF: Pull = Pull { part: 0.7, hardest: 6.0, duration: 0.0025, release: 0.0002 };
/// Farthest a hammer or a pull reaches, frets: from the first finger to the last, stretched.
pub(crate) const HAMMER_REACH: usize = 5;
/// Fastest slide to another note, m/s: seven frets of a guitar in 0.17 s. Where frets go by much faster, they pluck the
/// string, and where they keep time with it, each adds to what the one before did.
pub(crate) const SLIDE_SPEED: f64 = 1.0;
/// Farthest a slide goes, frets; what lies beyond is plucked anew.
pub(crate) const SLIDE_REACH: usize = 12;

/// How hard a finger comes down where somebody points, 0 to 1, and how fast it slides after them, s: from one picture
/// of a screen to the next.
pub(crate) const POINTED: f64 = 0.6;
pub(crate) const POINTING: f64 = 0.016;
/// Hardest pluck of somebody who points, N.
pub(crate) const HARDEST_POINTED: f64 = 50.0;

/// How long a string rings after such a pluck, s, before it is as good as silent; under a capo hands damp it then.
pub(crate) const POINTED_RINGING: f64 = 30.0;

/// How long a light finger stays at a node, s, and how it leaves.
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

/// How a stroke differs from the usual one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Striking {
    /// Its force as a multiple; below 0 it goes towards the board.
    pub force: f64,
    /// How long it pushes, as a multiple.
    pub duration: f64,
    /// How much nearer to the saddle it is, m.
    pub nearer: f64,
}

/// The usual stroke itself.
pub(crate) const DOWN_STROKE: Striking = Striking { force: 1.0, duration: 1.0, nearer: 0.0 };
/// A stroke back: less of the plectrum is under the string.
pub(crate) const UP_STROKE: Striking = Striking { force: 0.85, duration: 0.8, nearer: 0.004 };
/// A rest stroke: towards the board, with the flesh.
pub(crate) const REST_STROKE: Striking = Striking { force: -0.8, duration: 1.5, nearer: 0.0 };
/// A pop: three times as hard as a pluck.
pub(crate) const POP: Striking = Striking { force: 3.0, duration: 1.0, nearer: 0.0 };

/// How far the palm reaches from the saddle at the least and at full pressure, as a part of the length: 2 to
/// 6 cm on guitars, and no farther than this part of the way to the pluck.
pub(crate) const PALM_PLACE: (f64, f64) = (0.03, 0.09);
pub(crate) const PALM_BEFORE_PLUCK: f64 = 0.7;
/// Force of the palm then, as multiples of a match with the string. A damper R at a part x of the length takes
/// most out of the fundamental where R is a π-th of 1/x wave impedances: 3.5 of them, 1.8 matches, at the
/// farthest place.
pub(crate) const PALM_FORCE: (f64, f64) = (0.25, 2.0);
/// How fast the palm's force is there at a stroke, and how fast it follows its controller, s.
pub(crate) const PALM_LANDING: f64 = 0.001;
pub(crate) const PALM_RAMP: f64 = 0.03;
/// How long it waits on a silent string for the next note, s: a bar of slow music. A string under it is computed.
pub(crate) const PALM_WAITS: f64 = 2.0;

/// The joint of a thumb, bone under thin flesh.
pub(crate) const THUMB: Touch =
    Touch { mass: 0.012, stiffness: 3e6, exponent: 1.8, damping: 0.2, hand_damping: 0.5 };
/// How fast it comes, m/s: at the softest, and added at the hardest.
pub(crate) const SLAP_SPEED: (f64, f64) = (0.05, 1.6);
/// From how high, m.
pub(crate) const SLAP_CLEARANCE: f64 = 5e-4;
/// What presses it at the hardest while it is on the string, N, what lifts it, N, and when, s.
pub(crate) const SLAP_FORCE: f64 = 2.0;
pub(crate) const SLAP_BOUNCE: f64 = 12.0;
pub(crate) const SLAP_TIME: f64 = 0.005;
/// How soon after that it is off the string, s, so that the palm can come back.
pub(crate) const SLAP_CLEAR: f64 = 0.005;
/// How far past the last fret it falls, as a part of the length.
pub(crate) const PAST_LAST_FRET: f64 = 0.012;

/// Lowest and highest partial that a thumb beside the plectrum lets through.
pub(crate) const PINCHED: (f64, f64) = (3.0, 9.0);
/// How firmly it grazes, as a multiple of a match with the string, and how long, s.
pub(crate) const GRAZE: f64 = 1.0;
pub(crate) const GRAZE_TIME: f64 = 0.04;
/// Where the plectrum is then, as a part of the way from the saddle to the thumb.
pub(crate) const BESIDE_THUMB: f64 = 0.75;

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
