// The page of a class calculation: judgement, mass-elastic system, rules; the other sections are those of a
// sweep.

const judged = page.class;
const caseTitle = (one) => (one.name === "normal" ? "Normal firing" : "One cylinder misfiring");

const verdictText = (one) =>
  one.accepted === null
    ? "not decided: limits that are given could not be judged"
    : one.accepted
      ? "within all limits that are given"
      : "limits exceeded";

const passingTexts = {
  permitted: "yes",
  "near rated speed": "no",
  "above transient limit": "no",
  "no transient limit given": "not judged: no limit for passing is given",
  "no rated speed given": "not judged: no rated speed is given",
};

function showJudgement() {
  const section = byId("judgement");
  for (const one of judged.cases) {
    section.append(
      make("h3", {}, `${caseTitle(one)}: ${verdictText(one)}`),
      ...one.undecided.map((text) => make("p", { class: "warning" }, text)),
      table(
        [
          "section",
          "d [mm]",
          "half range [N m]",
          "stress [MPa], half range",
          "permissible [N m]",
          "used",
          "at [rpm]",
          "heat [W]",
          "by",
        ],
        one.sections.map((s) => {
          const unbounded = (value, text) => (s.unbounded && value === null ? "unbounded" : text(value));
          const stress = s.stress_of_rule === "nominal" ? s.worst_nominal_stress_Pa : s.worst_stress_Pa;
          const heat = sig(s.heat_W) + (s.permissible_heat_W === null ? "" : ` of ${sig(s.permissible_heat_W)}`);
          return [
            s.section,
            s.diameter_m === null ? "–" : sig(1e3 * s.diameter_m) + (s.bore_m ? ` / ${sig(1e3 * s.bore_m)}` : ""),
            unbounded(s.worst_half_range_Nm, (value) => sig(value, 5)),
            s.diameter_m === null ? "–" : unbounded(stress, (value) => `${sig(value / 1e6)} ${s.stress_of_rule}`),
            s.worst_permissible_Nm === null ? "–" : sig(s.worst_permissible_Nm),
            s.rule === null ? "–" : unbounded(s.utilisation, percent),
            s.rule === null ? "–" : sig(s.utilisation_at_rpm, 5),
            s.heat_exceeds ? `${heat}, exceeded at ${sig(s.heat_at_rpm, 5)} rpm` : heat,
            (s.rule ?? "torque not judged") +
              (s.permissible_heat_W === null ? "" : s.heat_exceeds === null ? ", heat not judged" : ", permissible heat"),
          ];
        }),
      ),
    );
    // An end that is known no better than between two speeds of the sweep has the speed outside behind it.
    const end = (speed, kept) =>
      sig(speed, 5) + (kept !== null && Math.abs(kept - speed) > 1e-5 * speed ? ` (not at ${sig(kept, 5)})` : "");
    const exceeded = one.sections.flatMap((s) =>
      s.exceeded.map((r) => [
        s.section,
        `${r.open_from ? "≤ " : ""}${end(r.from_rpm, r.kept_below_rpm)}`,
        `${r.open_to ? "≥ " : ""}${end(r.to_rpm, r.kept_above_rpm)}`,
        r.worst === null ? "unbounded" : percent(r.worst),
        sig(r.worst_rpm, 5),
        passingTexts[r.passing],
      ]),
    );
    if (exceeded.length)
      section.append(
        make("p", {}, "Ranges of speed in which the limit for continuous running is exceeded:"),
        table(["section", "from [rpm]", "to [rpm]", "used", "at [rpm]", "may be barred"], exceeded),
        exceeded.some((row) => row[5] === "no")
          ? make(
              "p",
              { class: "note" },
              "No range may be barred, and passed quickly, that reaches 0.8 of the rated speed or exceeds the limit for " +
                "passing.",
            )
          : "",
      );
    const barred = one.sections.flatMap((s) =>
      s.barred_by_rule.map((b) => [
        s.section,
        sig(b.critical_rpm, 6),
        orderText(b.order),
        b.mode,
        sig(b.speed_ratio, 3),
        b.from_rpm === null ? "none permitted" : `${sig(b.from_rpm, 5)} to ${sig(b.to_rpm, 5)}`,
      ]),
    );
    if (barred.length)
      section.append(
        make("p", {}, "Barred ranges by IACS UR M68.5, about the criticals in these ranges:"),
        table(["section", "critical [rpm]", "order", "mode", "speed ratio", "barred [rpm]"], barred),
      );
    for (const s of one.sections)
      if (s.rule_ends_rpm !== null)
        section.append(
          make(
            "p",
            { class: "note" },
            `${s.section}: IACS UR M68.5 has no limit above ${sig(s.rule_ends_rpm, 5)} rpm, 1.05 of the rated speed; ` +
              `from there to ${sig(judged.speeds_rpm.at(-1), 5)} rpm ` +
              (s.rule_beyond === null ? "the torque is not judged." : `the ${s.rule_beyond} alone holds.`),
          ),
        );
    if (one.chatter.length)
      section.append(
        make("p", {}, "Chatter: vibratory over mean force in a mesh above 1"),
        table(
          ["mesh", "from [rpm]", "to [rpm]", "largest ratio", "at [rpm]", judged.contact === "closed" ? "speeds and peaks at which teeth would separate" : "speeds and peaks at which teeth separate"],
          one.chatter.map((r) => [
            r.section,
            end(r.from_rpm, r.kept_below_rpm),
            end(r.to_rpm, r.kept_above_rpm),
            r.worst === null ? "unbounded" : sig(r.worst, 3),
            sig(r.worst_rpm, 5),
            r.separated_speeds,
          ]),
        ),
      );
    if (one.not_judged.length)
      section.append(make("p", { class: "note" }, `Without a limit, not judged: ${one.not_judged.join(", ")}.`));
  }
}

function showMassElastic() {
  const section = byId("masselastic"),
    m = judged.mass_elastic;
  section.append(
    trainFigure(page.model),
    table(
      ["node", "speed ratio", "inertia [kg m²], as it stands", "referred to the reference shaft"],
      m.nodes.map((n) => [n.name, sig(n.ratio, 5), sig(n.inertia, 6), sig(n.inertia * n.ratio * n.ratio, 6)]),
    ),
    table(
      ["joint", "between", "kind", "stiffness [N m/rad; mesh N/m]", "damping [N m s/rad; mesh N s/m]"],
      m.joints.map((j) => [
        j.name,
        j.nodes.join(" – "),
        j.kind,
        j.stiffness === null ? "–" : sig(j.stiffness, 6),
        j.damping === null ? "–" : sig(j.damping, 4),
      ]),
    ),
  );
}

function showRules() {
  const list = (title, texts) => [
    make("h3", {}, title),
    make(
      "ul",
      {},
      texts.map((text) => make("li", {}, text)),
    ),
  ];
  byId("rules").append(...list("Formulas", judged.rules), ...list("Not judged", judged.not_covered));
}

showAll(
  showHead,
  showJudgement,
  showMassElastic,
  showFigures,
  showCharts,
  showBars,
  showDiagram,
  showRules,
  showParameters,
);
