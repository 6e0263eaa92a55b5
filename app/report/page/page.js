// The parts that all pages share: contents, footer, theme, printing.

const stopAnimations = [],
  startAnimations = [];

function showContents() {
  byId("contents").append(
    ...[...document.querySelectorAll("main section")].map((section) =>
      make("a", { href: `#${section.id}` }, section.querySelector("h2").textContent),
    ),
  );
}

function showFooter(data) {
  byId("footer").append(
    make(
      "p",
      {},
      `drev ${data.version}, report of ${data.made}. One file, made to be kept: it loads nothing ` +
        `from anywhere. Charts: dygraphs ${Dygraph.VERSION} (MIT licence). Colours after M. Okabe and K. Ito.`,
    ),
    make(
      "details",
      {},
      make("summary", {}, "Licence of dygraphs"),
      make("pre", {}, byId("licence").textContent.trim()),
    ),
  );
}

/// Title, contents and footer of a page of one block.
function showTitle(page) {
  document.title = `drev: ${page.model_name}, ${page.title}`;
  byId("title").append(`${page.model_name}: ${page.title}`);
  byId("subtitle").append(page.about);
  showContents();
  showFooter(page);
}

/// The command that reproduces the page, and the model's parameters.
function showInputTable(page) {
  byId("inputs").append(
    make("p", {}, make("code", {}, page.command)),
    table(
      ["parameter", "value", "unit", "default", "range", "meaning"],
      page.inputs.map((input) => {
        const row = [input.name, input.value, input.unit, input.default, input.range, input.meaning];
        row.changed = !input.varied && input.value !== input.default;
        return row;
      }),
    ),
  );
}

/// The figure of the train, with a line below it that explains the drawing.
function trainFigure(model) {
  const held = model.nodes.filter((node) => node.held).map((node) => node.name);
  return make(
    "figure",
    {},
    make("div", { class: "wide" }, drawTrain(model)),
    make(
      "figcaption",
      { class: "note" },
      `${model.nodes.length} nodes, ${model.unknowns} unknowns, ` +
        `${model.joints.length} joints, ${model.loads.length} loads` +
        (held.length ? `; ${held.join(", ")} ${held.length > 1 ? "move" : "moves"} as given (hatched)` : "") +
        ". Discs and shafts as " +
        "thick as the fourth root of inertia and stiffness, gears to scale among themselves; ▼ a load. " +
        "Point at a part for its data.",
    ),
  );
}

function setTheme(theme) {
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
}

function showTheme(theme) {
  setTheme(theme);
  drawAll();
  charts.forEach((chart) => chart.draw());
}

/// Layout for printing: light theme, width of A4 between its margins, all charts drawn at once with high
/// resolution.
function layOutForPaper(on) {
  if (printing === on) return;
  printing = on;
  const root = document.documentElement;
  root.classList.toggle("paper", on);
  if (on) stopAnimations.forEach((stop) => stop());
  drawAll();
  setTheme(on ? "light" : byId("theme").value);
  charts.forEach((chart) => chart.resize());
  if (!on) startAnimations.forEach((start) => start());
}

function startControls() {
  const select = byId("theme");
  select.addEventListener("change", () => showTheme(select.value));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => showTheme(select.value));
  byId("print").addEventListener("click", () => print());
  let timer = 0;
  addEventListener("resize", () => {
    clearTimeout(timer);
    if (!printing) timer = setTimeout(() => charts.forEach((chart) => chart.resize()), 150);
  });
  addEventListener("beforeprint", () => layOutForPaper(true));
  addEventListener("afterprint", () => layOutForPaper(false));
}

/// Calls the functions that fill the sections, then draws.
function showAll(...shows) {
  for (const show of [...shows, startControls]) show();
  window.drevCharts = charts; // for tests and the console
  document.documentElement.dataset.ready = Math.round(performance.now());
  drawNext();
}
