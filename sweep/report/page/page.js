// The page: its sections from top to bottom, and the reader's choices.
const chosen = { campaign: 0, observable: 0, other: "", view: {}, map: {}, curvesBy: "", tables: {} };
// What is drawn again when values of the chosen campaign changed in place.
const dataChanged = [];

function outcomeTiles(model) {
  const good = ["completed", "skipped", "abandoned", "not yet"], counts = new Map(model.campaign.outcomes.map(([outcome]) => [outcome, 0]));
  for (let row = 0; row < model.rows; ++row) counts.set(model.outcome(row), (counts.get(model.outcome(row)) || 0) + 1);
  return [...counts].filter(([, count]) => count > 0)
    .map(([outcome, count]) => tile(count, outcome === "abandoned" ? "to be resumed" : outcome.replace("_", " "), !good.includes(outcome)));
}

function heading(model) {
  const { campaign } = model, tiles = el("span", { class: "outcomes" }, outcomeTiles(model));
  dataChanged.push(() => tiles.replaceChildren(...outcomeTiles(model)));
  const parts = [`${campaign.scene}, revision ${campaign.revision}`,
    `${campaign.design} design` + (campaign.sequences > 1 ? ` of ${campaign.sequences} independent sequences` : ""),
    plural(campaign.factors.length, "factor"),
    campaign.replicates > 1 ? plural(campaign.replicates, "repeat") + " of each point" : null,
    campaign.where ? `where ${campaign.where}` : null].filter(Boolean);
  const ranges = model.factors.map((f) => {
    const shown = quantity(f);  // in the unit of the figures
    return f.levels.length > 0 ? [f.name, shown.unit, shownLevels(f).texts.join(", "), f.meaning]
      : [f.name, shown.unit, `${show(shown.of(f.low))} to ${show(shown.of(f.high))}${f.log ? ", logarithmic" : ""}`, f.meaning];
  });
  return [el("h1", {}, campaign.name), el("p", { class: "says" }, parts.join(" · ")),
    campaign.summary ? el("p", {}, campaign.summary) : null,
    campaign.notes ? el("p", { class: "notes" }, campaign.notes) : null,
    el("div", { class: "tiles" }, tile(campaign.rows, "cases"), tiles,
      campaign.stopped_at !== null ? tile(campaign.stopped_at, "points at convergence") : null),
    el("details", { open: "" }, el("summary", {}, "Factors"),
      el("div", { class: "card" }, table([["factor"], ["unit"], ["values"], ["meaning", "text"]], ranges),
        campaign.fixed_text ? el("p", { class: "says" }, "Fixed: ", el("code", {}, campaign.fixed_text)) : null,
        el("p", { class: "says" }, "Design: ", el("code", {}, campaign.design_text))))];
}

const statistics = [
  ["mean", "mean"], ["sd", "standard deviation (divisor N)"], ["skewness", "skewness (Pearson, 3 (mean − median)/sd)"],
  ["g1", "moment skewness g1"], ["kurtosis", "kurtosis (3 for a normal distribution)"]];

// How a statistic of a response is shown: mean and standard deviation in its unit, the others are numbers.
function statisticOf(response, name) {
  const { factor, unit } = ["mean", "sd"].includes(name) ? quantityOf(response) : { factor: 1, unit: "" };
  return { factor, unit, says: (text) => scaledText(text, factor) + (unit ? ` ${unit}` : "") };
}

// The panels of a painted figure: [name, SVG]; one alone has no name.
function painted(campaign, response, figure) {
  return Object.entries(campaign.figures[response] || {}).filter(([name]) => name === figure || name.startsWith(figure + ":"))
    .map(([name, svg]) => [name.slice(figure.length + 1), svg]);
}

// A card for each panel, with [title, text] by `captions`; below it the same panel of the campaign to compare with.
function paintedCards(campaign, response, figure, captions, other) {
  const second = new Map(other ? painted(other.model.campaign, response, figure) : []);
  return painted(campaign, response, figure).map(([panel, svg]) => picture(...captions(panel),
    second.has(panel) ? [[campaignTitle(campaign), svg], [campaignTitle(other.model.campaign), second.get(panel)]] : [["", svg]]));
}

function captionOfFactor(model) { return (name) => [name, model.factors.find((factor) => factor.name === name).meaning]; }

// Figures over all finished cases of an unfinished campaign, marked as provisional.
function provisionalMark(history) {
  if (!history.provisional) return null;
  const { points, count } = history.provisional;
  return el("div", { class: "verdict provisional" }, el("b", {}, "Provisional: "),
    `These figures include all finished cases (${plural(count, "value")} at ${plural(points, "point")}). They depend on the order of completion and are not judged. Do not quote them.`);
}

function verdict(history) {
  const kind = history.converged_at !== null ? "verdict yes" : history.judged ? "verdict no" : "verdict";
  return el("div", { class: kind }, history.verdict, history.notes.map((note) => el("div", { class: "warning" }, note)));
}

function distributionSection(campaign, response, other) {
  const { provisional } = response.history;
  const columns = [["statistic"], ["value", "number"]].concat(provisional ? [["provisional", "number provisional"]] : [], other ? [[campaignTitle(other.model.campaign), "number"]] : []);
  const rows = statistics.map(([name, title]) => [title, response.history.statistics[name]].concat(provisional ? [provisional.statistics[name]] : [], other ? [other.response.history.statistics[name]] : [])
    .map((text, k) => (k === 0 ? text : statisticOf(response, name).says(text))));
  const levels = response.history.levels.map(({ title, has_unit, text }) => [title, has_unit ? statisticOf(response, "mean").says(text) : text]);
  const { title: named } = quantityOf(response), says = response.meaning ? `${named}: ${response.meaning}` : named;
  const { count, zero_share: zeros } = response.history, values = plural(count, "value") + (zeros > 0 ? `, ${Number((100 * zeros).toPrecision(2))} % zero` : "");
  return section("response", "Response", says, verdict(response.history), provisionalMark(response.history), el("div", { class: "grid wide" }, paintedCards(campaign, response.name, "distribution", () => ["Distribution", values], other),
    el("div", { class: "card" }, el("h3", {}, "Moments"),
      el("p", { class: "says" }, (response.history.count > 0 ? plural(response.history.count, "value") + (campaign.sample ? " with 95 % errors." : ".") : "No value counts yet.") +
        (response.history.excluded > 0 ? ` ${plural(response.history.excluded, "case")} without a value excluded.` : "")),
      table(columns, rows)),
    response.history.count > 0 ? el("div", { class: "card" }, el("h3", {}, "Quantiles"), table([["level"], ["value", "number"]], levels)) : null));
}

// Threshold crossings, of a design that seeks them.
function bracketsSection(campaign) {
  if (!campaign.brackets) return null;
  const { says, columns, rows } = campaign.brackets;
  return section("brackets", "Threshold crossings", capital(says) + ".",
    el("div", { class: "card" }, table(columns.map((title, j) => [title, typeof rows[0][j] === "number" ? "number" : ""]), rows)));
}

function momentsSection(campaign, response, other) {
  const caption = (name) => [statistics.find(([one]) => one === name)[1], statisticOf(response, name).says(response.history.statistics[name])];
  const cards = paintedCards(campaign, response.name, "convergence", caption, other);
  if (cards.length === 0) return null;
  return section("convergence", "Convergence", "Moments against the number of design points, with 95 % errors. The verdict uses complete blocks of the " +
    "prefix of the design. It does not depend on the order in which cases finish.", el("div", { class: "grid" }, cards));
}

// A calibration gathers its cases where its targets are met: means over bins compare unlike settings.
function effectsSection(model, response, other) {
  if (model.campaign.calibration) return null;
  return section("effects", "Main effects", "Mean response in 16 bins of equal count, or fewer for few cases. Each level is a bin. All factors share one scale. " +
    `Whiskers: ${response.whiskers}.`, el("div", { class: "grid" }, paintedCards(model.campaign, response.name, "effects", captionOfFactor(model), other)));
}

const trendSigns = { rises: "↗ rises", falls: "↘ falls", bends: "∼ bends" };

function influenceSection(campaign, response) {
  const { influence } = response, n = "number";
  const { factor, unit } = influence.shares ? { factor: 1, unit: "" } : quantityOf(response), titleOf = (column) => column + (unit ? ` (${unit})` : "");
  const columns = [["factor"], ...influence.shows.map((one) => [titleOf(one.column), n]), ["trend", "sign"], ["rank correlation", n]];
  const rows = influence.factors.map((f) => [f.name, ...influence.shows.map((one) => scaledText(f[one.text], factor)), trendSigns[f.trend] || "", scaledText(f.rank_text, 1)]);
  const cards = (figure, title) => paintedCards(campaign, response.name, figure, () => [title, ""]);
  return section("sensitivity", "Sensitivity", influence.says, el("div", { class: "grid wide" }, cards("sensitivity", influence.shares ? "Share of the variance" : "Elementary effects"),
    el("div", { class: "card" }, table(columns, rows),
      influence.unexplained ? el("p", { class: "says" }, capital(influence.unexplained) + ".") : null,
      influence.notes.map((note) => el("p", { class: "says" }, note))), cards("variance", "Parts of the variance")));
}

function curvesSection(model) {
  const { completed, drawn, families } = model.campaign.curves;
  if (families.length === 0 || model.factors.length === 0) return null;
  const says = (drawn < completed ? `${drawn} of ${completed} completed cases, chosen at random.` : "One line per completed case.") +
    " Point at a line or a name to highlight it. Click to show it alone.";
  return section("curves", "Curves", says, el("div", { class: "grid wide" }, families.map((family) => curveFigure(model, family))));
}

// Columns of the factors in the units of the figures, and what stands there for a row of the database's values.
function factorColumns(model) {
  const shown = model.factors.map((f) => quantity(f)), levels = model.factors.map((f) => (f.levels.length > 0 ? shownLevels(f) : null));
  const worded = (j) => levels[j] && !levels[j].numbers;
  return { columns: shown.map(({ title }, j) => [title, worded(j) ? "" : "number"]),
    cells: (values) => values.map((x, j) => (worded(j) || x === null ? x : show(Number(x) * (levels[j] ? levels[j].factor : shown[j].factor)))) };
}

function extremesSection(model, response) {
  const n = "number", { campaign } = model, factors = factorColumns(model), shown = quantityOf(response);
  const columns = [["point", n]].concat(campaign.replicates > 1 ? [["repeat", n]] : [], factors.columns, [[shown.title, n], ["case"]]);
  const rows = (list) => list.map((one) => [one.point].concat(campaign.replicates > 1 ? [one.replicate] : [], factors.cells(one.factors), [show(shown.of(one.value)), one.case.slice(0, 10)]));
  const part = (title, list) => el("div", { class: "card" }, el("h3", {}, title), table(columns, rows(list)));
  return section("extremes", "Extremes", "Use the id in the last column with grainsweep explain and replay.",
    el("div", { class: campaign.factors.length > 3 ? "grid full" : "grid wide" }, part(`Largest ${response.name}`, response.largest), part(`Smallest ${response.name}`, response.smallest)));
}

function failuresSection(model) {
  const { count, listed } = model.campaign.failures, factors = factorColumns(model);
  if (count === 0) return null;
  const columns = [["point", "number"], ["outcome"], ["attempts", "number"], ["reason", "text"]]
    .concat(factors.columns, [["case"]]);
  const rows = listed.map((one) => [one.point, one.outcome, one.attempts, one.reason].concat(factors.cells(one.factors), [one.case.slice(0, 10)]));
  const says = listed.length < count ? `The first ${listed.length} of ${count}. ` : "";
  return section("failures", "Failed cases", says + "All statistics exclude these cases.", el("div", { class: "card tail" }, table(columns, rows)));
}

function provenanceSection(campaign) {
  const columns = [["start"], ["version"], ["commit"], ["compiler"], ["flags", "text"], ["instructions"], ["processor", "text"], ["host"], ["settled", "number"]];
  const rows = campaign.runs.map((run) => [run.start, run.version, String(run.commit).replace(/^([0-9a-f]{12})[0-9a-f]*/, "$1"), run.compiler, run.flags, run.instruction_path, run.processor, run.host, run.settled]);
  return section("provenance", "Provenance", "One row per grainsweep run on this database.", el("div", { class: "card" }, table(columns, rows)),
    el("details", {}, el("summary", {}, "Campaign file"), el("pre", { class: "card" }, campaign.text)));
}

// The first view: the response against its most influential factor, coloured by the second.
function firstView(model, response) {
  const [a, b] = [response.order[0] || model.variables[0].name, response.order[1] || ""];
  chosen.view = { x: a, y: response.name, by: b };
  chosen.map = { a, b: b || a, shows: "mean" };
  chosen.curvesBy = a;
}

function againstSection(model, response) {
  const { settled } = model.campaign;
  return section("against", "Against each factor", settled > 1500 ? `1500 of ${settled} cases, chosen at random. Lines: binned means of all cases.` : "All cases, and their binned mean.",
    el("div", { class: "grid" }, model.factors.map((factor, j) => scatter(model, factor, response.means[j], response))));
}

function plainCases(model) {
  const cases = caseTable(model, () => {});
  dataChanged.push(() => cases.paint());
  return { cases, sections: [section("cases", "Cases", null, cases.node)] };
}

function explorerSections(model, response, other) {
  const large = explorer(model, other), map = model.factors.length > 1 ? factorMap(model, response) : null;
  const cases = caseTable(model, () => { large.redraw(); if (map) map.redraw(); });
  dataChanged.push(() => { large.redraw(); if (map) map.redraw(); cases.renew(); });
  selectionChanged.length = 0;
  selectionChanged.push(() => cases.paint(), () => { const chart = figures.find((one) => one.title === "Cases"); if (chart && chart.chart) chart.chart.draw(); });
  const sections = [section("explore", "Explore", "Any factor or response against any other, coloured by a third.", el("div", { class: "grid full" }, large.node))];
  if (map)
    sections.push(section("map", "Two factors at once", "Mean response in each cell. Point at a cell for its number of cases and its standard error. " +
      (response.pure_error !== null ? `The pure error has ${response.pure_error_freedom} degrees of freedom.` : "Without replicates the standard error includes the influence of the other factors."),
    el("div", { class: "grid full" }, map.node)));
  sections.push(section("cases", "Cases", "Click a column's name to sort. Type below it to filter. Click a row to open the case. The filters also apply to the figures of Explore" +
    (map ? " and Two factors at once." : "."), cases.node));
  return { cases, sections };
}

// The cases whose films the page holds.
function filmsSection(model) {
  const rows = filmedRows(model);
  if (rows.length === 0) return null;
  const films = filmPlayer.films().filter((film) => film.campaign === model.campaign.name);
  const buttons = films.map((film) => {
    const row = rows.find((one) => model.id(one) === film.id);
    return row === undefined ? null : button(`▶ ${film.says}`, () => selectCase(model, row));
  });
  return section("films", "Cases to watch", "Films of some cases in three dimensions. Triangles mark these cases in the figures, ▶ in the table.", el("div", { class: "controls" }, buttons));
}

// The campaign to compare with, where it has the response, too.
function compared(response) {
  if (!response || chosen.other === "") return null;
  const model = open(Number(chosen.other)), found = model.campaign.observables.find((one) => one.name === response.name);
  return found && found.history.count > 0 ? { model, response: found } : null;
}

function comparedLine(campaign, response, other) {
  if (chosen.other === "") return null;
  const name = campaignTitle(data.campaigns[Number(chosen.other)]);
  return el("p", { class: "overlaid" }, other ? ["Blue: ", el("b", {}, campaignTitle(campaign)), "; orange: ", el("b", { class: "second" }, name), ". Painted figures stand one below the other."]
    : `${name} has no values of ${response ? response.name : "this response"}.`);
}

function render() {
  if (selected && selected.index !== chosen.campaign) closeCase();
  const model = open(chosen.campaign), { campaign } = model;
  if (filmPlayer) filmPlayer.showMachine(campaign.name);
  const response = campaign.observables[chosen.observable], other = compared(response);
  const settled = response && response.history.count > 0;  // values in the prefix of the design
  const answered = settled || (response && model.responses[chosen.observable].values.some(Number.isFinite));
  if (answered && !chosen.view.x) firstView(model, response);
  let cases = null;
  dataChanged.length = 0;
  showPage(() => {
    const explore = answered ? explorerSections(model, response, other) : plainCases(model);
    ({ cases } = explore);
    return [...heading(model), comparedLine(campaign, response, other),
      answered ? null : el("p", { class: "says" }, campaign.observables.length === 0 ? "The scene measures series and profiles only." : "No case has a result yet."),
      settled ? bracketsSection(campaign) : null, calibrationSection(campaign), answered ? distributionSection(campaign, response, other) : null,
      ...(settled ? [momentsSection(campaign, response, other), effectsSection(model, response, other), influenceSection(campaign, response), modelSection(campaign, response)] : []),
      answered ? filmsSection(model) : null, ...explore.sections, settled ? againstSection(model, response) : null, curvesSection(model),
      settled ? extremesSection(model, response) : null, failuresSection(model), provenanceSection(campaign)];
  });
  cases.paint();
}

// `name`: the one to be chosen where there is such a one.
function fillObservables(name) {
  const { campaign } = open(chosen.campaign), wanted = campaign.observables.findIndex((one) => one.name === name), select = document.getElementById("observable");
  select.replaceChildren(...open(chosen.campaign).responses.map((one, i) => el("option", { value: i }, quantity(one).title)));
  chosen.observable = wanted >= 0 ? wanted : campaign.main;
  select.value = String(chosen.observable);
}

function fillOthers() {
  const select = document.getElementById("other");
  select.replaceChildren(el("option", { value: "" }, "nothing"), ...data.campaigns.map((c, i) => [c, i]).filter(([, i]) => i !== chosen.campaign).map(([c, i]) => el("option", { value: i }, campaignTitle(c))));
  if (chosen.other === String(chosen.campaign)) chosen.other = "";
  select.value = chosen.other;
}

// Takes newer data of the same databases; what the reader chose stays.
function replaceData(fresh) {
  const name = (index) => { const one = data.campaigns[Number(index)]; return one && `${one.database} ${one.name}`; };
  const kept = { campaign: name(chosen.campaign), other: chosen.other === "" ? null : name(chosen.other), observable: observableName(), scroll: window.scrollY,
    selected: selected && { campaign: name(selected.index), id: open(selected.index).id(selected.row) }, typing: typedInto(document.activeElement) };
  const place = (text) => fresh.campaigns.findIndex((one) => `${one.database} ${one.name}` === text);
  Object.assign(data, fresh);
  opened.clear();
  selected = null;
  chosen.campaign = Math.max(0, place(kept.campaign));
  chosen.other = kept.other === null || place(kept.other) < 0 ? "" : String(place(kept.other));
  fillCampaigns();
  if (data.campaigns.length === 0) return;
  fillObservables(kept.observable);
  fillOthers();
  render();
  if (kept.selected && place(kept.selected.campaign) >= 0) {
    const model = open(place(kept.selected.campaign)), [row] = rowsOf(model, kept.selected.id);
    if (row !== undefined) { selected = { index: model.index, row }; selectionChanged.forEach((changed) => changed()); }
  }
  if (kept.typing) kept.typing();
  window.scrollTo(0, kept.scroll);
  figures.filter((one) => inWindow(one.canvas)).forEach((one) => one.draw());
}

// Returns a function that goes on typing where the reader typed, in the field of the same name of a new page.
function typedInto(field) {
  if (!field || !field.matches("#page input[aria-label]")) return null;
  const { selectionStart, selectionEnd } = field, label = field.getAttribute("aria-label");
  return () => {
    const again = [...document.querySelectorAll("#page input[aria-label]")].find((one) => one.getAttribute("aria-label") === label);
    if (!again) return;
    again.focus({ preventScroll: true });
    again.setSelectionRange(selectionStart, selectionEnd);
  };
}

function observableName() {
  const one = data.campaigns[chosen.campaign] && data.campaigns[chosen.campaign].observables[chosen.observable];
  return one && one.name;
}

function inWindow(node) {
  const { top, bottom } = node.getBoundingClientRect();
  return bottom > 0 && top < window.innerHeight;
}

function fillCampaigns() {
  const campaigns = document.getElementById("campaign");
  campaigns.replaceChildren(...data.campaigns.map((c, i) => el("option", { value: i }, campaignTitle(c))));
  campaigns.value = String(chosen.campaign);
  for (const id of ["campaign-choice", "other-choice"]) document.getElementById(id).hidden = data.campaigns.length < 2;
  if (data.campaigns.length === 0) document.getElementById("page").replaceChildren(el("p", {}, "The database holds no campaign yet."));
  return campaigns;
}

function start() {
  document.title = `${data.databases.join(", ")} · grainsweep report`;
  const campaigns = fillCampaigns();
  campaigns.addEventListener("change", () => { chosen.campaign = Number(campaigns.value); chosen.view = {}; fillObservables(); fillOthers(); render(); });
  const observables = document.getElementById("observable");
  observables.addEventListener("change", () => { chosen.observable = Number(observables.value); chosen.view = {}; render(); });
  const others = document.getElementById("other");
  others.addEventListener("change", () => { chosen.other = others.value; render(); });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", render);
  unpacked(data).then(() => {
    if (data.campaigns.length === 0) return;
    fillObservables();
    fillOthers();
    render();
    showAsked();
  });
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
