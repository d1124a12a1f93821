//! The whole loop around each law.

use crate::keep;
use crate::laws::{Any, De, Dob, FirstOrderDe, Largest, ThirdOrder};
use controller_core::{Adrc, Compensate, Controller, NoCompensator, Pid, Real, Regulator};

pub(crate) fn keep_all<T: Real>() {
    keep! {
        Controller::<T>::new => fn(&_, _) -> _,
        Controller::<T, NoCompensator, Adrc<T>>::with_adrc => fn(&_, &_, _) -> _,
        Controller::<T, De<T>>::with_compensator => fn(&_, _, _) -> _,
        Controller::<T>::zeroed => fn(&_) -> _,
        Controller::<T, De<T>>::zeroed => fn(&_) -> _,
        Controller::<T, Any<T>>::with_compensator => fn(&_, _, _) -> _,
    }
    whole::<T, NoCompensator, Pid<T>>();
    whole::<T, NoCompensator, Adrc<T>>();
    whole::<T, De<T>, Pid<T>>();
    whole::<T, FirstOrderDe<T>, Pid<T>>();
    whole::<T, Dob<T>, Pid<T>>();
    whole::<T, ThirdOrder<T>, Pid<T>>();
    whole::<T, Largest<T>, Pid<T>>();
    whole::<T, Any<T>, Pid<T>>();
}

fn whole<T: Real, C: Compensate<T>, L: Regulator<T>>() {
    keep! {
        Controller::<T, C, L>::step => fn(&_, &mut _, &_) -> _,
        Controller::<T, C, L>::settle => fn(&_, &mut _, _, _, _),
        Controller::<T, C, L>::adopt => fn(&_, &_, &mut _),
        Controller::<T, C, L>::advance => fn(&_, &mut _, _),
        Controller::<T, C, L>::save => fn(&_, &_, &mut _) -> _,
        Controller::<T, C, L>::restore => fn(&_, &mut _, &_) -> _,
        Controller::<T, C, L>::resolution => fn(&_) -> _,
    }
}
