// Numbers, units and elements.

const DIGITS = 4;
const SUPERSCRIPT = {
  "-": "⁻",
  0: "⁰",
  1: "¹",
  2: "²",
  3: "³",
  4: "⁴",
  5: "⁵",
  6: "⁶",
  7: "⁷",
  8: "⁸",
  9: "⁹",
};

/// A number with so many significant digits: 91.68, 43 530, 1.5·10⁻⁷.
function sig(x, digits = DIGITS) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(Number(x.toPrecision(digits)))));
  if (exponent < -4 || exponent > 6) {
    const [mantissa, power] = x.toExponential(digits - 1).split("e");
    const m = mantissa.replace("-", "−");
    return `${m}·10${[...String(Number(power))].map((c) => SUPERSCRIPT[c]).join("")}`;
  }
  const text = x.toFixed(Math.max(0, digits - 1 - exponent)).replace("-", "−");
  const [whole, part] = text.split(".");
  const grouped = whole.replace(/\d(?=(\d{3})+$)/g, whole.replace("−", "").length > 4 ? "$&\u202f" : "$&");
  return part ? `${grouped}.${part}` : grouped;
}

/// A number on an axis, without trailing zeros.
function tidy(x) {
  const text = sig(x, 6);
  const [mantissa, power] = text.split("·");
  return (mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa) + (power ? `·${power}` : "");
}

const integer = (n) => String(n).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
const orderText = (order) => tidy(Number(order.toPrecision(4)));
const percent = (x, digits = 3) => (Number.isFinite(x) ? `${sig(100 * x, digits)}\u00a0%` : "–");

/// A unit as text: "rad/s^2" -> "rad/s²", with no-break spaces.
const unitText = (unit) => (unit || "").replace("^2", "²").replaceAll(" ", "\u00a0");

const PREFIXES = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];

/// Factor and name of a readable unit for a quantity of this size: N -> kN, rad -> mrad.
function readableUnit(unit, size) {
  const found = size > 0 ? PREFIXES.find(([value]) => size >= value) || PREFIXES.at(-1) : PREFIXES[3];
  // From 1 to 10 000 no prefix is needed.
  const [value, prefix] = size >= 1 && size < 1e4 ? PREFIXES[3] : found;
  return { factor: 1 / value, unit: prefix + unitText(unit) };
}

function quantity(x, unit, digits = DIGITS) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  const readable = unit ? readableUnit(unit, Math.abs(x)) : { factor: 1, unit: "" };
  return `${sig(x * readable.factor, digits)}${readable.unit ? "\u00a0" + readable.unit : ""}`;
}

/// An element with attributes and children (texts or elements).
function make(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

function draw(tag, attributes = {}, ...children) {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes))
    if (typeof value === "function") element.addEventListener(name, value);
    else element.setAttribute(name, value);
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

/// A text escaped for the chart library, which reads its texts as HTML, so that it is shown unchanged.
const asMarkup = (text) => String(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);

const byId = (id) => document.getElementById(id);
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/// A table from rows of cells; cells with numbers are right-aligned. head: texts of the header.
function table(head, rows, attributes = {}) {
  const cell = (tag, value, right) =>
    make(tag, right ? { class: "n" } : {}, value instanceof Node ? value : String(value));
  const right = head.map(
    (_, i) => rows.length > 0 && rows.every((row) => /^[−+\d–±<]|^rounding$/.test(String(row[i]))),
  );
  return make(
    "div",
    { class: "wide" },
    make(
      "table",
      attributes,
      make(
        "thead",
        {},
        make(
          "tr",
          {},
          head.map((text, i) => cell("th", text, right[i])),
        ),
      ),
      make(
        "tbody",
        {},
        rows.map((row) =>
          make(
            "tr",
            row.changed ? { class: "changed" } : {},
            row.map((value, i) => cell("td", value, right[i])),
          ),
        ),
      ),
    ),
  );
}

/// "mesh_1.force_N" -> {place: "mesh_1", quantity: "force"}
function channelName(name) {
  const dot = name.lastIndexOf(".");
  if (dot < 0) return { place: name, quantity: "" };
  const quantities = { angle: "angle, deviation", speed: "speed, deviation" };
  const what = name.slice(dot + 1).split("_")[0];
  return { place: name.slice(0, dot), quantity: quantities[what] || what };
}
