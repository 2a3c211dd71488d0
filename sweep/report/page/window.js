// The page of a process window: what to set, what it gives, the map of the two factors that matter most, and every
// response against every factor through the best setting.
const chosen = { campaign: 0 };
const page = document.getElementById("page");
const factors = data.factors.map((f) => Object.assign({ meaning: "", values: [f.low, f.high] }, f));
const responses = data.responses.map((r) => Object.assign({ levels: [] }, r));
const wanted = data.where || "no condition";
const sure = `${Number((100 * (1 - data.risk)).toPrecision(4))} %`;

// Where a setting stands on the axis of a factor: a level by its place among them.
function placeOf(factor, x) { return factor.numbers.length > 0 ? factor.numbers.indexOf(x) : x; }
function shownOf(factor) { return factor.levels.length > 0 ? { of: (x) => placeOf(factor, x), says: (x) => factor.levels[placeOf(factor, x)] } : quantity(factor); }
function settingText(one, j) {
  const factor = factors[j], { factor: scale, unit } = factor.levels.length > 0 ? { factor: 1, unit: "" } : quantity(factor);
  return factor.levels.length > 0 ? one.texts[j] : `${show(one.setting[j] * scale, 6)}${unit ? " " + unit : ""}`;
}
function responseScale(k) { return quantity(responses[k], data.curves.flatMap((curve) => curve.responses.map((r) => r[k].mean))); }
function withWidth(k, mean, width) { const s = responseScale(k); return withError(s.of(mean), s.of(width)) + (s.unit ? ` ${s.unit}` : ""); }

function settingSection() {
  const { best } = data;
  const says = data.meets
    ? `${data.objective ? `${data.maximize ? "Largest" : "Smallest"} ${data.objective} where` : "Surest setting where"} ${data.where ? `"${data.where}" holds` : "it is defined"} with probability ${sure} or more, ${data.single_run ? "for every single run" : "for the mean of many runs"}.`
    : `The condition "${wanted}" holds nowhere with probability ${sure}; it is likeliest here.`;
  const set = table([["set"], ["to", "number"]], factors.map((f, j) => [f.name, settingText(best, j)]));
  const gives = table([["expected"], ["mean, 95 %", "number"], ["a single run, 95 %", "number"]],
    responses.map((r, k) => { const one = best.responses[k]; return [r.name, withWidth(k, one.mean, one.mean_half_width), "± " + withError(responseScale(k).of(one.run_half_width), NaN)]; }));
  const share = `${show(100 * data.share, 3)} ± ${show(100 * data.share_error, 1)} %`;
  const tile = (number, label, bad) => el("div", { class: bad ? "tile bad" : "tile" }, el("b", {}, number), el("span", {}, label));
  return section("setting", "Setting", says,
    el("div", { class: "tiles" }, tile(share, "of the ranges lie in the window"), tile(show(best.probability, 3), "probability of the condition here", !data.meets)),
    el("div", { class: "grid wide" }, el("div", { class: "card" }, el("h3", {}, "Set"), set), responses.length > 0 ? el("div", { class: "card" }, el("h3", {}, "What it gives"), gives) : null));
}

// Cells of a map, the edge of the window, and the best setting.
function mapFigure(values, title, says, variable, tones) {
  const { map, best } = data, a = factors[map.across], b = factors[map.up], across = shownOf(a), up = shownOf(b);
  const edge = (factor, shown, edges, k) => (factor.levels.length > 0 ? k - 0.5 : shown.of(edges[k]));
  const at = (i, j) => j * map.columns + i, value = quantity(variable, values.filter((x) => x !== null));
  const inside = (i, j) => i >= 0 && j >= 0 && i < map.columns && j < map.rows && map.probability[at(i, j)] !== null && map.probability[at(i, j)] >= 1 - data.risk;
  const cells = [];
  for (let j = 0; j < map.rows; ++j) for (let i = 0; i < map.columns; ++i) cells.push({ i, j, value: values[at(i, j)], probability: map.probability[at(i, j)] });
  const build = () => {
    const colours = tones();
    const box = (scales, { i, j }) => [edge(a, across, map.across_edges, i), edge(a, across, map.across_edges, i + 1)].map((x) => scales.x.getPixelForValue(x))
      .concat([edge(b, up, map.up_edges, j), edge(b, up, map.up_edges, j + 1)].map((y) => scales.y.getPixelForValue(y)));
    const squares = { id: "squares", beforeDatasetsDraw(chart) {
      const { ctx, scales } = chart;
      ctx.save();
      for (const cell of cells) {
        if (cell.value === null) continue;
        const [x0, x1, y0, y1] = box(scales, cell);
        ctx.fillStyle = colours.of(cell.value);
        ctx.fillRect(x0, y1, x1 - x0 + 0.5, y0 - y1 + 0.5);
      }
      ctx.strokeStyle = colour("ink");
      ctx.lineWidth = 2.5;
      ctx.beginPath();
      for (const cell of cells) {
        const [x0, x1, y0, y1] = box(scales, cell), here = inside(cell.i, cell.j);
        if (cell.i + 1 < map.columns && inside(cell.i + 1, cell.j) !== here) { ctx.moveTo(x1, y0); ctx.lineTo(x1, y1); }
        if (cell.j + 1 < map.rows && inside(cell.i, cell.j + 1) !== here) { ctx.moveTo(x0, y1); ctx.lineTo(x1, y1); }
      }
      ctx.stroke();
      const x = scales.x.getPixelForValue(across.of(best.setting[map.across])), y = scales.y.getPixelForValue(up.of(best.setting[map.up]));
      ctx.lineWidth = 5;
      ctx.strokeStyle = "#ffffff";
      ctx.beginPath();
      ctx.arc(x, y, 8, 0, 2 * Math.PI);
      ctx.stroke();
      ctx.lineWidth = 2.5;
      ctx.strokeStyle = "#000000";
      ctx.beginPath();
      ctx.arc(x, y, 8, 0, 2 * Math.PI);
      ctx.stroke();
      ctx.restore();
    } };
    const centre = (factor, shown, edges, k) => (factor.levels.length > 0 ? k : shown.of((edges[k] + edges[k + 1]) / 2));
    const points = cells.map((cell) => ({ x: centre(a, across, map.across_edges, cell.i), y: centre(b, up, map.up_edges, cell.j), cell }));
    return { type: "scatter", data: { datasets: [{ data: points, pointRadius: 0, pointHoverRadius: 0, pointHitRadius: 20 }] },
      options: { layout: { padding: { right: 74, top: 20 } }, interaction: { mode: "nearest", intersect: false }, scales: { x: variableAxis(a), y: variableAxis(b) },
        plugins: { colourBar: { tones: colours }, tooltip: { callbacks: { label: (item) => {
          const { cell } = item.raw;
          return [`${a.name} ${a.levels.length > 0 ? a.levels[cell.i] : show(item.raw.x)}, ${b.name} ${b.levels.length > 0 ? b.levels[cell.j] : show(item.raw.y)}`,
            `${variable.name} ${cell.value === null ? "–" : value.says(cell.value)}`, `probability ${show(cell.probability, 3)}`];
        } } } } }, plugins: [squares] };
  };
  return figure(title, says, build, { height: 520 }).node;
}

function mapSection() {
  const { map } = data;
  if (!map) return null;
  const [a, b] = [factors[map.across], factors[map.up]];
  const rest = factors.map((f, j) => [f, j]).filter(([, j]) => j !== map.across && j !== map.up).map(([f, j]) => `${f.name} ${settingText(data.best, j)}`);
  const says = `The two factors that matter most at this setting; ${rest.length > 0 ? `the others stay: ${rest.join(", ")}` : "there is no other"}. The line surrounds where the condition holds with probability ${sure}; the ring is the setting.`;
  const probability = { name: "probability", unit: "1", levels: [] };
  const whole = () => Object.assign(colouring(probability, [0, 1]), { title: "probability" });
  const maps = [mapFigure(map.probability, `Process window: ${wanted}`, `Probability that it holds, over ${a.name} and ${b.name}.`, probability, whole)];
  if (map.objective) {
    const numbers = map.objective.filter((x) => x !== null);
    maps.push(mapFigure(map.objective, `${data.objective} over ${a.name} and ${b.name}`, "Mean response by the model.", responses[0], () => colouring(responses[0], numbers)));
  }
  return section("map", "The window", says, el("div", { class: "grid wide" }, maps));
}

// A line with the 95 % band of the mean, and the one of a single run, dashed.
function curveFigure(j, k) {
  const factor = factors[j], curve = data.curves[j], shown = shownOf(factor), value = k === null ? { of: (x) => x, title: "probability" } : responseScale(k);
  const xs = curve.at.map((x) => shown.of(x)), name = k === null ? "probability of the condition" : responses[k].name;
  const of = (pick) => xs.map((x, i) => ({ x, y: pick(i) }));
  const build = () => {
    const tone = colour("one"), edge = { borderWidth: 0, pointRadius: 0, pointHitRadius: 0, backgroundColor: withAlpha(tone, 0.17) };
    const dashed = { borderColor: tone, borderWidth: 1, borderDash: [4, 4], pointRadius: 0, pointHitRadius: 0 };
    const line = (pick) => ({ data: of(pick), borderColor: tone, backgroundColor: tone, borderWidth: 2, pointRadius: factor.levels.length > 0 ? 3 : 0, pointHitRadius: 8 });
    const about = (sign, width) => (i) => { const r = curve.responses[i][k]; return value.of(r.mean + sign * r[width]); };
    const sets = k === null ? [line((i) => curve.probability[i])] : [line((i) => value.of(curve.responses[i][k].mean)),
      Object.assign({ data: of(about(1, "mean_half_width")), fill: "+1" }, edge), Object.assign({ data: of(about(-1, "mean_half_width")) }, edge),
      Object.assign({ data: of(about(1, "run_half_width")) }, dashed), Object.assign({ data: of(about(-1, "run_half_width")) }, dashed)];
    return { type: "line", data: { datasets: sets }, options: { scales: { x: variableAxis(factor), y: axis(value.title, k === null ? { min: 0, max: 1 } : {}) },
      plugins: { marker: { at: shown.of(data.best.setting[j]), label: "setting" }, tooltip: { filter: (item) => item.datasetIndex === 0 } } } };
  };
  return figure(`${name} against ${factor.name}`, null, build).node;
}

function curvesSection() {
  const order = data.order;
  const figuresOf = (k) => order.map((j) => curveFigure(j, k));
  const all = responses.flatMap((_, k) => figuresOf(k)).concat(data.where ? figuresOf(null) : []);
  return section("curves", "Along each factor", "Through the setting, the other factors as they are there. Shaded: the mean lies within with 95 %; dashed: a single run does.", el("div", { class: "grid" }, all));
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
