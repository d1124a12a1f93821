% The output of a PI with a rate limit for a recorded measurement: what the loop would have done.
config = struct ("ts", 0.1, "kp", 2, "ki", 1, "output_lo", 0, "output_hi", 3, "output_rate_up", 4);
t = (0:0.1:5)';
record = struct ("r", t >= 0.5, "y", 1 - exp (-max (t - 0.7, 0)));
out = ctl_loop_mex (config, record);
for k = 1:5:numel (t)
  printf ("%4.1f s  y %6.3f  u %6.3f  integral %6.3f  status %d\n", t(k), record.y(k), out.u(k), out.i(k), out.status(k));
end
