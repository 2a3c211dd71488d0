// The response model of the observable that is shown, where the page has one: against each factor, and over the two that
// matter most.
function modelSection(campaign, response) {
  const model = campaign.models.find((one) => one.observable === response.name);
  if (!model) return null;
  if (model.refused) return section("model", "Response model", `There is none: ${model.refused}.`);
  const factors = model.factors.map((f) => Object.assign({ meaning: "", values: [f.low, f.high] }, f)), { map, middle } = model;
  const variable = { name: model.observable, unit: model.unit, levels: [] };
  const settingText = (j) => { const f = factors[j]; return `${f.name} ${f.levels.length > 0 ? middle.texts[j] : shownOf(f).says(middle.setting[j])}`; };
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
      return numbers.length === 0 ? null : cellMap(map, factors, values, { title: `${model.observable} over ${a} and ${b}`, says, variable, failed: model.failed, tones: () => colouring(variable, numbers) });
    };
    maps.push(drawn(map.averaged, rest.length > 0 ? "The other factors averaged over their ranges." : "Mean response."));
    if (rest.length > 0) maps.push(drawn(map.slice, `The other factors at the middle: ${rest.map(settingText).join(", ")}.`));
  }
  return section("model", "Response model", "What the cases say of settings that were not run. Blue: the other factors at the middle of their ranges, shaded where the mean lies within with 95 %, dashed a single run; orange: the other factors averaged over their ranges." + failedSays(model.failed),
    el("div", { class: "grid" }, curves), el("div", { class: "grid wide" }, maps.filter(Boolean)), el("div", { class: "card" }, model.says.trim().split("\n").map((text) => el("p", { class: "notes" }, text))));
}
