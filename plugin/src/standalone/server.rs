//! The JACK server, if one runs: what has to be known of it before the framework plays through it.

use jack::{Client, ClientOptions, ClientStatus, PortFlags};
use nice_plug::prelude::Plugin;

use crate::plugin::LowAction;

/// A server that runs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Server {
    /// Names of the ports at which keyboards arrive.
    pub keyboards: Vec<String>,
    /// Names of all ports at which anything does: those and other programs'.
    pub sources: Vec<String>,
    /// Hz. The framework computes at the one that it is told.
    pub sample_rate: u32,
    /// Whether another instrument plays through it already, whose name the framework would take.
    pub is_taken: bool,
}

/// The one that runs; none is started.
pub(super) fn running() -> Option<Server> {
    // The framework's name for the plugin. It plays under no other, and gives up without saying why.
    let name = LowAction::NAME.to_lowercase().replace(' ', "_");
    let (client, status) = Client::new(&name, ClientOptions::NO_START_SERVER).ok()?;
    let sources = |flags| client.ports(None, Some("midi"), flags | PortFlags::IS_OUTPUT);
    Some(Server {
        keyboards: sources(PortFlags::IS_PHYSICAL),
        sources: sources(PortFlags::empty()),
        sample_rate: client.sample_rate(),
        is_taken: status.contains(ClientStatus::NAME_NOT_UNIQUE),
    })
}
