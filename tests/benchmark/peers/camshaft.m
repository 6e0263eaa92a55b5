% The camshaft as S. L. Sunde's program TimeStepping (Mechanical analysis of camshaft system on a marine
% engine, NTNU, 2015, appendix A.2.1) steps it: dense matrices, Newmark with beta = 1/4 and gamma = 1/2, full
% Newton whose matrix is made and factored in each iteration, tables entered by interp1.
%
%   octave-cli camshaft.m FOLDER interp1|direct each|all STEP DURATION
%
% FOLDER as peer_files.hpp writes it. direct: interp1 replaced by a look-up in the evenly spaced table. each:
% cam by cam, as the source does; all: all cams of a kind in one call, which the source could have done.
% Prints: processor time of the loop [s], steps, then the free end's angle after each step [rad].
1;

function torque = loads(model, theta, u, direct)
  torque = zeros(size(u));
  for k = 1:numel(model.cams)  % one for each cam, or each kind
    cam = model.cams(k);
    angle = mod(theta + cam.phase + u(cam.at), 2*pi);
    if direct
      x = angle*model.per_radian;
      j = floor(x);
      torque(cam.at) = cam.torque(j + 1) + (x - j).*(cam.torque(j + 2) - cam.torque(j + 1));
    else
      torque(cam.at) = interp1(model.angles, cam.torque, angle, 'linear');
    end
  end
end

% Forces of the gear meshes and their tangent.
function [f, K] = contacts(model, u, K)
  f = zeros(size(u));
  for k = 1:rows(model.meshes)
    stiffness = model.meshes(k, 1);
    gap = model.meshes(k, 2);
    arms = model.meshes(k, 3:end)';
    x = arms'*u;
    if x > gap
      delta = x - gap;
    elseif x < -gap
      delta = x + gap;
    else
      continue
    end
    f = f + arms*(stiffness*delta);
    K = K + stiffness*(arms*arms');
  end
end

folder = argv(){1};
direct = strcmp(argv(){2}, 'direct');
each = strcmp(argv(){3}, 'each');
h = str2double(argv(){4});
steps = round(str2double(argv(){5})/h);
model.meshes = [];
for name = {'M', 'C', 'K', 'tables', 'loads', 'meshes', 'run'}
  file = [folder '/' name{1} '.txt'];
  if exist(file, 'file')
    model.(name{1}) = load(file);
  end
end
cams = {};
for k = 1:columns(model.tables)
  mine = model.loads(model.loads(:, 2) == k, :);
  torque = model.tables([1:end 1], k);
  if each
    for c = 1:rows(mine)
      cams{end + 1} = struct('at', mine(c, 1), 'phase', mine(c, 3), 'torque', torque);
    end
  else
    cams{end + 1} = struct('at', mine(:, 1), 'phase', mine(:, 3), 'torque', torque);
  end
end
model.cams = [cams{:}];
knots = rows(model.tables);
model.angles = linspace(0, 2*pi, knots + 1)';
model.per_radian = knots/(2*pi);
omega = model.run(1);
M = model.M; C = model.C; K = model.K;
n = rows(M);
beta = 1/4; gamma = 1/2;
tolerance = 1e-3;  % N m
most = 50;

started = cputime();
u = zeros(n, steps + 1); ud = u; udd = u; T = u;
T(:, 1) = loads(model, 0, u(:, 1), direct);
udd(:, 1) = M\T(:, 1);
for i = 1:steps
  theta = omega*i*h;
  ud(:, i+1) = ud(:, i) + (1-gamma)*h*udd(:, i);
  u(:, i+1) = u(:, i) + h*ud(:, i) + (0.5-beta)*h*h*udd(:, i);
  udd(:, i+1) = 0;
  T(:, i+1) = loads(model, theta, u(:, i+1), direct);
  [f, K_t] = contacts(model, u(:, i+1), K);
  r = M*udd(:, i+1) + K*u(:, i+1) + C*ud(:, i+1) + f - T(:, i+1);
  j = 0;
  while max(abs(r)) > tolerance && j < most
    J = K_t + gamma/(beta*h)*C + 1/(beta*h*h)*M;
    du = J\-r;
    u(:, i+1) = u(:, i+1) + du;
    ud(:, i+1) = ud(:, i+1) + gamma/(beta*h)*du;
    udd(:, i+1) = udd(:, i+1) + 1/(beta*h*h)*du;
    T(:, i+1) = loads(model, theta, u(:, i+1), direct);
    [f, K_t] = contacts(model, u(:, i+1), K);
    r = M*udd(:, i+1) + K*u(:, i+1) + C*ud(:, i+1) + f - T(:, i+1);
    j = j + 1;
  end
  if j == most
    error('step %d does not converge', i);
  end
end
printf('%.6f %d\n', cputime() - started, steps);
printf('%.16g\n', u(model.run(2), 2:end));
