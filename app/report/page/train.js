// The train as a schematic.
//
// Parts that turn together about one axis (joined by anything but gears) lie on one line, the longest chain in
// the main row, branches below. Lines in mesh touch at their gears; gears on a carrier are joined on its line.

const PITCH_LEAST = 24,
  DISC = 34,
  GEAR = 52,
  THICKEST = 7; // sizes [px]; disc and gear: largest radii
const MOST_LABELS = 60; // largest number of labels on one line
const LETTER = 6.8; // width of a letter of a label [px]
const TILT = (-55 * Math.PI) / 180; // of names that have no room beside each other [rad]
/// A name as a drawing has room for it; the title of its part has all of it.
const shortName = (name) => (name.length > 32 ? `${name.slice(0, 20)}…${name.slice(-11)}` : name);
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
  const nameWidth = labelled ? LETTER * Math.max(...model.nodes.map((node) => shortName(node.name).length)) : 0;
  const shortLabels = nameWidth + LETTER < pitch; // names have room beside each other
  const labelHeight = shortLabels ? 18 : nameWidth * Math.sin(-TILT) + 6;

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
  const grounded = new Set(
    model.joints.filter((joint) => joint.nodes.length < 2).map((joint) => joint.nodes[0]),
  );
  const top =
    Math.min(...plan.lines.map((_, i) => y[i] - half[i])) - 26 - (grounded.size && !shortLabels ? labelHeight : 0);
  // How far a name reaches to either side of its node: tilted to one, above a spring to ground to the other.
  const reachOf = nameWidth * (shortLabels ? 0.5 : Math.cos(TILT));
  const besideGears = (i) => plan.lines[plan.nodes[i].line].width === 1 && plan.gears[i].length > 0;
  const left = -Math.max(46, reachOf + 4),
    right =
      Math.max(
        ...model.nodes.map((_, i) => x(i) + (besideGears(i) ? nameWidth + 30 : reachOf)),
        ...plan.ties.map((tie) => x(tie.nodes[0]) + 100),
      ) + 60;
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
    const name = shortName(node.name);
    const tilted = (anchor, tx, ty) =>
      draw("text", { x: tx, y: ty, "text-anchor": anchor, transform: `rotate(${(180 * TILT) / Math.PI} ${tx} ${ty})` }, name);
    const level = (y) => draw("text", { x: cx, y, "text-anchor": "middle" }, name);
    if (besideGears(i)) {
      // next to its gears
      const side = Math.max(...plan.gears[i].map((tie) => Math.abs(offset(i, tie)))) + 12;
      svg.append(draw("text", { x: cx + side, y: cy + (node.held ? -8 : 4) }, name));
    } else if (grounded.has(i)) {
      // above, where a spring to ground is below
      const ty = cy - reach - (loaded.has(i) ? 15 : 5);
      svg.append(shortLabels ? level(ty) : tilted("start", cx + 4, ty));
    } else svg.append(shortLabels ? level(cy + reach + 15) : tilted("end", cx + 4, cy + reach + 8));
  });
  // Names of meshes, next to their contact where there is no name of a node.
  const boxOf = (text, x, y) => ({ left: x - 2, right: x + LETTER * text.length + 2, top: y - 10, bottom: y + 3 });
  const taken = [...svg.querySelectorAll("text:not([transform])")].map((label) => {
    const box = boxOf(label.textContent, Number(label.getAttribute("x")), Number(label.getAttribute("y")));
    const shift = label.getAttribute("text-anchor") === "middle" ? 0.5 * LETTER * label.textContent.length : 0;
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
