//! The loop: everything of the runtime, composed in one order.
//!
//! Order inside sample `k` (design rule; each step is a block with its own file):
//!
//! 1. judge the inputs ([`SampleGuard`](crate::SampleGuard)); replace what is not usable;
//! 2. anti-windup with the output applied since the last sample ([`AntiWindup`](crate::AntiWindup)), which also goes
//!    into the compensator's delay line;
//! 3. `u_f` from `y[k]` ([`Compensate`](crate::Compensate));
//! 4. working set-point ([`Setpoint`](crate::Setpoint)), deadband ([`Deadband`](crate::Deadband)), the law: a PID
//!    ([`Pid`](crate::Pid)) or an ADRC ([`Adrc`](crate::Adrc));
//! 5. `v = law + offset + u_f`, or what the mode says ([`Mode`](crate::Mode));
//! 6. `u = limit(v)` ([`Limit`](crate::Limit)): offset and `u_f` are inside the saturation;
//! 7. alarms ([`Alarms`](crate::Alarms)), status, output.

mod config;
mod io;
mod keep;
mod law;
mod numbers;
mod state;
mod step;
mod sum;
mod usual;

pub use config::ControllerConfig;
pub use io::{ControllerInput, ControllerOutput};
pub use law::Controller;
pub use numbers::ControllerNumbers;
pub use state::ControllerState;
