// The page of a nonlinear sweep: curves of periodic motions over the speed, stable and unstable ones
// distinguished.

const page = JSON.parse(document.querySelector("script.run").textContent);
const result = page.result;
const span = [result.speeds_rpm[0], result.speeds_rpm.at(-1)];
const speedOf = page.shaft === "reference shaft" ? "of the reference shaft" : `of ${page.shaft}, the reference shaft`;
const CURVE_COLORS = ["--c0", "--c1", "--c2", "--c4", "--ink"];
const STATES = { stable: null, unstable: [5, 4], "not judged": [9, 3, 2, 3] };

const stateOf = (curve, i) => (curve.stable[i] === null ? "not judged" : curve.stable[i] ? "stable" : "unstable");

/// Stretches of a curve with monotonic speed and one state, which a chart can draw.
function piecesOf(curve) {
  const pieces = [];
  let piece = null,
    way = 0;
  curve.speed_rpm.forEach((speed, i) => {
    const state = stateOf(curve, i);
    const step = i ? Math.sign(speed - curve.speed_rpm[i - 1]) : 0;
    if (!piece || state !== piece.state || (way && step && step !== way)) {
      // It begins where the last one ended, so that there is no gap between them.
      piece = { state, points: piece ? [i - 1, i] : [i] };
      way = step;
      pieces.push(piece);
    } else {
      piece.points.push(i);
      way = way || step;
    }
  });
  return pieces;
}

function showHead() {
  showTitle(page);
}

function showFigures() {
  const section = byId("figures");
  section.append(
    make(
      "p",
      {},
      `Periodic motions of ${sig(result.cycle_deg / 360)} turns a cycle by harmonic balance, ` +
        `${result.speeds_rpm.length} speeds ${sig(span[0])} to ${sig(span[1])} rpm ${speedOf}. Half range: ` +
        "(maximum − minimum)/2 over the cycle. Stable and unstable by Floquet multipliers.",
    ),
    table(
      ["curve", "turns a cycle", "motions", "stable", "speeds [rpm]", "followed to its ends", "starts from"],
      result.branches.map((curve, b) => [
        b + 1,
        sig(curve.cycle_deg / 360),
        curve.speed_rpm.length,
        curve.stable.filter((s) => s).length,
        `${sig(Math.min(...curve.speed_rpm), 6)} to ${sig(Math.max(...curve.speed_rpm), 6)}`,
        curve.whole ? "yes" : "no",
        curve.run_rpm === null ? "closed contacts" : `a run at ${sig(curve.run_rpm, 6)} rpm`,
      ]),
    ),
    ...page.notes.map((note) => make("p", { class: "note" }, note)),
    make("h3", {}, "Largest half range"),
    make(
      "p",
      { class: "note" },
      "Of stable motions and runs at the speeds asked for; between them, where a stable curve is higher.",
    ),
    table(
      ["section", "half range", "at [rpm]", "curve", "lowest", "highest", "heat [W]", "between", "at [rpm]"],
      result.sections.map((s) => {
        const most = result.largest.find(({ section }) => section === s.name);
        if (!most) return [s.name, "none found", "", "", "", "", "", "", ""];
        return [
          s.name,
          quantity(most.half_range, s.unit, 6),
          sig(most.speed_rpm, 8),
          most.branch ?? "run",
          quantity(most.lowest, s.unit, 6),
          quantity(most.highest, s.unit, 6),
          sig(most.heat_W, 6),
          quantity(most.between_half_range, s.unit, 6),
          sig(most.between_rpm, 8),
        ];
      }),
    ),
    make("h3", {}, "Folds, jumps and other changes"),
  );
  if (!result.changes.length) section.append(make("p", {}, "None within the speeds."));
  else
    section.append(
      table(
        ["speed [rpm]", "within [rpm]", "curve", "what", `half range of ${result.sections[0].name}`, "jumps to"],
        result.changes.map((c) => [
          sig(c.speed_rpm, 9),
          c.error_rpm === null ? "–" : sig(c.error_rpm, 2),
          c.branch,
          c.what,
          quantity(c.half_range[0], result.sections[0].unit),
          c.jumps_to ? quantity(c.jumps_to[0], result.sections[0].unit) : "–",
        ]),
      ),
    );
  const runs = result.runs.filter((run) => run.reason === null);
  if (!runs.length) return;
  section.append(
    make("h3", {}, "Where no motion that was found is stable: what a run does"),
    table(
      ["speed [rpm]", "cycles", "repeats after", "section", "mean", "±", "deviation", "lowest", "highest"],
      runs.flatMap((run) =>
        result.sections.map((s, c) => [
          sig(run.speed_rpm, 6),
          run.cycles,
          run.repeats_after ?? "–",
          s.name,
          ...[run.mean, run.mean_error, run.deviation, run.lowest, run.highest].map((values) => sig(values[c], 5)),
        ]),
      ),
    ),
  );
}

function showTrain() {
  byId("model").append(trainFigure(page.model));
}

/// Half range of a section along every curve.
function sectionChart(parent, group, s, c) {
  const all = result.branches.flatMap((curve) => curve.sections[c].half_range);
  const readable = readableUnit(s.unit, largest(all)),
    most = largest(all);
  const { limits, farAbove } = limitsOf(page.limits[c], most, s.unit);
  const lines = [];
  result.branches.forEach((curve, b) => {
    const counts = {};
    for (const piece of piecesOf(curve)) {
      const count = (counts[piece.state] = (counts[piece.state] ?? 0) + 1);
      lines.push({
        label: `curve ${b + 1}, ${piece.state}${count > 1 ? ` (${count})` : ""}`,
        points: piece.points.map((i) => [curve.speed_rpm[i], curve.sections[c].half_range[i]]),
        color: CURVE_COLORS[b % CURVE_COLORS.length],
        look: { strokeWidth: piece.state === "stable" ? 2 : 1.3, strokePattern: STATES[piece.state] },
      });
    }
  });
  for (const limit of limits)
    lines.push({
      label: limit.name,
      points: limit.values.map((value, i) => [result.speeds_rpm[i], value]),
      color: "--warn",
      look: { strokeWidth: 1.6, strokePattern: [8, 4] },
    });
  const runs = result.runs.filter((run) => run.reason === null);
  if (runs.length)
    lines.push({
      label: "half range of a run",
      points: runs.map((run) => [run.speed_rpm, 0.5 * (run.highest[c] - run.lowest[c])]),
      color: "--ink",
      look: { strokeWidth: 0, drawPoints: true, pointSize: 3.5 },
    });
  const key = (mark, text) => make("span", { class: "together" }, mark, text);
  const states = Object.keys(STATES).filter((state) => lines.some(({ label }) => label.includes(`, ${state}`)));
  const chart = new Chart(parent, {
    group,
    title: `${s.name} over speed`,
    savedTitle: `${page.model_name}: half range of ${s.name} [${readable.unit}]`,
    middle: true,
    xName: "rpm",
    xLabel: `speed of ${page.shaft} [rpm]`,
    yLabel: readable.unit,
    labels: lines.map(({ label }) => label),
    colors: () => lines.map(({ color }) => style(color)),
    series: (_, i) => lines[i].look,
    caption: make(
      "span",
      {},
      make("b", {}, s.name),
      make("span", { class: "unit" }, ` half range [${readable.unit}] `),
      result.branches.map((_, b) => key(keyMark(CURVE_COLORS[b % CURVE_COLORS.length]), `curve ${b + 1}`)),
      states.map((state) => key(keyMark("--ink", STATES[state]), state)),
      limits.map((limit) => key(keyMark("--warn", [8, 4]), limit.name)),
      runs.length ? key("● ", "a run that does not repeat") : null,
      farAbove,
    ),
    rows: () => {
      const rows = new Map();
      lines.forEach(({ points }, i) => {
        for (const [speed, value] of points) {
          if (!rows.has(speed)) rows.set(speed, [speed, ...lines.map(() => null)]);
          rows.get(speed)[i + 1] = value === null ? null : value * readable.factor;
        }
      });
      return { sparse: true, rows: [...rows.values()].sort((a, b) => a[0] - b[0]) };
    },
    underlay: (context, area, g) => {
      const text = new Labels(context, area);
      result.changes.forEach((change, i) => {
        const x = g.toDomXCoord(change.speed_rpm);
        if (x < area.x || x > area.x + area.w) return;
        line(context, x, area.y, x, area.y + area.h, style("--line"), [2, 3]);
        // In rows, so that all of several nearby changes are labelled.
        text.put(`${change.what} ${sig(change.speed_rpm, 6)}`, x + 3, area.y + 12 + 13 * (i % 3), style("--quiet"));
      });
    },
  });
  chart.section = s.name;
}

function showCharts() {
  const section = byId("speeds"),
    whole = span[0] < span[1] ? span : [0.99 * span[0], 1.01 * span[1]];
  const group = new Group(whole, ([from, to]) => {
    group.output.textContent = `${sig(from)} to ${sig(to)} rpm`;
  });
  section.append(
    make(
      "p",
      { class: "note" },
      "Half range along each curve of motions; where a stable stretch ends at a fold the train jumps. Dotted: folds " +
        "and other changes. Drag to zoom, double click for all of it.",
    ),
    toolbar(group),
  );
  result.sections.forEach((s, c) => sectionChart(section, group, s, c));
  group.describe(group.window);
}

showAll(showHead, showFigures, showTrain, showCharts, () => showInputTable(page));
