// Sections with text and tables.

/// Name, unit, key of the place, key of the error.
const RESULT_NAMES = {
  deflection_deg: ["Largest deflection", "°", "deflection_of", "deflection_error"],
  deflection_m: ["Largest deflection", "m", "deflection_of", "deflection_error"],
  max_torque_Nm: ["Largest torque", "N m", "max_torque_at", "max_error"],
  max_force_N: ["Largest force", "N", "max_force_at", "max_error"],
  static_torque_Nm: ["Static torque", "N m", "static_at"],
  static_force_N: ["Static force", "N", "static_at"],
  dynamic_amplification: ["Dynamic amplification, largest over static", "", null],
  max_mesh_force_N: ["Largest mesh force", "N", "max_mesh_force_at", "max_mesh_force_error"],
  front_contacts: ["Impacts on front flanks", "", null],
  back_contacts: ["Impacts on back flanks", "", null],
  time_separated_s: ["Time separated, all contacts", "s", null],
};

const unitOf = (key) => {
  const endings = {
    _Nm: "N m",
    _N: "N",
    _s: "s",
    _Hz: "Hz",
    _m: "m",
    _deg: "°",
    _J: "J",
    _W: "W",
    _m_per_s: "m/s",
    _rad_per_s: "rad/s",
    _rad: "rad",
    _per_s: "1/s",
  };
  const found = Object.keys(endings)
    .sort((a, b) => b.length - a.length)
    .find((ending) => key.endsWith(ending));
  return found ? [key.slice(0, -found.length), endings[found]] : [key, ""];
};

/// The significant digits of a value, down to the second digit of its error, as in the table of drev run.
const earnedDigits = (x, error) =>
  error > 0 ? Math.min(15, Math.max(2, Math.ceil(Math.log10(Math.abs(x) / error)) + 1)) : 12;

/// A value, with its error if that is known: the digits are then those of the table of drev run, in the same
/// unit.
const valueText = (x, unit, error) => {
  if (error !== null && error !== undefined)
    return `${sig(x, earnedDigits(x, error))} ± ${sig(error, 2)}${unit === "°" ? "°" : "\u00a0" + unitText(unit)}`;
  return unit === "°" ? `${sig(x)}°` : Number.isInteger(x) && !unit ? integer(x) : quantity(x, unit);
};

/// The time span that the figures belong to, and the evidence for their accuracy.
function spanText(run) {
  const r = run.result.results,
    of = r.of;
  const part = of.from_s > 0 ? `of the run from ${sig(of.from_s)} s to ${sig(of.to_s)} s` : "of the whole run";
  return (
    `Figures are ${part}, which starts ${of.start}${of.reason ? `; ${of.reason}` : ""}.` +
    (run.result.accuracy ? "" : " Unchecked: --accuracy gives their errors.") +
    (r.static_reason ? ` No static torque or amplification: ${r.static_reason}.` : "")
  );
}

function figuresOf(run) {
  const r = run.result.results,
    list = [];
  for (const [key, [name, unit, place, error]] of Object.entries(RESULT_NAMES))
    if (r[key] !== null && r[key] !== undefined)
      list.push({
        name,
        unit,
        value: r[key],
        error: error && r[error],
        where: place && r[place] ? r[place] : "",
      });
  if (r.frequencies_Hz && r.frequencies_Hz.length)
    list.push({
      name: "First natural frequency",
      unit: "Hz",
      value: r.frequencies_Hz[0],
      where: `${r.rigid_modes} rigid modes`,
    });
  const e = run.result.energy_error;
  if (e !== null && e !== undefined)
    list.push({ name: "Energy error", unit: "%", value: 100 * e, where: "of the largest energy of the run" });
  return list;
}

const figureText = (figure) =>
  figure.unit === "%"
    ? Math.abs(figure.value) < 1e-10
      ? "rounding"
      : percent(figure.value / 100, 2)
    : valueText(figure.value, figure.unit, figure.error);

const difference = (a, b) => {
  if (!Number.isFinite(a) || !Number.isFinite(b)) return "–";
  if (a === b || Math.max(Math.abs(a), Math.abs(b)) < 1e-10) return "0";
  return a === 0 ? "–" : `${b > a ? "+" : ""}${percent((b - a) / Math.abs(a), 3)}`;
};

function showFigures() {
  const section = byId("figures");
  if (!compared) {
    section.append(
      make(
        "div",
        { class: "cards" },
        figuresOf(runs[0]).map((f) =>
          make(
            "div",
            { class: "card" },
            make("div", { class: "what" }, f.name),
            make("div", { class: "value" }, figureText(f)),
            make("div", { class: "where" }, f.where),
          ),
        ),
      ),
    );
  } else {
    const [a, b] = runs.map(figuresOf);
    const names = [...new Set([...a, ...b].map((f) => f.name))];
    section.append(
      table(
        ["", "A", "B", "B against A", "where (A)"],
        names.map((name) => {
          const [fa, fb] = [a, b].map((list) => list.find((f) => f.name === name));
          return [
            name,
            fa ? figureText(fa) : "–",
            fb ? figureText(fb) : "–",
            difference(fa?.value, fb?.value),
            fa?.where ?? "",
          ];
        }),
      ),
    );
  }
  for (const run of runs)
    if (run.result.results.of?.start)
      section.append(make("p", { class: "note" }, prefixed(run, spanText(run))));
  for (const run of runs) showSections(section, run);
  for (const run of runs)
    if (run.result.note) section.append(make("p", { class: "note" }, prefixed(run, run.result.note)));
}

/// The load of each section compared with its limits, and its load cycles.
function showSections(section, run) {
  const carried = run.result.results.sections ?? [],
    counted = run.result.results.rainflow ?? [];
  if (carried.length) {
    const limited = carried.some((s) => s.permissible !== null);
    const settled = run.result.results.of.from_s > 0;
    section.append(
      make("h3", {}, headed(run, "What sections carry")),
      table(
        [
          "section",
          "unit",
          "largest",
          "smallest",
          ...(settled ? ["settled largest", "settled smallest"] : []),
          settled ? "settled half range" : "half range",
          ...(limited ? ["permissible half range", "used"] : []),
        ],
        carried.map((s) => [
          s.channel,
          s.unit,
          sig(s.peak_maximum, 5),
          sig(s.peak_minimum, 5),
          ...(settled ? [sig(s.maximum, 5), sig(s.minimum, 5)] : []),
          sig(s.half_range, 5),
          ...(limited
            ? [
                s.permissible === null ? "–" : sig(s.permissible, 5),
                s.permissible === null ? "–" : percent(s.half_range / s.permissible),
              ]
            : []),
        ]),
      ),
    );
  }
  showElements(section, run);
  if (!counted.length) return;
  section.append(
    make("h3", {}, headed(run, "Load cycles (rainflow, ASTM E1049)")),
    table(
      ["section", "cycles", "largest range", "Miner's sum", "until 1 [h]"],
      counted.map((c) => [
        c.channel,
        sig(c.cycles, 6),
        quantity(c.largest_range, c.unit),
        c.damage === null ? "no S-N line" : sig(c.damage),
        c.hours_to_failure === null ? "–" : sig(c.hours_to_failure, 3),
      ]),
    ),
    ...counted.map((c) =>
      make(
        "details",
        {},
        make("summary", {}, `Classes of ${c.channel}`),
        table(
          [`range, mean of the class [${unitText(c.unit)}]`, "cycles"],
          c.classes.map((one) => [sig(one.mean_range), sig(one.cycles, 6)]),
        ),
      ),
    ),
  );
}

/// Work, heat and stored energy of each element, if they were requested.
function showElements(section, run) {
  const elements = run.result.results.elements ?? [];
  if (!elements.length) return;
  const cell = (value) => (value === null ? "–" : sig(value, 5));
  section.append(
    make("h3", {}, headed(run, "Energy of elements")),
    table(
      ["element", "work [J]", "dissipated [J]", "mean dissipation [W]", "largest stored [J]"],
      [...elements]
        .sort((a, b) => (b.dissipated_J ?? 0) - (a.dissipated_J ?? 0))
        .map((e) => [
          e.element,
          cell(e.work_J),
          cell(e.dissipated_J),
          cell(e.mean_dissipation_W),
          cell(e.largest_stored_J),
        ]),
    ),
  );
}

/// A text with the prefix "Run A: " if there are two runs.
const prefixed = (run, text) => (run.name ? `Run ${run.name}: ${text}` : text);
const headed = (run, text) => (run.name ? `${text} of run ${run.name}` : text);

function showContactTable(section) {
  for (const run of runs) {
    const contacts = run.result.results.contacts || [];
    if (!contacts.length) continue;
    // All numbers that the run gives for each contact.
    const keys = Object.keys(contacts[0]).filter(
      (key) => key !== "element" && contacts.some((c) => typeof c[key] === "number"),
    );
    const heads = keys.map((key) => {
      const [name, unit] = unitOf(key);
      return (
        name.replaceAll("_", " ").replace("max at time", "at time").replace(/ error$/, " ±") +
        (unit ? ` [${unit}]` : key.endsWith("_share") ? " [%]" : "")
      );
    });
    section.append(
      make("h3", {}, headed(run, "Contacts")),
      table(
        ["element", ...heads.map((h) => h.replace(" share", ""))],
        contacts.map((c) => [
          c.element,
          ...keys.map((key) =>
            key.endsWith("_share")
              ? sig(100 * c[key], 3)
              : Number.isInteger(c[key])
                ? integer(c[key])
                : sig(c[key]),
          ),
        ]),
      ),
    );
    showImpacts(section, run, contacts);
  }
}

/// Distributions of the speed before and the largest force of each impact, by flank.
function showImpacts(section, run, contacts) {
  for (const [key, name] of [
    ["impact_speed", "Speed at impact"],
    ["impact_force", "Largest force of each impact"],
  ]) {
    const rows = contacts.flatMap((c) =>
      ["front", "back"]
        .filter((flank) => c[key]?.[flank]?.count > 0)
        .map((flank) => {
          const d = c[key][flank],
            readable = readableUnit(c[key].unit, d.max);
          return [c.element, flank, integer(d.count), readable.unit].concat(
            [d.mean, d.p50, d.p90, d.p99, d.max].map((x) => sig(x * readable.factor, 3)),
          );
        }),
    );
    if (!rows.length) continue;
    const head = [
      "element",
      "flank",
      "impacts",
      "unit",
      "mean",
      "median",
      "90 % below",
      "99 % below",
      "largest",
    ];
    section.append(make("h3", {}, headed(run, name)), table(head, rows));
  }
}

function showEnergyTable(section) {
  const rows = (run) => {
    const e = run.result.energy;
    const start = e.kinetic_J + e.stored_J - e.input_J + e.dissipated_J - e.imbalance_J;
    const clean = (x) => (Math.abs(x) < 1e-12 * e.scale_J ? 0 : x);
    return [
      ["At the start", clean(start)],
      ["+ put in by loads and known motions", e.input_J],
      ["− dissipated", -e.dissipated_J],
      ["+ gained (lost) by the method", e.imbalance_J],
      ["= kinetic at the end", e.kinetic_J],
      ["+ stored at the end", e.stored_J],
      ["Largest imbalance of the run", e.worst_imbalance_J],
      ["Largest energy of the run", e.scale_J],
    ];
  };
  const all = runs.map(rows);
  section.append(
    table(
      ["", ...runs.map((run) => (run.name ? `${run.name} [J]` : "[J]"))],
      all[0].map(([name], i) => [name, ...all.map((list) => sig(list[i][1]))]),
    ),
  );
  for (const run of runs) {
    const e = run.result.energy;
    section.append(
      make(
        "p",
        {},
        prefixed(
          run,
          e.scale_J > 0
            ? `The balance is off by ${percent(Math.abs(e.worst_imbalance_J / e.scale_J), 2)} of the ` +
                `largest energy, worst at ` +
                `${sig(e.worst_at_time_s)} s. What is off is energy that the method itself gained or lost.`
            : "There was no energy but that of the nominal rotation.",
        ),
      ),
    );
  }
}

function showAccuracy() {
  const section = byId("accuracy");
  for (const run of runs) {
    const a = run.result.accuracy;
    if (!a) {
      section.append(
        make(
          "p",
          {},
          prefixed(
            run,
            "No accuracy was asked for, so no error of the figures is stated; what speaks " +
              "for them is the method's tolerance or step below and the energy balance above. drev run … " +
              "--accuracy 1e-4 finds the " +
              "error of each figure.",
          ),
        ),
      );
      continue;
    }
    section.append(
      make(
        "p",
        {},
        prefixed(
          run,
          `Asked for: a relative error of ${tidy(a.asked)}: ` +
            (a.reached ? "reached." : `not reached: ${a.reason}.`) +
            ` Found by comparing ${a.coarse} with ${a.fine}.` +
            (a.growth ? ` A small difference grows ${sig(a.growth, 3)} times at most.` : "") +
            (a.horizon_s ? ` Beyond ${sig(a.horizon_s)} s, figures are statistics.` : ""),
        ),
      ),
    );
    section.append(
      table(
        ["figure", "value", "± error", "unit", "what the error is", "keeps it"],
        a.figures.map((f) => [
          f.name,
          Number.isInteger(f.value)
            ? integer(f.value)
            : sig(
                f.value,
                f.error === null ? 3 : earnedDigits(f.value, f.error),
              ),
          sig(f.error, 2),
          unitText(f.unit),
          f.kind,
          f.keeps_accuracy === null ? "" : f.keeps_accuracy ? "yes" : "no",
        ]),
      ),
    );
  }
}

function showMethod() {
  const section = byId("method");
  const rows = [
    ["Method", (r) => r.method],
    ["Why", (r) => r.method_reason],
    ["Reduction", (r) => r.reduction?.reason ?? "–"],
    ["Tolerance", (r) => (r.tolerance ? sig(r.tolerance, 3) : "–")],
    ["Step", (r) => (r.step_s ? quantity(r.step_s, "s") : "found by the method")],
    ["Simulated", (r) => `${sig(r.t_end_s, 6)} s`],
    [
      "Steps",
      (r) => integer(r.steps) + (r.rejected_steps ? `, and ${integer(r.rejected_steps)} rejected` : ""),
    ],
    [
      "Contact changes located",
      (r) => ((r.contact_changes ?? r.located) !== null ? integer(r.contact_changes ?? r.located) : "–"),
    ],
    ["Status", (r) => r.status + (r.reason ? `: ${r.reason}` : "")],
    ["Time of the computation", (r) => quantity(r.run_time_s, "s", 3)],
  ];
  section.append(
    table(
      ["", ...runs.map((run) => run.name)],
      [
        ...rows.map(([name, of]) => [name, ...runs.map((run) => of(run.result))]),
        ["drev", ...runs.map((run) => `version ${run.version}, ${run.made}`)],
      ],
    ),
  );
  for (const run of runs)
    section.append(make("p", {}, prefixed(run, "again with "), make("code", {}, run.command)));
}

function showInputs() {
  const section = byId("inputs"),
    rows = [];
  for (const input of runs[0].inputs) {
    const others = runs.slice(1).map((run) => run.inputs.find((i) => i.name === input.name)?.value ?? "–");
    const row = [input.name, input.value, ...others, input.unit, input.default, input.range, input.meaning];
    row.changed = [input.value, ...others].some((value) => value !== input.default);
    rows.push(row);
  }
  for (const input of (runs[1]?.inputs ?? []).filter((i) => !runs[0].inputs.some((j) => j.name === i.name)))
    rows.push([input.name, "–", input.value, input.unit, input.default, input.range, input.meaning]);
  section.append(
    table(["parameter", ...(compared ? ["A", "B"] : ["value"]), "unit", "default", "range", "meaning"], rows),
  );
}
