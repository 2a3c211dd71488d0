// The page itself: its sections from top to bottom, and what the reader chose.
const page = document.getElementById("page");
const chosen = { campaign: 0, observable: 0, other: "", view: {}, map: {}, curvesBy: "" };

function heading(campaign) {
  const tile = (number, label, bad) => el("div", { class: bad ? "tile bad" : "tile" }, el("b", {}, number), el("span", {}, label));
  const good = ["completed", "skipped", "abandoned", "not yet"];
  const tiles = campaign.outcomes.filter(([, count]) => count > 0)
    .map(([outcome, count]) => tile(count, outcome === "abandoned" ? "to be continued" : outcome.replace("_", " "), !good.includes(outcome)));
  const parts = [`${campaign.scene}, revision ${campaign.revision}`,
    `${campaign.design} design` + (campaign.sequences > 1 ? ` of ${campaign.sequences} independent sequences` : ""),
    plural(campaign.factors.length, "factor"),
    campaign.replicates > 1 ? plural(campaign.replicates, "repeat") + " of each point" : null,
    campaign.where ? `where ${campaign.where}` : null].filter(Boolean);
  const ranges = campaign.factors.map((f) => [f.name, f.unit === "1" ? "" : unitText(f.unit),
    f.levels.length > 0 ? f.levels.join(", ") : `${show(f.low)} to ${show(f.high)}${f.log ? ", logarithmic" : ""}`, f.meaning]);
  return [el("h1", {}, campaign.name), el("p", { class: "says" }, parts.join(" · ")),
    campaign.summary ? el("p", {}, campaign.summary) : null,
    campaign.notes ? el("p", { class: "notes" }, campaign.notes) : null,
    el("div", { class: "tiles" }, tile(campaign.rows, "cases"), tiles,
      campaign.stopped_at !== null ? tile(campaign.stopped_at, "points when it converged and stopped") : null),
    el("details", { open: "" }, el("summary", {}, "What was varied"),
      el("div", { class: "card" }, table([["factor"], ["unit"], ["values"], ["meaning", "text"]], ranges),
        campaign.fixed_text ? el("p", { class: "says" }, "Fixed: ", el("code", {}, campaign.fixed_text)) : null,
        el("p", { class: "says" }, "Design: ", el("code", {}, campaign.design_text))))];
}

// Figures over every finished case of a campaign that is not at its end: shown, and marked.
function provisionalMark(history) {
  if (!history.provisional) return null;
  const { points, count } = history.provisional;
  return el("div", { class: "verdict provisional" }, el("b", {}, "Provisional: "),
    `figures over all finished cases (${plural(count, "value")} of ${plural(points, "point")}) still move with which cases happen to be finished; they are not judged and not to be quoted.`);
}

function verdict(history) {
  const kind = history.converged_at !== null ? "verdict yes" : history.judged ? "verdict no" : "verdict";
  return el("div", { class: kind }, history.verdict, history.notes.map((note) => el("div", { class: "warning" }, note)));
}

function distributionSection(response, sample, other) {
  const { provisional } = response.history;
  const columns = [["statistic"], ["value", "number"]].concat(provisional ? [["provisional", "number provisional"]] : [], other ? [[campaignTitle(other.model.campaign), "number"]] : []);
  const rows = statistics.map(([name, title]) => [title, response.history.statistics[name].text].concat(provisional ? [provisional.statistics[name]] : [], other ? [other.response.history.statistics[name].text] : []));
  const says = response.meaning ? `${titled(response)}: ${response.meaning}` : titled(response);
  return section("response", "Response", says, verdict(response.history), provisionalMark(response.history), el("div", { class: "grid wide" }, response.histogram.counts.length > 0 ? histogram(response, other && other.response) : null,
    el("div", { class: "card" }, el("h3", {}, "Moments"),
      el("p", { class: "says" }, (response.history.count > 0 ? `over ${plural(response.history.count, "value")}` : "no value counts yet") + (sample && response.history.count > 0 ? ", with 95 % errors" : "") +
        (response.history.excluded > 0 ? `; ${plural(response.history.excluded, "case")} without a value left out` : "")),
      table(columns, rows))));
}

// Where the answer passes its threshold, of a design that sought it.
function bracketsSection(campaign) {
  if (!campaign.brackets) return null;
  const { says, columns, rows } = campaign.brackets;
  return section("brackets", "Passages", says.replace(/^./, (c) => c.toUpperCase()) + ".",
    el("div", { class: "card" }, table(columns.map((title, j) => [title, typeof rows[0][j] === "number" ? "number" : ""]), rows)));
}

function momentsSection(campaign, response, other) {
  if (!campaign.sample || response.history.points.length === 0) return null;
  return section("convergence", "Convergence", "Moments of the first points of the design against their number, with 95 % errors. " +
    "A verdict uses complete blocks of a gapless beginning, so it does not depend on which case finished first.",
  el("div", { class: "grid" }, statistics.map((statistic) => moment(campaign, response.history, other && other.response.history, statistic))));
}

function effectsSection(model, response, other) {
  const others = model.factors.map((factor) => effectOf(other, factor));
  const range = effectRange(response.effects.concat(others.filter(Boolean)));
  return section("effects", "Main effects", "Mean response in 16 bins of equal count (fewer for few cases, a level is a bin), one scale for all factors. " +
    `Whiskers: ${response.whiskers}.`,
  el("div", { class: "grid" }, model.factors.map((factor, j) => effect(factor, response.effects[j], response, range, others[j]))));
}

const trendSigns = { rises: "↗ rises", falls: "↘ falls", bends: "∼ bends" };

function influenceSection(response) {
  const { influence } = response, n = "number";
  const figuresOf = { morris: (f) => [f.mu_star_text, f.sigma], saltelli: (f) => [f.first_text, f.total_text], given_data: (f) => [f.first_text] }[influence.method];
  const titles = { morris: [["mu*", n], ["sigma", n]], saltelli: [["first order", n], ["total", n]], given_data: [["first order", n]] }[influence.method];
  const columns = [["factor"], ...titles, ["trend", "sign"], ["rank correlation", n]];
  const rows = influence.factors.map((f) => [f.name, ...figuresOf(f), trendSigns[f.trend] || "", f.rank_text]);
  const says = influence.method === "morris" ? "Change of the response when a factor moves over its range."
    : "Share of the variance of the response that a factor explains alone" + (influence.method === "saltelli" ? ", and with all its interactions." : ".");
  return section("sensitivity", "Sensitivity", says, el("div", { class: "grid wide" }, influenceFigure(influence),
    el("div", { class: "card" }, table(columns, rows), varianceBar(influence.variance),
      influence.unexplained ? el("p", { class: "says" }, influence.unexplained.replace(/^./, (c) => c.toUpperCase()) + ".") : null,
      influence.notes.map((note) => el("p", { class: "says" }, note)))));
}

function curvesSection(model) {
  const { completed, drawn, families } = model.campaign.curves;
  if (families.length === 0 || model.factors.length === 0) return null;
  const says = (drawn < completed ? `${drawn} of ${completed} completed cases, chosen at random.` : "Every completed case, a line each.") +
    " Point at a line or a name to see it among the others, click to keep it.";
  return section("curves", "Curves", says, el("div", { class: "grid wide" }, families.map((family) => curveFigure(model, family))));
}

function extremesSection(campaign, response) {
  const n = "number";
  const columns = [["point", n]].concat(campaign.replicates > 1 ? [["repeat", n]] : [],
    campaign.factors.map((f) => [f.name, f.levels.length > 0 ? "" : n]), [[response.name, n], ["case"]]);
  const rows = (list) => list.map((one) => [one.point].concat(campaign.replicates > 1 ? [one.replicate] : [], one.factors, [one.value, one.case.slice(0, 10)]));
  const part = (title, list) => el("div", { class: "card" }, el("h3", {}, title), table(columns, rows(list)));
  return section("extremes", "Extremes", "grainsweep explain and replay take the id in the last column.",
    el("div", { class: campaign.factors.length > 3 ? "grid full" : "grid wide" }, part(`Largest ${response.name}`, response.largest), part(`Smallest ${response.name}`, response.smallest)));
}

function failuresSection(campaign) {
  const { count, listed } = campaign.failures;
  if (count === 0) return null;
  const columns = [["point", "number"], ["outcome"], ["attempts", "number"], ["reason", "text"]]
    .concat(campaign.factors.map((f) => [f.name, f.levels.length > 0 ? "" : "number"]), [["case"]]);
  const rows = listed.map((one) => [one.point, one.outcome, one.attempts, one.reason].concat(one.factors, [one.case.slice(0, 10)]));
  const says = listed.length < count ? `The first ${listed.length} of ${count}. ` : "";
  return section("failures", "Failed cases", says + "They are left out of all statistics.", el("div", { class: "card tail" }, table(columns, rows)));
}

function provenanceSection(campaign) {
  const columns = [["start"], ["version"], ["commit"], ["compiler"], ["flags", "text"], ["instructions"], ["processor", "text"], ["host"], ["settled", "number"]];
  const rows = campaign.runs.map((run) => [run.start, run.version, String(run.commit).replace(/^([0-9a-f]{12})[0-9a-f]*/, "$1"), run.compiler, run.flags, run.instruction_path, run.processor, run.host, run.settled]);
  return section("provenance", "Provenance", "One line per run over this database.", el("div", { class: "card" }, table(columns, rows)),
    el("details", {}, el("summary", {}, "The campaign file"), el("pre", { class: "card" }, campaign.text)));
}

// What is drawn first: the response against its most influential factor, coloured by the second.
function firstView(model, response) {
  const weight = (f) => f.mu_star || f.total || f.first || 0;
  const order = [...response.influence.factors].sort((a, b) => weight(b) - weight(a)).map((f) => f.name);
  const [a, b] = [order[0] || model.variables[0].name, order[1] || ""];
  chosen.view = { x: a, y: response.name, by: b };
  chosen.map = { a, b: b || a, shows: "mean" };
  chosen.curvesBy = a;
}

function explorerSections(model, response, other) {
  const large = explorer(model, other), map = model.factors.length > 1 ? factorMap(model, response) : null;
  const cases = caseTable(model, () => { large.redraw(); if (map) map.redraw(); });
  selectionChanged.length = 0;
  selectionChanged.push(() => cases.paint(), () => { const chart = figures.find((one) => one.title === "Cases"); if (chart && chart.chart) chart.chart.draw(); });
  const explore = section("explore", "Explore", "Any factor or response against any other, coloured by a third.", el("div", { class: "grid full" }, large.node));
  const small = response ? section("against", "Against each factor", model.campaign.settled > 1500 ? `1500 of ${model.campaign.settled} cases are drawn, chosen at random; the lines are binned means of all cases.` : "Every case, and the binned mean.",
    el("div", { class: "grid" }, model.factors.map((factor, j) => scatter(model, factor, response.effects[j], response)))) : null;
  const maps = map ? section("map", "Two factors at once", "Mean response cell by cell. Point at a cell for its number of cases, the standard error of its mean" +
    (response.pure_error !== null ? `, and what the scatter of single runs alone gives (pure error of ${response.pure_error_freedom} degrees of freedom).` : "; without replicates that error holds the other factors' influence, too."),
  el("div", { class: "grid full" }, map.node)) : null;
  const listed = section("cases", "Cases", "Every case. Click a column's name to sort, write below it to filter, click a row to see the case; the filters hold for the figures of Explore and of two factors, too.", cases.node);
  return { explore, small, maps, listed, paint: cases.paint };
}

// The cases whose films the page holds.
function filmsSection(model) {
  const rows = filmedRows(model);
  if (rows.length === 0) return null;
  const films = filmPlayer.films().filter((film) => film.campaign === model.campaign.name);
  const buttons = films.map((film) => {
    const row = rows.find((one) => model.id(one) === film.id);
    return row === undefined ? null : el("button", { type: "button", class: "plain", click: () => selectCase(model, row) }, `▶ ${film.says}`);
  });
  return section("films", "Cases to watch", "Their particles in three dimensions; triangles mark them among the points, ▶ in the table.", el("div", { class: "controls" }, buttons));
}

function navigation() {
  const links = [...page.querySelectorAll("section[id]")].map((one) => el("button", { type: "button", click: () => one.scrollIntoView({ behavior: "smooth" }) }, one.querySelector("h2").textContent));
  document.getElementById("sections").replaceChildren(...links);
}

function render() {
  figures.forEach((one) => one.drop());
  figures = [];
  if (selected && selected.index !== chosen.campaign) closeCase();
  const model = open(chosen.campaign), { campaign } = model;
  const response = campaign.observables[chosen.observable];
  page.replaceChildren(...heading(campaign).filter(Boolean));
  let other = null;
  if (response && chosen.other !== "") {
    const otherModel = open(Number(chosen.other)), found = otherModel.campaign.observables.find((one) => one.name === response.name);
    if (found && found.history.count > 0) other = { model: otherModel, response: found };
  }
  if (chosen.other !== "") {
    const name = campaignTitle(data.campaigns[Number(chosen.other)]);
    page.append(el("p", { class: "overlaid" }, other ? ["Blue: ", el("b", {}, campaignTitle(campaign)), "; orange: ", el("b", { class: "second" }, name)] : `${name} has no values of ${response ? response.name : "this response"}.`));
  }
  let parts = null;
  const values = response ? model.responses[chosen.observable].values : [];
  if (response && response.history.count > 0) {
    if (!chosen.view.x) firstView(model, response);
    parts = explorerSections(model, response, other);
    page.append(...[bracketsSection(campaign), calibrationSection(campaign), distributionSection(response, campaign.sample, other), momentsSection(campaign, response, other), effectsSection(model, response, other),
      influenceSection(response), modelSection(campaign, response), filmsSection(model), parts.explore, parts.maps, parts.listed, parts.small, curvesSection(model), extremesSection(campaign, response)].filter(Boolean));
  } else if (values.some(Number.isFinite)) {  // answers, but none of the gapless beginning
    if (!chosen.view.x) firstView(model, response);
    parts = explorerSections(model, response, other);
    page.append(...[calibrationSection(campaign), distributionSection(response, campaign.sample, other), filmsSection(model), parts.explore, parts.maps, parts.listed, curvesSection(model)].filter(Boolean));
  } else {
    page.append(el("p", {}, campaign.observables.length === 0 ? "Series and profiles are measured, and no scalar." : "No case has an answer yet."));
    const cases = caseTable(model, () => {});
    parts = { paint: cases.paint };
    page.append(...[calibrationSection(campaign), section("cases", "Cases", "Every case.", cases.node), curvesSection(model)].filter(Boolean));
  }
  page.append(...[failuresSection(campaign), provenanceSection(campaign)].filter(Boolean));
  parts.paint();
  navigation();
  setTimeout(drawTheRest, 600);  // what the reader sees comes first
}

function fillObservables() {
  const { campaign } = open(chosen.campaign), select = document.getElementById("observable");
  select.replaceChildren(...campaign.observables.map((o, i) => el("option", { value: i }, titled(o))));
  chosen.observable = campaign.main;
  select.value = String(campaign.main);
}

function fillOthers() {
  const select = document.getElementById("other");
  select.replaceChildren(el("option", { value: "" }, "nothing"), ...data.campaigns.map((c, i) => [c, i]).filter(([, i]) => i !== chosen.campaign).map(([c, i]) => el("option", { value: i }, campaignTitle(c))));
  if (chosen.other === String(chosen.campaign)) chosen.other = "";
  select.value = chosen.other;
}

function start() {
  Chart.defaults.font.family = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', sans-serif";
  document.getElementById("database").textContent = data.databases.join(", ");
  document.title = `${data.databases.join(", ")} · grainsweep report`;
  const campaigns = document.getElementById("campaign");
  campaigns.replaceChildren(...data.campaigns.map((c, i) => el("option", { value: i }, campaignTitle(c))));
  for (const id of ["campaign-choice", "other-choice"]) document.getElementById(id).hidden = data.campaigns.length < 2;
  campaigns.addEventListener("change", () => { chosen.campaign = Number(campaigns.value); chosen.view = {}; fillObservables(); fillOthers(); render(); });
  const observables = document.getElementById("observable");
  observables.addEventListener("change", () => { chosen.observable = Number(observables.value); chosen.view = {}; render(); });
  const others = document.getElementById("other");
  others.addEventListener("change", () => { chosen.other = others.value; render(); });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", render);
  fillObservables();
  fillOthers();
  render();
  showAsked();
}

// #case=ID behind the page's address shows that case; the beginning of its id is enough.
function showAsked() {
  const asked = /^#case=([0-9a-f]+)$/.exec(location.hash);
  if (!asked) return;
  for (let index = 0; index < data.campaigns.length; ++index) {
    const model = open(index);
    for (let row = 0; row < model.rows; ++row) {
      if (!model.id(row).startsWith(asked[1])) continue;
      if (index !== chosen.campaign) {
        chosen.campaign = index;
        document.getElementById("campaign").value = String(index);
        fillObservables();
        fillOthers();
        render();
      }
      selectCase(model, row);
      return;
    }
  }
}

start();
