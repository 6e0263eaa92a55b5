// Charts over time: histories, forces and contacts, energies.

function timeText([from, to]) {
  const h = runs[0].history;
  const each = (to - from) / Math.max(1, 2 * (histories.charts[0]?.columns() ?? 500));
  const perGroup = h.step * h.group;
  const shown =
    perGroup < each
      ? `each point is the lowest or highest of about ${integer(Math.round((2 * each) / h.step))} samples`
      : h.group > 1
        ? `each point is the lowest or highest of ${h.group} samples, the finest kept here; history.csv ` +
          `of a shorter --every has more`
        : `every sample, ${quantity(h.step, "s", 3)} apart`;
  return `${tidy(from)} s to ${tidy(to)} s; ${shown}`;
}

const histories = new Group([0, duration], (window) =>
  histories.outputs.forEach((output) => {
    output.textContent = timeText(window);
  }),
);
histories.outputs = [];

function timeChart(parent, channel) {
  const factorOf = readableUnit(
    channel.unit,
    Math.max(...channel.of.map(({ series }) => Math.max(Math.abs(series.min), Math.abs(series.max)))),
  );
  const name = channel.energy ? { place: `${channel.name} energy`, quantity: "" } : channelName(channel.name);
  const extremes = channel.of.map(
    ({ run, series }) =>
      `${run.name} ${sig(series.min * factorOf.factor)} to ${sig(series.max * factorOf.factor)}`,
  );
  const keyed = channel.of.map(({ run }) =>
    compared
      ? [make("i", { class: "key", style: `background: var(--c${runs.indexOf(run)})` }), run.name]
      : [],
  );
  const chart = new Chart(parent, {
    group: histories,
    title: channel.name,
    xName: "s",
    xLabel: "time [s]",
    labels: channel.of.map(({ run }) => run.name || name.place),
    colors: () => channel.of.map(({ run }) => runColor(runs.indexOf(run))),
    caption: make(
      "span",
      {},
      make("b", {}, name.place),
      make("span", { class: "unit" }, ` ${name.quantity} [${factorOf.unit}]`),
      ...keyed.flat(),
      make("span", { class: "extremes" }, extremes.join(";  ")),
    ),
    rows: (from, to, columns) => {
      const curves = channel.of.map(({ run, series }) => thinned(run.history, series, from, to, columns));
      return { rows: rowsOf(curves, factorOf.factor), sparse: curves.every((curve) => curve.whole) };
    },
  });
  chart.channel = channel.name;
  return chart;
}

/// For a run-up, the axis of all charts over time shows the speed in place of the time: the nominal speed of
/// the reference shaft, or the actual one of a shaft. If the speed rises and falls again, a speed appears
/// twice.
const rising = runs.every(
  (run) => run.speeds && JSON.stringify(run.speeds) === JSON.stringify(runs[0].speeds),
)
  ? runs[0].speeds
  : null;

function speedAt(t) {
  const { time_s: times, speed_rpm: speeds } = rising,
    i = Math.min(Math.max(placeOf(times, t), 1), times.length - 1);
  return speeds[i - 1] + ((speeds[i] - speeds[i - 1]) * (t - times[i - 1])) / (times[i] - times[i - 1]);
}

/// Ticks at round speeds that are passed between two times.
function speedTicks(a, b, pixels, options, g) {
  const { time_s: times, speed_rpm: speeds } = rising;
  const inside = times.map((t, i) => i).filter((i) => times[i] > a && times[i] < b);
  const points = [[a, speedAt(a)], ...inside.map((i) => [times[i], speeds[i]]), [b, speedAt(b)]];
  const all = points.map(([, speed]) => speed);
  const found = [];
  for (const tick of Dygraph.numericLinearTicks(Math.min(...all), Math.max(...all), pixels, options, g))
    for (let i = 1; i < points.length; ++i) {
      const [[t0, s0], [t1, s1]] = [points[i - 1], points[i]];
      if (s0 === s1 || (s0 - tick.v) * (s1 - tick.v) > 0 || s0 === tick.v) continue;
      found.push({ v: t0 + ((t1 - t0) * (tick.v - s0)) / (s1 - s0), label: tick.label && tidy(tick.v) });
    }
  return found;
}

function axisChoice() {
  const select = make(
    "select",
    {
      "aria-label": "Axis of the histories",
      change: () => {
        const speed = select.value === "speed";
        document.querySelectorAll("select.timeaxis").forEach((other) => (other.value = select.value));
        drawAll();
        for (const chart of histories.charts)
          chart.graph?.updateOptions({
            xlabel: asMarkup(speed ? `speed of ${rising.shaft ?? "the reference shaft"} [rpm]` : "time [s]"),
            axes: {
              x: speed
                ? { ticker: speedTicks, valueFormatter: (t) => `${sig(speedAt(t), 5)} rpm, ${sig(t, 7)} s` }
                : { ticker: Dygraph.numericLinearTicks, valueFormatter: (t) => `s ${sig(t, 7)}` },
            },
          });
      },
    },
    make("option", { value: "time" }, "time [s]"),
    make("option", { value: "speed" }, "speed [rpm]"),
  );
  select.classList.add("timeaxis");
  return make("label", {}, "Axis ", select);
}

function bar(section) {
  const tools = toolbar(histories, ...(rising ? [axisChoice()] : []));
  histories.outputs.push(histories.output);
  section.append(tools);
}

function showHistories() {
  const section = byId("histories"),
    contacts = byId("contacts"),
    energy = byId("energy");
  const h = runs[0].history;
  section.append(
    make(
      "p",
      { class: "note" },
      "Drawn from " +
        `${runs.map((run) => `${integer(run.history.samples)} samples${run.name ? " of " + run.name : ""}`).join(", ")}, ` +
        "thinned so that no peak of them is lost. Drag to zoom, Shift and drag to move, Ctrl and wheel " +
        "to zoom about the pointer, double click for " +
        "all of it; with the keyboard + − ← → 0. All charts over time move together. Angles and speeds " +
        "are deviations from the nominal motion.",
    ),
  );
  bar(section);
  const channels = commonChannels((run) => run.history.series);
  const carriesGap = new Set(runs.flatMap((run) => run.history.bands.map((band) => `${band.element}`)));
  const meshes = channels.filter(
    (c) =>
      !c.energy &&
      (carriesGap.has(channelName(c.name).place) ||
        runs[0].model.joints.some((j) => j.kind === "mesh" && `${j.name}.force_N` === c.name)) &&
      /\.(force|torque)_/.test(c.name),
  );
  channels.filter((c) => !c.energy && !meshes.includes(c)).forEach((c) => timeChart(section, c));

  if (meshes.length || h.bands.length) {
    bar(contacts);
    contacts.append(
      make(
        "p",
        { class: "note" },
        "Force along the line of action, positive on the front flank. Below it: on which flank there is " +
          "contact.",
        ...[
          ["--front", "front flank, from below"],
          ["--open", "separated"],
          ["--back", "back flank, from above"],
        ].flatMap(([color, text]) => [
          make(
            "span",
            { class: "together" },
            make("i", { class: "key", style: `background: var(${color})` }),
            text,
          ),
          " ",
        ]),
      ),
    );
    for (const c of meshes) {
      const chart = timeChart(contacts, c);
      for (const run of runs)
        for (const band of run.history.bands.filter((b) => b.element === channelName(c.name).place))
          new Band(contacts, histories, run, band, chart);
    }
    showContactTable(contacts);
  } else {
    contacts.append(make("p", {}, "No meshes and no gaps in this model."));
  }
  showEnergyTable(energy);
  bar(energy);
  channels.filter((c) => c.energy).forEach((c) => timeChart(energy, c));
  histories.describe(histories.window);
}
