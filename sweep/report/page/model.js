// Shares of the variance by the model, with interactions, as grainsweep sensitivity prints them.
function modelShares({ columns, rows, says }) {
  return el("div", { class: "card" }, el("h3", {}, "Shares of the variance by the model"),
    rows.length > 0 ? table(columns.map((title, i) => (i === 0 ? [title] : [title, "number"])), rows) : null,
    says.map((text) => el("p", { class: "notes" }, `${capital(text)}.`)));
}

// The response model of the chosen observable: against each factor, and over the two most influential ones.
function modelSection(campaign, response) {
  const model = campaign.models.find((one) => one.observable === response.name);
  if (!model) return null;
  if (model.refused) return section("model", "Response model", `Not available: ${model.refused}.`);
  const [a, b] = model.over, cards = (figure, caption) => paintedCards(campaign, response.name, figure, caption);
  const curves = cards("model", (name) => [`${model.observable} against ${name}`, ""]);
  const maps = cards("model-map", (panel) => [`${model.observable} against ${a} and ${b}`,
    panel === "mid-range" ? `Other factors at mid-range: ${model.others}.` : model.others ? "Average over the other factors." : "Mean response."]);
  return section("model", "Response model", "Predictions between the computed cases. Blue: other factors at mid-range, with the 95 % bands of the mean (shaded) and of a single run (dashed); at words a dot and whiskers. Orange: average over the other factors." + failedSays(model.failed),
    el("div", { class: "grid" }, curves), el("div", { class: "grid wide" }, maps), modelShares(model.influence), el("div", { class: "card" }, model.says.trim().split("\n").map((text) => el("p", { class: "notes" }, text))));
}
