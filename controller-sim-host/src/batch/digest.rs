//! A study in 16 hexadecimal digits.

use super::study::Study;

/// Changes whenever rows of the same request would come out otherwise.
const FORMAT: &str = "controller-sim batch 1";

/// FNV-1a over everything that the rows depend on: the version of the program, the plants in order, and the request. Not the
/// threads, the shard, or where the rows go.
pub(super) fn digest(study: &Study) -> String {
    let mut hash = Fnv::new();
    let mut add = |text: &str| hash.add_text(text);
    add(FORMAT);
    add(env!("CARGO_PKG_VERSION"));
    for plant in &study.plants {
        add(&plant.name);
        add(&plant.family);
        add(&plant.expression);
    }
    add("methods");
    study.methods.iter().for_each(|method| add(method.name()));
    for (name, list) in [("ms", &study.ms), ("noise_ratio", &study.noise_ratios)] {
        add(name);
        list.iter().for_each(|x| add(&format!("{x:?}")));
    }
    add(&study.ts.map_or(String::new(), |ts| format!("{ts:?}")));
    hash.text()
}

pub(super) struct Fnv(u64);

impl Fnv {
    pub(super) const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub(super) fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// One text of several.
    pub(super) fn add_text(&mut self, text: &str) {
        self.add(text.as_bytes());
        // No text contains it: two lists never run into one.
        self.add(&[0]);
    }

    pub(super) fn text(&self) -> String {
        format!("{:016x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published values of FNV-1a, 64 bits.
    #[test]
    fn the_hash_is_the_published_one() {
        let of = |text: &str| {
            let mut hash = Fnv::new();
            hash.add(text.as_bytes());
            hash.0
        };
        assert_eq!(
            [of(""), of("a"), of("foobar")],
            [0xcbf29ce484222325, 0xaf63dc4c8601ec8c, 0x85944171f73967e8]
        );
    }
}
