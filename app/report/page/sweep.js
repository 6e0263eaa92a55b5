// The page of a sweep: amplitudes over speed by order and in sum, critical speeds, Campbell diagram.

const decode = (text) => {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Float32Array(bytes.buffer);
};

const page = JSON.parse(document.querySelector("script.run").textContent);
for (const sweep of page.sweeps)
  for (const s of sweep.sections)
    for (const key of ["half_range", "maximum", "minimum", "mean", "heat", "amplitude"]) s[key] = decode(s[key]);
for (const s of page.sweeps[0].sections) for (const limit of s.limits) limit.values = decode(limit.values);
const sweep = page.sweeps[0];
const span = [sweep.speeds_rpm[0], sweep.speeds_rpm.at(-1)];
// A single speed is widened to a range, which a chart needs.
const whole = span[0] < span[1] ? span : [0.99 * span[0], 1.01 * span[1]];
const speedOf = page.shaft === "reference shaft" ? "of the reference shaft" : `of ${page.shaft}, the reference shaft`;
const speedAxis = `speed of ${page.shaft} [rpm]`;
const NAMED_ORDERS = 5;
const TINTS = ["--c0", "--c2", "--c4", "--quiet"]; // none of them the limits'

/// Amplitudes of an order over the speeds.
const orderOf = (s, k) => s.amplitude.subarray(k * sweep.speeds_rpm.length, (k + 1) * sweep.speeds_rpm.length);

/// The orders with the largest amplitudes at the speeds and the criticals, largest first.
const chiefOrders = (s) =>
  sweep.orders
    .map((order, k) => {
      const between = s.criticals.filter((c) => c.order === order);
      return { order, k, most: Math.max(largest(orderOf(s, k)), ...between.map((c) => c.amplitude)) };
    })
    .filter(({ most }) => most > 0)
    .sort((a, b) => b.most - a.most)
    .slice(0, NAMED_ORDERS);

function showHead() {
  showTitle(page);
  for (const note of page.notes) byId("warnings").append(make("p", { class: "warning" }, note));
}

function showFigures() {
  byId("figures").append(
    make(
      "p",
      {},
      `${sweep.orders.length} orders ${sig(sweep.orders[0])} to ${sig(sweep.orders.at(-1))}, ` +
        `${sweep.speeds_rpm.length} speeds ${sig(span[0])} to ${sig(span[1])} rpm ${speedOf}` +
        `${page.contact ? `, contacts ${page.contact}` : ""}. Half range: (maximum − minimum)/2 of the sum of ` +
        "all orders with their phases over the whole cycle.",
    ),
    table(
      ["section", "largest half range", "at [rpm]", "largest mean", "chief orders", "largest heat [W]"],
      sweep.sections.map((s) => [
        s.name,
        s.unbounded ? "unbounded" : quantity(s.peaks[0].half_range, s.unit),
        sig(s.peaks[0].speed_rpm, 5),
        quantity(
          s.mean.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0),
          s.unit,
        ),
        chiefOrders(s)
          .slice(0, 3)
          .map(({ order }) => orderText(order))
          .join(", "),
        s.largest_heat === null ? "–" : sig(s.largest_heat),
      ]),
    ),
  );
  const order = [...sweep.criticals].sort((a, b) => (b.own_amplitude ?? Infinity) - (a.own_amplitude ?? Infinity));
  byId("figures").append(make("h3", {}, "Critical speeds, largest amplitude of their own mode first"));
  if (page.criticals_note) byId("figures").append(make("p", {}, page.criticals_note));
  if (!order.length) {
    if (page.campbell || !page.criticals_note)
      byId("figures").append(
        make("p", {}, "No order that the loads hold meets a natural frequency within the speeds."),
      );
    return;
  }
  byId("figures").append(
    table(
      ["speed [rpm]", "order", "mode", "frequency [Hz]", "damping ratio", "amplitude", "of the mode", "half range", "in"],
      order
        .slice(0, 30)
        .map((c) => [
          sig(c.speed_rpm, 6),
          orderText(c.order),
          c.mode,
          sig(c.frequency_Hz, 5),
          sig(c.damping_ratio, 3),
          c.amplitude === null ? "unbounded" : sig(c.amplitude, 5),
          c.own_amplitude === null ? "unbounded" : sig(c.own_amplitude, 5),
          c.half_range === null ? (c.amplitude === null ? "unbounded" : "–") : sig(c.half_range, 5),
          c.section,
        ]),
    ),
  );
  if (order.length > 30)
    byId("figures").append(make("p", { class: "note" }, `The 30 largest of ${order.length}.`));
}

function showTrain() {
  byId("model").append(trainFigure(page.model));
}

/// Amplitudes of one section over the speed.
function sectionChart(parent, group, s, index) {
  const chief = chiefOrders(s),
    readable = readableUnit(s.unit, largest(s.half_range)),
    most = Math.max(largest(s.half_range), s.peaks[0].half_range ?? 0) * readable.factor;
  const others = page.sweeps.slice(1).map((other) => ({ name: other.name, s: other.sections[index] }));
  const { limits, farAbove } = limitsOf(s.limits, most / readable.factor, s.unit);
  const curves = [
    { label: "half range", values: s.half_range, color: "--ink", look: { strokeWidth: 2, strokePattern: null } },
    ...others.map(({ name, s: other }) => ({
      label: `half range, ${name}`,
      values: other.half_range,
      color: "--quiet",
      look: { strokeWidth: 1.6, strokePattern: [7, 3] },
    })),
    ...limits.map((limit, i) => ({
      label: limit.name,
      values: limit.values,
      color: "--warn",
      look: { strokeWidth: 1.6, strokePattern: [[8, 4], [2, 3], [9, 3, 2, 3]][i % 3] },
    })),
    ...chief.map(({ order, k }, i) => ({
      order,
      label: `order ${orderText(order)}`,
      values: orderOf(s, k),
      color: TINTS[i % TINTS.length],
      look: { strokeWidth: 1.2, strokePattern: DASHES[i % DASHES.length] },
    })),
  ];
  const key = ({ label, color, look }) =>
    make("span", { class: "together" }, keyMark(color, look.strokePattern), label);
  const chart = new Chart(parent, {
    group,
    title: `${s.name} over speed`,
    savedTitle: `${page.model_name}: ${s.name} [${readable.unit}]`,
    middle: true,
    xName: "rpm",
    xLabel: speedAxis,
    yLabel: readable.unit,
    labels: curves.map(({ label }) => label),
    colors: () => curves.map(({ color }) => style(color)),
    series: (_, i) => curves[i].look,
    caption: make(
      "span",
      {},
      make("b", {}, s.name),
      make("span", { class: "unit" }, ` [${readable.unit}] `),
      curves.map(key),
      farAbove,
    ),
    rows: () => {
      const rows = new Map();
      for (const [i, speed] of sweep.speeds_rpm.entries())
        rows.set(speed, [
          speed,
          ...curves.map(({ values }) => (Number.isFinite(values[i]) ? values[i] * readable.factor : null)),
        ]);
      // Between the speeds the half range is known at its peaks, an order at its criticals.
      const put = (speed, column, value) => {
        if (sweep.speeds_rpm.includes(speed) || value === null || column === 0) return;
        if (!rows.has(speed)) rows.set(speed, [speed, ...curves.map(() => null)]);
        rows.get(speed)[column] = value * readable.factor;
      };
      for (const peak of s.peaks) put(peak.speed_rpm, 1, peak.half_range);
      for (const c of sweep.criticals) if (c.section === s.name) put(c.speed_rpm, 1, c.half_range);
      for (const c of s.criticals)
        put(c.speed_rpm, 1 + curves.findIndex(({ order }) => order === c.order), c.amplitude);
      return { sparse: true, rows: [...rows.values()].sort((a, b) => a[0] - b[0]) };
    },
    underlay: (context, area, g) => {
      const text = new Labels(context, area);
      const inThis = s.criticals.filter((c) => c.of_mode);
      for (const c of inThis.sort((a, b) => (b.amplitude ?? Infinity) - (a.amplitude ?? Infinity)).slice(0, 6)) {
        const x = g.toDomXCoord(c.speed_rpm);
        if (x < area.x || x > area.x + area.w) continue;
        line(context, x, area.y, x, area.y + area.h, style("--line"), [2, 3]);
        text.put(`order ${orderText(c.order)}, mode ${c.mode}`, x + 3, area.y + 12, style("--quiet"));
      }
    },
  });
  chart.section = s.name;
}

function showCharts() {
  const section = byId("speeds"),
    group = new Group(whole, ([from, to]) => {
      group.output.textContent = `${sig(from)} to ${sig(to)} rpm`;
    });
  section.append(
    make(
      "p",
      { class: "note" },
      `Half range and the ${NAMED_ORDERS} largest orders of each section. Dotted: its largest criticals. ` +
        "Drag to zoom, double click for all of it.",
    ),
    toolbar(group),
  );
  sweep.sections.forEach((s, i) => sectionChart(section, group, s, i));
  group.describe(group.window);
}

/// Amplitude of every order of a section at a speed, as bars.
function showBars() {
  const section = byId("orders"),
    holder = make("div", {});
  const which = make(
    "select",
    { "aria-label": "Section", change: () => show(null) },
    sweep.sections.map((s, i) => make("option", { value: i }, s.name)),
  );
  const at = make("input", {
    type: "range",
    min: 0,
    max: sweep.speeds_rpm.length - 1,
    "aria-label": "Speed",
    input: () => show(Number(at.value)),
  });
  const told = make("output", {});
  const show = (index) => {
    const s = sweep.sections[Number(which.value)];
    const i = index ?? s.half_range.indexOf(largest(s.half_range));
    at.value = i;
    told.textContent = `${sig(sweep.speeds_rpm[i], 5)} rpm, half range ${quantity(s.half_range[i], s.unit)}`;
    const values = sweep.orders.map((_, k) => orderOf(s, k)[i]);
    holder.replaceChildren(barChart(`${s.name} at ${sig(sweep.speeds_rpm[i], 5)} rpm`, s.unit, sweep.orders, values));
  };
  section.append(make("div", { class: "toolbar" }, make("label", {}, "Section ", which), at, told), holder);
  show(null);
}

function showDiagram() {
  const section = byId("campbell"),
    c = page.campbell;
  if (!c || !c.modes.length) {
    section.append(make("p", {}, page.criticals_note || "There are no elastic modes."));
    return;
  }
  // Not a number where the mode is overdamped: a gap in its line.
  const modeAt = (m, speed) => {
    const xs = c.mode_speeds_rpm,
      ys = m.frequency_Hz.map((y) => y ?? NaN);
    let k = 0;
    while (k + 2 < xs.length && xs[k + 1] < speed) ++k;
    if (xs.length < 2) return ys[0];
    const part = Math.min(1, Math.max(0, (speed - xs[k]) / (xs[k + 1] - xs[k])));
    return part === 0 ? ys[k] : part === 1 ? ys[k + 1] : ys[k] + part * (ys[k + 1] - ys[k]);
  };
  const met = [...new Set(sweep.criticals.map((x) => x.order))].sort((a, b) => a - b);
  const biggest = (order) =>
    Math.max(...sweep.criticals.filter((x) => x.order === order).map((x) => x.own_amplitude ?? Infinity));
  const shown = [...met].sort((a, b) => biggest(b) - biggest(a)).slice(0, 10).sort((a, b) => a - b);
  const group = new Group([0, 1.05 * whole[1]], () => {});
  const end = 1.05 * whole[1];
  const frequencies = c.modes.map((m) => modeAt(m, whole[1]) || Math.max(...m.frequency_Hz));
  // Up to the highest critical; without any, the first modes, which are all that there is to see.
  const heights = sweep.criticals.length ? sweep.criticals.map((x) => x.frequency_Hz) : frequencies.slice(0, 10);
  const high = 1.15 * Math.max(...heights, frequencies[0]) || 1;
  const modes = c.modes.filter((_, i) => frequencies[i] > 0 && frequencies[i] < high);
  const above = frequencies.filter((f) => f >= high).length;
  const labels = [
    ...modes.map((m) => `mode ${m.mode}`),
    ...shown.map((o) => `order ${orderText(o)}`),
    "critical",
  ];
  const chart = new Chart(section, {
    group,
    title: "Campbell diagram",
    savedTitle: `${page.model_name}: Campbell diagram, damped natural frequencies`,
    tall: true,
    labels,
    xName: "rpm",
    xLabel: speedAxis,
    yLabel: "frequency [Hz]",
    valueRange: [0, high],
    caption: make(
      "span",
      { class: "note" },
      "Damped natural frequencies, and the orders of the largest criticals. ● a critical, as large as its " +
        "amplitude beside the largest. Shaded: the speeds of the sweep." +
        (above ? ` Modes above ${sig(high, 3)} Hz: ${above}, in the table below.` : ""),
    ),
    colors: () => [...modes.map(() => style("--c0")), ...shown.map(() => style("--c1")), style("--ink")],
    series: (_, i) =>
      i < modes.length
        ? { strokePattern: null, strokeWidth: 1.5 }
        : i < labels.length - 1
          ? { strokePattern: [6, 3], strokeWidth: 1.2 }
          : { strokeWidth: 0, drawPoints: true, pointSize: 3.5 },
    rows: () => {
      const spots = sweep.criticals.filter((x) => shown.includes(x.order));
      const xs = [...new Set([0, ...c.mode_speeds_rpm.filter((x) => x <= end), ...spots.map((x) => x.speed_rpm), end])];
      xs.sort((a, b) => a - b);
      return {
        sparse: true,
        rows: xs.map((x) => [
          x,
          ...modes.map((m) => modeAt(m, x)),
          ...shown.map((o) => (o * x) / 60),
          spots.find((spot) => spot.speed_rpm === x)?.frequency_Hz ?? null,
        ]),
      };
    },
    underlay: (context, area, g) => {
      const clip = (x) => Math.min(area.x + area.w, Math.max(area.x, x));
      context.fillStyle = style("--panel");
      const [a, b] = [clip(g.toDomXCoord(span[0])), clip(g.toDomXCoord(span[1]))];
      context.fillRect(a, area.y, b - a, area.h);
      const text = new Labels(context, area);
      const [, x1] = g.xAxisRange(),
        [, y1] = g.yAxisRange();
      for (const m of modes) {
        const from = m.frequency_Hz.findIndex((y) => y !== null);
        text.put(
          `${m.mode}: ${sig(modeAt(m, whole[1]), 4)} Hz`,
          from > 0 ? clip(g.toDomXCoord(c.mode_speeds_rpm[from])) : area.x + 6,
          g.toDomYCoord(m.frequency_Hz[from]) - 4,
          style("--c0"),
        );
      }
      for (const o of shown) {
        const top = (o * x1) / 60 > y1;
        text.put(
          orderText(o),
          top ? g.toDomXCoord((y1 * 60) / o) - 6 : area.x + area.w - 4,
          top ? area.y + 13 : g.toDomYCoord((o * x1) / 60) - 4,
          style("--c1"),
          "right",
        );
      }
    },
  });
  chart.section = "campbell";
  section.append(
    table(
      ["mode", `frequency at ${sig(span[1], 5)} rpm [Hz]`, "damping ratio"],
      c.modes.map((m) => [m.mode, sig(modeAt(m, span[1]), 6), sig(m.damping_ratio.at(-1), 3)]),
    ),
  );
}

function showParameters() {
  showInputTable(page);
}
