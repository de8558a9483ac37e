//! How a program that runs in the background is told to end.

use std::io;

/// Ends when somebody presses Ctrl-C, or when the system asks the program to end. Signals are heard from the call on.
///
/// # Errors
/// If the system does not let signals be heard.
#[cfg(unix)]
pub fn until_told_to_end() -> io::Result<impl Future<Output = ()> + Send> {
    use tokio::signal::unix::{SignalKind, signal};
    let (mut interrupt, mut terminate) = (signal(SignalKind::interrupt())?, signal(SignalKind::terminate())?);
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
        }
    })
}

/// Ends when somebody presses Ctrl-C. Signals are heard from the call on.
///
/// # Errors
/// If the system does not let signals be heard.
#[cfg(not(unix))]
pub fn until_told_to_end() -> io::Result<impl Future<Output = ()> + Send> {
    let mut interrupt = tokio::signal::windows::ctrl_c()?;
    Ok(async move {
        interrupt.recv().await;
    })
}
