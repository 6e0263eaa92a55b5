// The page of shafts given by their contours: drawing with stress, stiffness, stations.

const page = JSON.parse(document.querySelector("script.run").textContent);
const SHAFT_WIDTH = 900,
  SHAFT_DRAWN = 200, // largest height of the drawing [px]
  SHAFT_AROUND = 40;

/// The contour, mirrored at its axis, in bands whose darkness shows their nominal shear stress.
function contourFigure(shaft) {
  const z = shaft.outline.z_m,
    r = shaft.outline.radius_m,
    stress = shaft.outline.stress_Pa_per_Nm;
  const most = Math.max(...r),
    peak = Math.max(...stress),
    length = z.at(-1);
  const scale = Math.min((SHAFT_WIDTH - 20) / length, SHAFT_DRAWN / (2 * most));
  const x = (at) => 10 + scale * at,
    height = Math.ceil(2 * scale * most + SHAFT_AROUND),
    middle = scale * most + 10,
    parts = [];
  for (let i = 0; i + 1 < z.length; i += 1) {
    const high = scale * r[i];
    parts.push(
      draw(
        "rect",
        {
          x: x(z[i]),
          y: middle - high,
          width: x(z[i + 1]) - x(z[i]) + 0.3,
          height: 2 * high,
          style: `fill: var(--c1); fill-opacity: ${(0.12 + (0.88 * stress[i]) / peak).toFixed(3)}`,
        },
        draw("title", {}, `z ${sig(1e3 * z[i], 4)} mm, radius ${sig(1e3 * r[i], 4)} mm, ${sig(stress[i] / 1e6)} MPa per N m`),
      ),
    );
  }
  parts.push(
    draw("line", { class: "axis", x1: 0, x2: SHAFT_WIDTH, y1: middle, y2: middle, "stroke-dasharray": "12 3 2 3" }),
  );
  for (const station of shaft.stations)
    parts.push(
      draw("line", { class: "axis", x1: x(station.from_m), x2: x(station.from_m), y1: height - 18, y2: height - 10 }),
    );
  return make(
    "figure",
    {},
    make(
      "div",
      { class: "wide" },
      draw("svg", { viewBox: `0 0 ${SHAFT_WIDTH} ${height}`, width: SHAFT_WIDTH, role: "img", "aria-label": `contour of ${shaft.name}` }, ...parts),
    ),
    make(
      "figcaption",
      { class: "note" },
      `${sig(1e3 * length, 5)} mm long, to scale; the darker, the larger the nominal shear stress on the surface, ` +
        `at most ${sig(peak / 1e6)} MPa per N m. Marks below: stations.`,
    ),
  );
}

function showHead() {
  document.title = `drev: ${page.model}, shafts`;
  byId("title").append(`${page.model}: shafts by their contours`);
  byId("subtitle").append(page.about || "");
  showContents();
  showFooter(page);
}

function showShafts() {
  for (const shaft of page.shafts)
    byId("shafts").append(
      make("h3", {}, `${shaft.name}, ${shaft.nodes[0]} to ${shaft.nodes[1]}`),
      contourFigure(shaft),
      table(
        ["", "value"],
        [
          ["torsional stiffness", `${quantity(shaft.stiffness_Nm_per_rad, "N m/rad", 6)} ± ${sig(shaft.stiffness_error_Nm_per_rad, 2)} N m/rad (mesh, ${integer(shaft.unknowns)} unknowns)`],
          ["sum of its stations", `${quantity(shaft.naive_stiffness_Nm_per_rad, "N m/rad", 6)}: ${percent(shaft.naive_excess)} too stiff`],
          ["softest, stiffest", `${quantity(shaft.softest_Nm_per_rad, "N m/rad", 5)}, ${quantity(shaft.stiffest_Nm_per_rad, "N m/rad", 5)}`],
          ["inertia", quantity(shaft.inertia_kg_m2, "kg m^2", 6)],
          ["segments", String(shaft.segments.length)],
        ],
      ),
      make(
        "div",
        { class: "stations" },
        table(
          ["station", "from [mm]", "length [mm]", "d [mm]", "bore [mm]", "J [mm⁴]", "own stiffness [N\u00a0m/rad]", "in the shaft [N\u00a0m/rad]", "inertia [kg\u00a0m²]", "stress factor", "at"],
          shaft.stations.map((s) => [
            s.name,
            sig(1e3 * s.from_m, 5),
            sig(1e3 * s.length_m, 5),
            sig(1e3 * s.diameter_m, 5),
            sig(1e3 * s.bore_m, 4),
            sig(1e12 * s.torsion_constant_m4, 6),
            sig(s.own_stiffness_Nm_per_rad, 5),
            sig(s.stiffness_Nm_per_rad, 5),
            sig(s.inertia_kg_m2, 5),
            s.stress_factor === null ? "no limit" : sig(s.stress_factor, 4),
            s.stress_place,
          ]),
        ),
      ),
    );
}

function showInputs() {
  byId("inputs").append(make("p", {}, make("code", {}, page.command)));
  if (page.inputs.length)
    byId("inputs").append(
      table(["parameter", "value", "default", "unit", "meaning"], page.inputs.map((i) => [i.name, String(i.value), String(i.default), i.unit || "", i.meaning])),
    );
}

showAll(showHead, showShafts, showInputs);
