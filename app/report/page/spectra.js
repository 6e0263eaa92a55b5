// Spectra, over frequency or over orders.

function showSpectra() {
  const section = byId("spectra");
  const withSpectra = runs.filter((run) => run.spectra);
  if (!withSpectra.length) {
    section.append(make("p", {}, "The run is too short for spectra."));
    return;
  }
  const shafts = withSpectra[0].campbell ? withSpectra[0].campbell.shafts : [];
  const base = withSpectra[0].campbell ? Math.max(...withSpectra[0].campbell.speed) / (2 * Math.PI) : 0;
  const s0 = withSpectra[0].spectra;
  const full = Math.max(
    ...withSpectra.map(({ spectra: s }) => s.line_Hz * (s.channels[0]?.amplitude.length ?? 1)),
  );
  // To where nearly all of the movement is.
  let busy = 0;
  for (const { spectra: s } of withSpectra)
    for (const c of s.channels) {
      const total = c.amplitude.reduce((sum, a) => sum + a * a, 0);
      let sum = 0,
        k = 0;
      while (k < c.amplitude.length && sum < 0.99 * total) ((sum += c.amplitude[k] ** 2), ++k);
      busy = Math.max(busy, 1.15 * k * s.line_Hz);
    }
  let unit = 1; // Hz of one unit of the x axis
  const group = new Group([0, full], ([from, to]) => {
    group.output.textContent = `${tidy(from / unit)} to ${tidy(to / unit)} ${unit === 1 ? "Hz" : "orders"}`;
  });
  const select = make(
    "select",
    {
      "aria-label": "Frequency axis",
      change: () => {
        unit = Number(select.value);
        const named = unit === 1 ? "frequency [Hz]" : `order of ${select.selectedOptions[0].dataset.shaft}`;
        drawAll();
        for (const chart of group.charts)
          chart.graph.updateOptions({
            xlabel: asMarkup(named),
            axes: {
              x: {
                axisLabelFormatter: (x) => tidy(x / unit),
                valueFormatter: (x) => `${sig(x / unit, 6)} ${unit === 1 ? "Hz" : "orders"}`,
                ticker: ticks,
              },
            },
          });
        group.show(...group.window);
      },
    },
    make("option", { value: 1 }, "frequency [Hz]"),
    ...shafts.map((shaft) =>
      make(
        "option",
        { value: base * shaft.ratio, "data-shaft": shaft.name },
        `orders of ${shaft.name} (${sig(60 * base * shaft.ratio)} rpm)`,
      ),
    ),
  );
  const ticks = (a, b, pixels, options, g) =>
    Dygraph.numericLinearTicks(a / unit, b / unit, pixels, options, g).map((tick) => ({
      ...tick,
      v: tick.v * unit,
      label: tick.label === undefined ? tick.label : tidy(tick.v),
    }));
  section.append(
    make(
      "p",
      { class: "note" },
      `Amplitudes of the time from ${sig(s0.from)} s to ${sig(s0.to)} s (${integer(s0.samples)} samples, ` +
        `lines ` +
        `${sig(s0.resolution_Hz, 3)} Hz apart, Hann window, mean ` +
        `removed)${s0.pooled > 1 ? `; drawn is the largest of each ${s0.pooled} lines` : ""}. ` +
        "Dotted: natural frequencies with contacts closed. The highest peaks are named.",
    ),
    toolbar(group, make("label", {}, "Axis ", select)),
  );
  const grid = make("div", { class: "spectra" });
  section.append(grid);
  const channels = commonChannels((run) => (run.spectra ? run.spectra.channels : []));
  for (const channel of channels) {
    const most = Math.max(
      ...channel.of.map(({ series }) => series.amplitude.reduce((a, b) => Math.max(a, b), 0)),
    );
    const readable = readableUnit(channel.unit, most),
      name = channelName(channel.name);
    const decade = Math.ceil(Math.log10(Math.max(most * readable.factor, 1e-290) * 1.3));
    const floor = 10 ** (decade - 6);
    const chart = new Chart(grid, {
      group,
      title: `Spectrum of ${channel.name}`,
      log: true,
      xName: "Hz",
      xLabel: "frequency [Hz]",
      valueRange: [floor, 10 ** decade],
      labels: channel.of.map(({ run }) => run.name || name.place),
      colors: () => channel.of.map(({ run }) => runColor(runs.indexOf(run))),
      caption: make(
        "span",
        {},
        make("b", {}, name.place),
        make("span", { class: "unit" }, ` ${name.quantity} [${readable.unit}]`),
      ),
      rows: (from, to, columns) => {
        const curves = channel.of.map(({ run, series }) =>
          highest(series.amplitude, run.spectra.line_Hz, from, to, 2 * columns),
        );
        curves.forEach((curve) => {
          curve.y = curve.y.map((y) => Math.max(y, floor / readable.factor));
        });
        return { rows: rowsOf(curves, readable.factor), sparse: false };
      },
      underlay: (context, area, g) => {
        const text = new Labels(context, area),
          [low, high] = g.xAxisRange();
        for (const m of runs[0].modes)
          if (m.frequency_Hz > low && m.frequency_Hz < high)
            line(
              context,
              g.toDomXCoord(m.frequency_Hz),
              area.y,
              g.toDomXCoord(m.frequency_Hz),
              area.y + area.h,
              style("--line"),
              [2, 3],
            );
        channel.of.forEach(({ run, series }) =>
          series.peaks.slice(0, 4).forEach((peak) => {
            if (peak.frequency_Hz < low || peak.frequency_Hz > high) return;
            text.put(
              sig(peak.frequency_Hz / unit, 4),
              g.toDomXCoord(peak.frequency_Hz) + 3,
              Math.max(g.toDomYCoord(peak.amplitude * readable.factor) - 3, area.y + 12),
              runColor(runs.indexOf(run)),
            );
          }),
        );
      },
    });
    chart.channel = channel.name;
  }
  group.window = [0, Math.min(full, busy || full)];
  group.describe(group.window);
  section.append(
    make(
      "details",
      {},
      make("summary", {}, "Highest peaks"),
      table(
        [
          "channel",
          ...(compared ? ["run"] : []),
          "frequency [Hz]",
          ...(base ? [`order of ${shafts[0].name}`] : []),
          "amplitude",
        ],
        channels.flatMap((channel) =>
          channel.of.flatMap(({ run, series }) =>
            series.peaks.map((peak) => [
              channel.name,
              ...(compared ? [run.name] : []),
              sig(peak.frequency_Hz, 5),
              ...(base ? [sig(peak.frequency_Hz / base)] : []),
              quantity(peak.amplitude, channel.unit),
            ]),
          ),
        ),
      ),
    ),
  );
}

/// A spectrum's lines between two frequencies, the highest of each of `columns` parts.
function highest(amplitude, step, from, to, columns) {
  const first = Math.max(0, Math.floor(from / step) - 1),
    last = Math.min(amplitude.length, Math.ceil(to / step) + 1);
  const per = Math.max(1, Math.ceil((last - first) / columns)),
    x = [],
    y = [];
  for (let k = first; k < last; k += per) {
    let best = k;
    for (let j = k; j < Math.min(k + per, last); ++j) if (amplitude[j] > amplitude[best]) best = j;
    x.push((best + 1) * step);
    y.push(amplitude[best]);
  }
  return { x, y };
}
