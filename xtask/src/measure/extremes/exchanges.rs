//! Playing on instruments that are exchanged for others while their strings ring: at any moment, one after another as soon as
//! there is room for the next, and asked for while there is none.

use low_action_dsp::{Instrument, Setup, TimedGesture};
use serde::{Deserialize, Serialize};

use super::balance::{Flow, Parts};
use super::draw::Draw;
use super::playing::gesture;
use super::setups;
use super::trial::{Fault, Outcome, Record};

/// The most products of a grid point and a step in a session: what is longer ends there.
const MOST_POINT_STEPS: f64 = 1e7;

/// The longest session, s, and the longest block, samples.
const LONGEST: f64 = 60.0;
const BLOCK: usize = 512;

/// A trial's file of this kind.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Session {
    /// Hz.
    pub sample_rate: f64,
    /// s.
    pub duration: f64,
    /// What happens in it.
    pub playing: Playing,
}

/// It is random in itself but follows from these numbers.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Playing {
    /// Where its random numbers begin.
    pub seed: i64,
    /// Time from one exchange to the next, s, about; 0 is as soon as there is room for another.
    pub every: f64,
    /// Gestures on each string in a second, about.
    pub gestures: f64,
    /// Part of the exchanges in which strings are much the same, so that they ring on.
    pub alike: f64,
    /// Part of the necks that come as near to the strings as any may.
    pub close: f64,
    /// Part of the blocks before which everything is taken back to silence.
    pub resets: f64,
}

impl Session {
    /// A session drawn at random.
    pub fn random(draw: &mut Draw) -> Session {
        Session {
            sample_rate: if draw.chance(0.5) {
                draw.one_of(&[44_100.0, 48e3, 96e3])
            } else {
                draw.over(8e3, 384e3)
            },
            duration: draw.over(0.05, 2.0),
            playing: Playing {
                seed: (draw.seed() >> 1) as i64,
                every: draw.over_or_nothing(0.4, 1e-3, 0.2),
                gestures: draw.over(3.0, 3000.0),
                alike: draw.one_of(&[1.0, 0.9, 0.5]),
                close: draw.one_of(&[0.0, 0.5, 1.0]),
                resets: draw.over_or_nothing(0.7, 1e-3, 0.1),
            },
        }
    }

    /// Plays it to its end.
    pub fn play(&self) -> Outcome {
        if !(0.0..=LONGEST).contains(&self.duration) {
            return Outcome::Refused(format!("duration is refused: it must be 0 to {LONGEST} s"));
        }
        let mut stage = match Stage::new(self) {
            Ok(stage) => stage,
            Err(reason) => return Outcome::Refused(reason),
        };
        let mut left = (self.duration * self.sample_rate).ceil() as usize;
        while left > 0 && (stage.record.point_samples as f64) < MOST_POINT_STEPS {
            let samples = stage.hands.whole(1, BLOCK).min(left);
            left -= samples;
            if let Err(fault) = stage.block(samples) {
                stage.record.fault = Some(fault);
                break;
            }
        }
        Outcome::Computed(stage.record)
    }
}

/// An instrument that waits to take over, and how it is set up.
type Next = (Setup, Box<Instrument>);

/// A session under way.
struct Stage<'a> {
    session: &'a Session,
    /// What draws instruments, and what draws all else: fewer gestures are then given to the same instruments.
    maker: Draw,
    hands: Draw,
    setup: Setup,
    instrument: Instrument,
    flows: Vec<Flow>,
    next: Option<Next>,
    /// Samples until the next exchange.
    until: f64,
    record: Record,
}

impl<'a> Stage<'a> {
    fn new(session: &'a Session) -> Result<Self, String> {
        let Session { sample_rate, playing, .. } = session;
        let [mut maker, hands] = [0, 1].map(|part| Draw::new(playing.seed as u64, part));
        let first = setups::instrument(&mut maker, *sample_rate, |draw| setups::any(draw, playing.close));
        let (setup, mut instrument) = first?;
        instrument.open_ledgers();
        let flows = vec![Flow::default(); instrument.string_count()];
        let record = Record { stream: true, ..Record::default() };
        Ok(Stage { session, maker, hands, setup, instrument, flows, next: None, until: 0.0, record })
    }

    /// Plays a block of so many samples, before which instruments may be exchanged.
    fn block(&mut self, samples: usize) -> Result<(), Fault> {
        if self.hands.chance(self.session.playing.resets) {
            self.instrument.reset();
        }
        self.until -= samples as f64;
        if self.until < 0.0 {
            self.exchange()?;
        }
        if self.hands.chance(0.2) {
            let effort = self.hands.one_of(&[0, 1, 3, 8, 20, 50]);
            self.instrument.set_effort(effort, self.hands.over(1e-15, 1e-3));
        }
        self.excite(samples);
        self.sound(samples)?;
        // What it is in the end is what is told, as of scenes.
        self.record.rounding = 0.0;
        for (string, flow) in self.flows.iter_mut().enumerate() {
            let ledger = self.instrument.ledger(string).expect("ledgers are open");
            self.record.see(flow.check(ledger)?);
        }
        Ok(())
    }

    /// Has the next instrument take over, or be turned away while there is no room for it.
    fn exchange(&mut self) -> Result<(), Fault> {
        let Playing { every, alike, close, .. } = self.session.playing;
        let (setup, successor) = match self.next.take() {
            Some(next) => next,
            None => {
                let (present, is_alike) = (&self.setup, self.maker.chance(alike));
                let draw = |draw: &mut Draw| {
                    if is_alike { setups::alike(draw, present, close) } else { setups::any(draw, close) }
                };
                let made = setups::instrument(&mut self.maker, self.session.sample_rate, draw);
                // Where none of many could be built there is none this time.
                let Ok((setup, mut instrument)) = made else { return Ok(()) };
                if self.maker.chance(0.5) {
                    instrument.open_ledgers();
                }
                instrument.observe(self.maker.chance(0.5));
                (setup, Box::new(instrument))
            }
        };
        let is_fading = self.instrument.is_fading();
        if !is_fading {
            self.fetch()?;
        }
        let goes_on = self.instrument.continues_in(&successor);
        if let Err(successor) = self.instrument.hand_over(successor) {
            assert!(is_fading, "an instrument is turned away though nothing is in its way");
            self.record.turned_away += 1;
            self.next = Some((setup, successor));
            return Ok(());
        }
        assert!(!is_fading, "an instrument took over while another was fading");
        self.setup = setup;
        self.record.exchanges[0] += 1;
        if goes_on {
            self.record.exchanges[1] += 1;
        } else {
            self.instrument.open_ledgers();
            self.flows = vec![Flow::default(); self.instrument.string_count()];
        }
        self.until = every * self.session.sample_rate * self.hands.between(0.0, 2.0);
        Ok(())
    }

    /// Takes out what has faded; what its ledgers have booked meanwhile must close, too.
    fn fetch(&mut self) -> Result<(), Fault> {
        let Some(before) = self.instrument.take_before() else { return Ok(()) };
        for ledger in (0..before.string_count()).filter_map(|string| before.ledger(string)) {
            self.record.see(Parts::of(ledger, ledger.put_in_gross)?);
        }
        Ok(())
    }

    /// Gestures at random for every string, and for one that is not there.
    fn excite(&mut self, samples: usize) {
        let expected = self.session.playing.gestures * samples as f64 / self.session.sample_rate;
        for string in 0..=self.instrument.string_count() {
            let length = self.instrument.geometry(string.min(self.instrument.string_count() - 1)).length;
            let draw = &mut self.hands;
            let count = (2.0 * expected * draw.between(0.0, 1.0) + draw.between(0.0, 1.0)) as usize;
            for _ in 0..count {
                // Some wait for a while, and may then meet another instrument.
                let latest = if draw.chance(0.1) { 20 * BLOCK } else { samples };
                let time = self.instrument.now() + draw.whole(0, latest) as u64;
                let gesture = gesture(draw, &self.setup, length);
                // A full queue leaves a gesture out.
                let _ = self.instrument.schedule(TimedGesture { time, string, gesture });
            }
        }
    }

    /// A block of sound.
    fn sound(&mut self, samples: usize) -> Result<(), Fault> {
        let (mut left, mut right) = ([0.0f32; BLOCK], [0.0f32; BLOCK]);
        let (left, right) = (&mut left[..samples], &mut right[..samples]);
        self.instrument.process(left, right);
        for string in 0..self.instrument.string_count() {
            let steps = self.instrument.ratio(string).value() * samples as f64;
            let points = self.instrument.model(string).grid.intervals as f64;
            self.record.point_samples += (points * steps) as u64;
            self.record.raised |= self.instrument.drive(string).heights.iter().any(|&height| height > 0.0);
            if !self.instrument.state(string).displacement().all(f64::is_finite) {
                return Err(Fault::NotFinite);
            }
        }
        let is_finite = left.iter().chain(right.iter()).all(|sample| sample.is_finite());
        if is_finite { Ok(()) } else { Err(Fault::NotFinite) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::trial::{Outcome, Trial};

    /// What is drawn does what it is drawn for, and a file of it can be replayed.
    #[test]
    fn instruments_are_exchanged_in_every_way() {
        let (mut exchanges, mut turned_away, mut raised) = ([0, 0], 0, [false; 2]);
        for number in 0..24 {
            let trial = Trial::of_exchanges(1, number);
            let Outcome::Computed(record) = trial.run() else { panic!("{}", trial.to_toml()) };
            assert_eq!(record.fault, None, "{}", trial.to_toml());
            raised[usize::from(number.is_multiple_of(3))] |= record.raised;
            turned_away += record.turned_away;
            exchanges = [0, 1].map(|which| exchanges[which] + record.exchanges[which]);
            let read = Trial::from_toml(&trial.to_toml()).unwrap();
            assert_eq!(read.run(), Outcome::Computed(record), "{}", trial.to_toml());
        }
        let [all, carried] = exchanges;
        assert!(carried > 0 && all > carried && turned_away > 0, "{exchanges:?} {turned_away}");
        // While strings are played, and in a scene.
        assert_eq!(raised, [true; 2]);
    }

    #[test]
    fn what_no_session_has_is_refused() {
        let good = "sample_rate = 48000.0\nduration = 0.01\n[playing]\nseed = 1\n";
        let outcome = |text: &str| Trial::from_toml(text).unwrap().run();
        assert!(matches!(outcome(good), Outcome::Computed(_)));
        for (from, to) in
            [("48000.0", "1.0"), ("0.01", "-1.0"), ("0.01", "1e9"), ("seed", "sead"), ("duration", "string")]
        {
            assert!(matches!(outcome(&good.replace(from, to)), Outcome::Refused(_)), "{to}");
        }
    }
}
