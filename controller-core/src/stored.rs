//! What laws and states are stored in, where a `bool`, an enumeration, an `Option` or a list would have bytes that are no value.
//!
//! Memory that is kept over a power failure, or that another program writes, can hold anything. With these types every bit
//! pattern of a law and of a state is a value: a step on damaged memory gives a number, and nothing worse.

use crate::mode::Mode;
use crate::real::Real;
use crate::snapshot::Words;
use core::ops::{Deref, DerefMut};

/// A `bool`: 0 is false, any other byte true.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Flag(u8);

impl Flag {
    #[inline(always)]
    pub(crate) const fn new(set: bool) -> Self {
        Self(set as u8)
    }

    #[inline(always)]
    pub(crate) const fn is_set(self) -> bool {
        self.0 != 0
    }

    /// As it is stored: 0 or 1, if nothing has damaged it.
    #[inline(always)]
    pub(crate) const fn byte(self) -> u8 {
        self.0
    }
}

/// A [`Mode`] by its number; an unknown number is [`Mode::Hold`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StoredMode(u8);

impl StoredMode {
    #[inline(always)]
    pub(crate) const fn new(mode: Mode) -> Self {
        Self(mode as u8)
    }

    #[inline(always)]
    pub(crate) const fn get(self) -> Mode {
        match Mode::from_number(self.0) {
            Some(mode) => mode,
            None => Mode::Hold,
        }
    }

    #[inline(always)]
    pub(crate) const fn is(self, mode: Mode) -> bool {
        self.0 == mode as u8
    }
}

/// A number that may be missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Optional<T> {
    value: T,
    given: Flag,
}

impl<T: Copy + Default> Optional<T> {
    pub(crate) fn new(value: Option<T>) -> Self {
        Self { value: value.unwrap_or_default(), given: Flag::new(value.is_some()) }
    }

    #[inline(always)]
    pub(crate) fn get(self) -> Option<T> {
        self.given.is_set().then_some(self.value)
    }

    /// Its number, whether it is given or not, and which of the two.
    #[inline(always)]
    pub(crate) fn write(self, words: &mut impl Words)
    where
        T: Real,
    {
        words.number(self.value);
        words.word(u32::from(self.given.byte()));
    }
}

/// Up to `L` items; a length beyond `L` counts as `L`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct List<X, const L: usize> {
    items: [X; L],
    length: u32,
}

impl<X: Copy + Default, const L: usize> List<X, L> {
    /// The first `L` of `items`.
    pub(crate) fn of(items: impl IntoIterator<Item = X>) -> Self {
        let mut list = Self { items: [X::default(); L], length: 0 };
        for (place, item) in list.items.iter_mut().zip(items) {
            *place = item;
            list.length += 1;
        }
        list
    }
}

impl<X, const L: usize> List<X, L> {
    #[inline(always)]
    const fn within(&self) -> usize {
        let length = self.length as usize;
        if length <= L { length } else { L }
    }
}

impl<X, const L: usize> Deref for List<X, L> {
    type Target = [X];

    #[inline(always)]
    fn deref(&self) -> &[X] {
        self.items.get(..self.within()).unwrap_or_default()
    }
}

impl<X, const L: usize> DerefMut for List<X, L> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [X] {
        let length = self.within();
        self.items.get_mut(..length).unwrap_or_default()
    }
}

impl<X: PartialEq, const L: usize> PartialEq for List<X, L> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_is_a_value() {
        for byte in 0..=u8::MAX {
            assert_eq!(Flag(byte).is_set(), byte != 0);
            let mode = StoredMode(byte).get();
            assert_eq!(mode as u8, if byte <= 6 { byte } else { Mode::Hold as u8 });
            assert_eq!(StoredMode(byte).is(mode), byte <= 6);
        }
        assert_eq!((Flag::new(true).byte(), Flag::new(false).byte()), (1, 0));
    }

    #[test]
    fn a_number_is_there_or_not() {
        assert_eq!(Optional::new(Some(2.5)).get(), Some(2.5));
        assert_eq!(Optional::<f64>::new(None).get(), None);
    }

    #[test]
    fn a_list_ends_where_its_room_does() {
        let mut list = List::<i32, 4>::of(0..3);
        assert_eq!(*list, [0, 1, 2]);
        list.fill(7);
        assert_eq!(*list, [7, 7, 7]);
        assert_eq!(*List::<i32, 2>::of(0..3), [0, 1]);
        for length in [4, 5, u32::MAX] {
            list.length = length;
            assert_eq!((list.len(), list.iter_mut().count()), (4, 4));
        }
        // What stands behind the end makes no difference.
        let [mut one, mut other] = [List::<i32, 2>::of([1, 2]), List::of([1, 3])];
        assert_ne!(one, other);
        (one.length, other.length) = (1, 1);
        assert_eq!(one, other);
    }
}
