% Octave's ode15s on one impact of the work-precision report; called by solve.py:
%
%     octave-cli ode15s.m PROBLEM TOLERANCE END EXACT
%
% PROBLEM is a file of `work-precision export`, END the time to follow (s), EXACT 1 to take free flight in closed form.
% Prints the striker's speed over that of the impact, contact times (s), impulses (N s), right-hand sides and seconds.
%
% It is tuned as well as it allows: analytic Jacobian (sparse in free flight), its own Events, tolerances in the scale of each
% unknown, a consistent initial slope (with the default it often fails to start), a first step that resolves the touch.
% It locates an event by linear interpolation of its last step (error of the square of the step, 1e-7 of the time at a
% tolerance of 1e-9), so the event is located again on the cubic through the states and slopes at the two ends of the step.
1;

function p = read_impact(path)
  words = strsplit(strtrim(fileread(path)));
  value = @(key) str2double(words{find(strcmp(words, key), 1) + 1});
  p.mass = value("mass_kg");
  p.speed = value("speed_m_s");
  at = find(strcmp(words, "law"), 1);
  p.law = words{at + 1};
  p.parameters = str2double(words(at + 2 : at + 6));
  at = find(strcmp(words, "modes"), 1);
  modes = reshape(str2double(words(at + 2 : end)), 3, [])';
  p.omega = modes(:, 1);
  p.zeta = modes(:, 2);
  p.phi = modes(:, 3);
  p.n = rows(modes);
  p.stiffness = p.omega .^ 2;
  p.damping = 2 * p.zeta .* p.omega;
  % compression and its rate are products with the state [z, z', a, a']
  p.seen = [-1, 0, p.phi', zeros(1, p.n); 0, -1, zeros(1, p.n), p.phi'];
  p.pushed = [0; 1 / p.mass; zeros(p.n, 1); -p.phi];
  n = p.n;
  p.free = sparse([1, 3 : n + 2, n + 3 : 2 * n + 2, n + 3 : 2 * n + 2], ...
                  [2, n + 3 : 2 * n + 2, 3 : n + 2, n + 3 : 2 * n + 2], ...
                  [1, ones(1, n), -p.stiffness', -p.damping'], 2 * n + 2, 2 * n + 2);
endfunction

% Force, and its derivatives with respect to compression and rate, on one smooth branch of the law.
function [force, by_xi, by_rate] = contact_force(p, phase, xi, rate)
  force = by_xi = by_rate = 0;
  if (strcmp(phase.kind, "flight") || xi <= 0)
    return;
  endif
  k = p.parameters;
  hertz = k(1) * xi * sqrt(xi);
  slope = 1.5 * k(1) * sqrt(xi);
  switch (p.law)
    case "hertz"
      [force, by_xi] = deal(hertz, slope);
    case "viscous"
      factor = 1 + k(2) * rate;
      if (factor > 0)
        [force, by_xi, by_rate] = deal(hertz * factor, slope * factor, hertz * k(2));
      endif
    case "hysteretic"
      [theta, by_theta] = hysteresis(p, phase, xi);
      force = hertz * (1 + theta);
      by_xi = slope * (1 + theta) + hertz * by_theta;
  endswitch
endfunction

function [theta, slope] = hysteresis(p, phase, xi)
  [~, middle, half, rate, eps_m] = num2cell(p.parameters){:};
  if (strcmp(phase.kind, "loading"))
    goal = middle + half;
    share = ((phase.anchor + eps_m) / (xi + eps_m)) ^ rate;
    slope = -rate / (xi + eps_m);
  else
    goal = middle - half;
    share = ((xi + eps_m) / (phase.anchor + eps_m)) ^ rate;
    slope = rate / (xi + eps_m);
  endif
  theta = goal + (phase.theta - goal) * share;
  slope *= theta - goal;
endfunction

function dy = rates(p, phase, y)
  global evaluations;
  evaluations += 1;
  seen = p.seen * y;
  dy = p.free * y + p.pushed * contact_force(p, phase, seen(1), seen(2));
endfunction

function j = jacobian(p, phase, y)
  j = p.free;
  if (! strcmp(phase.kind, "flight"))
    seen = p.seen * y;
    [~, by_xi, by_rate] = contact_force(p, phase, seen(1), seen(2));
    j = full(j) + p.pushed * ([by_xi, by_rate] * p.seen);
  endif
endfunction

% How far the phase is from its ends, positive inside; linear in the state.
function rows = margin_rows(p, phase)
  switch (phase.kind)
    case "flight"
      rows = -p.seen(1, :);
    case "single"
      rows = p.seen(1, :);
    case "loading"
      rows = p.seen(2, :);
    case "unloading"
      rows = [p.seen(1, :); -p.seen(2, :)];
  endswitch
endfunction

function [t, y, which] = advance(p, phase, t, y, finish, tolerance)
  lines = margin_rows(p, phase);
  offset = min(lines * y, 0);
  count = rows(lines);
  modal = p.speed * sqrt(p.mass);
  scales = [p.speed * 1e-4; p.speed; modal * min(1 ./ p.omega, 1e-4); modal * ones(p.n, 1)];
  options = odeset("RelTol", 1e-14, "AbsTol", tolerance * scales, "InitialSlope", rates(p, phase, y), ...
                   "Jacobian", @(t, y) jacobian(p, phase, y), ...
                   "Events", @(t, y) deal(lines * y - offset, ones(count, 1), -ones(count, 1)));
  if (! strcmp(phase.kind, "flight"))
    options = odeset(options, "InitialStep", min(3e-5 * tolerance ^ 0.4, 0.5 * (finish - t)));
  endif
  [times, states, te, ~, ie] = ode15s(@(t, y) rates(p, phase, y), [0, finish - t], y, options);
  if (isempty(te))
    t = finish;
    y = states(end, :)';
    which = 0;
    return;
  endif
  which = ie(end);
  % the last step goes beyond the event: the cubic through its ends
  h = times(end) - times(end - 1);
  [a, b] = deal(states(end - 1, :)', states(end, :)');
  [da, db] = deal(h * rates(p, phase, a), h * rates(p, phase, b));
  cubic = @(s) (1 + 2 * s) * (1 - s) ^ 2 * a + s * (1 - s) ^ 2 * da + s ^ 2 * (3 - 2 * s) * b - s ^ 2 * (1 - s) * db;
  margin = @(s) lines(which, :) * cubic(s) - offset(which);
  low = 0;
  high = 1;
  for i = 1 : 60
    middle = 0.5 * (low + high);
    if (margin(middle) > 0)
      low = middle;
    else
      high = middle;
    endif
  endfor
  t += times(end - 1) + high * h;
  y = cubic(high);
endfunction

% Free flight in closed form, with the same certified search as in Rust.
function [t, y, which] = fly(p, t, y, finish)
  n = p.n;
  a = 3 : n + 2;
  b = n + 3 : 2 * n + 2;
  reach = abs(p.phi) .* hypot(y(a), y(b) ./ p.omega);
  above = [flipud(cumsum(flipud(reach))); 0];
  bend = [0; cumsum((1 + 2 * p.zeta) .* p.stiffness .* reach)];
  damped = p.omega .* sqrt(1 - p.zeta .^ 2);
  fastest = max(p.omega);
  while (true)
    gaps = y(1) - [0; cumsum(p.phi .* y(a))];
    opens = y(2) - [0; cumsum(p.phi .* y(b))];
    which = 1;
    if (gaps(end) <= 0 && opens(end) < 0)
      return;
    endif
    clear_by = gaps - above;
    valid = clear_by > 0 | (clear_by == 0 & opens > 0);
    times = (opens + sqrt(max(opens .^ 2 + 2 * bend .* clear_by, 0))) ./ bend;
    times(isnan(times)) = Inf;
    times(! valid) = 0;
    step = max(times);
    if (step * fastest < 0.02)
      if (opens(end) < 0)
        step = -gaps(end) / opens(end);
      else
        step = max(step, 1e-4 / fastest);
      endif
      if (step <= 1e-15 * max(t, 1 / fastest))
        return;
      endif
    endif
    last = t + step >= finish;
    if (last)
      step = finish - t;
    endif
    [s, c, e] = deal(sin(damped * step), cos(damped * step), exp(-p.zeta .* p.omega * step));
    q = (y(b) + p.zeta .* p.omega .* y(a)) ./ damped;
    y(1) += y(2) * step;
    [y(a), y(b)] = deal(e .* (y(a) .* c + q .* s), e .* (y(b) .* c - (p.zeta .* p.omega .* q + damped .* y(a)) .* s));
    t += step;
    if (last)
      which = 0;
      return;
    endif
  endwhile
endfunction

function [restitution, times, impulses] = follow(p, exact, finish, tolerance)
  y = zeros(2 * p.n + 2, 1);
  y(2) = touch = -p.speed;
  [t, times, impulses] = deal(0, 0, []);
  theta = p.parameters(2) + p.parameters(3);
  start = struct("kind", "single", "anchor", 0, "theta", theta);
  if (strcmp(p.law, "hysteretic"))
    start.kind = "loading";
  endif
  phase = start;
  for events = 1 : 2000
    if (exact && strcmp(phase.kind, "flight"))
      [t, y, which] = fly(p, t, y, finish);
    else
      [t, y, which] = advance(p, phase, t, y, finish, tolerance);
    endif
    if (which == 0)
      if (! strcmp(phase.kind, "flight"))
        impulses(end + 1) = p.mass * (y(2) - touch);
      endif
      restitution = y(2) / p.speed;
      return;
    endif
    xi = max(p.seen(1, :) * y, 0);
    if (strcmp(phase.kind, "flight"))
      times(end + 1) = t;
      touch = y(2);
      phase = start;
    elseif (strcmp(phase.kind, "loading") || which == 2)
      other = {"loading", "unloading"}{1 + strcmp(phase.kind, "loading")};
      phase = struct("kind", other, "anchor", xi, "theta", hysteresis(p, phase, xi));
    else
      times(end + 1) = t;
      impulses(end + 1) = p.mass * (y(2) - touch);
      phase = struct("kind", "flight");
    endif
  endfor
  error("more than 2000 events");
endfunction

global evaluations = 0;
[path, tolerance, finish, exact] = argv(){end - 3 : end};
p = read_impact(path);
[tolerance, finish, exact] = deal(str2double(tolerance), str2double(finish), str2double(exact));
try
  % files are read before the clock runs
  [~, ~] = ode15s(@(t, y) -y, [0, 1], 1, odeset("InitialSlope", -1));
  tic;
  [restitution, times, impulses] = follow(p, exact, finish, tolerance);
  seconds = toc;
  printf("restitution %.17g\ntimes %s\nimpulses %s\nevaluations %d\nseconds %.9g\n", restitution, ...
         sprintf("%.17g ", times), sprintf("%.17g ", impulses), evaluations, seconds);
catch failure
  printf("failure %s\n", strsplit(failure.message, "\n"){1});
end_try_catch
