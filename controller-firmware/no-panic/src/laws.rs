//! The laws by themselves: PID, ADRC, compensators of every kind of shape.

use crate::keep;
use controller_core::{Adrc, AnyCompensator, Compensate, Compensator, Pid, PidState, Real};

/// Delay memory \[samples\].
pub(crate) const CAPACITY: usize = 40;

/// A disturbance estimator of a second-order model.
pub(crate) type De<T> = Compensator<T, 2, 1, CAPACITY>;
/// A disturbance estimator of a first-order model.
pub(crate) type FirstOrderDe<T> = Compensator<T, 1, 2, CAPACITY>;
/// A disturbance observer of a first-order model.
pub(crate) type Dob<T> = Compensator<T, 1, 0, CAPACITY>;
/// A disturbance observer of a third-order model.
pub(crate) type ThirdOrder<T> = Compensator<T, 3, 0, CAPACITY>;
/// The largest shape there is.
pub(crate) type Largest<T> = Compensator<T, 8, 3, CAPACITY>;
/// A shape known at run time.
pub(crate) type Any<T> = AnyCompensator<T, [T; CAPACITY]>;

pub(crate) fn keep_all<T: Real>() {
    keep! {
        Pid::<T>::new => fn(&_, _) -> _,
        Pid::<T>::step => fn(&_, &mut _, _) -> _,
        Pid::<T>::increment => fn(&_, &_, _) -> _,
        Pid::<T>::filter => fn(&_, &mut _, _) -> _,
        Pid::<T>::preview => fn(&_, &_, _) -> _,
        Pid::<T>::settle => fn(&_, &mut _, _, _),
        Pid::<T>::adopt => fn(&_, &_, &mut _),
        Pid::<T>::resolution => fn(&_, _) -> _,
        PidState::<T>::integrate => fn(&mut _, _),
        PidState::<T>::shift_integral => fn(&mut _, _),
        Adrc::<T>::new => fn(&_, _) -> _,
        Adrc::<T>::step => fn(&_, &mut _, _) -> _,
        Adrc::<T>::settle => fn(&_, &mut _, _),
        Adrc::<T>::adopt => fn(&_, &_, &mut _),
        Adrc::<T>::resolution => fn(&_, _) -> _,
        De::<T>::new => fn(&_, _) -> _,
        De::<T>::step => fn(&_, &mut _, _) -> _,
        FirstOrderDe::<T>::new => fn(&_, _) -> _,
        FirstOrderDe::<T>::step => fn(&_, &mut _, _) -> _,
        Dob::<T>::new => fn(&_, _) -> _,
        Dob::<T>::step => fn(&_, &mut _, _) -> _,
        ThirdOrder::<T>::new => fn(&_, _) -> _,
        ThirdOrder::<T>::step => fn(&_, &mut _, _) -> _,
        De::<T>::settled => fn(&_, _, _) -> _,
        FirstOrderDe::<T>::settled => fn(&_, _, _) -> _,
        Dob::<T>::settled => fn(&_, _, _) -> _,
        Largest::<T>::step => fn(&_, &mut _, _) -> _,
        Any::<T>::new => fn(&_, _, _) -> _,
        Any::<T>::state => fn(&_, _) -> _,
        Any::<T>::fits => fn(&_, &_) -> _,
    }
    compensator::<T, De<T>>();
    compensator::<T, FirstOrderDe<T>>();
    compensator::<T, Dob<T>>();
    compensator::<T, ThirdOrder<T>>();
    compensator::<T, Largest<T>>();
    compensator::<T, Any<T>>();
}

fn compensator<T: Real, C: Compensate<T>>() {
    keep! {
        C::sample => fn(&_, &mut _, _, _) -> _,
        C::settle => fn(&_, &mut _, _, _),
        C::resettle => fn(&_, &mut _, _),
        C::skip => fn(&_, &mut _, _, _),
        C::adopt => fn(&_, &_, &mut _, _, _) -> _,
        C::bounds => fn(&_) -> _,
        C::reach => fn(&_, &_, _, _) -> _,
    }
}
