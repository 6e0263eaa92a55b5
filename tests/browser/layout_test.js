// The train of random trees: every node has a place of its own, on a line that is large enough.
const script = require("fs").readFileSync(process.argv[2], "utf8");
const layout = new Function(script + "; return layout;")();
let seed = 1;
const random = (below) => {
  seed = (1103515245 * seed + 12345) % 2147483648;
  return Math.floor((seed / 2147483648) * below);
};
for (let trial = 0; trial < 2000; ++trial) {
  const count = 2 + random(25);
  const joints = [];
  for (let i = 1; i < count; ++i) joints.push({ kind: random(8) ? "shaft" : "mesh", nodes: [random(i), i] });
  const plan = layout({ nodes: Array.from({ length: count }, () => ({})), joints });
  const places = new Set(plan.nodes.map(({ line, row, x }) => `${line} ${row} ${x}`));
  const inside = plan.nodes.every(({ line, row, x }) => row < plan.lines[line].rows && x < plan.lines[line].width);
  if (places.size !== count || !inside) throw new Error("train " + JSON.stringify(joints));
}
