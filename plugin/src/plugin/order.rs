//! What the parameters ask for, as the numbers of [`crate::controls`].

#[cfg(test)]
mod tests;

use low_action_dsp::{Error, Setup};
use nice_plug::prelude::*;

use super::shelf::{self, Shelf};
use crate::controls::{Luthier, Touching};
use crate::engine::EngineOptions;
#[cfg(feature = "editor")]
use crate::params::exact_without_modulation;
use crate::params::{ControlParams, InstrumentChoice, LegatoChoice, LowActionParams, exact};
use crate::performance::InputMode;

/// What an engine is built from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Order {
    pub instrument: InstrumentChoice,
    /// A file of the user's that takes its place, and which edition of it.
    file: (u32, u32),
    pub luthier: Luthier,
    /// Hz.
    pub sample_rate: f32,
}

impl Order {
    /// What the parameters ask for, in real time or offline.
    pub fn of(params: &LowActionParams, sample_rate: f32, offline: bool) -> Self {
        Self::read(params, sample_rate, offline, exact)
    }

    fn read(params: &LowActionParams, sample_rate: f32, offline: bool, exact: Exact) -> Self {
        let LowActionParams { instrument, setup, strings, player, .. } = params;
        let live = instrument.quality.value().0;
        let quality = if offline { instrument.render_quality.value().quality(live) } else { live };
        let luthier = Luthier {
            quality,
            iterations: usize::try_from(instrument.iterations.value()).unwrap_or(0),
            action: exact(&setup.action),
            relief: 1e-3 * exact(&setup.relief),
            fret_height: exact(&setup.fret_height),
            loss_0: exact(&setup.loss_0),
            loss_1: exact(&setup.loss_1),
            tension_modulation: setup.tension_modulation.value(),
            pickup_position: 1e-3 * exact(&setup.pickup_position),
            pickup_blend: exact(&setup.pickup_blend),
            idle_hands: exact(&player.idle_hands),
            tuning: 0.01 * exact(&setup.tuning),
            strings: std::array::from_fn(|index| exact(&strings[index].tuning)),
        };
        let file = match instrument.file.value().unsigned_abs() {
            shelf::NONE => (shelf::NONE, 0),
            number => (number, params.shelf.edition()),
        };
        Self { instrument: instrument.instrument.value(), file, luthier, sample_rate }
    }

    /// Builds what is asked for. Where the file that was chosen cannot be played, whatever is done to it, the instrument
    /// that comes with the program is, and the shelf tells why. One that only bears too much is nobody else's: it is refused.
    pub fn build<T>(
        &self,
        shelf: &Shelf,
        make: impl Fn(&EngineOptions) -> Result<T, Error>,
    ) -> Result<T, String> {
        let name = self.instrument.id();
        let make_by = |luthier: &Luthier, setup| {
            make(&luthier.options(setup, f64::from(self.sample_rate))).map_err(|error| error.to_string())
        };
        let problem = match self.file {
            (shelf::NONE, _) => None,
            (number, _) => {
                let setup = shelf.setup(number);
                match setup.clone().and_then(|setup| make_by(&self.luthier, setup)) {
                    Ok(made) => {
                        shelf.replace(None);
                        shelf.tell(None);
                        return Ok(made);
                    }
                    Err(problem) => {
                        let untouched = self.untouched().luthier;
                        let bears_less =
                            |setup| untouched != self.luthier && make_by(&untouched, setup).is_ok();
                        if setup.is_ok_and(bears_less) {
                            shelf.tell(None);
                            return Err(problem);
                        }
                        shelf.replace(Some(self.file));
                        Some(format!("{problem}; {name} is played instead"))
                    }
                }
            }
        };
        shelf.tell(problem);
        make_by(&self.luthier, Setup::shipped(name).ok_or_else(|| format!("there is no set-up {name}"))?)
    }

    /// Whether the instrument that comes with the program is known to be played in the place of the file.
    #[cfg(feature = "editor")]
    pub fn is_replaced(&self, shelf: &Shelf) -> bool {
        shelf.replaced() == Some(self.file)
    }

    /// The set-up that is asked for, as it comes, for pictures: nothing is built, and nobody is told what is wrong with a
    /// file.
    #[cfg(feature = "editor")]
    pub fn planned(&self, shelf: &Shelf) -> Option<Setup> {
        let file = match self.file {
            (shelf::NONE, _) => None,
            _ if self.is_replaced(shelf) => None,
            (number, _) => shelf.setup(number).ok(),
        };
        file.or_else(|| Setup::shipped(self.instrument.id()))
    }

    /// Whether it is of the same instrument, whatever was done to that: only another one can have other strings.
    pub fn is_of_the_same(&self, other: &Self) -> bool {
        (self.instrument, self.file) == (other.instrument, other.file)
    }

    /// The same, but as the set-up comes.
    pub fn untouched(&self) -> Self {
        let luthier = Luthier { quality: self.luthier.quality, ..Luthier::default() };
        Self { luthier, ..*self }
    }
}

/// How a parameter's value is read.
type Exact = fn(&FloatParam) -> f64;

/// A set-up with what luthier and hands do to it by the parameters' own values, whatever a host adds to them for the moment.
#[cfg(feature = "editor")]
pub(crate) fn settled(params: &LowActionParams, own: &Setup) -> Setup {
    let mut setup = own.clone();
    Order::read(params, 0.0, false, exact_without_modulation).luthier.work_on(&mut setup);
    let touching = touching_by(params, exact_without_modulation);
    setup.player = touching.hands(&setup.player, setup.neck.scale_length);
    setup
}

/// How the parameters have the hands act.
pub(crate) fn touching(params: &LowActionParams) -> Touching {
    touching_by(params, exact)
}

fn touching_by(params: &LowActionParams, exact: Exact) -> Touching {
    let LowActionParams { player, control, .. } = params;
    Touching {
        pluck_position: 1e-3 * exact(&player.pluck_position),
        pluck_force: exact(&player.pluck_force),
        pluck_softest: exact(&player.pluck_softest),
        pluck_duration: exact(&player.pluck_duration),
        pluck_release: 1e-3 * exact(&player.pluck_release),
        velocity_curve: exact(&player.velocity_curve),
        variation: exact(&player.variation),
        take: u64::try_from(player.take.value()).unwrap_or(0),
        finger_force: exact(&player.finger_force),
        finger_hardness: exact(&player.finger_hardness),
        finger_mass: exact(&player.finger_mass),
        finger_hover: exact(&player.finger_hover),
        hand_damping: exact(&player.hand_damping),
        bend_range: f64::from(control.bend_range.value()),
        ignore_rpn: control.ignore_rpn.value(),
        tremolo_arm: exact(&control.tremolo_arm),
        legato: control.legato.value() == LegatoChoice::Always,
        keyswitches: u8::try_from(control.keyswitches.value()).ok(),
        hand_position: u8::try_from(control.hand_position.value()).ok().filter(|&fret| fret > 0),
        capo: u8::try_from(control.capo.value()).unwrap_or(0),
        hand_controllers: control.hand_controllers.value(),
    }
}

/// What the parameters have channels mean.
pub(crate) fn input(params: &LowActionParams) -> InputMode {
    let ControlParams { input_mode, first_channel, string_order, .. } = &params.control;
    let first_channel = u8::try_from(first_channel.value()).unwrap_or(1);
    input_mode.value().mode(first_channel, string_order.value())
}

/// Pages of eight knobs, the most played ones first.
pub(super) fn remote_controls(params: &LowActionParams, context: &mut impl RemoteControlsContext) {
    let LowActionParams { instrument, setup, strings, player, control, output, .. } = params;
    context.add_section("Low Action", |section| {
        section.add_page("Play", |page| {
            page.add_param(&player.pluck_position);
            page.add_param(&player.pluck_force);
            page.add_param(&player.finger_force);
            page.add_param(&setup.action);
            page.add_param(&setup.pickup_position);
            page.add_param(&setup.loss_1);
            page.add_param(&control.tremolo_arm);
            page.add_param(&output.level);
        });
        section.add_page("Set-up", |page| {
            page.add_param(&instrument.instrument);
            page.add_param(&instrument.file);
            page.add_param(&setup.action);
            page.add_param(&setup.relief);
            page.add_param(&setup.fret_height);
            page.add_param(&setup.loss_0);
            page.add_param(&setup.pickup_blend);
            page.add_param(&setup.tuning);
        });
        section.add_page("Hands", |page| {
            page.add_param(&player.pluck_duration);
            page.add_param(&player.pluck_release);
            page.add_param(&player.velocity_curve);
            page.add_param(&player.variation);
            page.add_param(&player.finger_hardness);
            page.add_param(&player.finger_mass);
            page.add_param(&player.finger_hover);
            page.add_param(&player.hand_damping);
        });
        section.add_page("Strings", |page| {
            strings.iter().for_each(|string| page.add_param(&string.tuning));
        });
        section.add_page("Engine", |page| {
            page.add_param(&instrument.quality);
            page.add_param(&instrument.render_quality);
            page.add_param(&instrument.iterations);
            page.add_param(&instrument.relax);
            page.add_param(&setup.tension_modulation);
            page.add_param(&output.bypass);
            page.add_param(&control.ignore_rpn);
            page.add_param(&player.idle_hands);
        });
        section.add_page("Control", |page| {
            page.add_param(&control.input_mode);
            page.add_param(&control.first_channel);
            page.add_param(&control.string_order);
            page.add_param(&control.bend_range);
            page.add_param(&control.legato);
            page.add_param(&control.hand_position);
            page.add_param(&control.keyswitches);
            page.add_param(&player.pluck_softest);
        });
        section.add_page("Before playing", |page| {
            page.add_param(&player.take);
            page.add_param(&control.capo);
            page.add_param(&control.hand_controllers);
        });
    });
}
