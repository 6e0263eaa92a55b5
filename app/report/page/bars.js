// Amplitudes of orders as bars.

const BAR_WIDTH = 720,
  BAR_HEIGHT = 190;

/// A bar for each order; the axis has a readable unit, the five largest bars are labelled with their orders.
function barChart(title, unit, orders, values) {
  const most = values.reduce((a, b) => (Number.isFinite(b) ? Math.max(a, b) : a), 0),
    readable = readableUnit(unit, most);
  const left = 62,
    top = 14,
    wide = BAR_WIDTH - left - 8,
    high = BAR_HEIGHT - top - 34;
  const ticks = niceTicks(0, most * readable.factor || 1, 5);
  const full = Math.max(ticks.at(-1).v, most * readable.factor) || 1;
  const y = (value) => top + high * (1 - value / full);
  const step = wide / orders.length,
    every = Math.ceil(34 / step);
  const named = [...values.keys()].sort((a, b) => values[b] - values[a]).slice(0, 5);
  const parts = [];
  for (const tick of ticks)
    parts.push(
      draw("line", { class: "axis", x1: left, x2: left + wide, y1: y(tick.v), y2: y(tick.v) }),
      draw("text", { class: "quiet", x: left - 5, y: y(tick.v) + 4, "text-anchor": "end" }, tick.label),
    );
  orders.forEach((order, i) => {
    const value = Number.isFinite(values[i]) ? values[i] * readable.factor : 0,
      x = left + i * step;
    parts.push(
      draw(
        "rect",
        { class: "bar", x: x + 0.15 * step, width: 0.7 * step, y: y(value), height: top + high - y(value) },
        draw("title", {}, `order ${orderText(order)}: ${quantity(values[i], unit)}`),
      ),
    );
    if (i % every === 0)
      parts.push(
        draw(
          "text",
          { class: "quiet", x: x + step / 2, y: top + high + 14, "text-anchor": "middle" },
          orderText(order),
        ),
      );
    if (named.includes(i) && value > 0.02 * full && step > 24)
      parts.push(
        draw("text", { x: x + step / 2, y: Math.max(11, y(value) - 3), "text-anchor": "middle" }, sig(value, 3)),
      );
  });
  parts.push(
    draw(
      "text",
      { class: "quiet", x: left + wide / 2, y: BAR_HEIGHT - 4, "text-anchor": "middle" },
      "order, per turn of the reference shaft",
    ),
  );
  return make(
    "figure",
    {},
    make("figcaption", {}, make("b", {}, title), make("span", { class: "unit" }, ` amplitude [${readable.unit}]`)),
    draw(
      "svg",
      { viewBox: `0 0 ${BAR_WIDTH} ${BAR_HEIGHT}`, width: BAR_WIDTH, class: "bars", role: "img", "aria-label": title },
      ...parts,
    ),
  );
}
