% Reads results/camshaft as docs/results.md shows it; arguments: the directory and a channel.
arguments = argv();
directory = arguments{end - 1};
channel = arguments{end};

% [csv]
file = fopen([directory '/history.csv']);
names = strsplit(fgetl(file), ',');  % time_s, then the channels with their units
fclose(file);
history = dlmread([directory '/history.csv'], ',', 1, 0);
values = history(:, strcmp(names, channel));
summary = jsondecode(fileread([directory '/summary.json']));
fprintf('%s %.6g\n', summary.status, max(abs(values)));
% [csv]

assert(size(history, 2) == numel(names));
h5 = load([directory '/history.h5']);  % in MATLAB: h5read(file, ['/' channel])
assert(isequal(h5.time_s(:), history(:, 1)));
assert(isequal(h5.(strrep(strrep(channel, '.', '_'), '-', '_'))(:), values));
