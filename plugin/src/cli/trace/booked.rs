//! What a trace has of the energy ledger.

use low_action_dsp::Entry;

/// What an array of the ledger holds of an entry.
pub(super) type Part = fn(&Entry) -> f64;

/// The ledger's arrays, without what only instruments do, placing fingers, and without what the bridge of a body puts into strings,
/// which in all is what it takes from them: each string has an array of its own for that. Readers add up all whose names begin
/// with `energy_`: no other may.
pub(super) const LEDGER: [(&str, Part); 19] = [
    ("energy_string", |entry| entry.energies.string),
    ("energy_tension", |entry| entry.energies.tension),
    ("energy_contact", |entry| entry.energies.contact),
    ("energy_finger", |entry| entry.energies.finger),
    ("energy_body", |entry| entry.energies.body),
    ("power_loss", |entry| entry.power_loss),
    ("power_loss_0", |entry| entry.losses.loss_0),
    ("power_loss_1", |entry| entry.losses.loss_1),
    ("power_loss_contact", |entry| entry.losses.contact),
    ("power_loss_hand", |entry| entry.losses.hand),
    ("power_loss_body", |entry| entry.losses.body),
    ("power_solver", |entry| entry.power_solver),
    ("power_in", |entry| entry.power_in),
    ("power_in_pluck", |entry| entry.inputs.pluck),
    ("power_in_hand", |entry| entry.inputs.hand),
    ("power_in_slide", |entry| entry.inputs.slide),
    ("power_in_barrier", |entry| entry.inputs.barrier),
    ("power_in_tension", |entry| entry.inputs.tension),
    ("residual", |entry| entry.residual),
];

/// What has been lost, taken by the solver and put in since the row before, J: with rows left out, powers alone leave the balance
/// open.
pub(super) const WORK: [(&str, Part); 3] = [
    ("work_loss", |entry| entry.power_loss),
    ("work_solver", |entry| entry.power_solver),
    ("work_in", |entry| entry.power_in),
];
