% The controller's C interface, by ctl_loop_mex, against discretisations that Octave makes of the continuous laws.
%
% Nothing here comes from the library but its documented rules: integral by the backward or the trapezoid rule, the filtered
% path by Tustin's, the compensator as the pair that is exact for a plant held between the samples. Run by
% `cargo xtask test --only octave`, with the folder of ctl_loop_mex on the path.
1;
pkg load control

% u of the PID for records of r and y from rest: each path by its own filter, the continuous law
% ki/s * (r - y) + (b*kp - ki*tf + c*kd*s)/(1 + tf*s) * r - (kp - ki*tf + kd*s)/(1 + tf*s) * y.
function [u, i, pd] = pid_by_filters (p, ts, r, y)
  i = through (integral_of (p, ts), r - y);
  pd = through (path_of (p, ts, p.b, p.c), r) - through (path_of (p, ts, 1, 1), y);
  u = i + pd;
end

function integral = integral_of (p, ts)
  if (p.integral_rule == 0)
    % s = (z - 1)/(z*ts)
    integral = tf ([p.ki*ts, 0], [1, -1], ts);
  else
    integral = c2d (tf (p.ki, [1, 0]), ts, "tustin");
  end
end

function path = path_of (p, ts, b, c)
  if (p.tf == 0)
    path = tf (b*p.kp, 1, ts);
  else
    path = c2d (tf ([c*p.kd, b*p.kp - p.ki*p.tf], [p.tf, 1]), ts, "tustin");
  end
end

function out = through (system, in)
  [num, den] = tfdata (system, "vector");
  % Both in descending powers of z: the same length makes them polynomials in 1/z.
  num = [zeros(1, numel (den) - numel (num)), num];
  out = filter (num, den, in);
end

% The plant K*prod(1 + z1*s + z2*s^2)/(s^k*prod(1 + a1*s + a2*s^2)) * exp(-delay*s), held over ts: N whole samples, and
% polynomials in 1/z with y = z^-(N+1) * B/A * u.
function [N, B, A] = held (m, delay, ts)
  num = m.gain;
  for j = 1:rows (m.zeros)
    num = conv (num, [m.zeros(j,2), m.zeros(j,1), 1]);
  end
  den = [1, zeros(1, m.integrators)];
  for j = 1:rows (m.poles)
    den = conv (den, [m.poles(j,2), m.poles(j,1), 1]);
  end
  den = den(find (den, 1):end);
  num = num(find (num, 1):end);
  n = numel (den) - 1;
  num = [zeros(1, n - numel (num)), num] / den(1);
  den = den / den(1);
  % Controllable companion form.
  F = [-den(2:end); eye(n-1), zeros(n-1, 1)];
  G = [1; zeros(n-1, 1)];
  N = floor (delay/ts + 1e-9);
  part = max (delay - N*ts, 0);
  if (part < 1e-9*ts)
    part = 0;
  end
  % Of each period the older input acts first, for the fraction, then the newer one for the rest.
  [~, old] = over (F, G, part);
  [rest, new] = over (F, G, ts - part);
  [Phi, ~] = over (F, G, ts);
  old = rest * old;
  A = real (poly (exp (roots (den) * ts)));
  B = numerator (Phi, new, num, A, n + 1) + [0, numerator(Phi, old, num, A, n)](1:n+1);
end

function [Phi, Gamma] = over (F, G, t)
  n = rows (F);
  E = expm ([F, G; zeros(1, n + 1)] * t);
  Phi = E(1:n, 1:n);
  Gamma = E(1:n, n+1);
end

% The first `count` coefficients of A(1/z) * sum(C*Phi^j*Gamma*z^-j).
function B = numerator (Phi, Gamma, C, A, count)
  h = zeros (1, count);
  x = Gamma;
  for j = 1:count
    h(j) = C * x;
    x = Phi * x;
  end
  B = conv (A, h)(1:count);
end

% C_u without its first delay, C_y: the pair of the compensator's doc. `u_f` for records of the applied output (of the sample
% before, as a step is told it) and of y, from rest.
function u_f = compensator_by_filters (m, latency, gain, time_constant, d, ts, applied, y)
  [num_u, num_y, den] = pair (m, latency, gain, time_constant, d, ts);
  u_f = filter (num_u, den, applied) + filter (num_y, den, y);
end

function [num_u, num_y, den] = pair (m, latency, gain, time_constant, d, ts)
  [N, B, A] = held (m, m.dead_time + latency, ts);
  lags = repmat (time_constant, 1, d);
  % Slow zeros of the left half plane become lags of the filter.
  for j = 1:rows (m.zeros)
    if (m.zeros(j,2) == 0 && m.zeros(j,1) >= ts)
      lags(end+1) = m.zeros(j,1);
    end
  end
  excess = numel (lags) - (m.integrators + sum (1 + (m.poles(:,2) != 0)));
  top = 1;
  den = 1;
  for tau = lags
    p = exp (-ts/tau);
    top *= 1 - p;
    den = conv (den, [1, -p]);
  end
  F = top;
  for j = 1:excess
    F = conv (F, [0.5, 0.5]);
  end
  num_u = gain * conv ([zeros(1, N), B], F) / sum (B);
  num_y = -gain * conv (A, F) / sum (B);
end

% The whole linear loop on recorded r and y, with its own output as the applied one: u(k) = pid(k) + u_f(k).
function u = closed_by_recursion (pid, num_u, num_y, den, y)
  fixed = filter (num_y, den, y);
  u = zeros (size (pid));
  w = zeros (size (pid));
  for k = 1:numel (pid)
    % w: the part of u_f that comes from u, by its difference equation.
    for j = 1:min (numel (num_u), k - 1)
      w(k) += num_u(j) * u(k-j);
    end
    for j = 2:min (numel (den), k)
      w(k) -= den(j) * w(k-j+1);
    end
    u(k) = pid(k) + fixed(k) + w(k);
  end
end

function close_to (name, got, wanted, tolerance)
  err = max (abs (got - wanted)) / max (abs (wanted));
  printf ("  %-58s %.1e\n", name, err);
  assert (max (abs (wanted)) > 0.1 && err <= tolerance, "%s: %g of the largest, allowed %g", name, err, tolerance);
end

function refused (word, varargin)
  try
    ctl_loop_mex (varargin{:});
  catch problem
    assert (! isempty (strfind (problem.message, word)), "'%s' does not say '%s'", problem.message, word);
    return
  end
  error ("'%s' was not refused", word);
end

function m = model (gain, poles, zeros_of, integrators, dead_time)
  m = struct ("gain", gain, "poles", poles, "zeros", zeros_of, "integrators", integrators, "dead_time", dead_time);
end

function config = with_model (config, m)
  config.model_gain = m.gain;
  config.model_dead_time = m.dead_time;
  config.model_integrators = m.integrators;
  if (rows (m.poles) > 0)
    config.model_pole_a1 = m.poles(:,1);
    config.model_pole_a2 = m.poles(:,2);
  end
  if (rows (m.zeros) > 0)
    config.model_zero_a1 = m.zeros(:,1);
    config.model_zero_a2 = m.zeros(:,2);
  end
end

samples = 2000;
rand ("twister", 6);
t = (0:samples-1)';
% Steps and noise from the first sample on: no coefficient is without effect.
r = 1 - 2*(mod (t, 700) >= 400) + 0.1*rand (samples, 1);
y = filter (0.1, [1, -0.9], r) + 0.05*(rand (samples, 1) - 0.5);
applied = filter (0.2, [1, -0.8], sin (t/40)) + 0.1*rand (samples, 1);
tolerance = 1e-12;

printf ("PID: u, integral term, filtered terms, to %g of the largest\n", tolerance);
sets = [
  % ts   kp    ki   kd    tf     b    c    rule
  0.1,   2,    1,   0.2,  0.05,  1,   0,   0;
  0.1,   2,    1,   0.2,  0.05,  1,   1,   1;
  0.01,  2.35, 1.88, 0.48, 0.119, 1,  1,   1;
  0.05,  0.8,  0.3, 0,    0,     0.6, 0,   0;
  0.05,  0.8,  0.3, 0,    0,     1.7, 0,   1;
  1,     -3,   -0.2, -5,  2.5,   0.3, 0.4, 0;
  0.02,  1.5,  0,   0.3,  0.01,  0.5, 2,   0];
for k = 1:rows (sets)
  s = num2cell (sets(k,:));
  p = struct ("kp", s{2}, "ki", s{3}, "kd", s{4}, "tf", s{5}, "b", s{6}, "c", s{7}, "integral_rule", s{8});
  config = p;
  config.ts = s{1};
  out = ctl_loop_mex (config, struct ("r", r, "y", y, "settle", [0, 0, 0]));
  [u, i, pd] = pid_by_filters (p, s{1}, r, y);
  name = sprintf ("kp %g ki %g kd %g tf %g ts %g rule %d", p.kp, p.ki, p.kd, p.tf, s{1}, p.integral_rule);
  close_to (name, out.u, u, tolerance);
  close_to ("", out.pd, pd, tolerance);
  if (p.ki != 0)
    close_to ("", out.i, i, tolerance);
  end
  if (p.ki != 0 && p.tf != 0)
    % The same by lsim, which simulates state spaces, and takes no static gain for one.
    by_lsim = @(system, in) lsim (ss (system), in, t*s{1});
    u = by_lsim (integral_of (p, s{1}), r - y) + by_lsim (path_of (p, s{1}, p.b, p.c), r) ...
        - by_lsim (path_of (p, s{1}, 1, 1), y);
    close_to ("", out.u, u, tolerance);
  end
end

none = zeros (0, 2);
ts = 0.1;
cases = {
  % name, model, latency, kind, gain, time constant, order asked for, d
  "estimator, second order, fraction of a sample", model(1.5, [1.2, 0.2], none, 0, 0.23), 0, 1, 0.69, 0.35, 0, 3;
  "estimator, first order, no delay", model(-0.8, [2, 0], none, 0, 0), 0, 1, 1, 0.4, 0, 3;
  "estimator, latency", model(1, [0.9, 0.4], none, 0, 0.2), 0.07, 1, 0.5, 0.25, 0, 3;
  "observer, first order, whole delay", model(1.98, [8, 0], none, 0, 0.3), 0, 2, 1, 0.5, 0, 1;
  "observer, two lags", model(1, [1, 0; 0.5, 0], none, 0, 0.25), 0, 2, 1, 0.3, 0, 2;
  "observer, complex pair", model(2, [0.8, 1], none, 0, 0.15), 0, 2, 1, 0.4, 0, 2;
  "observer, integrating", model(0.5, [0.4, 0], none, 1, 0.2), 0, 2, 1, 0.4, 0, 2;
  "observer, higher order asked for", model(1, [1, 0], none, 0, 0.12), 0, 2, 1, 0.3, 3, 3;
  "observer, slow zero", model(1, [2, 0; 0.5, 0], [0.6, 0], 0, 0.3), 0, 2, 1, 0.3, 0, 1;
  "observer, zero of the right half plane", model(1, [2, 0; 0.5, 0], [-0.3, 0], 0, 0.1), 0, 2, 1, 0.3, 0, 2};
printf ("compensators: u_f of recorded signals; u of the law on its own output\n");
for k = 1:rows (cases)
  [name, m, latency, kind, gain, constant, asked, d] = cases{k,:};
  sign_of = sign (m.gain);
  p = struct ("kp", 0.4*sign_of, "ki", 0.1*sign_of, "kd", 0.1*sign_of, "tf", 0.2, "b", 1, "c", 0, "integral_rule", 1);
  config = p;
  config.ts = ts;
  config.compensator = kind;
  config.latency = latency;
  % Recorded outputs are none that the law has asked for: nothing is to be taken back.
  config.anti_windup = 2;
  if (kind == 1)
    config.kfd = gain;
    config.tfd = constant;
  else
    config.alpha = constant;
    config.filter_order = asked;
  end
  config = with_model (config, m);
  out = ctl_loop_mex (config, struct ("r", r, "y", y, "u_applied", applied, "settle", [0, 0, 0]));
  u_f = compensator_by_filters (m, latency, gain, constant, d, ts, applied, y);
  pid = pid_by_filters (p, ts, r, y);
  close_to (name, out.u_f, u_f, tolerance);
  close_to ("", out.u, pid + u_f, tolerance);
  % With its own output: the loop through C_u amplifies rounding while it integrates what y shows.
  record = struct ("r", r(1:400), "y", y(1:400), "settle", [0, 0, 0]);
  out = ctl_loop_mex (config, record);
  [num_u, num_y, den] = pair (m, latency, gain, constant, d, ts);
  close_to ("", out.u, closed_by_recursion (pid(1:400), num_u, num_y, den, y(1:400)), tolerance);
  % In two halves, the memory handed on.
  half = @(part) struct ("r", r(part), "y", y(part));
  first = half (1:150);
  first.settle = [0, 0, 0];
  [one, block] = ctl_loop_mex (config, first);
  [two, block] = ctl_loop_mex ([], half (151:400), block);
  assert (isequal ([one.u; two.u], out.u), "%s: going on gives other bits", name);
end

config = struct ("ts", 0.1, "kp", 1, "ki", 0.5);
record = struct ("r", r, "y", y);
refused ("kp", setfield (config, "kp", NaN), record);
refused ("KP", setfield (config, "KP", 1), record);
refused ("action", setfield (config, "action", 0.5), record);
refused ("kp", setfield (config, "kp", [1, 2]), record);
refused ("needed", config, struct ("r", r));
refused ("as long", config, struct ("r", r, "y", y(1:10)));
refused ("as long", config, struct ("r", r, "y", []));
refused ("setpoint", config, struct ("r", r, "y", y, "setpoint", 1));
refused ("block", config, record, 17);
refused ("not initialised", [], record, zeros (200, 1, "uint64"));
refused ("model_pole_a1", setfield (config, "model_pole_a1", ones (1, 9)), record);
assert (numel (ctl_loop_mex (config, struct ("r", 1, "y", 0)).u) == 1);
bad = ctl_loop_mex (config, struct ("r", 1, "y", [0; NaN; Inf; 0]));
assert (isequal (bitand (bad.status, 32) != 0, [false; true; true; false]) && all (isfinite (bad.u)));
printf ("all agree\n");
