//! Every sample of every controller as CSV.

use crate::simulate::RunResult;
use std::io::{self, Write};

/// Writes `controller,t,r,y,u,u_f,d_hat,d,mode,status`, one line per sample, controllers one after the other.
/// Numbers in SI units with all their digits; a measurement that is bad is `NaN`; `status` is the number of
/// its bits.
///
/// # Errors
/// Whatever the writer cannot do.
pub fn write_csv(result: &RunResult, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "controller,t,r,y,u,u_f,d_hat,d,mode,status")?;
    for controller in &result.controllers {
        let name = field(&controller.name);
        for s in &controller.trace {
            let (mode, status) = (s.mode.name(), s.status.bits());
            writeln!(
                to,
                "{name},{},{},{},{},{},{},{},{mode},{status}",
                s.t, s.r, s.y, s.u, s.u_f, s.d_hat, s.d
            )?;
        }
    }
    Ok(())
}

/// A text as a CSV field: in quotes when it has a comma, a quote or a space at an end.
fn field(text: &str) -> String {
    if text.contains([',', '"', ';']) || text.trim() != text {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::field;

    #[test]
    fn a_name_with_a_comma_is_one_field() {
        assert_eq!(field("PI, \"fast\""), "\"PI, \"\"fast\"\"\"");
        assert_eq!(field("PI + DOB"), "PI + DOB");
    }
}
