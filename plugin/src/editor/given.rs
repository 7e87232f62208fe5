//! What every view is given.

use low_action_dsp::Setup;
use low_action_dsp::setup::Player;
use nice_plug::context::gui::GuiContext;
use nice_plug::prelude::{Param, ParamSetter};

use super::history::History;
use super::notes::name_by_sound;
use crate::display::Snapshot;
use crate::params::LowActionParams;
use crate::params::words::Words;
use crate::plugin::layout::Keyboard;
use crate::plugin::meters::Meters;
use crate::plugin::order::{self, Order};
use crate::pointer::Pointer;

/// By how much a string's length, as a part of it, may be off from that of its set-up: no more than rounding.
const SAME_LENGTH: f32 = 1e-4;

/// What every view is given.
pub struct Given<'a> {
    /// Everything that can be set.
    pub params: &'a LowActionParams,
    /// Sets it, so that the host knows: begin, set, end.
    pub setter: ParamSetter<'a>,
    /// Level, load and lights.
    pub meters: &'a Meters,
    /// The strings as they were last seen.
    pub snapshot: &'a Snapshot,
    /// Whether that picture is a new one.
    pub fresh: bool,
    /// Plays on the strings.
    pub pointer: &'a Pointer,
    /// The set-up that the parameters ask for.
    pub plan: &'a Plan,
    /// What has been done, to be undone.
    pub history: &'a History,
    /// The way to the host past the history.
    pub gui: &'a GuiContext,
    /// What a musician hears of each parameter.
    pub words: &'a Words,
    /// What the computer's keys play, where there is no host that wants them for itself.
    pub keyboard: Option<Keyboard>,
}

impl Given<'_> {
    /// The value, 0 to 1, that a parameter has or that the host was asked for.
    pub fn value<P: Param>(&self, param: &P) -> f32 {
        self.history.asked.value(param.as_ptr())
    }

    /// The same as the parameter has it.
    pub fn plain<P: Param>(&self, param: &P) -> P::Plain {
        param.preview_plain(self.value(param))
    }
}

#[derive(Debug)]
struct Made {
    order: Order,
    /// Whether another instrument takes the place of the file that is asked for.
    is_replaced: bool,
    /// As it comes.
    own: Setup,
    /// With all that a luthier has done to it; strings have the names of what they sound.
    setup: Setup,
    player: Player,
}

/// The set-up that the parameters ask for, whether it sounds already or not.
#[derive(Debug, Default)]
pub struct Plan {
    made: Option<Made>,
}

impl Plan {
    /// Follows the parameters; reads the set-up anew only where they ask for another.
    pub fn follow(&mut self, params: &LowActionParams) {
        // Neither the rate nor how a host renders changes what is seen.
        let order = Order::of(params, 0.0, false);
        let is_replaced = order.is_replaced(&params.shelf);
        let hands = |setup: &Setup| order::touching(params).hands(&setup.player, setup.neck.scale_length);
        match &mut self.made {
            Some(made) if made.order == order && made.is_replaced == is_replaced => {
                made.player = hands(&made.setup);
            }
            made => {
                if let Some(own) = order.planned(&params.shelf) {
                    let mut setup = own.clone();
                    order.luthier.work_on(&mut setup);
                    name_by_sound(&mut setup, &own);
                    let player = hands(&setup);
                    *made = Some(Made { order, is_replaced, own, setup, player });
                }
            }
        }
    }

    /// The set-up with all that a luthier has done to it, its strings by the notes that they sound; none before the first look at the parameters.
    pub fn setup(&self) -> Option<&Setup> {
        self.made.as_ref().map(|made| &made.setup)
    }

    /// Whether a snapshot is of its strings. While a host does not process it may be of those before.
    pub fn is_of(&self, snapshot: &Snapshot) -> bool {
        let Some(setup) = self.setup() else { return false };
        let length = setup.neck.scale_length as f32;
        let strings = snapshot.strings();
        strings.len() == setup.string.len()
            && strings.iter().all(|string| (string.length / length - 1.0).abs() < SAME_LENGTH)
    }

    /// The set-up as it comes; none before the first look at the parameters.
    pub fn own(&self) -> Option<&Setup> {
        self.made.as_ref().map(|made| &made.own)
    }

    /// The hands as they act now.
    pub fn player(&self) -> Option<&Player> {
        self.made.as_ref().map(|made| &made.player)
    }
}

#[cfg(test)]
mod tests {
    use nice_plug::prelude::Enum;

    use super::*;
    use crate::display::StringSeen;
    use crate::params::{InstrumentChoice, Start};
    use crate::plugin::shelf::Shelf;
    use crate::setups::SHIPPED;

    #[test]
    fn a_snapshot_is_of_as_many_strings_as_long() {
        let params = |name: &str| {
            let place = SHIPPED.iter().position(|known| *known == name).expect("it comes with the program");
            let start = Start { instrument: InstrumentChoice::from_index(place), ..Start::default() };
            LowActionParams::new(Shelf::new(Vec::new()), &start)
        };
        let of = |name: &str| {
            let setup = Setup::shipped(name).expect("it comes with the program");
            let mut string = StringSeen::default();
            string.length = setup.neck.scale_length as f32;
            Snapshot::of(vec![string; setup.string.len()])
        };
        let names = ["electric", "classical", "bass", "ukulele"];
        for planned in names {
            let mut plan = Plan::default();
            assert!(!plan.is_of(&of(planned)), "nothing is planned");
            plan.follow(&params(planned));
            for seen in names {
                assert_eq!(plan.is_of(&of(seen)), planned == seen, "{seen} on the neck of {planned}");
            }
        }
    }
}
