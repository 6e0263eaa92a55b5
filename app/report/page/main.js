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
  showContents();
  showFooter(runs[0]);
}

function showModel() {
  const section = byId("model");
  const train = (r) => [
    r.model.nodes.map((node) => node.name),
    r.model.joints.map((joint) => [joint.name, joint.kind, joint.nodes]),
  ];
  for (const run of distinct(train)) {
    if (distinct(train).length > 1) section.append(make("h3", {}, `Run ${run.name}`));
    section.append(trainFigure(run.model));
  }
}

showAll(
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
);
