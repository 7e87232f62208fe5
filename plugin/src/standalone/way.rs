//! By which way sound goes to the devices.

use anyhow::{Result, ensure};

use super::Devices;
use super::server::Server;
use super::{PERIOD, SAMPLE_RATE, given};
use crate::cli::say;

/// The system's own way to its devices, by the framework's name for it.
pub(super) const NATIVE: &str = if cfg!(target_os = "macos") {
    "core-audio"
} else if cfg!(target_os = "windows") {
    "wasapi"
} else {
    "alsa"
};
/// The way through the JACK server, which knows its own devices.
pub(super) const JACK: &str = "jack";
/// No way at all, by our name for it and by the framework's: for those who only look at the editor.
const NONE: &str = "none";
pub(super) const NOTHING: &str = "dummy";
/// What stands for JACK if a server runs, and for the system's own way otherwise.
const AUTO: &str = "auto";

/// A way to the devices.
#[derive(Debug)]
pub struct Way {
    /// The framework's name for it.
    pub(super) name: String,
    /// The server that it goes through.
    pub(super) server: Option<Server>,
    /// The output's full name; nothing is the system's usual one.
    pub(super) output: Option<String>,
    /// Hz: what is asked for, what the output takes, or what the server has.
    pub sample_rate: u32,
    /// Samples computed at a time; the server has its own.
    pub(super) period: u32,
}

impl Way {
    /// The one that is asked for, where this server runs, or none. An output has a name only by the system's own way.
    ///
    /// # Errors
    /// When it has to go through a server that does not run, or that another one of these plays through.
    pub(super) fn to(devices: &Devices, server: Option<Server>) -> Result<Self> {
        let asked = asked(devices);
        let is_taken = server.as_ref().is_some_and(|server| server.is_taken);
        let taken = "another Low Action plays through it, and it has room for one";
        ensure!(asked != JACK || server.is_some(), "no sound can be played by jack: no JACK server runs");
        ensure!(asked != JACK || !is_taken, "no sound can be played by jack: {taken}");
        let server = server.filter(|_| matches!(asked, AUTO | JACK) && !is_taken);
        if asked == AUTO && is_taken {
            say("warning", &format!("not by jack but by {NATIVE}: {taken}"));
        }
        let name = match asked {
            AUTO if server.is_some() => JACK,
            AUTO => NATIVE,
            NONE => NOTHING,
            named => named,
        };
        let asked_for = devices.sample_rate.unwrap_or(SAMPLE_RATE);
        let sample_rate = server.as_ref().map_or(asked_for, |server| server.sample_rate);
        let period = devices.period.unwrap_or(PERIOD);
        Ok(Self { name: name.to_owned(), server, output: None, sample_rate, period })
    }

    /// That devices were named where the way to them takes no names, or numbers given where it has its own, if so.
    pub(super) fn given_in_vain(&self, devices: &Devices) -> Option<String> {
        let named = |option: &str, name: &Option<String>| Some(format!("{option} {:?}", name.as_ref()?));
        let counted = |option: &str, number: Option<u32>| Some(format!("{option} {}", number?));
        let output = named("--output-device", &devices.output);
        let (backend, given) = match self.name.as_str() {
            JACK => {
                let rate = counted("--sample-rate", devices.sample_rate);
                (JACK, vec![output, rate, counted("--period-size", devices.period)])
            }
            NOTHING => (NONE, vec![output, named("--midi-input", &devices.keyboard)]),
            _ => return None,
        };
        let given: Vec<String> = given.into_iter().flatten().collect();
        (!given.is_empty()).then(|| {
            format!("--backend {backend} does not take {}: --backend {NATIVE} does", given.join(" or "))
        })
    }

    /// Whether one that is asked for may go through a server.
    pub(super) fn may_need_server(devices: &Devices) -> bool {
        matches!(asked(devices), AUTO | JACK)
    }
}

/// The way that is asked for, if only by the name of an output.
fn asked(devices: &Devices) -> &str {
    let is_named = devices.output.is_some() || given(&devices.others, "--output-device");
    match devices.backend.as_deref().unwrap_or(AUTO) {
        AUTO if is_named => NATIVE,
        asked => asked,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(backend: &str) -> Devices {
        Devices { backend: Some(backend.into()), ..Devices::default() }
    }

    fn server(is_taken: bool) -> Option<Server> {
        Some(Server { keyboards: Vec::new(), sources: Vec::new(), sample_rate: 44_100, is_taken })
    }

    /// Name and rate of the way.
    fn found(backend: &str, server: Option<Server>) -> Result<(String, u32), String> {
        let way = Way::to(&asked(backend), server).map_err(|error| error.to_string())?;
        Ok((way.name, way.sample_rate))
    }

    #[test]
    fn a_server_has_its_own_rate() {
        for backend in [JACK, AUTO] {
            assert_eq!(found(backend, server(false)), Ok((JACK.into(), 44_100)));
        }
        assert_eq!(found(AUTO, None), Ok((NATIVE.into(), 48_000)));
        for (backend, name) in [(NATIVE, NATIVE), (NONE, NOTHING)] {
            assert_eq!(found(backend, server(false)), Ok((name.into(), 48_000)));
        }
    }

    #[test]
    fn an_output_that_is_named_is_gone_to_by_the_way_that_knows_it() {
        let output = Devices { output: Some("USB".into()), sample_rate: Some(96_000), ..Devices::default() };
        let other = Devices { output: None, others: vec!["--output-device=USB".into()], ..output.clone() };
        for named in [output, other] {
            for backend in [None, Some(AUTO.to_owned())] {
                let named = Devices { backend, ..named.clone() };
                assert!(!Way::may_need_server(&named));
                let way = Way::to(&named, server(false)).expect("it is there");
                assert_eq!(
                    (way.name.as_str(), way.sample_rate, way.server.is_none()),
                    (NATIVE, 96_000, true)
                );
            }
            let jack = Devices { backend: Some(JACK.into()), ..named };
            assert_eq!(Way::to(&jack, server(false)).expect("it runs").name, JACK);
        }
    }

    #[test]
    fn a_server_that_cannot_be_played_through_is_told() {
        let told = found(JACK, None).unwrap_err();
        assert_eq!(told, "no sound can be played by jack: no JACK server runs");
        let told = found(JACK, server(true)).unwrap_err();
        assert!(told.starts_with("no sound can be played by jack: another Low Action"), "{told}");
        assert_eq!(found(AUTO, server(true)), Ok((NATIVE.into(), 48_000)));
    }

    #[test]
    fn devices_named_in_vain_are_told() {
        let named =
            Devices { output: Some("USB".into()), keyboard: Some("Keys".into()), ..Devices::default() };
        let told = |backend: &str, devices: &Devices| {
            Way::to(&asked(backend), server(false)).expect("it is there").given_in_vain(devices)
        };
        let one = format!("--backend jack does not take --output-device \"USB\": --backend {NATIVE} does");
        assert_eq!(told(JACK, &named), Some(one));
        let both = told(NONE, &named);
        assert!(both.is_some_and(|told| told.contains("\"USB\" or --midi-input \"Keys\"")));
        let keyboard = told(NONE, &Devices { output: None, ..named.clone() });
        let begins = "--backend none does not take --midi-input \"Keys\":";
        assert!(keyboard.is_some_and(|told| told.starts_with(begins)));
        assert_eq!(told(NATIVE, &named), None);
        let numbers = Devices { sample_rate: Some(44_100), period: Some(128), ..Devices::default() };
        let two = format!(
            "--backend jack does not take --sample-rate 44100 or --period-size 128: --backend {NATIVE} does"
        );
        for jack in [JACK, AUTO] {
            assert_eq!(told(jack, &numbers), Some(two.clone()));
        }
        assert_eq!((told(NATIVE, &numbers), told(NONE, &numbers)), (None, None));
        assert_eq!(told(JACK, &Devices::default()), None);
    }
}
