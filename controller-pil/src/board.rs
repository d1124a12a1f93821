//! The boards that images are built for.

/// A board: where its memories are and what runs on it.
///
/// Addresses and sizes are those of the emulated machines, which are smaller than the ones of some real boards; only the
/// microbit's RAM is set to another size than the emulator gives it by itself, 16 KiB.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Board {
    /// The name of the machine that emulates it.
    pub name: &'static str,
    /// Its core, as its maker writes it.
    pub core: &'static str,
    /// The target that the compiler builds for.
    pub target: &'static str,
    /// The processor to build for where the target's own choice leaves out part of the instructions.
    pub cpu: Option<&'static str>,
    /// Begin and size of the flash \[bytes\].
    pub flash: Region,
    /// Begin and size of the RAM \[bytes\].
    pub ram: Region,
    /// Clock of the system timer \[Hz\].
    pub clock: u32,
    /// What the emulator is told besides the name of the machine.
    pub emulator: &'static [&'static str],
}

/// A piece of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Region {
    /// First address.
    pub origin: u32,
    /// Size in bytes.
    pub length: u32,
}

impl Region {
    /// Whether `address` is in it.
    #[must_use]
    pub const fn contains(&self, address: u32) -> bool {
        address >= self.origin && address - self.origin < self.length
    }
}

const MEGA: u32 = 1 << 20;
const KILO: u32 = 1 << 10;

/// All boards; the first is the reference.
pub const BOARDS: [Board; 5] = [
    Board {
        name: "mps2-an386",
        core: "Cortex-M4F",
        target: "thumbv7em-none-eabihf",
        cpu: None,
        flash: Region { origin: 0, length: 4 * MEGA },
        ram: Region { origin: 0x2000_0000, length: 4 * MEGA },
        clock: 25_000_000,
        emulator: &[],
    },
    // The RAM of the largest nRF51822. One loop with an estimator runs in the 16 KiB of the others (a check links the guide's
    // for that), the demo does not: two loops, a simulated plant for each, and a law that is built while they run.
    Board {
        name: "microbit",
        core: "Cortex-M0",
        target: "thumbv6m-none-eabi",
        cpu: None,
        flash: Region { origin: 0, length: 256 * KILO },
        ram: Region { origin: 0x2000_0000, length: 32 * KILO },
        clock: 16_000_000,
        emulator: &["-global", "nrf51-soc.sram-size=32768"],
    },
    Board {
        name: "mps2-an385",
        core: "Cortex-M3",
        target: "thumbv7m-none-eabi",
        cpu: None,
        flash: Region { origin: 0, length: 4 * MEGA },
        ram: Region { origin: 0x2000_0000, length: 4 * MEGA },
        clock: 25_000_000,
        emulator: &[],
    },
    Board {
        name: "mps2-an500",
        core: "Cortex-M7",
        target: "thumbv7em-none-eabihf",
        cpu: Some("cortex-m7"),
        flash: Region { origin: 0, length: 4 * MEGA },
        ram: Region { origin: 0x2000_0000, length: 4 * MEGA },
        clock: 25_000_000,
        emulator: &[],
    },
    Board {
        name: "mps2-an505",
        core: "Cortex-M33",
        target: "thumbv8m.main-none-eabihf",
        cpu: None,
        flash: Region { origin: 0x1000_0000, length: 4 * MEGA },
        ram: Region { origin: 0x3800_0000, length: 4 * MEGA },
        clock: 20_000_000,
        emulator: &[],
    },
];

/// The board with this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Board> {
    BOARDS.iter().find(|board| board.name == name)
}

/// The first board for this target.
#[must_use]
pub fn of_target(target: &str) -> Option<&'static Board> {
    BOARDS.iter().find(|board| board.target == target)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_is_found_by_its_name_and_by_its_target() {
        assert_eq!(named("mps2-an500").map(|b| b.core), Some("Cortex-M7"));
        assert_eq!(named("mps2"), None);
        // Two boards share this one; the reference comes first.
        assert_eq!(of_target("thumbv7em-none-eabihf").map(|b| b.name), Some("mps2-an386"));
        assert_eq!(of_target("x86_64-unknown-linux-gnu"), None);
    }

    #[test]
    fn a_region_ends_where_it_ends() {
        let region = Region { origin: 0xFFFF_0000, length: 0x1_0000 };
        assert!(
            region.contains(0xFFFF_FFFF) && region.contains(0xFFFF_0000) && !region.contains(0xFFFE_FFFF)
        );
        assert!(!named("mps2-an505").unwrap().flash.contains(0));
    }
}
