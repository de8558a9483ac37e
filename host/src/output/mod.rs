//! What a person sees: the story on stderr while it happens, the result on stdout, the event log in a file.

pub(crate) mod conclusions;
pub mod events;
pub(crate) mod layout;
pub mod narration;
pub mod printer;
pub mod style;
pub mod table;

pub use events::{EventLog, EventLogError};
pub use narration::{Changed, Narration};
pub use printer::{Printer, Progress, ResultFormat};
pub use style::{Colour, Style};
