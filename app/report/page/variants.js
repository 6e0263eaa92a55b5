// The page of a study of many variants: statistics with their intervals, histograms, Sobol indices, scatter plots.

const page = JSON.parse(document.querySelector("script.run").textContent);
const result = page.result,
  points = page.points;
const PLOT = { width: 720, height: 230, left: 62, right: 14, top: 14, bottom: 34 };
const PARTS = 20; // number of parts of a parameter's range, each with a mean of the figure

/// Unit of a figure. A number without unit has no prefix either: "[m]" would be read as metres.
const unitOf = (figure, size) => (figure.unit ? readableUnit(figure.unit, size) : { factor: 1, unit: "1" });
const known = result.figures.filter((figure) => figure.count > 0);
const varies = (figure) => figure.max.value > figure.min.value;
const plusMinus = (value, error, unit) => `${quantity(value, unit, 5)} ± ${quantity(error, unit, 2)}`;
const variedText = (varied) =>
  Object.entries(varied)
    .map(([name, value]) => `${name} ${typeof value === "number" ? sig(value, 5) : value}`)
    .join(", ");

function showHead() {
  showTitle(page);
  const failed = result.study.variants - result.statuses.success;
  if (failed)
    byId("warnings").append(
      make("p", { class: "warning" }, `${integer(failed)} of ${integer(result.study.variants)} variants failed; figures are of the others.`),
    );
}

function showFigures() {
  const study = result.study;
  byId("figures").append(
    make(
      "p",
      {},
      `${integer(study.variants)} variants${study.sample ? `, drawn by ${study.sample}` : ": all combinations"} of `,
      make("code", {}, study.varied.join(" ")),
      study.correlations.length ? `, correlations ${study.correlations.join(" ")}` : "",
      `. Method: ${study.method}${study.step_s > 0 ? `, step ${quantity(study.step_s, "s")}` : ""}. `,
      study.sample
        ? "Mean ± half its 95 % interval, as of independent variants: too wide for a Latin hypercube and a Sobol sequence. " +
            (study.sample.startsWith("saltelli") ? "Mean, deviation and quantiles are of the independent variants, two of each block. " : "") +
            "In brackets: 95 % intervals of quantiles, by order statistics."
        : "A table of all combinations is no sample: its means and quantiles have no intervals.",
    ),
    table(
      ["figure", "mean", "standard deviation", "5 %", "median", "95 %", "least", "largest"],
      known.map((figure) => {
        const at = (part) => figure.quantiles.find((q) => q.part === part);
        const end = (value) => (value === null ? "?" : quantity(value, figure.unit, 3)); // beyond all values
        const part = (q) => quantity(q.value, figure.unit) + (q.low !== null || q.high !== null ? ` [${end(q.low)}, ${end(q.high)}]` : "");
        return [
          figure.name,
          figure.mean_error === null ? quantity(figure.mean, figure.unit, 5) : plusMinus(figure.mean, figure.mean_error, figure.unit),
          quantity(figure.deviation, figure.unit),
          part(at(0.05)),
          part(at(0.5)),
          part(at(0.95)),
          quantity(figure.min.value, figure.unit),
          quantity(figure.max.value, figure.unit),
        ];
      }),
    ),
  );
  if (known.some(varies))
    byId("figures").append(
      make("h3", {}, "Where they are least and largest"),
      table(
        ["figure", "", "value", "variant", "parameters"],
        known.filter(varies).flatMap((figure) => [
          [figure.name, "least", quantity(figure.min.value, figure.unit, 6), figure.min.variant, variedText(figure.min.varied)],
          [figure.name, "largest", quantity(figure.max.value, figure.unit, 6), figure.max.variant, variedText(figure.max.varied)],
        ]),
      ),
    );
  const warnings = result.warnings || []; // tables of older versions have none
  if (result.failures.length)
    byId("figures").append(
      make("h3", {}, "Failures"),
      table(
        ["variant", "status", "parameters", "reason"],
        result.failures.map((f) => [f.variant, f.status, variedText(f.varied), f.reason]),
      ),
    );
  if (warnings.length)
    byId("figures").append(
      make("h3", {}, "Warnings"),
      table(
        ["variant", "parameters", "warning"],
        warnings.map((w) => [w.variant, variedText(w.varied), w.warning]),
      ),
    );
}

/// An SVG with axes from x0 to x1, with the ticks given, and from 0 to y1; paint(x, y, parts) adds its
/// content.
function plot(label, [x0, x1], xTicks, y1, xLabel, paint) {
  const wide = PLOT.width - PLOT.left - PLOT.right,
    high = PLOT.height - PLOT.top - PLOT.bottom;
  const x = (value) => PLOT.left + (wide * (value - x0)) / (x1 - x0),
    y = (value) => PLOT.top + high * (1 - value / y1);
  const parts = [];
  for (const tick of niceTicks(0, y1, 4))
    parts.push(
      draw("line", { class: "axis", x1: PLOT.left, x2: PLOT.left + wide, y1: y(tick.v), y2: y(tick.v) }),
      draw("text", { class: "quiet", x: PLOT.left - 5, y: y(tick.v) + 4, "text-anchor": "end" }, tick.label),
    );
  for (const tick of xTicks)
    parts.push(draw("text", { class: "quiet", x: x(tick.v), y: PLOT.height - 20, "text-anchor": "middle" }, tick.label));
  paint(x, y, parts);
  parts.push(
    draw("text", { class: "quiet", x: PLOT.left + wide / 2, y: PLOT.height - 4, "text-anchor": "middle" }, xLabel),
  );
  return draw(
    "svg",
    { viewBox: `0 0 ${PLOT.width} ${PLOT.height}`, width: PLOT.width, class: "histogram", role: "img", "aria-label": label },
    ...parts,
  );
}

/// Histogram of the values of a figure, with mean and quantiles, and with their intervals as bands.
function histogram(figure) {
  const low = figure.min.value,
    high = figure.max.value,
    most = figure.histogram.reduce((a, b) => Math.max(a, b), 0);
  const readable = unitOf(figure, Math.max(Math.abs(low), Math.abs(high))),
    f = readable.factor,
    each = (high - low) / figure.histogram.length;
  const title = `distribution of ${figure.name}`;
  const picture = plot(title, [low * f, high * f], niceTicks(low * f, high * f, 8), most, `${figure.name} [${readable.unit}]`, (x, y, parts) => {
    figure.histogram.forEach((count, i) => {
      const from = x((low + i * each) * f);
      parts.push(
        draw(
          "rect",
          { class: "bar", x: from, width: Math.max(0.5, x((low + (i + 1) * each) * f) - from - 0.5), y: y(count), height: y(0) - y(count) },
          draw("title", {}, `${quantity(low + i * each, figure.unit)} to ${quantity(low + (i + 1) * each, figure.unit)}: ${integer(count)}`),
        ),
      );
    });
    const mark = (value, from, to, color, dash, name) => {
      if (from !== null && to !== null)
        parts.push(
          draw("rect", { x: x(from * f), width: Math.max(1, x(to * f) - x(from * f)), y: PLOT.top, height: y(0) - PLOT.top, style: `fill: var(${color}); fill-opacity: .25` }),
        );
      parts.push(
        draw(
          "line",
          { x1: x(value * f), x2: x(value * f), y1: PLOT.top, y2: y(0), style: `stroke: var(${color}); stroke-width: 1.6`, ...(dash ? { "stroke-dasharray": dash } : {}) },
          draw("title", {}, name),
        ),
      );
    };
    for (const q of figure.quantiles.filter(({ part }) => [0.05, 0.5, 0.95].includes(part)))
      mark(q.value, q.low, q.high, "--c1", "5 3", `${percent(q.part)}: ${quantity(q.value, figure.unit)}`);
    const e = figure.mean_error;
    mark(figure.mean, ...(e === null ? [null, null] : [figure.mean - e, figure.mean + e]), "--ink", null, `mean ${quantity(figure.mean, figure.unit, 5)}`);
  });
  return make(
    "figure",
    {},
    make(
      "figcaption",
      {},
      make("b", {}, figure.name),
      make("span", { class: "unit" }, ` ${integer(figure.count)} values in ${figure.histogram.length} equal parts `),
      make("span", { class: "together" }, keyMark("--ink"), "mean"),
      make("span", { class: "together" }, keyMark("--c1", [5, 3]), "5 %, median, 95 %"),
      figure.mean_error !== null ? make("span", { class: "unit" }, " bands: 95 % intervals") : null,
    ),
    picture,
  );
}

function showHistograms() {
  const same = known.filter((figure) => !varies(figure));
  byId("histograms").append(
    ...known.filter(varies).map(histogram),
    make(
      "p",
      { class: "note" },
      "Counts of all variants that have the figure. " +
        (same.length ? `The same in all variants: ${same.map((s) => `${s.name} ${quantity(s.mean, s.unit)}`).join("; ")}.` : ""),
    ),
  );
}

/// First-order and total indices of each parameter, with their intervals.
function indexPicture(figure) {
  const most = Math.max(1, ...figure.sobol.map((s) => s.total + s.total_error));
  const count = figure.sobol.length;
  const names = figure.sobol.map((s, i) => ({ v: i + 0.5, label: s.parameter }));
  return plot(`Sobol indices of ${figure.name}`, [0, count], names, most, "parameter: first order and total", (x, y, parts) => {
    figure.sobol.forEach((s, i) => {
      [
        ["first", "--c0"],
        ["total", "--c1"],
      ].forEach(([kind, color], k) => {
        const value = s[kind],
          error = s[`${kind}_error`],
          at = x(i + 0.32 + 0.36 * k),
          half = x(0.12) - x(0),
          clamp = (v) => y(Math.max(0, Math.min(most, v)));
        parts.push(
          draw("rect", { x: at - half, width: 2 * half, y: clamp(value), height: y(0) - clamp(value), style: `fill: var(${color})` },
            draw("title", {}, `${s.parameter}, ${kind}: ${sig(value, 3)} ± ${sig(error, 2)}`)),
          draw("line", { x1: at, x2: at, y1: clamp(value - error), y2: clamp(value + error), style: "stroke: var(--ink); stroke-width: 1.4" }),
        );
      });
    });
  });
}

function showSensitivity() {
  const section = byId("sensitivity"),
    with_indices = known.filter((figure) => figure.sobol.length);
  if (!with_indices.length)
    return section.append(
      make("p", {}, "There are none: they need a sample made for them, --sample saltelli:N, and figures that vary."),
      make("p", { class: "note" }, "First order: the part of a figure's variance that one parameter brings about by itself; total: with all its interactions."),
    );
  section.append(
    make(
      "p",
      {},
      "First order: the part of the figure's variance that one parameter brings about by itself; total: with all its interactions. " +
        "Estimates of Saltelli and others (2010); 95 % intervals by the jackknife.",
    ),
  );
  for (const figure of with_indices)
    section.append(
      make(
        "figure",
        {},
        make(
          "figcaption",
          {},
          make("b", {}, figure.name),
          make("span", { class: "together" }, keyMark("--c0"), "first order"),
          make("span", { class: "together" }, keyMark("--c1"), "total"),
        ),
        indexPicture(figure),
      ),
      table(
        ["parameter", "first order", "± (95 %)", "total", "± (95 %)"],
        figure.sobol.map((s) => [s.parameter, sig(s.first, 3), sig(s.first_error, 2), sig(s.total, 3), sig(s.total_error, 2)]),
      ),
    );
}

/// A figure over a parameter: a point for each variant, and the mean over parts of the range.
function scatter(parent, group, parameter, figure, values) {
  const readable = unitOf(figure, Math.max(Math.abs(figure.min.value), Math.abs(figure.max.value)));
  const pairs = parameter.values
    .map((x, i) => [x, values[i] === null ? null : values[i] * readable.factor])
    .filter(([x, y]) => x !== null && y !== null)
    .sort((a, b) => a[0] - b[0]);
  const [low, high] = group.span,
    parts = parameter.names ? parameter.names.length : PARTS;
  const partOf = (x) => (parameter.names ? x - 1 : Math.min(parts - 1, Math.floor((parts * (x - low)) / (high - low))));
  const sums = Array.from({ length: parts }, () => ({ n: 0, x: 0, y: 0 }));
  for (const [x, y] of pairs) {
    const sum = sums[partOf(x)];
    sum.n += 1;
    sum.x += x;
    sum.y += y;
  }
  const rows = [
    ...pairs.map(([x, y]) => [x, y, null]),
    ...sums.filter(({ n }) => n > 1).map(({ n, x, y }) => [x / n, null, y / n]),
  ].sort((a, b) => a[0] - b[0]);
  const chart = new Chart(parent, {
    group,
    title: `${figure.name} over ${parameter.name}`,
    savedTitle: `${page.model_name}: ${figure.name} [${readable.unit}] over ${parameter.name}`,
    middle: true,
    xName: parameter.name,
    xLabel: parameter.name,
    yLabel: readable.unit,
    labels: ["variant", "mean of a part of the range"],
    colors: () => [style("--c0"), style("--c1")],
    series: (_, i) =>
      i === 0 ? { strokeWidth: 0, drawPoints: true, pointSize: 1.8, strokePattern: null } : { strokeWidth: 2, strokePattern: null },
    caption: make(
      "span",
      {},
      make("b", {}, figure.name),
      make("span", { class: "unit" }, ` [${readable.unit}] over ${parameter.name} `),
      make("span", { class: "together" }, keyMark("--c1"), parameter.names ? "mean" : `mean of 1/${PARTS} of the range`),
    ),
    rows: () => ({ sparse: true, rows }),
  });
  chart.scatter = { figure: figure.name, parameter: parameter.name };
}

function showScatter() {
  const section = byId("scatter");
  section.append(
    make(
      "p",
      { class: "note" },
      (points.count < points.of
        ? `${integer(points.count)} of ${integer(points.of)} variants, chosen by chance. `
        : "A point a variant. ") +
        "The line, the mean of the figure over parts of the parameter's range, shows the first order of its effect. Drag to zoom, double click for all of it.",
    ),
  );
  for (const parameter of points.parameters) {
    section.append(make("h3", {}, parameter.name));
    const numbers = parameter.values.filter((x) => x !== null);
    if (!numbers.length) {
      section.append(make("p", { class: "note" }, "Texts of more than 12 values have no axis; the table has them."));
      continue;
    }
    if (parameter.names)
      section.append(make("p", { class: "note" }, parameter.names.map((name, i) => `${i + 1}: ${name}`).join(", ")));
    const low = numbers.reduce((a, b) => Math.min(a, b)),
      high = numbers.reduce((a, b) => Math.max(a, b));
    const wide = high > low ? high - low : Math.abs(low) || 1;
    const group = new Group([low - 0.03 * wide, high + 0.03 * wide], ([from, to]) => {
      group.output.textContent = `${sig(from)} to ${sig(to)}`;
    });
    group.span = [low, low + wide];
    section.append(toolbar(group));
    points.figures.forEach((column) => {
      const figure = known.find(({ name }) => name === column.name);
      if (figure && varies(figure)) scatter(section, group, parameter, figure, column.values);
    });
    group.describe(group.window);
  }
}

function showTrain() {
  byId("model").append(trainFigure(page.model));
}

showAll(showHead, showFigures, showHistograms, showSensitivity, showScatter, showTrain, () => showInputTable(page));
