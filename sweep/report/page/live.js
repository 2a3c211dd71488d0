// The page of `grainsweep serve`: the report whose data grows. Results come one by one and are drawn at once; figures that
// need all of them (moments, indices, models) come with the next data of the whole page.
const token = new URLSearchParams(location.search).get("token");
// The token leaves the address, so that it is not in the history and not copied with it. A reload finds it here.
try { sessionStorage.setItem(`grainsweep ${location.pathname}`, token); history.replaceState(null, "", location.pathname + location.hash); } catch (error) { /* a reader who keeps nothing */ }
const address = (path, more) => `${path}?${new URLSearchParams({ token, ...more })}`;

async function ask(path, more, body) {
  const answer = await fetch(address(path, more), body === undefined ? {} : { method: "POST", body });
  if (!answer.ok) throw new Error((await answer.text()).trim() || `the server answers ${answer.status}`);
  return answer.json();
}

// Asks for work and waits for its end.
async function work(path, more, body) {
  return endOf(await ask(path, more, body));
}

async function endOf(begun) {
  if (begun.job === undefined) return begun;
  for (;;) {
    await new Promise((go) => setTimeout(go, 300));
    const state = await ask("job", { number: begun.job });
    if (state.running) continue;
    if (state.code !== 0) throw new Error(state.err.trim().replace(/^grainsweep: /, "") || `it ended with code ${state.code}`);
    return state;
  }
}

// ---- what runs now

function spanText(seconds) {
  if (!Number.isFinite(seconds)) return "";
  const s = Math.round(seconds), two = (n) => String(n).padStart(2, "0");
  return s < 60 ? `${s} s` : s < 3600 ? `${Math.floor(s / 60)}:${two(s % 60)} min` : `${Math.floor(s / 3600)}:${two(Math.floor((s % 3600) / 60))} h`;
}

const live = { now: null, lost: false, failures: [], points: new Map() /* wanted, by database */, configs: new Map() /* the same */, panel: el("section", { id: "now", "aria-live": "polite" }) };

// Where a case stands, in words: its point and its factors.
function placeOf(database, id) {
  for (let index = 0; index < data.campaigns.length; ++index) {
    if (data.campaigns[index].database !== database) continue;
    const model = open(index), rows = rowsOf(model, id);
    if (rows.length > 0) return { model, row: rows[0] };
  }
  return null;
}

function runningTable(state) {
  const shown = state.run.running.slice(0, 64);
  const rows = shown.map((one) => {
    const place = placeOf(state.database, one.case);
    const factors = place ? place.model.factors.map((f) => `${f.name} ${quantity(f).says(f.values[place.row])}`).join(", ") : "";
    const done = one.share === null ? el("span", {}, "begins") : el("progress", { max: 1, value: one.share, title: `${Math.round(100 * one.share)} %` });
    const name = place ? `point ${place.model.places[0].values[place.row]}` : one.case.slice(0, 10);
    return [place ? el("button", { type: "button", class: "plain", title: one.case, click: () => selectCase(place.model, place.row) }, name) : name,
      done, spanText(one.seconds), factors, one.attempt, one.host];
  });
  const more = state.run.running.length + state.run.running_more - shown.length;
  return [table([["case"], ["done"], ["for", "number"], ["factors", "text"], ["attempt", "number"], ["host"]], rows),
    more > 0 ? el("p", { class: "says" }, `and ${more} more`) : null];
}

// A design that extends, and the number of points that it shall have.
function morePoints(state, act) {
  const campaign = data.campaigns.find((one) => one.database === state.database && one.extends_from);
  if (!campaign) return null;
  const wanted = live.points.get(state.database) ?? 2 * campaign.extends_from;
  const field = el("input", { type: "number", min: 1, value: wanted, "aria-label": "points of the design", input: () => live.points.set(state.database, field.value) });
  return el("span", { class: "choice" }, button("Extend the design to", act("more", () => ({ points: field.value }))), field, "points");
}

// The campaign file that Run starts: by default the one named as the database.
const stem = (name) => name.replace(/\.[^.]*$/, "");
function configOf(state) {
  const files = data.steerable;
  return live.configs.get(state.database) ?? files.find((file) => stem(file) === stem(state.database)) ?? files[0];
}

function configChoice(state) {
  if (data.steerable.length < 2) return null;
  return choice("Campaign file", data.steerable.map((file) => [file, file]), configOf(state), (file) => live.configs.set(state.database, file));
}

function steering(state) {
  if (!data.steerable) return null;
  const said = el("span", { class: "quiet" });
  const act = (path, more) => async () => {
    try {
      await ask(path, { database: state.database, config: configOf(state), ...(typeof more === "function" ? more() : more) }, "");
      said.textContent = "asked";
    } catch (error) { said.textContent = error.message; }
  };
  return el("div", { class: "controls" }, state.run ? button("Stop after the running cases", act("stop")) : [configChoice(state), button("Run", act("run")),
    button("Run crashed cases again", act("again", { outcome: "crashed" })), button("Run timed-out cases again", act("again", { outcome: "timed_out" })), morePoints(state, act)], said);
}

// What the time left ends, where later cases depend on results.
function partOf({ database, run }) {
  const campaign = data.campaigns.find((one) => one.database === database && one.name === run.campaign);
  return campaign && campaign.calibration ? " in this wave" : campaign && campaign.brackets ? " in this round" : "";
}

function stateOf(state) {
  const many = data.databases.length > 1, name = many ? `${state.database}: ` : "";
  if (!state.in_place) return el("div", { class: "verdict no" }, `${name}the database was moved or deleted. The page shows what it held.`);
  if (state.error) return el("div", { class: "verdict no" }, `${name}${state.error}`);
  if (!state.run) return el("div", { class: "card" }, el("p", { class: "says" }, `${name}no run is under way.`), steering(state));
  const { run } = state, share = run.questions > 0 ? run.decided / run.questions : 1, rate = run.seconds > 0 ? run.settled / run.seconds : 0;
  const facts = [`${run.decided} of ${plural(run.questions, "case")}`, rate > 0 ? (rate >= 0.5 ? `${show(rate, 3)}/s` : `${show(60 * rate, 3)}/min`) : null,
    run.decided < run.questions ? `${run.at_most ? "at most " : ""}${spanText(run.seconds_left)} left${partOf(state)}` : null, run.failed > 0 ? `${run.failed} failed` : null].filter(Boolean).join(" · ");
  return el("div", { class: "card" },
    el("div", { class: "caption" }, el("h3", {}, `${name}${run.campaign}`), el("span", { class: "quiet" }, facts)),
    el("progress", { class: "whole", max: 1, value: share, "aria-label": "share of the cases that are decided" }),
    run.judgement ? el("p", { class: "says" }, run.judgement) : null, runningTable(state), steering(state));
}

function failuresNow() {
  if (live.failures.length === 0) return null;
  return el("div", { class: "card" }, el("h3", {}, "Failed since this page was opened"),
    table([["case"], ["outcome"], ["reason", "text"]], live.failures.slice(-8).reverse().map((one) => [one.case.slice(0, 10), one.outcome.replace("_", " "), one.reason || ""])));
}

const mostShown = 20;
function showNow() {
  if (live.panel.contains(document.activeElement) && document.activeElement.tagName !== "BUTTON") return;
  const rank = (state) => (state.error || !state.in_place ? 0 : state.run ? 1 : 2);  // what needs attention stands first
  const all = live.now ? [...live.now.databases].sort((a, b) => rank(a) - rank(b)) : [], states = all.slice(0, mostShown);
  const away = live.lost ? el("div", { class: "verdict no" }, "The server does not answer. The page shows the last it said and asks again.") : null;
  const told = live.now && live.now.databases.some((one) => one.error);
  const broken = live.now && live.now.error && !told ? el("div", { class: "verdict no" }, live.now.error) : null;
  const more = all.length > mostShown ? el("p", { class: "says" }, `and ${all.length - mostShown} more databases`) : null;
  live.panel.replaceChildren(...[away, broken, ...states.map(stateOf), more, failuresNow()].filter(Boolean));
}

// ---- results as they come

const waiting = new Map();  // results by the case's id, not drawn yet
let drawing = 0, drawCost = 0;

// Results told since the data of the page were made: newer data may not contain the last of them.
let sinceData = [];  // {number of the event, database, results}
const numberOf = (id) => Number(id.slice(id.lastIndexOf("-") + 1));

function take(database, results, id) {
  sinceData.push({ number: numberOf(id), database, results });
  live.failures.push(...results.filter((one) => !["completed", "skipped", "abandoned"].includes(one.outcome)));
  live.failures.splice(0, Math.max(0, live.failures.length - 50));
  wait(database, results);
}

function wait(database, results) {
  for (const one of results) waiting.set(`${database} ${one.case}`, { database, one });
  if (!drawing) drawing = setTimeout(draw, Math.max(400, 5 * drawCost));
}

function draw() {
  clearTimeout(drawing);
  drawing = 0;
  const begun = performance.now(), touched = new Set();
  for (let index = 0; index < data.campaigns.length; ++index) {
    const model = open(index);
    for (const { database, one } of waiting.values()) {
      if (model.campaign.database !== database) continue;
      for (const row of rowsOf(model, one.case)) {
        model.settle(row, one.outcome);
        for (const response of model.responses) if (response.name in one.values) response.values[row] = one.values[response.name];
        touched.add(index);
      }
    }
  }
  waiting.clear();
  if (touched.has(chosen.campaign)) dataChanged.forEach((changed) => changed());
  document.documentElement.dataset.results = String(Number(document.documentElement.dataset.results || 0) + 1);
  drawCost = performance.now() - begun;
}

// ---- newer data of the whole page

let refreshing = false;
async function refresh() {
  const busy = document.activeElement && document.activeElement.tagName === "SELECT" && document.activeElement.matches(":focus");
  if (refreshing || busy || document.hidden) { live.stale = true; return; }
  refreshing = true;
  live.stale = false;
  try {
    const fresh = await unpacked(await ask("data")), covered = numberOf(fresh.event);
    replaceData(fresh);
    live.listDatabases();
    sinceData = sinceData.filter((told) => told.number > covered);
    if (sinceData.length > 0) {
      sinceData.forEach((told) => wait(told.database, told.results));
      draw();
    }
  } catch (error) {
    live.stale = true;
  }
  refreshing = false;
}
setInterval(() => { if (live.stale) refresh(); }, 1500);
document.addEventListener("visibilitychange", () => { if (live.stale) refresh(); });

// ---- SQL

function sqlConsole() {
  const text = el("textarea", { rows: 3, spellcheck: "false", "aria-label": "SQL", placeholder: "SELECT ..." });
  text.value = data.campaigns.length > 0 ? `SELECT * FROM ${data.campaigns[0].name} LIMIT 20` : "";
  const out = el("div", {}), database = choice("database", [], "", () => {}), select = database.control;
  live.listDatabases = () => {
    const chosenOne = data.databases.includes(select.value) ? select.value : data.databases[0];
    select.replaceChildren(...data.databases.map((name) => el("option", { value: name }, name)));
    select.value = chosenOne;
    database.hidden = data.databases.length < 2;
  };
  live.listDatabases();
  const run = async () => {
    out.replaceChildren(el("p", { class: "says" }, "…"));
    try {
      const answer = await work("query", { database: select.value }, text.value);
      const rows = JSON.parse(answer.out), columns = rows.length > 0 ? Object.keys(rows[0]) : [];
      out.replaceChildren(el("p", { class: "says" }, plural(rows.length, "row") + (rows.length > 500 ? ", the first 500 shown" : "")),
        rows.length > 0 ? table(columns.map((name) => [name, typeof rows[0][name] === "number" ? "number" : ""]), rows.slice(0, 500).map((row) => columns.map((name) => row[name] ?? ""))) : "");
    } catch (error) {
      out.replaceChildren(el("div", { class: "verdict no" }, error.message));
    }
  };
  text.addEventListener("keydown", (event) => { if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) run(); });
  return section("sql", "SQL", "One read-only statement, 10 s of processor time at most. Ctrl+Enter runs it.",
    el("div", { class: "card" }, text, el("div", { class: "controls" }, button("Run", run), database), out));
}

// ---- films

document.addEventListener("grainsweep:case", (event) => {
  const { database, case_id: id } = event.detail;  // several databases may hold a campaign of one name
  const place = placeOf(database, id), unfinished = place && ["not yet", "abandoned"].includes(place.model.outcome(place.row));
  const said = el("span", { class: "says" });
  const show = button(unfinished ? "Picture of the last checkpoint" : "▶ Film", async () => {
    said.textContent = unfinished ? " …" : " computing it again, at low priority …";
    try {
      const begun = await ask("film", { database, case: id }, "");
      await endOf(begun);
      said.replaceChildren(" ", el("a", { href: begun.film, target: "_blank", rel: "noopener" }, "open it"));
    } catch (error) {
      said.textContent = ` ${error.message}`;
    }
  });
  casePanel().querySelector(".watch").replaceChildren(el("p", {}, show, said));
});

// ---- begin

document.title = document.title.replace("report", "live");
document.getElementById("page").before(live.panel);
const consoleOfSql = sqlConsole();
document.getElementById("page").after(el("main", { class: "beside" }, consoleOfSql));

// A browser opens six connections to a server, and a stream keeps one. So the tabs share the stream of one of them, which
// holds a lock; when it is closed, the next one takes the lock. A tab that hears nothing asks by itself.
const uses = { results: ({ database, results }, id) => take(database, results, id), now: (now) => { live.now = now; showNow(); }, page: refresh };
const kinds = Object.keys(uses), silence = 5000;
let last = data.event, heard = 0;

function receive({ kind, text, id }) {
  if (kind === "lost") { live.lost = true; showNow(); return; }
  heard = performance.now();
  live.lost = false;
  if (kind === "results") {
    const known = id.split("-")[0] === last.split("-")[0] && numberOf(id) <= numberOf(last);
    if (known) return;
    last = id;
  }
  uses[kind](JSON.parse(text), id);
}

async function catchUp() {
  try {
    const answer = await fetch(address("events", { since: last, once: 1 }));
    if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
    for (const event of (await answer.text()).split("\n\n")) {
      const field = (name) => (event.split("\n").find((line) => line.startsWith(`${name}: `)) || "").slice(name.length + 2);
      if (kinds.includes(field("event"))) receive({ kind: field("event"), text: field("data"), id: field("id") });
    }
  } catch (error) {
    receive({ kind: "lost" });
  }
}

function openStream(pass) {
  const events = new EventSource(address("events", { since: last }));
  for (const kind of kinds)
    events.addEventListener(kind, (event) => { const told = { kind, text: event.data, id: event.lastEventId }; receive(told); pass(told); });
  events.addEventListener("error", () => { receive({ kind: "lost" }); pass({ kind: "lost" }); });
}

async function askAgainAndAgain(pause) {
  for (;;) {
    if (performance.now() - heard > pause) await catchUp();
    await new Promise((go) => setTimeout(go, Math.min(pause, 1000)));
  }
}

if (navigator.locks && window.BroadcastChannel) {
  const name = `grainsweep ${location.pathname} ${data.event.split("-")[0]}`, channel = new BroadcastChannel(name);
  channel.onmessage = (event) => receive(event.data);
  navigator.locks.request(name, () => new Promise(() => openStream((told) => channel.postMessage(told))));
  heard = performance.now() - silence + 300;  // soon, if this tab has no stream
  askAgainAndAgain(silence);
} else {
  askAgainAndAgain(900);  // no secure context: a proxy without https
}
