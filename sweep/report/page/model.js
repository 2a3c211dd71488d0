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
  const factors = model.factors.map((f) => Object.assign({ meaning: "", values: [f.low, f.high] }, f)), { map, middle } = model;
  const variable = { name: model.observable, unit: model.unit, levels: [] };
  const settingText = (j) => { const f = factors[j]; return `${f.name} ${middle.setting[j] === null ? middle.texts[j] : shownOf(f).says(middle.setting[j])}`; };
  const curves = model.order.map((j) => {
    const curve = model.curves[j], value = quantity(variable, curve.mean.concat(curve.averaged).filter((x) => x !== null));
    return bandCurve(factors[j], curve.at, curve, { title: `${model.observable} against ${factors[j].name}`, value, failed: model.failed.map((one) => one.setting[j]) });
  });
  const maps = [];
  if (map) {
    const [a, b] = [factors[map.across].name, factors[map.up].name];
    const rest = factors.map((_, j) => j).filter((j) => j !== map.across && j !== map.up);
    const drawn = (values, says) => {
      const numbers = values.filter((x) => x !== null);
      return numbers.length === 0 ? null : cellMap(map, factors, values, { title: `${model.observable} against ${a} and ${b}`, says, variable, failed: model.failed, tones: () => colouring(variable, numbers) });
    };
    maps.push(drawn(map.averaged, rest.length > 0 ? "Average over the other factors." : "Mean response."));
    if (rest.length > 0) maps.push(drawn(map.slice, `Other factors at mid-range: ${rest.map(settingText).join(", ")}.`));
  }
  return section("model", "Response model", "Predictions between the computed cases. Blue: other factors at mid-range, with the 95 % bands of the mean (shaded) and of a single run (dashed); at levels a bar and whiskers. Orange: average over the other factors." + failedSays(model.failed),
    el("div", { class: "grid" }, curves), el("div", { class: "grid wide" }, maps.filter(Boolean)), modelShares(model.influence), el("div", { class: "card" }, model.says.trim().split("\n").map((text) => el("p", { class: "notes" }, text))));
}
