// A chart as a file: PNG, SVG or CSV. One function paints the chart, on a canvas or as SVG.

const SAVED_WIDTH = 900,
  SAVED_HEIGHT = 420,
  SAVED_FONT = "12px system-ui, 'DejaVu Sans', sans-serif";

/// The part of a canvas context that charts use, written as SVG.
class SvgContext {
  constructor(width, height) {
    Object.assign(this, { strokeStyle: "#000", fillStyle: "#000", lineWidth: 1, font: SAVED_FONT });
    Object.assign(this, { textAlign: "left", size: [width, height], parts: [], path: "", dash: [], clips: 0 });
    this.kept = [];
    this.measure = document.createElement("canvas").getContext("2d");
  }
  save() {
    const { strokeStyle, fillStyle, lineWidth, textAlign, dash, turned, clips } = this;
    this.kept.push({ strokeStyle, fillStyle, lineWidth, textAlign, dash, turned, clips });
  }
  restore() {
    const kept = this.kept.pop();
    for (; this.clips > kept.clips; --this.clips) this.parts.push("</g>");
    Object.assign(this, kept);
  }
  setLineDash(dash) {
    this.dash = dash;
  }
  beginPath() {
    this.path = "";
  }
  moveTo(x, y) {
    this.path += `M${x.toFixed(2)} ${y.toFixed(2)}`;
  }
  lineTo(x, y) {
    this.path += `L${x.toFixed(2)} ${y.toFixed(2)}`;
  }
  arc(x, y, r) {
    const [left, radius] = [(x - r).toFixed(2), r.toFixed(2)];
    this.path +=
      `M${left} ${y.toFixed(2)}a${radius} ${radius} 0 1 0 ${(2 * r).toFixed(2)} 0` +
      `a${radius} ${radius} 0 1 0 ${(-2 * r).toFixed(2)} 0`;
  }
  rect(x, y, w, h) {
    this.path += `M${x} ${y}h${w}v${h}h${-w}z`;
  }
  stroke() {
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.join(" ")}"` : "";
    this.parts.push(
      `<path d="${this.path}" fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}"${dash}/>`,
    );
  }
  fill() {
    this.parts.push(`<path d="${this.path}" fill="${this.fillStyle}"/>`);
  }
  fillRect(x, y, width, height) {
    this.parts.push(`<path d="M${x} ${y}h${width}v${height}h${-width}z" fill="${this.fillStyle}"/>`);
  }
  clip() {
    const name = `clip${this.parts.length}`;
    this.parts.push(`<clipPath id="${name}"><path d="${this.path}"/></clipPath><g clip-path="url(#${name})">`);
    ++this.clips;
  }
  measureText(text) {
    this.measure.font = this.font;
    return this.measure.measureText(text);
  }
  fillText(text, x, y) {
    const anchor = { right: "end", center: "middle" }[this.textAlign] ?? "start";
    this.parts.push(
      `<text x="${x.toFixed(2)}" y="${y.toFixed(2)}" text-anchor="${anchor}" fill="${this.fillStyle}" ` +
        `font-size="${parseFloat(this.font)}">${asMarkup(text)}</text>`,
    );
  }
  text() {
    const [width, height] = this.size;
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" ` +
      `viewBox="0 0 ${width} ${height}" font-family="system-ui, DejaVu Sans, sans-serif">` +
      `${this.parts.join("")}</svg>`
    );
  }
}

/// Values at equal distances of 1, 2 or 5 times a power of ten, about `count` of them.
function niceTicks(low, high, count) {
  const rough = (high - low) / count,
    power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= rough * 0.999);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push({ v: k * step, label: tidy(k * step) });
  return ticks;
}

/// Paints the chart as it is shown, in the colours for paper.
function paintChart(context, chart, width, height) {
  const o = chart.options,
    { rows, sparse } = chart.data(),
    looks = chart.looks(sparse),
    [x0, x1] = chart.graph.xAxisRange(),
    [y0, y1] = chart.graph.yAxisRange();
  context.font = SAVED_FONT;
  const named = o.labels.map((label, i) => ({ label: String(label), color: looks.colors[i] }));
  const legend = { rows: [[]], width: 0 };
  for (const one of named) {
    one.width = 34 + context.measureText(one.label).width + 14;
    if (legend.width + one.width > width - 90 && legend.rows.at(-1).length)
      (legend.rows.push([]), (legend.width = 0));
    legend.rows.at(-1).push(one);
    legend.width += one.width;
  }
  const area = { x: 72, y: 30, w: width - 90, h: height - 30 - 46 - 16 * legend.rows.length };
  const scale = o.log ? Math.log10 : (y) => y;
  const g = {
    toDomXCoord: (x) => area.x + ((x - x0) / (x1 - x0)) * area.w,
    toDomYCoord: (y) => area.y + ((scale(y1) - scale(y)) / (scale(y1) - scale(y0))) * area.h,
    xAxisRange: () => [x0, x1],
    yAxisRange: () => [y0, y1],
  };
  Object.assign(context, { fillStyle: "#ffffff" });
  context.fillRect(0, 0, width, height);
  const write = (text, x, y, align, color = "#1a1d21") => {
    Object.assign(context, { fillStyle: color, textAlign: align, font: SAVED_FONT });
    context.fillText(text, x, y);
  };
  write(o.savedTitle ?? (chart.caption.textContent || o.title), area.x, 18, "left");
  for (const tick of niceTicks(x0, x1, 9)) {
    const x = g.toDomXCoord(tick.v);
    line(context, x, area.y, x, area.y + area.h, "#e4e8ec");
    write(tick.label, x, area.y + area.h + 16, "center");
  }
  for (const tick of o.log ? decades(y0, y1) : niceTicks(y0, y1, 7)) {
    const y = g.toDomYCoord(tick.v);
    line(context, area.x, y, area.x + area.w, y, "#e4e8ec");
    write(tick.label, area.x - 6, y + 4, "right");
  }
  write(String(o.xLabel), area.x + area.w / 2, area.y + area.h + 34, "center");
  context.save();
  context.beginPath();
  context.rect(area.x, area.y, area.w, area.h);
  context.clip();
  if (o.underlay) o.underlay(context, area, g);
  named.forEach(({ label, color }, i) => {
    const look = looks.series[curveName(o.labels[i])];
    Object.assign(context, { strokeStyle: color, fillStyle: color, lineWidth: look.strokeWidth || 1 });
    context.setLineDash(look.strokePattern ?? []);
    context.beginPath();
    let drawn = false;
    for (const row of rows) {
      const y = row[i + 1];
      if (y === null || y === undefined || Number.isNaN(y)) continue;
      const at = [g.toDomXCoord(row[0]), g.toDomYCoord(y)];
      if (look.drawPoints) context.arc(at[0], at[1], look.pointSize ?? 3, 0, 2 * Math.PI);
      else context[drawn ? "lineTo" : "moveTo"](...at);
      drawn = true;
    }
    if (look.drawPoints) context.fill();
    else context.stroke();
  });
  context.restore();
  line(context, area.x, area.y, area.x, area.y + area.h, "#59616b");
  line(context, area.x, area.y + area.h, area.x + area.w, area.y + area.h, "#59616b");
  legend.rows.forEach((row, r) => {
    let x = area.x;
    const y = height - 8 - 16 * (legend.rows.length - 1 - r);
    for (const one of row) {
      const look = looks.series[curveName(one.label)] ?? {};
      line(context, x, y - 4, x + 26, y - 4, one.color, look.strokePattern ?? []);
      write(one.label, x + 32, y, "left");
      x += one.width;
    }
  });
}

/// Calls paint with the colours for paper, whatever the theme.
function onPaper(paint) {
  const root = document.documentElement,
    theme = root.dataset.theme;
  root.dataset.theme = "light";
  try {
    return paint();
  } finally {
    if (theme === undefined) delete root.dataset.theme;
    else root.dataset.theme = theme;
  }
}

function chartAsSvg(chart) {
  const context = new SvgContext(SAVED_WIDTH, SAVED_HEIGHT);
  onPaper(() => paintChart(context, chart, SAVED_WIDTH, SAVED_HEIGHT));
  return context.text();
}

function chartAsCanvas(chart) {
  const canvas = document.createElement("canvas"),
    fine = 2;
  Object.assign(canvas, { width: fine * SAVED_WIDTH, height: fine * SAVED_HEIGHT });
  const context = canvas.getContext("2d");
  context.scale(fine, fine);
  onPaper(() => paintChart(context, chart, SAVED_WIDTH, SAVED_HEIGHT));
  return canvas;
}

/// The points shown, as CSV; a text that a spreadsheet would read as a formula is escaped.
function chartAsCsv(chart) {
  const cell = (text) => `"${(/^[=+\-@\t\r]/.test(text) ? "'" : "") + text.replaceAll('"', '""')}"`;
  const o = chart.options;
  const title = o.savedTitle ?? (chart.caption.textContent || o.title);
  const head = [String(o.xLabel), ...o.labels.map((label) => `${label}`)].map(cell).join(",");
  const lines = chart.data().rows.map((row) => row.map((v) => (v === null ? "" : String(v))).join(","));
  return [`# ${title}`.replaceAll("\n", " "), head, ...lines].join("\n") + "\n";
}

function download(name, blob) {
  const url = URL.createObjectURL(blob);
  make("a", { download: name, href: url }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/// Buttons that save a chart.
function saveButtons(chart) {
  const name = String(chart.options.title).replace(/[^\w.-]+/g, "_");
  const kinds = {
    PNG: () => chartAsCanvas(chart).toBlob((blob) => download(`${name}.png`, blob), "image/png"),
    SVG: () => download(`${name}.svg`, new Blob([chartAsSvg(chart)], { type: "image/svg+xml" })),
    CSV: () => download(`${name}.csv`, new Blob([chartAsCsv(chart)], { type: "text/csv" })),
  };
  return make(
    "div",
    { class: "save" },
    Object.entries(kinds).map(([kind, click]) =>
      make(
        "button",
        {
          type: "button",
          title: `Save this chart as ${kind}`,
          "aria-label": `Save ${chart.options.title} as ${kind}`,
          click: () => {
            drawAll();
            click();
          },
        },
        kind,
      ),
    ),
  );
}
