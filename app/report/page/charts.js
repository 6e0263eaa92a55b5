// Charts (dygraphs); all charts of one kind show the same range of x.

const DASHES = [null, [7, 4], [2, 3], [9, 3, 2, 3]];
const charts = [];
let printing = false;

/// Charts not yet drawn: they are drawn one after the other, so that the page can be used meanwhile.
const waiting = [];

function drawNext() {
  if (waiting.length) {
    waiting.shift().draw();
    setTimeout(drawNext);
  } else {
    document.documentElement.dataset.drawn = Math.round(performance.now());
  }
}

function drawAll() {
  while (waiting.length) waiting.shift().draw();
}

const runColor = (i) => style(`--c${i}`);

/// Charts that share their x axis: zoomed and moved together.
class Group {
  constructor(whole, describe) {
    this.whole = whole; // [from, to]
    this.window = [...whole];
    this.charts = [];
    this.describe = describe; // function called with the window after each change
  }
  add(chart) {
    this.charts.push(chart);
    charts.push(chart);
    waiting.push(chart);
  }
  show(from, to) {
    const [low, high] = this.whole,
      least = (high - low) * 1e-7;
    const width = Math.min(high - low, Math.max(to - from, least));
    const begin = Math.min(Math.max(from, low), high - width);
    this.window = [begin, begin + width];
    // Visible charts are drawn at once, the others when the browser is idle.
    const inSight = (chart) => {
      const box = chart.element.getBoundingClientRect();
      return box.bottom > 0 && box.top < innerHeight;
    };
    const later = this.charts.filter((chart) => !inSight(chart) || (chart.draw(), false));
    clearTimeout(this.timer);
    this.timer = setTimeout(() => later.forEach((chart) => chart.draw()), 120);
    this.describe(this.window);
  }
  zoom(factor, center) {
    const [from, to] = this.window;
    const c = center ?? 0.5 * (from + to);
    this.show(c - (c - from) * factor, c + (to - c) * factor);
  }
  move(part) {
    const [from, to] = this.window,
      width = to - from;
    this.show(from + part * width, to + part * width);
  }
  reset() {
    for (const chart of this.charts)
      chart.graph?.updateOptions({ valueRange: chart.options.valueRange ?? null }, true);
    this.show(...this.whole);
  }
}

/// Drag: zoom; with Shift: move; wheel with Ctrl: zoom about the pointer; double click: the whole range.
function interaction(group) {
  const D = Dygraph;
  return {
    mousedown(event, g, context) {
      if (event.button > 0) return;
      context.initializeMouseDown(event, g, context);
      (event.shiftKey ? D.startPan : D.startZoom)(event, g, context);
      const move = (e) => {
        if (context.isZooming) return D.moveZoom(e, g, context);
        D.movePan(e, g, context);
        cancelAnimationFrame(group.frame);
        group.frame = requestAnimationFrame(() => group.show(...g.xAxisRange()));
      };
      const up = (e) => {
        // wherever the pointer is, and before dygraphs' own listener, which ends the zoom
        document.removeEventListener("mousemove", move);
        document.removeEventListener("mouseup", up, true);
        (context.isZooming ? D.endZoom : D.endPan)(e, g, context);
      };
      document.addEventListener("mousemove", move);
      document.addEventListener("mouseup", up, true);
    },
    dblclick: () => group.reset(),
    wheel(event, g) {
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      group.zoom(Math.exp(Math.sign(event.deltaY) * 0.25), g.toDataXCoord(event.offsetX));
    },
    touchstart: (event, g, context) => D.defaultInteractionModel.touchstart(event, g, context),
    touchmove: (event, g, context) => {
      D.defaultInteractionModel.touchmove(event, g, context);
      group.show(...g.xAxisRange());
    },
    touchend: (event, g, context) => D.defaultInteractionModel.touchend(event, g, context),
  };
}

function keys(group) {
  const actions = {
    "+": () => group.zoom(0.5),
    "=": () => group.zoom(0.5),
    "-": () => group.zoom(2),
    ArrowLeft: () => group.move(-0.25),
    ArrowRight: () => group.move(0.25),
    0: () => group.reset(),
    Home: () => group.reset(),
  };
  return (event) => {
    if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
  };
}

/// Buttons for all charts of a group, and the text with the range shown.
function toolbar(group, ...more) {
  const button = (text, label, click) =>
    make("button", { type: "button", "aria-label": label, title: label, click }, text);
  group.output = make("output", {});
  return make(
    "div",
    { class: "toolbar", keydown: keys(group) },
    button("Whole", "Show all of it (0)", () => group.reset()),
    button("+", "Zoom in (+)", () => group.zoom(0.5)),
    button("−", "Zoom out (−)", () => group.zoom(2)),
    button("◀", "Earlier (left arrow)", () => group.move(-0.25)),
    button("▶", "Later (right arrow)", () => group.move(0.25)),
    ...more,
    group.output,
  );
}

/// Names of curves for dygraphs, which finds curves by them and treats some words (__proto__) as its own: a
/// zero-width space in front prevents that. It shows names as text, but reads titles of axes as HTML.
const curveName = (label) => `\u200b${label}`;

/// One chart. options: {group, title, caption, labels, rows(from, to, columns) -> {rows, sparse}, xName, xLabel; and
/// where they are not the default: yLabel, valueRange, log, legend, tall, middle, colors(), series(label, i),
/// underlay}.
class Chart {
  constructor(parent, options) {
    this.options = options;
    this.element = make("div", {
      class: options.tall ? "chart tall" : options.middle ? "chart middle" : "chart",
      tabindex: "0",
      role: "img",
      "aria-label": `${options.title}; zoom with + and −, move with the arrow keys`,
      keydown: keys(options.group),
    });
    this.caption = make("figcaption", {}, options.caption || make("b", {}, options.title));
    parent.append(make("figure", {}, saveButtons(this), this.caption, this.element));
    options.group.add(this);
  }
  columns() {
    return Math.max(200, Math.round(this.element.clientWidth - 70));
  }
  colors() {
    return this.options.colors ? this.options.colors() : this.options.labels.map((_, i) => runColor(i));
  }
  data() {
    const [from, to] = this.options.group.window;
    const got = this.options.rows(from, to, this.columns());
    this.points = got.rows.length;
    this.element.dataset.points = this.points;
    return got;
  }
  looks(sparse) {
    const o = this.options;
    const strokes = Object.fromEntries(
      o.labels.map((label, i) => [
        curveName(label),
        {
          strokeWidth: sparse ? 1.6 : 1,
          strokePattern: sparse ? DASHES[i % DASHES.length] : null,
          ...(o.series ? o.series(label, i) : {}),
        },
      ]),
    );
    return {
      colors: this.colors(),
      series: strokes,
      gridLineColor: style("--grid"),
      axisLineColor: style("--line"),
      pixelRatio: printing ? 3 : Math.max(1, devicePixelRatio || 1),
    };
  }
  draw() {
    const { rows, sparse } = this.data(),
      o = this.options,
      window = [...o.group.window];
    if (this.graph) {
      this.graph.updateOptions({ file: rows, dateWindow: window, ...this.looks(sparse) });
      return;
    }
    this.graph = new Dygraph(this.element, rows, {
      labels: [o.xName, ...o.labels.map(curveName)],
      dateWindow: window,
      ...this.looks(sparse),
      logscale: !!o.log,
      xlabel: asMarkup(o.xLabel),
      ...(o.yLabel ? { ylabel: asMarkup(o.yLabel) } : {}),
      xLabelHeight: 17,
      yLabelWidth: 16,
      axisLabelFontSize: 11,
      connectSeparatedPoints: true,
      highlightCircleSize: 3,
      legend: o.legend ?? "follow",
      labelsSeparateLines: true,
      interactionModel: interaction(o.group),
      animatedZooms: false,
      ...(o.valueRange ? { valueRange: o.valueRange } : {}),
      axes: {
        x: {
          valueFormatter: (x) => `${o.xName} ${sig(x, 7)}`,
          axisLabelFormatter: (x) => tidy(x),
          pixelsPerLabel: 55,
        },
        y: {
          valueFormatter: (y) => sig(y, 5),
          axisLabelFormatter: (y) => tidy(y),
          axisLabelWidth: o.tall ? 58 : 52,
          ticker: o.log ? decades : (low, high, pixels) => heights(low, high, pixels / (o.tall ? 40 : 28)),
        },
      },
      zoomCallback: (from, to) => o.group.show(from, to),
      underlayCallback: o.underlay ? (context, area, g) => o.underlay(context, area, g) : null,
    });
  }
  resize() {
    if (!this.graph) return;
    this.graph.updateOptions(this.looks(false), true);
    this.graph.resize();
    this.draw();
  }
}

const LIMIT_SHOWN = 2.5; // largest limit shown, relative to the largest value of the curves [-]
const largest = (values) => values.reduce((a, b) => (Number.isFinite(b) && b > a ? b : a), 0);

/// The limits of a section that are drawn with curves up to `most`, and a remark on the others.
function limitsOf(all, most, unit) {
  const limits = all.filter((limit) => largest(limit.values) <= LIMIT_SHOWN * most);
  const above = all.filter((limit) => !limits.includes(limit));
  const texts = above.map((limit) => `${limit.name}, ${quantity(largest(limit.values), unit)}`);
  return {
    limits,
    farAbove: texts.length ? make("span", { class: "unit" }, ` Far above the chart: ${texts.join("; ")}.`) : null,
  };
}

/// A short line in the colour and dashes of a curve.
function keyMark(color, dash) {
  const mark = draw(
    "line",
    { x1: 0, x2: 22, y1: 5, y2: 5, "stroke-width": 2, ...(dash ? { "stroke-dasharray": dash.join(" ") } : {}) },
  );
  mark.style.stroke = `var(${color})`;
  const svg = draw("svg", { class: "mark", width: 22, height: 10, "aria-hidden": "true" }, mark);
  return svg;
}

/// Ticks of a logarithmic axis: powers of ten, at most five of them labelled.
function decades(low, high) {
  const first = Math.ceil(Math.log10(low) - 1e-9),
    last = Math.floor(Math.log10(high) + 1e-9);
  const every = Math.ceil((last - first + 1) / 5);
  return Array.from({ length: last - first + 1 }, (_, i) => {
    const v = 10 ** (first + i);
    return { v, label: (last - first - i) % every ? "" : tidy(v) };
  });
}

/// Ticks of a y axis, about `count` of them, at least three.
function heights(low, high, count) {
  let ticks = [];
  for (let n = Math.max(count, 3); ticks.length < 3 && n < 100; n *= 1.3) ticks = niceTicks(low, high, n);
  return ticks;
}

/// Text next to a place in a chart, unless it would cover another text.
class Labels {
  constructor(context, area) {
    Object.assign(this, { context, area, taken: [] });
    context.font = "11px system-ui, 'DejaVu Sans', sans-serif";
  }
  put(text, x, y, color, align = "left") {
    const width = this.context.measureText(text).width,
      left = align === "right" ? x - width : x;
    const box = { left: left - 3, right: left + width + 3, top: y - 11, bottom: y + 3 };
    if (
      box.left < this.area.x - 1 ||
      box.right > this.area.x + this.area.w + 1 ||
      box.top < this.area.y ||
      box.bottom > this.area.y + this.area.h
    )
      return false;
    if (
      this.taken.some(
        (b) => b.left < box.right && b.right > box.left && b.top < box.bottom && b.bottom > box.top,
      )
    )
      return false;
    this.taken.push(box);
    Object.assign(this.context, { fillStyle: color, textAlign: "left" });
    this.context.fillText(text, left, y);
    return true;
  }
}

function line(context, x0, y0, x1, y1, color, dash = []) {
  context.save();
  Object.assign(context, { strokeStyle: color, lineWidth: 1 });
  context.setLineDash(dash);
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
  context.restore();
}

/// The flank of a gap in contact over time: the part of each pixel's time, front from below, back from above.
class Band {
  constructor(parent, group, run, band, chart) {
    Object.assign(this, { group, run, band, chart });
    this.element = make("canvas", {
      class: "band",
      role: "img",
      "aria-label": `Contact of ${band.element} over time`,
    });
    parent.append(
      make(
        "figure",
        {},
        make(
          "figcaption",
          {},
          make("b", {}, `${band.element}${run.name ? ", run " + run.name : ""}`),
          make("span", { class: "unit" }, ` contact: part of the time on each flank`),
        ),
        this.element,
      ),
    );
    group.add(this);
  }
  draw() {
    if (!this.chart.graph) return;
    const { times, end } = this.run.history;
    const area = this.chart.graph.getArea(),
      width = Math.round(area.w),
      height = 44;
    const ratio = printing ? 3 : devicePixelRatio || 1;
    Object.assign(this.element, { width: width * ratio, height: height * ratio });
    Object.assign(this.element.style, { width: `${width}px`, marginLeft: `${area.x}px` });
    const context = this.element.getContext("2d");
    context.scale(ratio, ratio);
    context.fillStyle = style("--open");
    context.fillRect(0, 0, width, height);
    const [from, to] = this.group.window,
      per = (to - from) / width;
    const colors = [style("--front"), style("--back")];
    this.points = 0;
    for (let c = 0; c < width; ++c) {
      const t0 = from + c * per,
        t1 = t0 + per;
      if (t0 >= end) break;
      let first = placeOf(times, t0);
      if (first > 0 && (first === times.length || times[first] > t0)) --first;
      let front = 0,
        back = 0,
        time = 0;
      for (let i = first; i < times.length && times[i] < t1; ++i) {
        const next = i + 1 < times.length ? times[i + 1] : end;
        const span = Math.min(next, t1) - Math.max(times[i], t0);
        if (span <= 0) continue;
        ((front += span * this.band.front[i]), (back += span * this.band.back[i]), (time += span));
      }
      if (time <= 0) continue;
      ++this.points;
      const heights = [front, back].map((s) => (s > 0 ? Math.max(1, (height * s) / (255 * time)) : 0));
      context.fillStyle = colors[0];
      context.fillRect(c, height - heights[0], 1, heights[0]);
      context.fillStyle = colors[1];
      context.fillRect(c, 0, 1, heights[1]);
    }
    this.element.dataset.points = this.points;
  }
  resize() {
    this.draw();
  }
}
