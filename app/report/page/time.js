// What is drawn over time: histories, forces and contacts, energies.

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

function bar(section) {
  const tools = toolbar(histories);
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
