// The data of the page, unpacked when needed. Texts of the database become text nodes only, never markup.
const data = JSON.parse(document.getElementById("data").textContent);

// A column of numbers: an index byte per row into a few values, or four or eight bytes per row.
function numbersOf(packed) {
  if (packed.u8 === undefined) return packed.f32 === undefined ? new Float64Array(bytesOf(packed.f64).buffer) : new Float32Array(bytesOf(packed.f32).buffer);
  const values = packed.of.map((x) => (x === null ? NaN : x));
  return Float64Array.from(bytesOf(packed.u8), (i) => values[i]);
}

function idsOf(text) {
  const bytes = bytesOf(text);
  const digits = (byte) => byte.toString(16).padStart(2, "0");
  return (row) => Array.from(bytes.subarray(16 * row, 16 * row + 16), digits).join("");
}

// A campaign with its columns: variables are what can be drawn against one another.
const opened = new Map();
function open(index) {
  if (opened.has(index)) return opened.get(index);
  const campaign = data.campaigns[index];
  const variable = (thing) => {
    let values = null;
    return { name: thing.name, unit: thing.unit || "", meaning: thing.meaning || "", levels: thing.levels || [], log: Boolean(thing.log),
      low: thing.low, high: thing.high, get values() { return values || (values = numbersOf(thing.values)); } };
  };
  const factors = campaign.factors.map(variable), responses = campaign.observables.map(variable);
  const places = [variable({ name: "point", meaning: "number of the design point", values: campaign.points })];
  if (campaign.replicates > 1) places.push(variable({ name: "replicate", meaning: "repeat of the point", values: campaign.repeats }));
  const outcomes = bytesOf(campaign.outcome_of.u8), words = [...campaign.outcome_of.of];
  const model = { index, campaign, rows: campaign.rows, factors, responses, places, variables: factors.concat(responses, places),
    id: idsOf(campaign.ids), outcome: (row) => words[outcomes[row]],
    settle(row, outcome) { if (!words.includes(outcome)) words.push(outcome); outcomes[row] = words.indexOf(outcome); },
    keep: null /* rows that pass the filters of the case table; null: all */ };
  opened.set(index, model);
  return model;
}

// Rows of a case, which may stand at several places of the design.
function rowsOf(model, id) {
  if (!model.byId) {
    model.byId = new Map();
    for (let row = 0; row < model.rows; ++row) {
      const here = model.id(row), rows = model.byId.get(here);
      if (rows) rows.push(row); else model.byId.set(here, [row]);
    }
  }
  return model.byId.get(id) || [];
}

function campaignTitle(campaign) { return data.databases.length > 1 ? `${campaign.name} (${campaign.database})` : campaign.name; }

function titled(thing) { const unit = unitText(thing.unit); return thing.name + (unit ? ` (${unit})` : ""); }
function textOf(variable, row) {
  const x = variable.values[row];
  return variable.levels.length > 0 ? shownLevels(variable).texts[x] ?? "–" : show(x, 6);
}

// Levels as the page shows them: numbers with the prefix that suits all of them, words as they are.
const levelsShown = new WeakMap();
function shownLevels({ levels, unit }) {
  if (!levelsShown.has(levels)) {
    const numbers = levels.map(Number), numeric = !numbers.some(Number.isNaN), scale = numeric ? scaleFor(unit || "", numbers) : { factor: 1, unit: "" };
    levelsShown.set(levels, { ...scale, numbers: numeric ? numbers : null, texts: scale.factor === 1 ? levels : numbers.map((x) => show(x * scale.factor, 6)) });
  }
  return levelsShown.get(levels);
}

// A variable as an axis shows it: numbers times `factor`, and its title. Of levels the numbers are their indices.
function quantity(variable, numbers) {
  if (variable.levels?.length > 0) {
    const { unit, texts } = shownLevels(variable);
    return { factor: 1, unit, title: variable.name + (unit ? ` (${unit})` : ""), of: (x) => x, says: (x) => texts[x] + (unit ? ` ${unit}` : "") };
  }
  const range = Number.isFinite(variable.high) && variable.high > variable.low ? [variable.low, variable.high] : numbers || variable.values;
  const { factor, unit } = scaleFor(variable.unit || "", range);
  return { factor, unit, title: variable.name + (unit ? ` (${unit})` : ""), of: (x) => x * factor, says: (x) => show(x * factor) + (unit ? ` ${unit}` : "") };
}

// A response of the page's data as its figures show it.
function quantityOf(response) { return quantity(response, numbersOf(response.values)); }

// "0.0036 ± 0.0002", or the number alone, times `factor`.
function scaledText(text, factor) {
  const [x, error] = String(text).split(" ± ").map(Number);
  if (!Number.isFinite(x) || (factor === 1 && error !== undefined)) return text;
  return error === undefined ? show(x * factor) : withError(x * factor, error * factor);
}

// The quantity on a curve's axis from its title, as "distance from the wall (m)".
function axisOf(title, numbers) {
  const [, name, unit] = /^(.*) \(([^()]*)\)$/.exec(title) || [title, title, ""];
  return quantity({ name, unit }, numbers);
}
