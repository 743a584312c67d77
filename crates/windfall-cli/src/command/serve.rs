//! `windfall serve`

use crate::args::serve::ServeArguments;
use crate::show::{message, write_result};
use windfall_web::serve::{ServeRequest, Server};

/// Serves a directory until the program is interrupted.
pub fn run(arguments: &ServeArguments) -> anyhow::Result<()> {
    let server = Server::open(&ServeRequest {
        directory: arguments.directory.clone(),
        host: arguments.host,
        port: arguments.port,
        upload_limit: arguments.upload_limit.saturating_mul(1_000_000),
        token: !arguments.no_token,
    })?;
    let address = server.address();
    // The address is the result: whoever starts the program reads it from there.
    write_result(&format!("{address}\n"))?;
    message("Ctrl-C ends it");
    if !arguments.no_open
        && let Err(error) = open::that_detached(server.opening_address())
    {
        message(&format!(
            "the browser does not open ({error}); open the address yourself"
        ));
    }
    Ok(server.run()?)
}
