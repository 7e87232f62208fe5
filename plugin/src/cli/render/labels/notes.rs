//! Notes that sounded, a flat record for each.

use low_action_dsp::Gesture;
use low_action_dsp::setup::frequency;
use serde::Serialize;

use super::Clock;
use super::source::LabelledString;
use crate::performance::{Annotation, Excitation, NewNote, Stopped, Technique, TimedAnnotation};

/// A note that sounded. What it has not is `null`.
#[derive(Debug, Clone, Serialize)]
pub(super) struct LabelledNote {
    /// From 1.
    string: usize,
    string_name: String,
    fret: usize,
    /// MIDI's own numbers: 1 to 16, 0 to 127, 1 to 127.
    channel: u8,
    key: u8,
    velocity: u8,
    /// MIDI note number in equal temperament, and what sounds, Hz.
    pitch: f64,
    frequency: f64,
    /// Samples of the sound, and s.
    asked_sample: u64,
    asked: f64,
    onset_sample: u64,
    onset: f64,
    released_sample: Option<u64>,
    released: Option<f64>,
    end_sample: u64,
    end: f64,
    end_by: &'static str,
    technique: &'static str,
    stop: &'static str,
    partial: Option<u32>,
    returned: bool,
    strokes: u64,
    /// Of the gesture that makes it sound: m from the nut, N, m/s, s.
    stroke_position: Option<f64>,
    stroke_force: Option<f64>,
    stroke_speed: Option<f64>,
    stroke_duration: Option<f64>,
    stroke_release: Option<f64>,
    /// m from the nut.
    finger_position: Option<f64>,
    touch_position: Option<f64>,
    /// 0 to 1.
    palm: f64,
    bent_short: bool,
}

/// A note on its way from being asked for to its end.
pub(super) struct Course {
    string: usize,
    pub note: NewNote,
    /// When it sounded, and by what; not yet, or never, if it was called off.
    pub sounded: Option<(u64, Excitation)>,
    strokes: u64,
    released: Option<u64>,
    pub end: Option<(u64, &'static str)>,
    bent_short: bool,
}

/// The notes that are heard, in order of onset, and of strings at once.
pub(super) fn notes(courses: &[Course], strings: &[LabelledString], clock: Clock) -> Vec<LabelledNote> {
    let mut notes: Vec<LabelledNote> =
        courses.iter().filter_map(|course| course.label(strings, clock)).collect();
    notes.sort_by_key(|note| (note.onset_sample, note.string));
    notes
}

/// What became of each note.
pub(super) fn courses(annotations: &[TimedAnnotation], strings: usize) -> Vec<Course> {
    let mut courses: Vec<Course> = Vec::new();
    // The note that each string is for.
    let mut present: Vec<Option<usize>> = vec![None; strings];
    for &TimedAnnotation { time, string, annotation } in annotations {
        let course = present[string].map(|index| &mut courses[index]);
        match annotation {
            Annotation::Begins(note) => {
                if let Some(before) = course {
                    before.end = Some((time, "note"));
                }
                present[string] = Some(courses.len());
                courses.push(Course {
                    string,
                    note,
                    sounded: None,
                    strokes: 0,
                    released: None,
                    end: None,
                    bent_short: false,
                });
            }
            Annotation::Sounds(excitation) => {
                if let Some(course) = course {
                    course.sounded.get_or_insert((time, excitation));
                    course.strokes += 1;
                }
            }
            Annotation::Released => {
                if let Some(course) = course {
                    course.released = Some(time);
                }
            }
            Annotation::Damped => {
                if let Some(course) = course {
                    course.end = Some((time, "damped"));
                }
                present[string] = None;
            }
            Annotation::BentShort => {
                if let Some(course) = course {
                    course.bent_short = true;
                }
            }
            Annotation::Bent { .. } => {}
        }
    }
    courses
}

impl Course {
    /// In words and numbers, if the sound has it.
    fn label(&self, strings: &[LabelledString], clock: Clock) -> Option<LabelledNote> {
        let Self { note, strokes, bent_short, .. } = *self;
        let (onset, excitation) = self.sounded.filter(|&(onset, _)| clock.has(onset))?;
        let released = self.released.filter(|&released| clock.has(released));
        let (end, end_by) = self.end.filter(|&(end, _)| clock.has(end)).unwrap_or((clock.samples, "file"));
        // A stroke that is a moment late may come after its string has been taken.
        let end = end.max(onset);
        let string = &strings[self.string];
        let partial = note.partial.or(excitation.pinched);
        let order = f64::from(partial.unwrap_or(1));
        let plain = string.pitch + note.fret as f64;
        // What a finger or a capo stops, the neck has its own say in.
        let stopped = string.fret_frequencies.get(note.fret.wrapping_sub(1)).copied();
        let stopped = stopped.filter(|_| matches!(excitation.stop, Stopped::Finger | Stopped::Capo));
        let Stroke { position, force, speed, duration, release } = Stroke::of(excitation.gesture);
        Some(LabelledNote {
            string: string.string,
            string_name: string.name.clone(),
            fret: note.fret,
            channel: note.channel + 1,
            key: note.key,
            velocity: (note.velocity * 127.0).round() as u8,
            pitch: plain + 12.0 * libm::log2(order),
            frequency: order * stopped.unwrap_or_else(|| frequency(plain)),
            asked_sample: note.asked,
            asked: clock.seconds(note.asked),
            onset_sample: onset,
            onset: clock.seconds(onset),
            released_sample: released,
            released: released.map(|released| clock.seconds(released)),
            end_sample: end,
            end: clock.seconds(end),
            end_by,
            technique: technique(excitation.technique),
            stop: stop(&excitation, note.partial.is_some()),
            partial,
            returned: note.returned,
            strokes,
            stroke_position: position,
            stroke_force: force,
            stroke_speed: speed,
            stroke_duration: duration,
            stroke_release: release,
            finger_position: excitation.finger,
            touch_position: excitation.touch,
            palm: note.palm,
            bent_short,
        })
    }
}

/// What a gesture that makes a string sound is like.
#[derive(Default)]
struct Stroke {
    position: Option<f64>,
    force: Option<f64>,
    speed: Option<f64>,
    duration: Option<f64>,
    release: Option<f64>,
}

impl Stroke {
    fn of(gesture: Option<Gesture>) -> Self {
        match gesture {
            Some(Gesture::Pluck { position, force, duration, release }) => Self {
                position: Some(position),
                force: Some(force),
                duration: Some(duration),
                release: Some(release),
                ..Self::default()
            },
            Some(Gesture::Throw { position, speed, .. }) => {
                Self { position: Some(position), speed: Some(speed), ..Self::default() }
            }
            Some(Gesture::Slide { position, duration, .. }) => {
                Self { position: Some(position), duration: Some(duration), ..Self::default() }
            }
            _ => Self::default(),
        }
    }
}

/// What hands do, in a word.
fn technique(technique: Technique) -> &'static str {
    match technique {
        Technique::Pluck => "pluck",
        Technique::UpStroke => "up_stroke",
        Technique::RestStroke => "rest_stroke",
        Technique::Slap => "slap",
        Technique::Pop => "pop",
        Technique::Pinch => "pinch",
        Technique::Tap => "tap",
        Technique::HammerOn => "hammer_on",
        Technique::PullOff => "pull_off",
        Technique::Slide => "slide",
        Technique::Continued => "continued",
    }
}

/// How the string is stopped, in a word.
fn stop(excitation: &Excitation, harmonic: bool) -> &'static str {
    match excitation.stop {
        _ if excitation.touch.is_some() && harmonic => "harmonic",
        _ if excitation.touch.is_some() => "muted",
        Stopped::Nut => "open",
        Stopped::Capo => "capo",
        Stopped::Finger => "finger",
        Stopped::Bar => "bar",
    }
}
