//! `windfall serve`: arguments.

use clap::{Args, ValueHint};
use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

/// `windfall serve`
#[derive(Debug, Args)]
#[command(
    after_help = "The server answers on this machine alone, and only those who have the token in the \
address that it prints; each start has a new one. Programs send it as Authorization: Bearer TOKEN. \
What is done in the page is done to the files of the campaign: every other command sees it. Ctrl-C ends it; work that \
runs is stopped, and nothing half-written remains.

With --host it can be reached from other machines. The connection is not encrypted: do this in \
networks that you trust.

Examples:
  windfall serve my-campaign
  windfall serve .                        every campaign in this directory
  windfall serve --no-open --port 9000    for a browser elsewhere, through ssh -L 9000:localhost:9000"
)]
pub struct ServeArguments {
    /// A campaign directory, or a directory with campaigns in it
    #[arg(default_value = ".", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Port; 8417 if left out, or another one where that is taken
    #[arg(long, value_name = "PORT")]
    pub port: Option<u16>,
    /// Address to listen at
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub host: IpAddr,
    /// Do not open the browser
    #[arg(long)]
    pub no_open: bool,
    /// Answer every account and program on this machine, without a token
    #[arg(long)]
    pub no_token: bool,
    /// Largest file that the page may add, in MB
    #[arg(long, value_name = "MB", default_value_t = 2000)]
    pub upload_limit: u64,
}
