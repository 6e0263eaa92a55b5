// The runs: decoding of the data blocks, and thinning of histories to the points drawn.

function decode(text, Type) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Type(bytes.buffer);
}

function readRun(element, index, count) {
  const run = JSON.parse(element.textContent);
  run.name = count > 1 ? "AB"[index] : "";
  const h = run.history;
  const times = h.times
    ? decode(h.times, Float64Array)
    : Float64Array.from({ length: h.groups }, (_, i) => i * h.every * h.group);
  h.times = times;
  h.step = h.samples > 1 ? h.end / (h.samples - 1) : h.end; // mean interval of the samples
  for (const s of h.series) {
    s.low = decode(s.low, Float32Array);
    s.high = s.high ? decode(s.high, Float32Array) : s.low;
    s.min = s.low.reduce((a, b) => Math.min(a, b), Infinity);
    s.max = s.high.reduce((a, b) => Math.max(a, b), -Infinity);
  }
  for (const band of h.bands) {
    band.front = decode(band.front, Uint8Array);
    band.back = decode(band.back, Uint8Array);
  }
  for (const c of run.waterfall ? run.waterfall.channels : []) c.amplitude = decode(c.amplitude, Float32Array);
  for (const c of run.spectra ? run.spectra.channels : []) c.amplitude = decode(c.amplitude, Float32Array);
  return run;
}

const elements = [...document.querySelectorAll("script.run")];
const runs = elements.map((element, i) => readRun(element, i, elements.length));
const compared = runs.length > 1;
const duration = Math.max(...runs.map((run) => run.history.end));

/// First place with times[place] >= t.
function placeOf(times, t) {
  let low = 0,
    high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

/// Points of one curve between a and b: every sample if there are few, otherwise the lowest and the highest
/// of each of `columns` equal parts. A group of samples also gives two points.
function thinned(history, series, a, b, columns) {
  const { times, group } = history;
  const first = Math.max(0, placeOf(times, a) - 1),
    last = Math.min(times.length, placeOf(times, b) + 1);
  const x = [],
    y = [];
  let before = series.low[first];
  const both = (x0, x1, low, high) => {
    // The point nearer to the last one comes first, both near the ends, so that a steady rise is drawn
    // without steps.
    x.push(x0 + 0.02 * (x1 - x0), x0 + 0.98 * (x1 - x0));
    if (Math.abs(low - before) < Math.abs(high - before)) y.push(low, high);
    else y.push(high, low);
    before = y[y.length - 1];
  };
  if (last - first <= 2 * columns) {
    for (let i = first; i < last; ++i)
      if (group === 1) {
        x.push(times[i]);
        y.push(series.low[i]);
      } else {
        both(times[i], i + 1 < times.length ? times[i + 1] : history.end, series.low[i], series.high[i]);
      }
    return { x, y, whole: group === 1 };
  }
  for (let c = 0; c < columns; ++c) {
    const begin = first + Math.floor(((last - first) * c) / columns);
    const end = first + Math.floor(((last - first) * (c + 1)) / columns);
    let low = Infinity,
      high = -Infinity;
    for (let i = begin; i < end; ++i) {
      if (series.low[i] < low) low = series.low[i];
      if (series.high[i] > high) high = series.high[i];
    }
    both(times[begin], end < times.length ? times[end] : history.end, low, high);
  }
  return { x, y, whole: false };
}

/// Several curves as rows [x, y_1, y_2, ...]; null where a curve has no point.
function rowsOf(curves, factor) {
  if (curves.length === 1) return curves[0].x.map((x, i) => [x, curves[0].y[i] * factor]);
  const places = curves.map(() => 0),
    rows = [];
  for (;;) {
    const x = Math.min(...curves.map((curve, c) => curve.x[places[c]] ?? Infinity));
    if (x === Infinity) return rows;
    rows.push([
      x,
      ...curves.map((curve, c) => (curve.x[places[c]] === x ? curve.y[places[c]++] * factor : null)),
    ]);
  }
}

/// Channels of all runs by name, in the order of the first run: [{name, unit, energy, of: [{run, series}]}].
function commonChannels(pick) {
  const found = new Map();
  for (const run of runs)
    for (const series of pick(run)) {
      if (!found.has(series.name)) found.set(series.name, { ...series, of: [] });
      found.get(series.name).of.push({ run, series });
    }
  return [...found.values()];
}

/// The runs in which this part differs: all runs, or the first one if all are equal.
const distinct = (pick) =>
  compared && JSON.stringify(pick(runs[0])) !== JSON.stringify(pick(runs[1])) ? runs : runs.slice(0, 1);
