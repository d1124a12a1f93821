//! The small blocks, and the cell that hands over a law.

use crate::keep;
use controller_core::{
    Accumulator, Alarms, AntiWindup, Controller, Deadband, DelayLine, Instance, Lag, Limit, Mode, ParamCell,
    Pid, PidState, Real, SampleGuard, Setpoint, Status,
};

pub(crate) fn keep_all<T: Real>() {
    keep! {
        Accumulator::<T>::add => fn(&mut _, _),
        Accumulator::<T>::set => fn(&mut _, _),
        Accumulator::<T>::approach => fn(&mut _, _, _, _) -> _,
        Accumulator::<T>::short_of => fn(&_, _) -> _,
        Lag::<T>::advance => fn(&mut _, _, _) -> _,
        Lag::<T>::tap => fn(&_, _) -> _,
        Limit::<T>::new => fn(&_, _) -> _,
        Limit::<T>::apply => fn(&_, &mut _, _) -> _,
        Limit::<T>::no_faster_than => fn(_, _) -> _,
        Limit::<T>::into_range => fn(&_, _) -> _,
        Setpoint::<T>::new => fn(&_, _) -> _,
        Setpoint::<T>::start => fn(&_, _, _) -> _,
        Setpoint::<T>::advance => fn(&_, &mut _, _),
        Setpoint::<T>::ramp => fn(&_, &mut _, _),
        Setpoint::<T>::into_range => fn(&_, _) -> _,
        SampleGuard::<T>::new => fn(&_, _, _, _) -> _,
        SampleGuard::<T>::judge => fn(&_, &mut _, _, _, _) -> _,
        SampleGuard::<T>::lost => fn(&_, &mut _, _),
        SampleGuard::<T>::fallback_output => fn(&_) -> _,
        Alarms::<T>::new => fn(&_) -> _,
        Alarms::<T>::check => fn(&_, _, _, _) -> _,
        Deadband::<T>::new => fn(_) -> _,
        Deadband::<T>::apply => fn(&_, _, _) -> _,
        AntiWindup::<T>::new => fn(&_, &_, _) -> _,
        AntiWindup::<T>::correction => fn(&_, _, _, _) -> _,
        // Memory of any length, and of one.
        DelayLine::<[T; 40]>::push::<T> => fn(&mut _, _),
        DelayLine::<[T; 40]>::tap::<T> => fn(&_, _) -> _,
        DelayLine::<[T; 40]>::fill::<T> => fn(&mut _, _),
        DelayLine::<[T; 1]>::push::<T> => fn(&mut _, _),
        DelayLine::<[T; 1]>::tap::<T> => fn(&_, _) -> _,
        DelayLine::<&'static mut [T]>::push::<T> => fn(&mut _, _),
        DelayLine::<&'static mut [T]>::tap::<T> => fn(&_, _) -> _,
        ParamCell::<Pid<T>>::publish => fn(&_, _) -> _,
        ParamCell::<Pid<T>>::take_newer => fn(&_, &mut _) -> _,
        ParamCell::<Controller<T>>::publish => fn(&_, _) -> _,
        ParamCell::<Controller<T>>::take_newer => fn(&_, &mut _) -> _,
        Instance::<Pid<T>, PidState<T>>::step => fn(&mut _, &_) -> _,
        Instance::<Pid<T>, PidState<T>>::adopt => fn(&mut _, _),
        Mode::in_force => fn(_, _) -> _,
        Mode::from_number => fn(_) -> _,
        Mode::name => fn(_) -> _,
        Status::has => fn(_, _) -> _,
        Status::when => fn(_, _) -> _,
    }
}
