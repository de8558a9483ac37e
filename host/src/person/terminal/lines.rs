//! Lines of a blocking reader, for code that must not block.

use std::io::{BufRead, Read};

use tokio::sync::{mpsc, oneshot};

/// The longest line that is taken as an answer, in bytes.
pub(super) const MAX_LINE_BYTES: usize = 10_000;

/// What came in.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Line {
    /// A line, with whatever ended it.
    Text(String),
    /// A line that cannot be taken, and what to tell the person.
    Unreadable(String),
    /// The input has ended.
    End,
}

/// Reads a line whenever one is asked for, on a thread of its own.
///
/// Standard input cannot be read without blocking, and a read that a person never finishes must not keep the
/// program from ending: nothing waits for the thread.
#[derive(Debug)]
pub(super) struct Lines {
    requests: mpsc::UnboundedSender<oneshot::Sender<std::io::Result<Line>>>,
}

impl Lines {
    pub(super) fn of(mut reader: impl BufRead + Send + 'static) -> std::io::Result<Self> {
        let (requests, mut requested) = mpsc::unbounded_channel::<oneshot::Sender<_>>();
        std::thread::Builder::new().name("answers".to_owned()).spawn(move || {
            while let Some(reply) = requested.blocking_recv() {
                // Whoever asked may have gone; the next request then gets the next line.
                let _ = reply.send(read_line(&mut reader));
            }
        })?;
        Ok(Self { requests })
    }

    pub(super) async fn next(&mut self) -> std::io::Result<Line> {
        let (reply, line) = oneshot::channel();
        let gone = |_| std::io::Error::other("the thread that reads the input has ended");
        self.requests.send(reply).map_err(|_| std::io::Error::other("nothing reads the input any more"))?;
        line.await.map_err(gone)?
    }
}

fn read_line(reader: &mut impl BufRead) -> std::io::Result<Line> {
    let mut bytes = Vec::new();
    let read = reader.by_ref().take(MAX_LINE_BYTES as u64 + 1).read_until(b'\n', &mut bytes)?;
    if read == 0 {
        return Ok(Line::End);
    }
    if bytes.len() > MAX_LINE_BYTES {
        if bytes.last() != Some(&b'\n') {
            reader.skip_until(b'\n')?;
        }
        return Ok(Line::Unreadable(format!(
            "That has more than {MAX_LINE_BYTES} bytes; please say it in a sentence."
        )));
    }
    Ok(match String::from_utf8(bytes) {
        Ok(text) => Line::Text(text),
        Err(_) => Line::Unreadable("That is not UTF-8 text; please type it again.".to_owned()),
    })
}
