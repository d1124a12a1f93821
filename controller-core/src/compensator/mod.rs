//! The disturbance blocks of both papers as one family: `u_f = C_u(z)*u + C_y(z)*y`.
//!
//! For a plant `G = K*B_c(s)*exp(-s*T)/(s^k*A_c(s))` with the zero-order-hold equivalent
//! `G_d = z^-(N+1)*B(z^-1)/A(z^-1)`, `(N+m)*ts = dead_time + latency`, the discrete-exact pair is
//!
//! ```text
//! C_u =  gain * z^-(N+1) * B/B(1) * F        C_y = -gain * A/B(1) * F
//! F   = prod(1-p_i)/(1-p_i*z^-1) * ((1+z^-1)/2)^e
//! ```
//!
//! so that `C_u + G_d*C_y = 0` holds exactly: with a perfect model nothing is fed back while tracking, there is no
//! algebraic loop, and the loop's characteristic polynomial is the one without the compensator. The `p_i` are `d`
//! poles `exp(-ts/alpha)` and one pole `exp(-ts/beta)` for every plant zero with `beta >= ts`; `e` fills the order
//! up, one zero at the Nyquist frequency per excess degree.
//!
//! * Disturbance observer (DOB): `gain = 1`, `d` the relative degree, eqs (26), (27) of Tena et al. 2022.
//! * Disturbance estimator (DE): `gain = K_FD`, `d = 3`, eqs (13)-(15) of Vrančić & Huba 2021, `u_f = -d_f`.
//!
//! Numerically: neither `A` nor its static gain is ever formed. The `y` path is a cascade of first- and
//! second-order sections of unit static gain with `1 - q` from `expm1`; the `u` path is one chain of lags whose
//! output polynomial is `B`; states are plain signals. The factor `e` is shared by both.

mod any;
mod config;
mod discretise;
pub(crate) mod kernel;
mod law;
mod matrix;
mod none;
mod shape;
mod view;
mod zoh;

pub use any::{AnyCompensator, AnyCompensatorState};
pub use config::{CompensatorConfig, EstimatorConfig, FilterNames, ObserverConfig};
pub use kernel::{Coefficients, Compensate, CompensatorOutput};
pub use law::{Compensator, CompensatorInput, CompensatorState, Estimator, Observer};
pub use none::NoCompensator;

/// Most excess sections (`e`) a compensator can have.
pub const MAX_EXCESS: usize = 3;
