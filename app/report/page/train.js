// The train as a schematic, and its mode shapes.
//
// Parts that turn together about one axis (joined by anything but gears) lie on one line, the longest chain in
// the main row, branches below. Lines in mesh touch at their gears; gears on a carrier are joined on its line.

const PITCH_LEAST = 24,
  DISC = 34,
  GEAR = 52,
  THICKEST = 7; // sizes [px]; disc and gear: largest radii
const MOST_LABELS = 60; // largest number of labels on one line
const coupling = (joint) => joint.kind === "gear" || (joint.kind === "mesh" && !joint.carried);

function layout(model) {
  const count = model.nodes.length;
  const pairs = model.joints.filter((joint) => joint.nodes.length === 2);
  const next = model.nodes.map(() => []);
  for (const joint of pairs)
    if (!coupling(joint)) {
      const [a, b] = joint.nodes;
      if (!next[a].includes(b)) (next[a].push(b), next[b].push(a));
    }
  const nodes = model.nodes.map(() => ({ line: -1, x: 0, row: 0, from: -1 }));
  const lines = [];
  const walk = (start, allowed) => {
    // breadth-first search: order and predecessors
    const order = [start],
      from = new Map([[start, -1]]);
    for (const i of order)
      for (const j of next[i]) if (!from.has(j) && allowed(j)) (from.set(j, i), order.push(j));
    return { order, from };
  };
  for (let start = 0; start < count; ++start) {
    if (nodes[start].line >= 0) continue;
    const all = walk(start, () => true).order;
    const ends = walk(all.at(-1), () => true); // the longest chain begins at the farthest node
    const trunk = [];
    for (let i = ends.order.at(-1); i >= 0; i = ends.from.get(i)) trunk.push(i);
    if (trunk[0] > trunk.at(-1)) trunk.reverse();
    const line = { nodes: all, rows: 1, width: trunk.length };
    const taken = new Set(); // occupied places of branches
    trunk.forEach((i, x) =>
      Object.assign(nodes[i], { line: lines.length, x, row: 0, from: trunk[x - 1] ?? -1 }),
    );
    for (let t = trunk.length - 1; t >= 0; --t) {
      // branches, from the right, each straight on or on the next row that is free
      const branch = [[trunk[t], t]];
      while (branch.length) {
        const [i, x] = branch.pop();
        for (const j of next[i])
          if (nodes[j].line < 0) {
            let row = Math.max(1, nodes[i].row);
            while (taken.has(`${row} ${x + 1}`)) ++row;
            taken.add(`${row} ${x + 1}`);
            Object.assign(nodes[j], { line: lines.length, x: x + 1, row, from: i });
            line.rows = Math.max(line.rows, row + 1);
            line.width = Math.max(line.width, x + 2);
            branch.push([j, x + 1]);
          }
      }
    }
    lines.push(line);
  }
  const ties = pairs.filter(coupling);
  const gears = model.nodes.map(() => []);
  for (const tie of ties) tie.nodes.forEach((node) => gears[node].push(tie));
  return { nodes, lines, ties, gears };
}

/// Places of the lines, from the longest one on: x so that gears in mesh are above each other. The gears of one
/// node are side by side.
function place(plan, pitch, gap) {
  const offset = (node, tie) => {
    const list = plan.gears[node];
    return list.length < 2 ? 0 : (list.indexOf(tie) / (list.length - 1) - 0.5) * 2 * gap;
  };
  const shift = plan.lines.map(() => null),
    order = [];
  while (shift.includes(null)) {
    const longest = plan.lines
      .map((_, i) => i)
      .filter((i) => shift[i] === null)
      .reduce((a, b) => (plan.lines[b].width > plan.lines[a].width ? b : a));
    shift[longest] = 0;
    order.push({ line: longest, tie: null });
    const queue = [longest];
    for (const line of queue)
      for (const tie of plan.ties) {
        const [a, b] = tie.nodes;
        const mine = plan.nodes[a].line === line ? a : b,
          other = mine === a ? b : a;
        if (plan.nodes[mine].line !== line || shift[plan.nodes[other].line] !== null) continue;
        shift[plan.nodes[other].line] =
          shift[line] +
          plan.nodes[mine].x * pitch +
          offset(mine, tie) -
          plan.nodes[other].x * pitch -
          offset(other, tie);
        order.push({ line: plan.nodes[other].line, tie });
        queue.push(plan.nodes[other].line);
      }
  }
  const least = Math.min(...plan.nodes.map((node) => shift[node.line] + node.x * pitch));
  const x = (node) => shift[plan.nodes[node].line] + plan.nodes[node].x * pitch - least;
  return { x, offset, order };
}

/// A dashpot: a rod with its piston in a cylinder that is open towards it.
function dashpot(x0, y0, x1, y1) {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1,
    [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
  const wide = 5,
    half = Math.min(7, 0.25 * length);
  const at = (along, across) =>
    `${(x0 + along * ux - across * uy).toFixed(1)} ${(y0 + along * uy + across * ux).toFixed(1)}`;
  const middle = length / 2;
  return draw("path", {
    class: "law dashpot",
    d:
      `M${at(0, 0)}L${at(middle, 0)}M${at(middle, -wide + 1.5)}L${at(middle, wide - 1.5)}` +
      `M${at(middle - half, -wide)}L${at(middle + half, -wide)}L${at(middle + half, wide)}` +
      `L${at(middle - half, wide)}M${at(middle + half, 0)}L${at(length, 0)}`,
  });
}

/// Symbol of dry friction: two plates, each on its rod.
const plates = (x0, y0, x1, y1) => {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [u, v] = [(2 * (x1 - x0)) / length, (2 * (y1 - y0)) / length];
  const plate = (x, y, s) =>
    `M${x} ${y}L${(x0 + x1) / 2 + s * u} ${(y0 + y1) / 2 + s * v}m${-4 * v} ${4 * u}l${8 * v} ${-8 * u}`;
  return draw("path", { class: "law", d: plate(x0, y0, -1) + plate(x1, y1, 1) });
};
/// A zigzag between two points.
function zigzag(x0, y0, x1, y1, size = 4) {
  const points = [];
  for (let i = 0; i <= 8; ++i) {
    const side = i === 0 || i === 8 ? 0 : i % 2 ? size : -size,
      along = i / 8;
    const length = Math.hypot(x1 - x0, y1 - y0) || 1;
    points.push(
      `${x0 + (x1 - x0) * along - ((y1 - y0) / length) * side},${y0 + (y1 - y0) * along + ((x1 - x0) / length) * side}`,
    );
  }
  return draw("polyline", { points: points.join(" "), class: "law" });
}

const ground = (x, y) =>
  draw("path", {
    class: "held",
    d: `M${x - 9} ${y}h18` + [-7, -2, 3, 8].map((d) => `M${x + d} ${y}l-4 5`).join(""),
  });

function jointText(joint) {
  const parts = [`${joint.name}: ${joint.type}`];
  const turns = joint.kind !== "mesh";
  if (joint.stiffness)
    parts.push(quantity(joint.stiffness, turns ? (joint.turns ? "N m/rad" : "N/m") : "N/m"));
  if (joint.radii) parts.push(`base radii ${joint.radii.map((r) => sig(1e3 * r)).join(" and ")} mm`);
  if (joint.ratio) parts.push(`ratio ${sig(joint.ratio)}`);
  if (joint.gap) parts.push(`gap ${quantity(joint.gap, joint.turns && turns ? "rad" : "m")}`);
  return parts.join(", ");
}

/// Sizes by the fourth root, as for discs of equal thickness and shafts of equal length.
const fourth = (values, largest) => {
  const top = Math.max(...values.filter((v) => v > 0), 0);
  return (v) => (v > 0 && top > 0 ? largest * Math.pow(v / top, 0.25) : 0);
};

function drawTrain(model) {
  for (const joint of model.joints) joint.turns = model.nodes[joint.nodes[0]].turns;
  const plan = layout(model);
  const widest = Math.max(...plan.lines.map((line) => line.width));
  const least = widest <= MOST_LABELS ? PITCH_LEAST : 0;
  const pitch = Math.max(least, Math.min(130, 1120 / Math.max(widest, 1)));
  const gearGap = Math.min(26, Math.max(14, pitch * 0.6));
  const { x, offset, order } = place(plan, pitch, gearGap);
  const disc = fourth(
    model.nodes.map((node) => node.inertia),
    DISC,
  );
  const thick = fourth(
    model.joints.filter((j) => j.kind === "shaft").map((j) => j.stiffness),
    THICKEST,
  );
  const radii = plan.ties.flatMap((tie) => tie.radii || []);
  const scale = radii.length ? GEAR / Math.max(...radii) : 1;
  const gearRadius = (tie, node) =>
    tie.radii ? Math.max(6, tie.radii[tie.nodes.indexOf(node)] * scale) : 22;
  const labelled = widest <= MOST_LABELS;
  const shortLabels = pitch > 75;
  const nameLength = Math.max(...model.nodes.map((node) => node.name.length));
  const labelHeight = shortLabels || !labelled ? 18 : Math.min(90, nameLength * 5 + 6);

  // Heights: each line is below the one it was reached from, with touching gears, or below all lines so far.
  const y = plan.lines.map(() => 0),
    half = plan.lines.map((line) =>
      Math.max(DISC, ...line.nodes.flatMap((i) => plan.gears[i].map((tie) => gearRadius(tie, i)))),
    );
  const height = (line) => (plan.lines[line].rows - 1) * 70;
  let bottom = 0;
  order.forEach(({ line, tie }, place) => {
    if (!tie) {
      y[line] = place === 0 ? 0 : bottom + labelHeight + half[line] + 20;
    } else {
      const [a, b] = tie.nodes,
        other = plan.nodes[a].line === line ? plan.nodes[b].line : plan.nodes[a].line;
      const [r, s] = [gearRadius(tie, a), gearRadius(tie, b)];
      y[line] = y[other] - (tie.internal ? Math.abs(r - s) : r + s); // upwards, since labels are below
    }
    bottom = Math.max(bottom, y[line] + half[line] + height(line));
  });
  const top = Math.min(...plan.lines.map((_, i) => y[i] - half[i])) - 26;
  const left = -46,
    right =
      Math.max(...model.nodes.map((_, i) => x(i)), ...plan.ties.map((tie) => x(tie.nodes[0]) + 100)) + 60;
  const lowest = bottom + labelHeight + (model.joints.some((joint) => joint.nodes.length < 2) ? 14 : 4);
  const svg = draw("svg", {
    viewBox: `${left} ${top} ${right - left} ${lowest - top}`,
    role: "img",
    "aria-label": "Schematic of the model",
    style: `width:${Math.round(right - left)}px`,
  });
  const at = (i) => [x(i), y[plan.nodes[i].line] + plan.nodes[i].row * 70];

  for (const joint of model.joints) {
    const [a, b] = joint.nodes;
    const [x0, y0] = at(a);
    if (b === undefined) {
      const foot = y0 + Math.max(disc(model.nodes[a].inertia), 8) + 20;
      svg.append(
        draw(
          "g",
          {},
          draw("title", {}, jointText(joint)),
          ({ damper: dashpot, friction: plates }[joint.kind] || zigzag)(x0, foot - 20, x0, foot),
          ground(x0, foot),
        ),
      );
      continue;
    }
    const [x1, y1] = at(b);
    if (coupling(joint)) continue;
    const title = draw("title", {}, jointText(joint));
    if (joint.kind === "shaft")
      svg.append(
        draw(
          "g",
          {},
          title,
          draw("line", {
            x1: x0,
            y1: y0,
            x2: x1,
            y2: y1,
            class: "shaft",
            "stroke-width": Math.max(1.2, thick(joint.stiffness)),
          }),
        ),
      );
    else if (joint.kind === "damper") svg.append(draw("g", {}, title, dashpot(x0, y0, x1, y1)));
    else if (joint.kind === "friction") svg.append(draw("g", {}, title, plates(x0, y0, x1, y1)));
    else svg.append(draw("g", {}, title, zigzag(x0, y0, x1, y1, joint.kind === "spring" ? 6 : 3)));
  }
  const grounded = new Set(
    model.joints.filter((joint) => joint.nodes.length < 2).map((joint) => joint.nodes[0]),
  );
  const loaded = new Map();
  for (const load of model.loads)
    loaded.set(load.node, [...(loaded.get(load.node) || []), `${load.name}: ${load.type}`]);
  model.nodes.forEach((node, i) => {
    const [cx, cy] = at(i);
    const r = disc(node.inertia);
    const width = Math.max(Math.min(4, 0.7 * pitch), Math.min(14, 0.36 * pitch));
    const group = draw(
      "g",
      {},
      draw(
        "title",
        {},
        `${node.name}: ${node.turns ? "inertia" : "mass"} ` +
          `${sig(node.inertia)} ${node.turns ? "kg m²" : "kg"}${node.held ? ", moves as given" : ""}`,
      ),
    );
    for (const tie of plan.gears[i]) {
      const g = gearRadius(tie, i);
      const gx = cx + offset(i, tie);
      if (gx !== cx)
        group.append(draw("line", { x1: cx, y1: cy, x2: gx, y2: cy, class: "shaft", "stroke-width": 5 }));
      group.append(draw("rect", { x: gx - 5, y: cy - g, width: 10, height: 2 * g, rx: 1.5, class: "gear" }));
    }
    group.append(
      r > 0
        ? draw("rect", {
            x: cx - width / 2,
            y: cy - Math.max(r, 2),
            width,
            height: 2 * Math.max(r, 2),
            rx: 2,
            class: "disc",
          })
        : draw("circle", { cx, cy, r: 3, class: "dot" }),
    );
    if (node.held)
      group.append(
        draw("path", {
          class: "held",
          d:
            `M${cx - 24} ${cy - 9}v18M${cx - 24} ${cy}h${24 - width / 2}` +
            [-9, -3, 3, 9].map((d) => `M${cx - 24} ${cy + d}l-6 4`).join(""),
        }),
      );
    if (loaded.has(i))
      group.append(
        draw(
          "path",
          { class: "load", d: `M${cx - 4} ${cy - r - 11}h8l-4 7z` },
          draw("title", {}, loaded.get(i).join("; ")),
        ),
      );
    svg.append(group);
    if (!labelled) return;
    const reach = Math.max(r, 4, ...plan.gears[i].map((tie) => gearRadius(tie, i)));
    if (plan.lines[plan.nodes[i].line].width === 1 && plan.gears[i].length) {
      // next to its gears
      const side = Math.max(...plan.gears[i].map((tie) => Math.abs(offset(i, tie)))) + 12;
      svg.append(draw("text", { x: cx + side, y: cy + (node.held ? -8 : 4) }, node.name));
    } else if (grounded.has(i)) {
      // above, where a spring to ground is below
      svg.append(
        draw("text", { x: cx, y: cy - reach - (loaded.has(i) ? 15 : 5), "text-anchor": "middle" }, node.name),
      );
    } else if (shortLabels) {
      svg.append(draw("text", { x: cx, y: cy + reach + 15, "text-anchor": "middle" }, node.name));
    } else {
      const ty = cy + reach + 8;
      svg.append(
        draw(
          "text",
          { x: cx + 4, y: ty, "text-anchor": "end", transform: `rotate(-55 ${cx + 4} ${ty})` },
          node.name,
        ),
      );
    }
  });
  // Names of meshes, next to their contact where there is no name of a node.
  const boxOf = (text, x, y) => ({ left: x - 2, right: x + 6.3 * text.length + 2, top: y - 10, bottom: y + 3 });
  const taken = [...svg.querySelectorAll("text:not([transform])")].map((label) => {
    const box = boxOf(label.textContent, Number(label.getAttribute("x")), Number(label.getAttribute("y")));
    const shift = label.getAttribute("text-anchor") === "middle" ? 3.15 * label.textContent.length : 0;
    return { ...box, left: box.left - shift, right: box.right - shift };
  });
  for (const tie of plan.ties) {
    const [a, b] = tie.nodes;
    const [xa, ya] = at(a),
      [xb, yb] = at(b);
    const ga = gearRadius(tie, a),
      contact = ya + (yb > ya ? ga : -ga);
    const tx = Math.max(xa + offset(a, tie), xb + offset(b, tie)) + 10;
    const text = tie.name + (tie.gap ? " (backlash)" : "");
    const free = (y) => {
      const box = boxOf(text, tx, y);
      return taken.every(
        (b) => b.left > box.right || b.right < box.left || b.top > box.bottom || b.bottom < box.top,
      );
    };
    const ty = [4, -9, 17, -22, 30].map((d) => contact + d).find(free) ?? contact + 4;
    taken.push(boxOf(text, tx, ty));
    svg.append(
      draw(
        "g",
        {},
        draw("title", {}, jointText(tie)),
        draw("text", { x: tx, y: ty, class: "quiet" }, text),
      ),
    );
  }
  return svg;
}

/// Curves of a mode shape over the train: one axis a line, in the order from top to bottom.
class ShapeView {
  constructor(model, plan, width, rowHeight, bare) {
    const widest = Math.max(...plan.lines.map((line) => line.width));
    const pitch = (width - (bare ? 10 : 120)) / Math.max(widest, 2);
    const { x, order } = place(plan, pitch, 0);
    // A bare view shows only the longest line.
    if (bare && widest === 1) return this.asRow(model.nodes.length, width, rowHeight);
    const shown = bare ? order.slice(0, 1) : [...order].reverse();
    this.amplitude = rowHeight * 0.42;
    const first = (line) => Math.min(...plan.lines[line].nodes.map(x));
    const left = Math.min(...shown.map(({ line }) => first(line))) - (bare ? 4 : 104);
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
            nodes.length === 1 ? model.nodes[nodes[0]].name : `${model.nodes[nodes[0]].name} …`,
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
