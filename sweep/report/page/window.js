// The page of a process window: what to set, what it gives, the map of the two factors that matter most, and every
// response against every factor through the best setting.
const chosen = { campaign: 0 };
const page = document.getElementById("page");
const factors = data.factors.map((f) => Object.assign({ meaning: "", values: [f.low, f.high] }, f));
const responses = data.responses.map((r) => Object.assign({ levels: [] }, r));
const wanted = data.where || "no condition";
const sure = `${Number((100 * (1 - data.risk)).toPrecision(4))} %`;

function settingText(one, j) {
  const factor = factors[j], { factor: scale, unit } = factor.levels.length > 0 ? { factor: 1, unit: "" } : quantity(factor);
  return factor.levels.length > 0 ? one.texts[j] : `${show(one.setting[j] * scale, 6)}${unit ? " " + unit : ""}`;
}
function responseScale(k) { return quantity(responses[k], data.curves.flatMap((curve) => curve.responses.map((r) => r[k].mean)).filter((x) => x !== null)); }
function withWidth(k, mean, width) { const s = responseScale(k); return withError(s.of(mean), s.of(width)) + (s.unit ? ` ${s.unit}` : ""); }

function settingSection() {
  const { best } = data;
  const says = data.meets
    ? `${data.objective ? `${data.maximize ? "Largest" : "Smallest"} ${data.objective} where` : "Surest setting where"} ${data.where ? `"${data.where}" holds` : "it is defined"} with probability ${sure} or more, ${data.single_run ? "for every single run" : "for the mean of many runs"}.`
    : `The condition "${wanted}" holds nowhere with probability ${sure}; it is likeliest here.`;
  const near = data.failed_near ? ` Here ${data.failed_near}.` : "";
  const set = table([["set"], ["to", "number"]], factors.map((f, j) => [f.name, settingText(best, j)]));
  const gives = table([["expected"], ["mean, 95 %", "number"], ["a single run, 95 %", "number"]],
    responses.map((r, k) => { const one = best.responses[k]; return [r.name, withWidth(k, one.mean, one.mean_half_width), "± " + withError(responseScale(k).of(one.run_half_width), NaN)]; }));
  const share = `${show(100 * data.share, 3)} ± ${show(100 * data.share_error, 1)} %`;
  const tile = (number, label, bad) => el("div", { class: bad ? "tile bad" : "tile" }, el("b", {}, number), el("span", {}, label));
  return section("setting", "Setting", says + near,
    el("div", { class: "tiles" }, tile(share, "of the ranges lie in the window"), tile(show(best.probability, 3), "probability of the condition here", !data.meets)),
    el("div", { class: "grid wide" }, el("div", { class: "card" }, el("h3", {}, "Set"), set), responses.length > 0 ? el("div", { class: "card" }, el("h3", {}, "What it gives"), gives) : null));
}

// Cells of a map, the edge of the window, and the best setting.
function windowMap(values, title, says, variable, tones) {
  const { map, best } = data;
  return cellMap(map, factors, values, { title, says, variable, tones, setting: best.setting, failed: data.failed,
    inside: (k) => map.probability[k] !== null && map.probability[k] >= 1 - data.risk,
    more: (k) => [`probability ${show(map.probability[k], 3)}`] });
}

function mapSection() {
  const { map } = data;
  if (!map) return null;
  const [a, b] = [factors[map.across], factors[map.up]];
  const rest = factors.map((f, j) => [f, j]).filter(([, j]) => j !== map.across && j !== map.up).map(([f, j]) => `${f.name} ${settingText(data.best, j)}`);
  const says = `The two factors that matter most at this setting; ${rest.length > 0 ? `the others stay: ${rest.join(", ")}` : "there is no other"}. The line surrounds where the condition holds with probability ${sure}; the ring is the setting.` + failedSays(data.failed);
  const probability = { name: "probability", unit: "1", levels: [] };
  const whole = () => Object.assign(colouring(probability, [0, 1]), { title: "probability" });
  const maps = [windowMap(map.probability, `Process window: ${wanted}`, `Probability that it holds, over ${a.name} and ${b.name}.`, probability, whole)];
  if (map.objective) {
    const numbers = map.objective.filter((x) => x !== null);
    if (numbers.length > 0) maps.push(windowMap(map.objective, `${data.objective} over ${a.name} and ${b.name}`, "Mean response by the model.", responses[0], () => colouring(responses[0], numbers)));
  }
  return section("map", "The window", says, el("div", { class: "grid wide" }, maps));
}

function curveFigure(j, k) {
  const curve = data.curves[j], one = k === null ? null : curve.responses.map((r) => r[k]);
  const title = `${k === null ? "probability of the condition" : responses[k].name} against ${factors[j].name}`;
  const lines = k === null ? { mean: curve.probability } : { mean: one.map((r) => r.mean), mean_half_width: one.map((r) => r.mean_half_width), run_half_width: one.map((r) => r.run_half_width) };
  return bandCurve(factors[j], curve.at, lines, { title, value: k === null ? { of: (x) => x, title: "probability" } : responseScale(k),
    limits: k === null ? { min: 0, max: 1 } : {}, marker: { at: data.best.setting[j], label: "setting" }, failed: data.failed.map((one) => one.setting[j]) });
}

function curvesSection() {
  const order = data.order;
  const figuresOf = (k) => order.map((j) => curveFigure(j, k));
  const all = responses.flatMap((_, k) => figuresOf(k)).concat(data.where ? figuresOf(null) : []);
  return section("curves", "Along each factor", "Through the setting, the other factors as they are there. Shaded: the mean lies within with 95 %; dashed: a single run does." + failedSays(data.failed), el("div", { class: "grid" }, all));
}

function listSection(id, title, says, list) {
  if (list.length === 0) return null;
  const columns = factors.map((f) => [f.name, f.levels.length > 0 ? "" : "number"]).concat([["probability", "number"]], responses.map((r) => [r.name, "number"]));
  const rows = list.map((one) => factors.map((_, j) => settingText(one, j)).concat([show(one.probability, 3)], responses.map((_, k) => withWidth(k, one.responses[k].mean, one.responses[k].mean_half_width))));
  return section(id, title, says, el("div", { class: "card" }, table(columns, rows)));
}

function start() {
  Chart.defaults.font.family = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', sans-serif";
  document.getElementById("database").textContent = data.databases.join(", ");
  document.title = `${data.campaign}: process window`;
  for (const id of ["campaign-choice", "other-choice", "observable-choice"]) document.getElementById(id).hidden = true;
  figures.forEach((one) => one.drop());
  figures = [];
  page.replaceChildren(...[el("h1", {}, `${data.campaign}: process window`), el("p", { class: "says" }, `${data.scene} · ${wanted}`), settingSection(), mapSection(), curvesSection(),
    listSection("front", "Trade-off", `Settings where neither ${data.objective} nor ${data.against} can be better without the other being worse, whether the condition holds or not.`, data.front),
    listSection("next", "To run next", "The cases that promise most.", data.next),
    section("basis", "What it rests on", null, el("div", { class: "card" }, data.models.concat(data.notes).map((text) => el("p", { class: "notes" }, text))))].filter(Boolean));
  document.getElementById("sections").replaceChildren(...[...page.querySelectorAll("section[id]")].map((one) => el("button", { type: "button", click: () => one.scrollIntoView({ behavior: "smooth" }) }, one.querySelector("h2").textContent)));
  setTimeout(drawTheRest, 100);
}

window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", start);
start();
