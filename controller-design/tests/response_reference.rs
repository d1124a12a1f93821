//! Indices against the reference values of Tena et al. 2022 (recomputed to 1e-5) and Airikka 2021.

use controller_core::PidConfig;
use controller_design::model::{TransferFunction, parse};
use controller_design::response::{ContinuousResponse, Indices, Load};

fn plant(text: &str) -> TransferFunction {
    parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

fn pi(kp: f64, ki: f64) -> PidConfig {
    PidConfig { kp, ki, ..PidConfig::default() }
}

fn indices(g: &TransferFunction, pid: &PidConfig, alpha: Option<f64>, load: Load) -> Indices {
    let response = match alpha {
        None => ContinuousResponse::new(g, pid, None),
        Some(alpha) => ContinuousResponse::with_alpha(g, pid, alpha),
    };
    response.expect("a loop").indices(load).expect("a stable loop")
}

#[test]
fn ratios_of_an_observer() {
    // IAE, ISE, ITAE, e_max, TV for alpha = 100, 10, 1.
    type Rows = [[f64; 5]; 3];
    let table: [(&str, f64, f64, Rows); 6] = [
        (
            "exp(-5*s)/(1+95*s)",
            3.16418932,
            0.0870833318,
            [
                [1.19653, 0.72765, 2.42306, 0.86054, 1.16938],
                [0.40972, 0.15538, 0.46032, 0.52633, 1.25362],
                [0.1744, 0.0354, 0.17286, 0.33494, 1.0944],
            ],
        ),
        (
            "exp(-20*s)/(1+80*s)",
            0.696075276,
            0.011533633,
            [
                [0.8572, 0.5052, 1.2669, 0.7958, 1.446],
                [0.3218, 0.1166, 0.3285, 0.5534, 1.433],
                [0.2277, 0.0640, 0.2230, 0.4759, 1.332],
            ],
        ),
        (
            "exp(-90*s)/(1+10*s)",
            0.100985197,
            0.00274121568,
            [
                [0.7276, 0.6196, 0.7804, 1.0, 1.516],
                [0.5270, 0.4752, 0.4431, 1.0, 1.648],
                [0.4881, 0.4390, 0.4018, 1.0, 1.641],
            ],
        ),
        (
            "exp(-5*s)/(1+95*s)",
            9.33178522,
            0.595653038,
            [
                [1.5727, 0.9836, 4.720, 0.9676, 1.079],
                [1.0178, 0.7369, 1.300, 0.8190, 1.458],
                [0.5885, 0.2928, 0.6599, 0.6258, 1.331],
            ],
        ),
        (
            "exp(-20*s)/(1+80*s)",
            2.02428791,
            0.0521097579,
            [
                [1.3060, 0.9959, 1.9868, 0.9306, 1.279],
                [0.8611, 0.5759, 1.0251, 0.7678, 1.601],
                [0.6420, 0.3448, 0.7233, 0.6813, 1.388],
            ],
        ),
        (
            "exp(-90*s)/(1+10*s)",
            0.266519128,
            0.00869073746,
            [
                [1.4808, 1.4316, 1.9072, 1.0, 1.850],
                [1.4479, 1.4411, 1.8053, 1.0, 2.359],
                [1.3629, 1.3223, 1.6661, 1.0, 2.330],
            ],
        ),
    ];
    for (text, kp, ki, rows) in table {
        let (g, pid) = (plant(text), pi(kp, ki));
        let base = indices(&g, &pid, None, Load::Step);
        assert!((base.ie * ki + 1.0).abs() < 1e-9, "{base:?}");
        for (alpha, row) in [100.0, 10.0, 1.0].into_iter().zip(rows) {
            let x = indices(&g, &pid, Some(alpha), Load::Step);
            let ratios = [
                x.iae / base.iae,
                x.ise / base.ise,
                x.itae / base.itae,
                x.e_max / base.e_max,
                x.tv / base.tv,
            ];
            for (ours, theirs) in ratios.iter().zip(row) {
                // The reference prints four or five digits.
                assert!((ours - theirs).abs() < 6e-5 + 4e-4 * theirs, "{text} {alpha}: {ratios:?}\n{row:?}");
            }
            assert!(x.ie.abs() < 1e-8 * base.iae, "{}", x.ie);
        }
    }
}
