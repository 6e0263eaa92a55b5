// Modes, and the speeds at which they resonate.

const stillness = matchMedia("(prefers-reduced-motion: reduce)");

/// Curves of a mode shape over the train: one axis a line, in the order from top to bottom.
class ShapeView {
  constructor(model, plan, width, rowHeight, bare) {
    const widest = Math.max(...plan.lines.map((line) => line.width));
    const axisName = (line) =>
      shortName(model.nodes[plan.lines[line].nodes[0]].name) + (plan.lines[line].nodes.length > 1 ? " …" : "");
    const nameWidth = LETTER * Math.max(...plan.lines.map((_, line) => axisName(line).length));
    const pitch = (width - (bare ? 10 : nameWidth + 36)) / Math.max(widest, 2);
    const { x, order } = place(plan, pitch, 0);
    // A bare view shows only the longest line.
    if (bare && widest === 1) return this.asRow(model.nodes.length, width, rowHeight);
    const shown = bare ? order.slice(0, 1) : [...order].reverse();
    this.amplitude = rowHeight * 0.42;
    const first = (line) => Math.min(...plan.lines[line].nodes.map(x));
    const left = Math.min(...shown.map(({ line }) => first(line))) - (bare ? 4 : nameWidth + 20);
    const right =
      Math.max(...shown.map(({ line }) => Math.max(...plan.lines[line].nodes.map(x)))) + (bare ? 4 : 16);
    const heights = shown.map(({ line }) =>
      plan.lines[line].nodes.length > 1 ? rowHeight : 0.6 * rowHeight,
    );
    this.svg = draw("svg", {
      viewBox: `${left} 0 ${Math.max(right - left, bare ? 20 : 240)} ${heights.reduce((a, b) => a + b, 0)}`,
      role: "img",
      "aria-label": "Mode shape",
      style: bare ? "" : `width:${Math.round(Math.max(right - left, 240))}px`,
      ...(bare ? { preserveAspectRatio: "none", width: "100%", height: rowHeight } : {}),
    });
    let below = 0;
    this.rows = [];
    const axisOf = new Map();
    shown.forEach(({ line }, row) => {
      const y = below + 0.5 * heights[row],
        nodes = plan.lines[line].nodes;
      below += heights[row];
      axisOf.set(line, y);
      this.svg.append(
        draw("line", {
          class: "axis",
          x1: first(line) - 6,
          y1: y,
          x2: Math.max(...nodes.map(x)) + 6,
          y2: y,
          ...(bare ? { "vector-effect": "non-scaling-stroke" } : {}),
        }),
      );
      if (!bare)
        this.svg.append(
          draw(
            "text",
            { x: first(line) - 12, y: y + 4, "text-anchor": "end", class: "quiet" },
            axisName(line),
            draw("title", {}, model.nodes[nodes[0]].name),
          ),
        );
      for (const i of nodes) this.rows.push({ i, x: x(i), y, from: plan.nodes[i].from });
    });
    if (!bare)
      for (const tie of plan.ties) {
        const [a, b] = tie.nodes;
        this.svg.append(
          draw("line", {
            class: "tie",
            x1: x(a),
            y1: axisOf.get(plan.nodes[a].line),
            x2: x(b),
            y2: axisOf.get(plan.nodes[b].line),
          }),
        );
      }
    const where = new Map(this.rows.map((row) => [row.i, row]));
    this.links = this.rows.filter((row) => row.from >= 0).map((row) => [where.get(row.from), row]);
    const path = (kind) =>
      draw("path", { class: kind, ...(bare ? { "vector-effect": "non-scaling-stroke" } : {}) });
    this.envelopes = [path("envelope"), path("envelope")];
    this.curve = path("shape");
    this.svg.append(...this.envelopes, this.curve);
    this.dots = bare
      ? []
      : this.rows.map((row) =>
          draw(
            "circle",
            { class: "dot", r: Math.min(3.2, 0.6 * pitch), cx: row.x },
            draw("title", {}, model.nodes[row.i].name),
          ),
        );
    this.svg.append(...this.dots);
  }
  /// A bare view of a train of single nodes in mesh: node after node.
  asRow(count, width, rowHeight) {
    this.amplitude = rowHeight * 0.42;
    this.rows = Array.from({ length: count }, (_, i) => ({
      i,
      x: (width * (i + 0.5)) / count,
      y: rowHeight / 2,
    }));
    this.links = this.rows.slice(1).map((row, i) => [this.rows[i], row]);
    this.curve = draw("path", { class: "shape" });
    this.dots = [];
    this.svg = draw(
      "svg",
      { viewBox: `0 0 ${width} ${rowHeight}`, role: "img", "aria-label": "Mode shape" },
      draw("line", { class: "axis", x1: 0, y1: rowHeight / 2, x2: width, y2: rowHeight / 2 }),
      this.curve,
    );
  }
  path(factor) {
    const y = (row) => (row.y - this.amplitude * factor * this.shape[row.i]).toFixed(2);
    return this.links.map(([a, b]) => `M${a.x.toFixed(1)} ${y(a)}L${b.x.toFixed(1)} ${y(b)}`).join("");
  }
  show(shape) {
    this.shape = shape;
    if (this.dots.length)
      this.envelopes.forEach((envelope, i) => envelope.setAttribute("d", this.path(i ? -1 : 1)));
    this.move(1);
  }
  /// factor: factor of the shape, 1 to -1.
  move(factor) {
    this.curve.setAttribute("d", this.path(factor));
    this.dots.forEach((dot, k) => {
      const row = this.rows[k];
      dot.setAttribute("cy", row.y - this.amplitude * factor * this.shape[row.i]);
    });
  }
}

function showModes() {
  const section = byId("modes");
  const shown = distinct((r) => r.modes);
  for (const run of shown) {
    if (!run.modes.length) {
      section.append(make("p", {}, prefixed(run, "There are no elastic modes.")));
      continue;
    }
    if (shown.length > 1) section.append(make("h3", {}, `Run ${run.name}`));
    const plan = layout(run.model);
    const view = new ShapeView(run.model, plan, 1000, 76, false);
    const words = make("p", { "aria-live": "polite" });
    let moving = !stillness.matches,
      mode = 0,
      frame = 0;
    const animate = (now) => {
      if (!moving || printing) return;
      view.move(Math.cos(now / 400));
      frame = requestAnimationFrame(animate);
    };
    const buttons = run.modes.map((m, i) => {
      const small = new ShapeView(run.model, plan, 120, 36, true);
      small.show(m.shape);
      return make(
        "button",
        {
          type: "button",
          "aria-pressed": "false",
          "aria-label": `Mode ${i + 1}, ${sig(m.frequency_Hz, 5)} Hz`,
          click: () => select(i),
        },
        make("b", {}, String(i + 1)),
        `  ${sig(m.frequency_Hz, 5)} Hz`,
        small.svg,
      );
    });
    const select = (i) => {
      mode = i;
      buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(k === i)));
      const m = run.modes[i];
      const top = m.shape.map((v, k) => [Math.abs(v), k]).sort((a, b) => b[0] - a[0])[0][1];
      view.show(m.shape);
      view.svg.dataset.mode = i + 1;
      words.replaceChildren(
        make("b", {}, `Mode ${i + 1}: ${sig(m.frequency_Hz, 5)} Hz`),
        `, moves most at ${run.model.nodes[top].name}`,
        m.energy.length ? "; elastic energy in " : "",
        m.energy.map((e) => `${e.element} ${percent(e.share, 2)}`).join(", "),
      );
    };
    const toggle = make(
      "button",
      {
        type: "button",
        click: () => {
          moving = !moving;
          toggle.textContent = moving ? "Hold" : "Move";
          if (moving) animate(performance.now());
          else view.move(1);
        },
      },
      moving ? "Hold" : "Move",
    );
    section.append(
      make("div", { class: "thumbs", role: "group", "aria-label": "Modes" }, buttons),
      make("div", { class: "toolbar" }, words, toggle),
      make(
        "figure",
        {},
        view.svg,
        make(
          "figcaption",
          { class: "note" },
          "Motion of each node, forwards upwards, the largest 1; dotted: in mesh. Contacts closed, undamped" +
            `${run.result.results.rigid_modes ? `; besides ${run.result.results.rigid_modes} rigid modes` : ""}.`,
        ),
      ),
    );
    select(0);
    if (moving) animate(performance.now());
    stopAnimations.push(() => {
      cancelAnimationFrame(frame);
      view.move(1);
    });
    startAnimations.push(() => moving && animate(performance.now()));
  }
  if (shown.length > 1) {
    const count = Math.max(...runs.map((run) => run.modes.length));
    const f = (run, i) => run.modes[i]?.frequency_Hz;
    section.append(
      make("h3", {}, "Natural frequencies"),
      table(
        ["mode", "A [Hz]", "B [Hz]", "B against A"],
        Array.from({ length: count }, (_, i) => [
          i + 1,
          sig(f(runs[0], i), 5),
          sig(f(runs[1], i), 5),
          difference(f(runs[0], i), f(runs[1], i)),
        ]),
      ),
    );
  }
}

const CAMPBELL_MODES = 4; // number of modes shown unless zoomed out

function showCampbell() {
  const section = byId("campbell");
  const shown = distinct((r) => [r.campbell, r.modes.map((m) => m.frequency_Hz)]);
  for (const run of shown) {
    const c = run.campbell;
    if (shown.length > 1) section.append(make("h3", {}, `Run ${run.name}`));
    if (!c) {
      const text = run.result.run_up
        ? "Nothing turns nominally. The speeds that the run passes, with their criticals and orders, are below, under orders over the speed."
        : "No shaft turns in this model, so there are no orders.";
      section.append(make("p", {}, text));
      continue;
    }
    const rpm = 60 / (2 * Math.PI),
      slowest = c.speed[0] * rpm,
      runSpeed = c.speed[1] * rpm,
      fastest = 1.6 * runSpeed;
    const frequencies = run.modes.map((m) => m.frequency_Hz);
    const high = 1.12 * (frequencies[Math.min(CAMPBELL_MODES, frequencies.length) - 1] ?? fastest / 6);
    const modeNames = frequencies.map((_, i) => `mode ${i + 1}`);
    const orderNames = c.orders.map((o) =>
      o.of === "loads" ? `order ${orderText(o.order)}` : `teeth of ${o.of}`,
    );
    const labels = [...modeNames, ...orderNames, "resonance"];
    const orderLimit = c.orders.map((o) => o.order);
    const crossings = c.crossings
      .filter((x) => orderLimit.some((o) => Math.abs(o - x.order) < 1e-6) && x.speed * rpm <= fastest)
      .sort((a, b) => a.speed - b.speed);
    const group = new Group([0, fastest], () => {});
    const rows = () => {
      const xs = [0, ...crossings.map((x) => x.speed * rpm), fastest];
      return {
        sparse: true,
        rows: xs.map((x, k) => [
          x,
          ...frequencies,
          ...c.orders.map((o) => (o.order * x) / 60),
          k > 0 && k <= crossings.length ? frequencies[crossings[k - 1].mode] : null,
        ]),
      };
    };
    new Chart(section, {
      group,
      title: "Campbell diagram",
      tall: true,
      labels,
      rows,
      yLabel: "frequency [Hz]",
      xName: "rpm",
      xLabel: `speed of ${c.shaft} [rpm]`,
      valueRange: [0, high],
      caption: make(
        "span",
        { class: "note" },
        "Level lines: natural frequencies (they do not depend on speed here). Rays: the orders of the " +
          "loads that excite most, and tooth " +
          `passing, per turn of ${c.shaft}. ● resonance. Drag to zoom, double click for all of it.`,
      ),
      colors: () => [
        ...modeNames.map(() => style("--c0")),
        ...c.orders.map((o) => style(o.of === "loads" ? "--c1" : "--c2")),
        style("--ink"),
      ],
      series: (label, i) =>
        i < modeNames.length
          ? { strokePattern: null, strokeWidth: 1.4 }
          : i < labels.length - 1
            ? {
                strokePattern: c.orders[i - modeNames.length].of === "loads" ? [6, 3] : [2, 3],
                strokeWidth: 1.2,
              }
            : { strokeWidth: 0, drawPoints: true, pointSize: 3.5 },
      underlay: (context, area, g) => {
        const text = new Labels(context, area),
          x = g.toDomXCoord(runSpeed),
          right = area.x + area.w - 4;
        line(context, x, area.y, x, area.y + area.h, style("--ink"), [1, 3]);
        text.put(
          c.speed[0] === c.speed[1] ? "this run" : "this run, at most",
          x + 4,
          area.y + 12,
          style("--ink"),
        );
        frequencies.forEach((f, i) =>
          text.put(`${i + 1}: ${sig(f, 4)} Hz`, area.x + 6, g.toDomYCoord(f) - 4, style("--c0")),
        );
        c.orders.forEach((o) => {
          const [y0, y1] = g.yAxisRange(),
            [, x1] = g.xAxisRange();
          const top = (o.order * x1) / 60 > y1,
            mesh = o.of !== "loads",
            name = o.of === "loads" ? orderText(o.order) : o.of;
          const px = top ? g.toDomXCoord((y1 * 60) / o.order) : right;
          const py = top ? area.y + (mesh ? 12 : 26) : g.toDomYCoord((o.order * x1) / 60) - 4;
          if (py > g.toDomYCoord(y0)) return;
          text.put(
            name,
            top ? px - (mesh ? 6 : 9) : right,
            py,
            style(o.of === "loads" ? "--c1" : "--c2"),
            "right",
          );
        });
      },
    });
    if (c.unknown.length)
      section.append(
        make(
          "p",
          {},
          `The orders of ${c.unknown.join(", ")} are not known, and their resonances not shown: ` +
            "a torque of each does not repeat within two turns of its node.",
        ),
      );
    const passed = c.speed[0] !== c.speed[1];
    const near = [...c.crossings]
      .filter((x) =>
        passed
          ? x.speed >= c.speed[0] && x.speed <= c.speed[1]
          : x.speed * rpm > 0.5 * runSpeed && x.speed * rpm < 2 * runSpeed,
      )
      .sort((a, b) => b.static - a.static)
      .slice(0, 12);
    if (!near.length) continue;
    section.append(
      make(
        "h3",
        {},
        passed
          ? `Criticals passed between ${sig(slowest)} and ${sig(runSpeed)} rpm, most excited first`
          : "Resonances between half and twice the speed of the run, most excited first",
      ),
      table(
        [
          "mode",
          "frequency [Hz]",
          "order",
          "speed [rpm]",
          passed ? "from the top speed" : "from this run",
          "static response",
        ],
        near.map((x) => [
          x.mode + 1,
          sig(frequencies[x.mode], 5),
          orderText(x.order),
          sig(x.speed * rpm),
          difference(runSpeed, x.speed * rpm),
          quantity(x.static, run.model.nodes[0].turns ? "rad" : "m", 3),
        ]),
      ),
      make(
        "p",
        { class: "note" },
        "Static response: what the order's torques, all nodes and phases together, would move the mode by " +
          "at its " +
          "largest node if it were at rest; at the resonance it is 1/(2ζ) times that, as far as contacts " +
          "stay closed.",
      ),
    );
  }
}
