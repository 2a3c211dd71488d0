// The selected case: its inputs and responses. The event `grainsweep:case` of the document announces it.
let selected = null;  // { index of the campaign, row }
const selectionChanged = [];

// Whether the page holds a film of a case, and the rows of a campaign that have one.
const filmPlayer = window.grainsweepWatch;
function hasFilm(model, row) { return Boolean(filmPlayer) && filmPlayer.hasFilm(model.campaign.name, model.id(row)); }
function filmedRows(model) {
  if (!filmPlayer) return [];
  if (!model.filmed) model.filmed = Array.from({ length: model.rows }, (_, row) => row).filter((row) => hasFilm(model, row));
  return model.filmed;
}

function casePanel() { return document.getElementById("case-panel"); }

function closeCase() {
  selected = null;
  casePanel().hidden = true;
  document.dispatchEvent(new CustomEvent("grainsweep:closed"));
  document.body.classList.remove("with-panel");
  selectionChanged.forEach((changed) => changed());
}

function selectCase(model, row) {
  selected = { index: model.index, row };
  const { campaign } = model, id = model.id(row);
  const line = (variable) => {
    const shown = quantity(variable, [variable.values[row]]);
    return [el("span", { title: variable.meaning }, variable.name), variable.levels.length > 0 ? textOf(variable, row) : Number.isFinite(variable.values[row]) ? show(variable.values[row] * shown.factor, 6) : "–", shown.unit];
  };
  const list = (title, variables) => [el("h3", {}, title), table([["", ""], ["", "number"], ["", "unit"]], variables.map(line))];
  const failure = campaign.failures.listed.find((one) => one.case === id);
  casePanel().replaceChildren(
    el("div", { class: "caption" }, el("h2", {}, `Point ${model.places[0].values[row]}` + (model.places[1] ? `, replicate ${model.places[1].values[row]}` : "")),
      button("✕", closeCase, { "aria-label": "close" })),
    el("p", { class: "says" }, `${campaignTitle(campaign)} · ${model.outcome(row)}`),
    failure ? el("p", { class: "warning" }, failure.reason) : "",
    el("div", { class: "watch" }),
    ...list("Inputs", model.factors), ...list("Responses", model.responses),
    el("p", { class: "says" }, "Recompute this case: ", el("code", {}, `grainsweep replay ${campaign.database} ${id}`)));
  casePanel().hidden = false;
  document.body.classList.add("with-panel");
  selectionChanged.forEach((changed) => changed());
  document.dispatchEvent(new CustomEvent("grainsweep:case", { detail: { database: campaign.database, campaign: campaign.name, case_id: id } }));
}

document.addEventListener("keydown", (event) => { if (event.key === "Escape" && selected) closeCase(); });
