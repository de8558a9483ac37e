//! The verbs of captions and their inflection.

use super::Action;

/// Which form of its verb a word is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// take
    Base,
    /// takes
    Third,
    /// took
    Past,
    /// taken
    Participle,
    /// grabbed: past and participle alike
    PastOrParticiple,
    /// put: base, past and participle alike
    Unchanged,
    /// taking
    Gerund,
}

impl Form {
    /// Whether the word can stand behind "is" in the passive voice.
    pub(crate) fn can_be_participle(self) -> bool {
        matches!(self, Self::Participle | Self::PastOrParticiple | Self::Unchanged)
    }

    /// Whether the word can stand behind "to".
    pub(crate) fn can_be_base(self) -> bool {
        matches!(self, Self::Base | Self::Unchanged)
    }
}

/// What a verb says; some need the words behind them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sense {
    /// Always the same action.
    Plain(Action),
    /// Takes the mug; takes it to the kitchen; takes a sip; takes off the jacket.
    Take,
    /// Gets the mug; gets up.
    Get,
    /// Puts the mug back; puts on the jacket.
    Put,
    /// Turns on the lamp; turns around.
    Turn,
    /// Looks for the keys; looks at the wall.
    Look,
    /// Pulls out a drawer; pulls a cart.
    Pull,
    /// Leaves the mug on the table; leaves with the mug.
    Leave,
    /// Returns the book; returns to the kitchen.
    Return,
    /// Sets the mug down; sets up the printer.
    Set,
    /// Tidies the desk; tidies the book away.
    Tidy,
    /// Washes the plate; washes her hands (with the soap that the caption is about).
    Wash,
    /// Checks the phone; checks for the keys.
    Check,
    /// Reaches for the mug.
    Reach,
    /// Tries on the jacket; tries to take it.
    Try,
}

/// Verbs that are inflected by the rules: base forms.
pub(crate) const REGULAR: &[(Sense, &[&str])] = &[
    (
        Sense::Plain(Action::Use),
        &[
            "use", "utilise", "utilize", "operate", "play", "type", "watch", "listen", "sip", "cook", "stir",
            "pour", "chop", "paint", "iron", "open", "close", "click", "scroll", "browse", "call", "dial",
            "plug", "unplug", "ride", "fill", "heat", "boil", "brew", "bake", "toast", "blend", "mix", "fry",
            "serve", "chew", "taste", "apply", "spray", "shave", "comb", "brush", "style", "blow-dry",
            "print", "scan", "record", "strum", "practice", "practise", "study", "work", "exercise", "enjoy",
            "unlock", "lock", "adjust", "squeeze", "consult", "water", "handle", "slice", "peel", "consume",
            "swallow", "smoke", "fasten", "flip", "leaf", "skim", "interact", "engage", "switch", "dress",
            "sharpen", "pedal", "test", "sample", "snack", "munch", "lather", "charge", "knead",
        ],
    ),
    (
        Sense::Plain(Action::Take),
        &[
            "grab", "pick", "fetch", "collect", "retrieve", "remove", "borrow", "lift", "snatch", "receive",
            "accept", "select", "obtain", "acquire", "seize", "gather", "unhook",
        ],
    ),
    (
        Sense::Plain(Action::Place),
        &[
            "place", "store", "deposit", "replace", "stow", "tuck", "drop", "park", "position", "stack",
            "load", "shelve", "stash", "pack", "insert",
        ],
    ),
    (
        Sense::Plain(Action::Transport),
        &[
            "carry",
            "move",
            "transport",
            "transfer",
            "relocate",
            "shift",
            "drag",
            "push",
            "haul",
            "deliver",
            "lug",
        ],
    ),
    (
        Sense::Plain(Action::Clean),
        &[
            "wipe",
            "clean",
            "vacuum",
            "dust",
            "scrub",
            "mop",
            "polish",
            "disinfect",
            "hoover",
            "launder",
            "sanitise",
            "sanitize",
        ],
    ),
    (Sense::Plain(Action::Search), &["search", "hunt", "locate", "discover", "rummage"]),
    (Sense::Plain(Action::Give), &["hand", "pass", "offer", "loan", "share", "donate"]),
    (Sense::Turn, &["turn"]),
    (Sense::Look, &["look"]),
    (Sense::Pull, &["pull"]),
    (Sense::Return, &["return"]),
    (Sense::Tidy, &["tidy", "clear"]),
    (Sense::Wash, &["wash", "rinse", "dry"]),
    (Sense::Check, &["check"]),
    (Sense::Reach, &["reach"]),
    (Sense::Try, &["try"]),
];

/// Verbs with forms of their own: base, third person, past, participle, gerund.
pub(crate) const IRREGULAR: &[(Sense, [&str; 5])] = &[
    (Sense::Plain(Action::Use), ["read", "reads", "read", "read", "reading"]),
    (Sense::Plain(Action::Use), ["write", "writes", "wrote", "written", "writing"]),
    (Sense::Plain(Action::Use), ["drink", "drinks", "drank", "drunk", "drinking"]),
    (Sense::Plain(Action::Use), ["eat", "eats", "ate", "eaten", "eating"]),
    (Sense::Plain(Action::Use), ["wear", "wears", "wore", "worn", "wearing"]),
    (Sense::Plain(Action::Use), ["hold", "holds", "held", "held", "holding"]),
    (Sense::Plain(Action::Use), ["cut", "cuts", "cut", "cut", "cutting"]),
    (Sense::Plain(Action::Use), ["shut", "shuts", "shut", "shut", "shutting"]),
    (Sense::Plain(Action::Use), ["draw", "draws", "drew", "drawn", "drawing"]),
    (Sense::Plain(Action::Use), ["sit", "sits", "sat", "sat", "sitting"]),
    (Sense::Plain(Action::Use), ["sleep", "sleeps", "slept", "slept", "sleeping"]),
    (Sense::Plain(Action::Use), ["sing", "sings", "sang", "sung", "singing"]),
    (Sense::Plain(Action::Use), ["knit", "knits", "knitted", "knitted", "knitting"]),
    (Sense::Plain(Action::Use), ["sew", "sews", "sewed", "sewn", "sewing"]),
    (Sense::Plain(Action::Use), ["bite", "bites", "bit", "bitten", "biting"]),
    (Sense::Plain(Action::Use), ["spread", "spreads", "spread", "spread", "spreading"]),
    (Sense::Plain(Action::Use), ["drive", "drives", "drove", "driven", "driving"]),
    (Sense::Plain(Action::Use), ["light", "lights", "lit", "lit", "lighting"]),
    (Sense::Take, ["take", "takes", "took", "taken", "taking"]),
    (Sense::Get, ["get", "gets", "got", "gotten", "getting"]),
    (Sense::Plain(Action::Take), ["steal", "steals", "stole", "stolen", "stealing"]),
    (Sense::Plain(Action::Take), ["choose", "chooses", "chose", "chosen", "choosing"]),
    (Sense::Plain(Action::Take), ["catch", "catches", "caught", "caught", "catching"]),
    (Sense::Put, ["put", "puts", "put", "put", "putting"]),
    (Sense::Set, ["set", "sets", "set", "set", "setting"]),
    (Sense::Leave, ["leave", "leaves", "left", "left", "leaving"]),
    (Sense::Plain(Action::Place), ["lay", "lays", "laid", "laid", "laying"]),
    (Sense::Plain(Action::Place), ["hang", "hangs", "hung", "hung", "hanging"]),
    (Sense::Plain(Action::Place), ["hide", "hides", "hid", "hidden", "hiding"]),
    (Sense::Plain(Action::Transport), ["bring", "brings", "brought", "brought", "bringing"]),
    (Sense::Plain(Action::Transport), ["slide", "slides", "slid", "slid", "sliding"]),
    (Sense::Plain(Action::Clean), ["sweep", "sweeps", "swept", "swept", "sweeping"]),
    (Sense::Plain(Action::Search), ["find", "finds", "found", "found", "finding"]),
    (Sense::Plain(Action::Search), ["seek", "seeks", "sought", "sought", "seeking"]),
    (Sense::Plain(Action::Give), ["give", "gives", "gave", "given", "giving"]),
    (Sense::Plain(Action::Give), ["lend", "lends", "lent", "lent", "lending"]),
];

/// Regular verbs that double their last letter before -ed and -ing.
const DOUBLING: &[&str] = &[
    "sip", "stir", "chop", "plug", "unplug", "grab", "drop", "drag", "mop", "scrub", "scan", "strum", "flip",
    "skim", "transfer", "lug",
];

/// The other forms of a regular verb.
pub(crate) fn inflect(base: &str) -> [(Form, String); 4] {
    let consonant_y = base.ends_with('y')
        && !base.ends_with("ay")
        && !base.ends_with("ey")
        && !base.ends_with("oy")
        && !base.ends_with("uy");
    let hissing = ["s", "x", "z", "ch", "sh", "o"].iter().any(|ending| base.ends_with(ending));
    let stem = &base[..base.len() - 1];
    let last = &base[base.len() - 1..];
    let third = match (consonant_y, hissing) {
        (true, _) => format!("{stem}ies"),
        (false, true) => format!("{base}es"),
        (false, false) => format!("{base}s"),
    };
    let (past, gerund) = if DOUBLING.contains(&base) {
        (format!("{base}{last}ed"), format!("{base}{last}ing"))
    } else if last == "e" {
        (format!("{base}d"), format!("{stem}ing"))
    } else if consonant_y {
        (format!("{stem}ied"), format!("{base}ing"))
    } else {
        (format!("{base}ed"), format!("{base}ing"))
    };
    [
        (Form::Base, base.to_owned()),
        (Form::Third, third),
        (Form::PastOrParticiple, past),
        (Form::Gerund, gerund),
    ]
}
