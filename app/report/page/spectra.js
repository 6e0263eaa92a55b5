// Spectra, over frequency or over orders.

function showSpectra() {
  const section = byId("spectra");
  for (const run of runs) if (run.result.run_up) showOrders(section, run);
  const withSpectra = runs.filter((run) => run.spectra);
  if (!withSpectra.length) {
    if (!runs.some((run) => run.result.run_up))
      section.append(make("p", {}, "The run is too short for spectra."));
    return;
  }
  const shafts = withSpectra[0].campbell ? withSpectra[0].campbell.shafts : [];
  const base = (withSpectra[0].spectra.speed ?? 0) / (2 * Math.PI); // actual turns of the shaft per second
  const s0 = withSpectra[0].spectra;
  const full = Math.max(
    ...withSpectra.map(({ spectra: s }) => s.line_Hz * (s.channels[0]?.amplitude.length ?? 1)),
  );
  // Up to the frequency below which almost all of the motion is.
  let busy = 0;
  for (const { spectra: s } of withSpectra)
    for (const c of s.channels) {
      const total = c.amplitude.reduce((sum, a) => sum + a * a, 0);
      let sum = 0,
        k = 0;
      while (k < c.amplitude.length && sum < 0.99 * total) ((sum += c.amplitude[k] ** 2), ++k);
      busy = Math.max(busy, 1.15 * k * s.line_Hz);
    }
  let unit = 1; // frequency of one unit of the x axis [Hz]
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
        `What swings faster than ${sig((0.5 * s0.samples) / (s0.to - s0.from), 3)} Hz, half the rate of the ` +
        "samples, is folded back below it: a smaller --every shows it where it is. " +
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
    const decade = most > 0 ? Math.ceil(Math.log10(most * readable.factor * 1.3)) : 0;
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
  if (base) showOrderBars(section, withSpectra[0], base, channels);
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

/// Amplitudes at half orders of the reference shaft, as bars: the highest line within a quarter of an order.
function showOrderBars(section, run, base, channels) {
  const { spectra } = run,
    lines = spectra.channels[0]?.amplitude.length ?? 0;
  const most = Math.min(24, Math.floor((2 * lines * spectra.line_Hz) / base));
  if (most < 2 || spectra.line_Hz > 0.2 * base) return;
  const orders = Array.from({ length: most }, (_, k) => 0.5 * (k + 1));
  const holder = make("div", {});
  const show = () => {
    const channel = channels[Number(which.value)],
      { amplitude } = channel.of[0].series;
    const values = orders.map((order) => {
      const from = Math.max(0, Math.ceil(((order - 0.2) * base) / spectra.line_Hz) - 1),
        to = Math.min(amplitude.length, Math.floor(((order + 0.2) * base) / spectra.line_Hz));
      return amplitude.subarray(from, Math.max(to, from + 1)).reduce((a, b) => Math.max(a, b), 0);
    });
    holder.replaceChildren(barChart(headed(run, `Orders of ${channel.name}`), channel.unit, orders, values));
  };
  const which = make(
    "select",
    { "aria-label": "Channel", change: show },
    channels.map((channel, i) => make("option", { value: i }, channel.name)),
  );
  section.append(make("div", { class: "toolbar" }, make("label", {}, "Orders of ", which)), holder);
  show();
}

/// Lines of a spectrum between two frequencies: the highest in each of `columns` parts.
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

/// Amplitudes of orders over the speed of a run-up.
function showOrders(section, run) {
  const up = run.result.run_up;
  if (up.speed_rpm.length < 2 || !up.orders.length) {
    section.append(make("p", {}, prefixed(run, "The run-up is too short to track orders.")));
    return;
  }
  const group = new Group([Math.min(...up.speed_rpm), Math.max(...up.speed_rpm)], ([from, to]) => {
    group.output.textContent = `${sig(from)} to ${sig(to)} rpm`;
  });
  section.append(
    make("h3", {}, headed(run, "Orders over the speed")),
    make(
      "p",
      { class: "note" },
      `Amplitude of each order, in windows of ${integer(up.turns)} turns of ${up.shaft ?? "the reference shaft"} ` +
        `(Hann window over the ${up.shaft === null ? "" : "actual "}angle), at the mean speed of the window: its mean over the window, ` +
        "below the highest one where a resonance is passed within it. Dotted: criticals passed, contacts closed.",
    ),
    toolbar(group),
  );
  const grid = make("div", { class: "spectra" });
  section.append(grid);
  // A run-up with a run-down passes a speed twice: it is drawn over time, not joined backwards.
  const places = up.speed_rpm.map((_, i) => i).sort((a, b) => up.speed_rpm[a] - up.speed_rpm[b]);
  const tint = (i) => style(["--c0", "--c1", "--c2", "--c4", "--ink"][i % 5]);
  for (const channel of up.channels) {
    const most = Math.max(...channel.amplitude.flat()),
      readable = readableUnit(channel.unit, most),
      name = channelName(channel.name);
    const chart = new Chart(grid, {
      group,
      title: `Orders of ${channel.name}`,
      xName: "rpm",
      xLabel: `speed of ${up.shaft ?? "the reference shaft"} [rpm]`,
      labels: up.orders.map((order) => `order ${orderText(order)}`),
      colors: () => up.orders.map((_, i) => tint(i)),
      series: (_, i) => ({ strokePattern: DASHES[Math.floor(i / 5) % DASHES.length] }),
      caption: make(
        "span",
        {},
        make("b", {}, name.place),
        make("span", { class: "unit" }, ` ${name.quantity} [${readable.unit}]`),
      ),
      rows: () => ({
        sparse: true,
        rows: places.map((w) => [
          up.speed_rpm[w],
          ...channel.amplitude.map((amplitude) => amplitude[w] * readable.factor),
        ]),
      }),
      underlay: (context, area, g) => {
        const text = new Labels(context, area);
        for (const c of up.criticals.slice(0, 6))
          for (const speed of [c.speed_rpm, -c.speed_rpm]) {
            const x = g.toDomXCoord(speed);
            if (x < area.x || x > area.x + area.w) continue;
            line(context, x, area.y, x, area.y + area.h, style("--line"), [2, 3]);
            text.put(orderText(c.order), x + 3, area.y + 12, style("--ink"));
          }
      },
    });
    chart.channel = channel.name;
  }
  group.describe(group.window);
  showWaterfall(section, run, group, places);
}

/// The waterfall of a run-up: a line for each of evenly spaced orders, with its amplitude above its order.
/// places: numbers of the windows by ascending speed.
function showWaterfall(section, run, group, places) {
  const fall = run.waterfall;
  if (!fall) return;
  const highest = fall.orders[fall.orders.length - 1],
    windows = fall.speed_rpm.length;
  // At most 30 lines are drawn.
  const apart = fall.orders[1] - fall.orders[0],
    every = Math.ceil(fall.orders.length / 30),
    lines = fall.orders.map((_, k) => k).filter((k) => Math.round(fall.orders[k] / apart) % every === 0),
    spacing = apart * every;
  section.append(
    make("h3", {}, headed(run, "Waterfall")),
    make(
      "p",
      { class: "note" },
      `A line every ${tidy(spacing)} orders up to ${tidy(highest)}: the amplitude of that order over the speed stands on ` +
        "the line's own height. Orders of the loads lie along the lines; what swings with a frequency of its own crosses " +
        "them along a hyperbola. Dashed: natural frequencies, contacts closed. waterfall.csv of --out has all orders.",
    ),
  );
  for (const channel of fall.channels) {
    const most = channel.amplitude.reduce((a, b) => Math.max(a, b), 0);
    if (!(most > 0)) continue;
    const readable = readableUnit(channel.unit, most),
      name = channelName(channel.name),
      height = highest / 4; // height of the largest amplitude [orders]
    const largest = lines.map((k) =>
      channel.amplitude.subarray(k * windows, (k + 1) * windows).reduce((a, b) => Math.max(a, b), 0),
    );
    const chart = new Chart(section, {
      group,
      title: `Waterfall of ${channel.name}`,
      tall: true,
      legend: "never",
      xName: "rpm",
      xLabel: `speed of ${run.result.run_up.shaft ?? "the reference shaft"} [rpm]`,
      yLabel: "order",
      valueRange: [0, highest + height],
      labels: lines.map((k) => `order ${orderText(fall.orders[k])}`),
      colors: () => largest.map((value) => style(value > 0.03 * most ? "--c0" : "--line")),
      series: () => ({ strokePattern: null, strokeWidth: 1 }),
      caption: make(
        "span",
        {},
        make("b", {}, name.place),
        make(
          "span",
          { class: "unit" },
          ` ${name.quantity}; a height of 1 order is ${sig((most * readable.factor) / height, 3)} ${readable.unit}`,
        ),
      ),
      rows: () => ({
        sparse: true,
        rows: places.map((w) => [
          fall.speed_rpm[w],
          ...lines.map((k) => fall.orders[k] + (height * channel.amplitude[k * windows + w]) / most),
        ]),
      }),
      underlay: (context, area, g) => {
        const [low, high] = g.xAxisRange();
        for (const mode of run.modes)
          for (let i = 0; i < 40; ++i) {
            const [a, b] = [i, i + 0.6].map((part) => low + ((high - low) * part) / 40);
            const at = (rpm) => (60 * mode.frequency_Hz) / Math.abs(rpm);
            if (Math.min(at(a), at(b)) > highest) continue;
            line(
              context,
              g.toDomXCoord(a),
              g.toDomYCoord(Math.min(at(a), highest)),
              g.toDomXCoord(b),
              g.toDomYCoord(Math.min(at(b), highest)),
              style("--line"),
              [],
            );
          }
      },
    });
    chart.channel = channel.name;
  }
}
