// The page of a process window: the setting, its predictions, the map over the two most influential factors, and every
// response against every factor through the setting.
const chosen = { campaign: 0 };
const { factors, responses } = data;
const wanted = data.where || "no condition";
const sure = `${Number((100 * (1 - data.risk)).toPrecision(4))} %`;

function settingText(one, j) {
  if (one.setting[j] === null) return one.texts[j];
  const factor = factors[j], shown = quantity(factor);
  if (factor.levels.length > 0) return shown.says(factor.numbers.length > 0 ? factor.numbers.indexOf(one.setting[j]) : one.setting[j]);
  return `${show(shown.of(one.setting[j]), 6)}${shown.unit ? " " + shown.unit : ""}`;
}
function responseScale(k) { return quantity(responses[k]); }
function withWidth(k, mean, width) { const s = responseScale(k); return withError(s.of(mean), s.of(width)) + (s.unit ? ` ${s.unit}` : ""); }

function settingSection() {
  const { best } = data;
  const says = data.meets
    ? `${data.objective ? `Setting with the ${data.goal}` : "Most probable setting"} where ${data.where ? `"${data.where}" holds` : "the response is defined"} with probability ${sure} or more. The probability is that of ${data.single_run ? "a single run" : "the mean of many runs"}.`
    : `No setting meets "${wanted}" with probability ${sure}. This one has the largest probability.`;
  const near = data.failed_near ? ` Here ${data.failed_near}.` : "";
  const set = table([["factor"], ["value", "number"]], factors.map((f, j) => [f.name, settingText(best, j)]));
  const gives = table([["response"], ["mean, 95 %", "number"], ["a single run, 95 %", "number"]],
    responses.map((r, k) => { const one = best.responses[k]; return [r.name, withWidth(k, one.mean, one.mean_half_width), "± " + withError(responseScale(k).of(one.run_half_width), NaN)]; }));
  const share = `${show(100 * data.share, 3)} ± ${show(100 * data.share_error, 1)} %`;
  return section("setting", "Setting", says + near,
    el("div", { class: "tiles" }, tile(share, `of ${data.share_of} is in the window`), tile(show(best.probability, 3), "probability of the condition", !data.meets)),
    el("div", { class: "grid wide" }, el("div", { class: "card" }, el("h3", {}, "Setting"), set), responses.length > 0 ? el("div", { class: "card" }, el("h3", {}, "Prediction"), gives) : null));
}

function drawn(list) { return list.map(({ title, says, svg }) => picture(title, says, [["", svg]])); }

function mapSection({ maps }) {
  if (maps.length === 0) return null;
  const rest = data.others.map((j) => `${factors[j].name} ${settingText(data.best, j)}`);
  const says = `Through the setting, against the two factors that decide most whether the condition holds.${rest.length > 0 ? ` Other factors: ${rest.join(", ")}.` : ""} Inside the line the condition holds with probability ${sure} or more. The ring marks the setting.` + failedSays(data.failed);
  return section("map", "Process window", says, el("div", { class: "grid wide" }, drawn(maps)));
}

function curvesSection({ curves }) {
  return section("curves", "Along each factor", "Predictions through the setting; the other factors keep their values there. Shaded: 95 % band of the mean. Dashed: 95 % band of a single run." + failedSays(data.failed), el("div", { class: "grid" }, drawn(curves)));
}

function listSection(id, title, says, list) {
  if (list.length === 0) return null;
  const columns = factors.map((f) => [f.name, f.levels.length > 0 ? "" : "number"]).concat([["probability", "number"]], responses.map((r) => [r.name, "number"]));
  const rows = list.map((one) => factors.map((_, j) => settingText(one, j)).concat([show(one.probability, 3)], responses.map((_, k) => withWidth(k, one.responses[k].mean, one.responses[k].mean_half_width))));
  return section(id, title, says, el("div", { class: "card" }, table(columns, rows)));
}

function start() {
  document.title = `${data.campaign}: process window`;
  for (const id of ["campaign-choice", "other-choice", "observable-choice"]) document.getElementById(id).hidden = true;
  showPage(() => [el("h1", {}, `${data.campaign}: process window`), el("p", { class: "says" }, `${data.scene} · ${wanted}`), settingSection(), mapSection(data.campaigns[0].figures), curvesSection(data.campaigns[0].figures),
    listSection("front", "Trade-off", `Settings where ${data.objective} cannot improve unless ${data.against} worsens. ${data.volume ? `Here: ${data.volume}.` : "The condition need not hold."}`, data.front),
    listSection("next", "To run next", "The most promising cases.", data.next),
    section("basis", "Basis", null, el("div", { class: "card" }, data.models.concat(data.notes).map((text) => el("p", { class: "notes" }, text))))]);
}

unpacked(data).then(start);
