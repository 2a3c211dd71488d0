// The table of all cases, with sorting and a filter per column. The document holds the rows in view only, so ten thousand
// cases are as fast as ten.
const filterHelp = "Filter numbers with >0.3, <=2, 0.2..0.5, =1 or !=1, and texts with a part of the text, =whole text or !unwanted. The word none selects missing values. Separate several conditions by spaces.";

// Returns the test of a row that an expression describes, or a text that names its error.
function filterOf(expression, column) {
  const tests = [];
  for (const word of expression.trim().split(/[\s,]+/).filter(Boolean)) {
    const comparison = /^(>=|<=|!=|>|<|=)(.+)$/.exec(word), range = /^(.+)\.\.(.+)$/.exec(word);
    if (word === "none") tests.push((row) => column.missing(row));
    else if (word === "!none") tests.push((row) => !column.missing(row));
    else if (column.number && range) {
      const [low, high] = [Number(range[1]), Number(range[2])];
      if (Number.isNaN(low) || Number.isNaN(high)) return `${word}: a range needs two numbers, such as 0.2..0.5`;
      tests.push((row) => column.number(row) >= low && column.number(row) <= high);
    } else if (column.number && comparison) {
      const x = Number(comparison[2]), near = (y) => Math.abs(y - x) <= 1e-6 * Math.max(Math.abs(x), Math.abs(y));
      if (Number.isNaN(x)) return `${comparison[2]} is not a number`;
      tests.push({ ">": (row) => column.number(row) > x, ">=": (row) => column.number(row) >= x, "<": (row) => column.number(row) < x, "<=": (row) => column.number(row) <= x,
        "=": (row) => near(column.number(row)), "!=": (row) => !near(column.number(row)) }[comparison[1]]);
    } else if (comparison && comparison[1] === "=") tests.push((row) => column.text(row).toLowerCase() === comparison[2].toLowerCase());
    else if (comparison && comparison[1] === "!=") tests.push((row) => column.text(row).toLowerCase() !== comparison[2].toLowerCase());
    else if (comparison) return `${word}: texts are compared by = and != only`;
    else if (word[0] === "!") tests.push((row) => !column.text(row).toLowerCase().includes(word.slice(1).toLowerCase()));
    else if (column.number) tests.push((row) => column.text(row).startsWith(word));
    else tests.push((row) => column.text(row).toLowerCase().includes(word.toLowerCase()));
  }
  return (row) => tests.every((test) => test(row));
}

function caseColumns(model) {
  const ofLevels = (variable, { numbers, factor, unit }) => ({ title: variable.name, unit, meaning: variable.meaning, number: (row) => numbers[variable.values[row]] * factor,
    text: (row) => textOf(variable, row), stored: (row) => numbers[variable.values[row]], missing: () => false, sort: (row) => numbers[variable.values[row]] });
  const ofVariable = (variable) => (variable.levels.length > 0 && shownLevels(variable).numbers ? ofLevels(variable, shownLevels(variable)) : variable.levels.length > 0
    ? { title: variable.name, unit: "", meaning: variable.meaning, text: (row) => textOf(variable, row), missing: () => false, sort: (row) => variable.values[row] }
    : ofNumbers(variable, steady(variable) ? quantity(variable) : { unit: unitText(variable.unit), of: (x) => x }));
  // The unit of the figures follows the values: where these grow, a filter that was typed must keep its meaning.
  const steady = (variable) => variable.high > variable.low || data.event === undefined;
  // `stored`: as in the database.
  const ofNumbers = (variable, shown) => ({ title: variable.name, unit: shown.unit, meaning: variable.meaning, number: (row) => shown.of(variable.values[row]),
    text: (row) => show(shown.of(variable.values[row]), 5), stored: (row) => variable.values[row],
    missing: (row) => !Number.isFinite(variable.values[row]), sort: (row) => variable.values[row] });
  const word = (title, meaning, text) => ({ title, unit: "", meaning, text, missing: () => false, sort: text });
  return [...model.places.map(ofVariable), word("outcome", "outcome of the case", model.outcome), ...model.factors.map(ofVariable), ...model.responses.map(ofVariable),
    word("case", "case id for grainsweep explain, replay and solve", (row) => (hasFilm(model, row) ? "▶ " : "") + model.id(row).slice(0, 10))];
}

function caseTable(model, filtered) {
  const columns = caseColumns(model), rowHeight = 27, filters = columns.map(() => null);
  // Filters and order outlive the table: newer data are shown through them.
  const kept = (chosen.tables[campaignTitle(model.campaign)] ||= { filters: {}, sorted: null, scroll: 0 });
  let order = Array.from({ length: model.rows }, (_, row) => row), sorted = { column: -1, down: false }, shown = order;
  const widths = columns.map((column) => {
    let longest = Math.max(column.title.length + 2, column.unit.length + 1, 6);
    for (let k = 0; k < Math.min(60, model.rows); ++k) longest = Math.max(longest, column.text(Math.floor((k * model.rows) / Math.min(60, model.rows))).length);
    return Math.min(24, longest) * 8 + 26;
  });
  const count = el("span", { class: "quiet" }), body = el("tbody"), above = el("td", { colspan: columns.length }), under = el("td", { colspan: columns.length });
  const arrows = columns.map(() => el("span", { class: "arrow" }));
  const sortBy = (k, down) => {
    sorted = { column: k, down };
    kept.sorted = { title: columns[k].title, down };
    const column = columns[k], sign = sorted.down ? -1 : 1;
    const key = order.map((_, row) => column.sort(row));
    order.sort((a, b) => {
      const [x, y] = [key[a], key[b]];
      if (typeof x === "string") return sign * (x < y ? -1 : x > y ? 1 : a - b);
      if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y) || a - b;  // no value: last, either way
      return sign * (x - y) || a - b;
    });
    arrows.forEach((arrow, j) => { arrow.textContent = j === k ? (sorted.down ? " ▼" : " ▲") : ""; });
    refresh();
  };
  const heads = columns.map((column, k) => el("th", { scope: "col", title: column.meaning }, el("button", { type: "button", click: () => sortBy(k, sorted.column === k && !sorted.down) }, column.title, arrows[k]), el("small", {}, column.unit || "\u00a0")));
  let waiting = 0;
  const inputs = columns.map((column, k) => el("input", { type: "text", spellcheck: "false", autocomplete: "off", "aria-label": `filter ${column.title}`, title: filterHelp, placeholder: column.number ? ">…" : "…",
    input: (event) => {
      const made = event.target.value.trim() === "" ? null : filterOf(event.target.value, column);
      const wrong = typeof made === "string";
      event.target.classList.toggle("wrong", wrong);
      event.target.title = wrong ? made : filterHelp;
      kept.filters[column.title] = event.target.value;
      if (wrong) return;
      filters[k] = made;
      clearTimeout(waiting);
      waiting = setTimeout(filter, model.rows > 3000 ? 180 : 60);
    } }));
  const view = el("div", { class: "rows", tabindex: "0", scroll: () => { kept.scroll = view.scrollTop; requestAnimationFrame(paint); } },
    el("table", { style: `width: ${widths.reduce((a, b) => a + b, 0)}px` }, el("colgroup", {}, widths.map((w) => el("col", { style: `width: ${w}px` }))),
      el("thead", {}, el("tr", {}, heads), el("tr", { class: "filters" }, inputs.map((input) => el("th", {}, input)))),
      el("tbody", { class: "space" }, el("tr", {}, above)), body, el("tbody", { class: "space" }, el("tr", {}, under))));
  function filter() {
    const tests = filters.filter(Boolean);
    model.keep = tests.length > 0 ? Uint8Array.from({ length: model.rows }, (_, row) => (tests.every((test) => test(row)) ? 1 : 0)) : null;
    refresh();
    filtered();
  }
  function refresh() {
    shown = model.keep ? order.filter((row) => model.keep[row]) : order;
    count.textContent = model.keep ? `${shown.length} of ${plural(model.rows, "case")}` : plural(model.rows, "case");
    paint();
  }
  function paint() {
    const first = Math.max(0, Math.floor(view.scrollTop / rowHeight) - 8), last = Math.min(shown.length, first + Math.ceil((view.clientHeight || 460) / rowHeight) + 16);
    above.style.height = `${first * rowHeight}px`;
    under.style.height = `${(shown.length - last) * rowHeight}px`;
    body.replaceChildren(...shown.slice(first, last).map((row) => el("tr", { class: selected && selected.index === model.index && selected.row === row ? "selected" : null, "data-row": row, click: () => selectCase(model, row) },
      columns.map((column) => el("td", { class: column.number ? "number" : null, title: column.text(row) }, column.text(row))))));
  }
  function csv() {
    const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
    const cell = (column, row) => (column.title === "case" ? model.id(row) : column.missing(row) ? "" : column.number ? String(Number((column.stored || column.number)(row).toPrecision(7))) : quoted(column.text(row)));
    const lines = [columns.map((column) => quoted(column.title)), ...shown.map((row) => columns.map((column) => cell(column, row)))].map((line) => line.join(","));
    save(fileName(model.campaign.name, "cases") + ".csv", new Blob([lines.join("\n") + "\n"], { type: "text/csv" }));
  }
  const clear = () => { inputs.forEach((input, k) => { input.value = ""; input.classList.remove("wrong"); filters[k] = null; }); kept.filters = {}; filter(); };
  count.textContent = plural(model.rows, "case");
  // Values changed in place.
  function renew() {
    if (kept.sorted) sortBy(columns.findIndex((column) => column.title === kept.sorted.title), kept.sorted.down);
    if (filters.some(Boolean)) filter();
    paint();
  }
  function restore() {
    columns.forEach((column, k) => {
      const text = kept.filters[column.title];
      if (!text) return;
      inputs[k].value = text;
      const made = filterOf(text, column);
      if (typeof made !== "string") filters[k] = made;
    });
    if (filters.some(Boolean)) {
      const tests = filters.filter(Boolean);
      model.keep = Uint8Array.from({ length: model.rows }, (_, row) => (tests.every((test) => test(row)) ? 1 : 0));
    }
    const k = kept.sorted ? columns.findIndex((column) => column.title === kept.sorted.title) : -1;
    if (k >= 0) sortBy(k, kept.sorted.down); else refresh();
    view.scrollTop = kept.scroll;
  }
  const node = el("div", { class: "card cases" }, el("div", { class: "controls" }, count, el("span", { class: "spring" }),
    button("Clear filters", clear), button("Save as CSV", csv)), view,
  el("p", { class: "says" }, filterHelp));
  restore();
  return { node, paint, renew, restoreScroll() { view.scrollTop = kept.scroll; } };
}
