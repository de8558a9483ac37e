//! Words of a text: where they stand, whether they are possessive, and what separates them.
//!
//! A word is a run of letters, digits, underscores and combining accents, with apostrophes and hyphens inside
//! it: `Anna-Lena` and `O'Brien` are one word each, so that `Anna` is not found in the former. Case does not
//! matter, nor does it whether an accent is written as one character with its letter or as two.

/// What stands between a word and the one before it; the strongest mark counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Gap {
    /// Space, a quotation mark, a bracket, the beginning of the text.
    Space,
    /// `&` or `+`.
    Ampersand,
    /// `,`
    Comma,
    /// `/` or `|`
    Slash,
    /// The end of a clause: `.`, `;`, `:`, `!`, `…`, a dash, a line break.
    Stop,
    /// `?`
    Question,
}

impl Gap {
    fn of(character: char) -> Self {
        match character {
            '&' | '+' => Self::Ampersand,
            ',' | '،' | '、' | '，' => Self::Comma,
            '/' | '|' => Self::Slash,
            '.' | ';' | ':' | '!' | '…' | '-' | '\u{2012}'..='\u{2015}' | '\n' | '\r' | '。' | '！' | '؛' => {
                Self::Stop
            }
            '?' | '？' | '؟' => Self::Question,
            _ => Self::Space,
        }
    }
}

/// A folded word as a number: up to 16 bytes are packed as they are, longer words are hashed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Key(u128);

impl Key {
    /// Spreads keys over a table of 2^`bits` places.
    pub(crate) fn slot(self, bits: u32) -> usize {
        // Fibonacci hashing of both halves: neighbours in the alphabet end up far apart.
        let mixed = (self.0 as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
            ^ ((self.0 >> 64) as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        (mixed.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - bits)) as usize
    }

    /// The longest folded word, in bytes, whose key is that word's alone.
    pub(crate) const EXACT_BYTES: usize = 16;

    /// The key of a word that is folded already.
    pub(crate) const fn of_folded(word: &str) -> Self {
        let bytes = word.as_bytes();
        let mut key = 0;
        let mut index = 0;
        if bytes.len() > Self::EXACT_BYTES {
            // FNV-1a, 128 bits. Who looks a long word up compares its letters too.
            key = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
            while index < bytes.len() {
                key = (key ^ bytes[index] as u128).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
                index += 1;
            }
            return Self(key);
        }
        while index < bytes.len() {
            key = key << 8 | bytes[index] as u128;
            index += 1;
        }
        Self(key)
    }
}

/// One word of a text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Word {
    /// Texts are short; a place in one fits into 32 bits.
    start: u32,
    end: u32,
    /// The word without case and possessive ending.
    pub(crate) key: Key,
    /// Whether the text has `'s` or, after an s, an apostrophe behind the word.
    pub(crate) possessive: bool,
    /// Whether the word begins with a capital letter.
    pub(crate) capital: bool,
    /// What separates it from the word before.
    pub(crate) gap: Gap,
}

impl Word {
    /// A word that fills a place until another comes.
    pub(crate) const FILLER: Self =
        Self { start: 0, end: 0, key: Key(0), possessive: false, capital: false, gap: Gap::Space };

    /// The place behind the word in its text, its possessive ending left out, in bytes.
    pub(crate) fn end(&self) -> usize {
        self.end as usize
    }

    /// The word as it is written, without its possessive ending.
    pub(crate) fn text<'text>(&self, text: &'text str) -> &'text str {
        &text[self.start as usize..self.end as usize]
    }
}

/// The words of a text one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Words<'text> {
    text: &'text str,
    position: usize,
}

impl<'text> Words<'text> {
    pub(crate) fn new(text: &'text str) -> Self {
        Self { text, position: 0 }
    }

    /// What stands behind the last word; [`Gap::Space`] where nothing does. Ask once the words are exhausted.
    pub(crate) fn end(text: &str) -> Gap {
        let last = Words::new(text).last();
        let rest = last.map_or(0, |word| word.end as usize);
        text[rest..].chars().map(Gap::of).max().unwrap_or(Gap::Space)
    }
}

impl Iterator for Words<'_> {
    type Item = Word;

    fn next(&mut self) -> Option<Word> {
        let mut gap = Gap::Space;
        let mut characters = self.text[self.position..].char_indices();
        let (offset, first) = loop {
            let (offset, character) = characters.next()?;
            if is_word_character(character) {
                break (offset, character);
            }
            gap = gap.max(Gap::of(character));
        };
        let start = self.position + offset;
        let spelled = plain(&self.text[start..]).unwrap_or_else(|| intricate(&self.text[start..]));
        let Spelled { length, behind, key, possessive } = spelled;
        self.position = start + behind;
        let end = start + length;
        let capital = first.is_uppercase();
        Some(Word { start: start as u32, end: end as u32, key, possessive, capital, gap })
    }
}

/// A word at the beginning of a text.
struct Spelled {
    /// Its length in bytes, the possessive ending left out.
    length: usize,
    /// Its length with the ending.
    behind: usize,
    key: Key,
    possessive: bool,
}

/// A word of plain letters and digits, which most are; `None` for any other.
fn plain(text: &str) -> Option<Spelled> {
    let mut packed = 0;
    let mut length = 0;
    for &byte in text.as_bytes() {
        if byte.is_ascii_alphanumeric() || byte == b'_' {
            packed = packed << 8 | u128::from(byte.to_ascii_lowercase());
            length += 1;
        } else if byte.is_ascii() && !is_joiner(char::from(byte)) {
            break;
        } else {
            return None;
        }
    }
    (length <= Key::EXACT_BYTES).then_some(Spelled {
        length,
        behind: length,
        key: Key(packed),
        possessive: false,
    })
}

/// Any word: with accents, apostrophes, hyphens, or long.
fn intricate(text: &str) -> Spelled {
    let mut behind = 0;
    let mut apostrophe = None;
    let mut last = ' ';
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        let joins = is_joiner(character) && characters.peek().copied().is_some_and(is_word_character);
        if !joins && !is_word_character(character) {
            break;
        }
        if joins && is_apostrophe(character) {
            apostrophe = Some((behind, character.len_utf8()));
        }
        behind += character.len_utf8();
        last = character;
    }
    let ending = apostrophe.filter(|&(at, width)| matches!(&text[at + width..behind], "s" | "S"));
    let length = ending.map_or(behind, |(at, _)| at);
    let bare = matches!(last, 's' | 'S' | 'x' | 'X' | 'z' | 'Z')
        && text[behind..].chars().next().is_some_and(is_apostrophe);
    let key = Key::of_folded(&fold(&text[..length]));
    Spelled { length, behind, key, possessive: ending.is_some() || bare }
}

fn is_word_character(character: char) -> bool {
    if character.is_ascii() {
        character.is_ascii_alphanumeric() || character == '_'
    } else {
        character.is_alphanumeric() || is_accent(character)
    }
}

fn is_accent(character: char) -> bool {
    matches!(character, '\u{300}'..='\u{36f}')
}

fn is_apostrophe(character: char) -> bool {
    matches!(character, '\'' | '’' | 'ʼ' | '＇' | '`' | '´')
}

fn is_joiner(character: char) -> bool {
    is_apostrophe(character) || matches!(character, '-' | '‐' | '\u{2011}')
}

/// Lower case, one kind of apostrophe and hyphen, accents joined to their letters.
pub(crate) fn fold(word: &str) -> String {
    let mut folded = String::with_capacity(word.len());
    for character in word.chars() {
        if is_apostrophe(character) {
            folded.push('\'');
        } else if is_joiner(character) {
            folded.push('-');
        } else if let Some(letter) = is_accent(character)
            .then(|| folded.chars().last().and_then(|base| with_accent(base, character)))
            .flatten()
        {
            folded.pop();
            folded.push(letter);
        } else {
            // The final sigma is the same letter as the others.
            folded.extend(character.to_lowercase().map(|lower| if lower == 'ς' { 'σ' } else { lower }));
        }
    }
    folded
}

/// Letters of European names with an accent, as pairs of the bare and the accented letter.
const ACCENTED: &[(char, &str)] = &[
    ('\u{300}', "aàeèiìoòuùnǹ"),
    ('\u{301}', "aáeéiíoóuúyýcćlĺnńrŕsśzźgǵ"),
    ('\u{302}', "aâeêiîoôuûcĉgĝhĥjĵsŝwŵyŷ"),
    ('\u{303}', "aãnñoõiĩuũ"),
    ('\u{304}', "aāeēiīoōuū"),
    ('\u{306}', "aăeĕgğiĭoŏuŭ"),
    ('\u{307}', "cċeėgġzż"),
    ('\u{308}', "aäeëiïoöuüyÿ"),
    ('\u{30a}', "aåuů"),
    ('\u{30b}', "oőuű"),
    ('\u{30c}', "cčdďeěnňrřsštťzž"),
    ('\u{327}', "cçsştţ"),
    ('\u{328}', "aąeęiįuų"),
];

fn with_accent(base: char, accent: char) -> Option<char> {
    let (_, letters) = ACCENTED.iter().find(|&&(mark, _)| mark == accent)?;
    let mut letters = letters.chars();
    while let (Some(bare), Some(accented)) = (letters.next(), letters.next()) {
        if bare == base {
            return Some(accented);
        }
    }
    None
}
