// The page, section by section.

function showHead() {
  const model = runs[0].result.model;
  document.title = `drev: ${model}${compared ? ", two runs" : ""}`;
  byId("title").append(
    compared && runs[1].result.model !== model ? `${model} and ${runs[1].result.model}` : model,
    compared ? ": two runs compared" : "",
  );
  byId("subtitle").append(compared ? `A: ${runs[0].command}  ·  B: ${runs[1].command}` : runs[0].about);
  for (const run of runs) {
    const notes = (run.notes ?? []).map((note) => `Note: ${note}.`);
    for (const text of [run.warning, ...(run.result.warnings ?? []), ...notes])
      if (text) byId("warnings").append(make("p", { class: "warning" }, prefixed(run, text)));
  }
  byId("contents").append(
    ...[...document.querySelectorAll("main section")].map((section) =>
      make("a", { href: `#${section.id}` }, section.querySelector("h2").textContent),
    ),
  );
  byId("footer").append(
    make(
      "p",
      {},
      `drev ${runs[0].version}, report of ${runs[0].made}. One file, made to be kept: it loads nothing ` +
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

function showModel() {
  const section = byId("model");
  const train = (r) => [
    r.model.nodes.map((node) => node.name),
    r.model.joints.map((joint) => [joint.name, joint.kind, joint.nodes]),
  ];
  for (const run of distinct(train)) {
    const svg = drawTrain(run.model);
    const held = run.model.nodes.filter((node) => node.held).map((node) => node.name);
    if (distinct(train).length > 1) section.append(make("h3", {}, `Run ${run.name}`));
    section.append(
      make(
        "figure",
        {},
        make("div", { class: "wide" }, svg),
        make(
          "figcaption",
          { class: "note" },
          `${run.model.nodes.length} nodes, ${run.model.unknowns} unknowns, ` +
            `${run.model.joints.length} joints, ${run.model.loads.length} loads` +
            (held.length
              ? `; ${held.join(", ")} ${held.length > 1 ? "move" : "moves"} as given (hatched)`
              : "") +
            ". Discs and shafts as " +
            "thick as the fourth root of inertia and stiffness, gears to scale among themselves; ▼ a load. " +
            "Point at a part for its data.",
        ),
      ),
    );
  }
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

/// Light, at the width of A4 between its margins, all charts drawn at once and finely.
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

for (const show of [
  showHead,
  showFigures,
  showModel,
  showModes,
  showCampbell,
  showHistories,
  showSpectra,
  showAccuracy,
  showMethod,
  showInputs,
  startControls,
])
  show();
window.drevCharts = charts; // for tests, and for the console
document.documentElement.dataset.ready = Math.round(performance.now());
drawNext();
