//! The program without a command: the instrument itself.

use super::{Failure, Outcome, StandAloneArgs};

/// Plays, or lists the devices there are.
#[cfg(feature = "standalone")]
pub(super) fn run(arguments: &StandAloneArgs) -> Outcome {
    use std::io::Write;

    use low_action_dsp::Setup;

    use super::{instrument, unless_closed};
    use crate::engine::{Engine, EngineOptions};
    use crate::params::Start;
    use crate::standalone::{self, Devices};

    if arguments.list_devices {
        unless_closed(std::io::stdout().write_all(standalone::list().as_bytes()))?;
        return Ok(());
    }
    arguments.taken.mode()?;
    let mut start = Start { quality: arguments.quality, ..Start::default() };
    let name = arguments.instrument.to_string_lossy();
    let mut setup = match (crate::params::InstrumentChoice::named(&name), Setup::shipped(&name)) {
        (Some(choice), Some(setup)) => {
            start.instrument = choice;
            setup
        }
        _ => {
            let (path, text, setup) = instrument::file(&arguments.instrument)?;
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            start.file = Some((stem.into_owned(), text));
            setup
        }
    };
    arguments.taken.work_on(&mut setup);
    arguments.taken.fits(&setup, &arguments.instrument)?;
    start.settings = arguments.taken.settings()?;
    let devices = Devices {
        backend: arguments.backend.clone(),
        output: arguments.output_device.clone(),
        keyboard: arguments.midi_input.clone(),
        sample_rate: arguments.sample_rate,
        period: arguments.period_size,
        others: arguments.options.clone(),
    };
    let way = devices.way()?;
    // Whatever cannot be built is better said before the devices are opened.
    let rate = f64::from(way.sample_rate);
    let options = EngineOptions { quality: arguments.quality, ..EngineOptions::new(setup, rate) };
    Engine::new(&options).map_err(|error| Failure::Impossible(anyhow::anyhow!("{name}: {error}")))?;
    standalone::open(start, &devices, &way)?;
    Ok(())
}

/// Says how to get the instrument.
#[cfg(not(feature = "standalone"))]
pub(super) fn run(_arguments: &StandAloneArgs) -> Outcome {
    Err(Failure::Usage(
        "this build has no stand-alone instrument: build it with `cargo build --release --features \
         standalone`, or see `low-action --help` for the commands"
            .into(),
    ))
}
