// What the page knows: the figures it holds, unpacked when they are needed. Texts of the database reach the page as
// text nodes only, never as markup.
const data = JSON.parse(document.getElementById("data").textContent);

function bytesOf(text) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

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
  const variable = (kind) => (thing) => {
    let values = null;
    return { kind, name: thing.name, unit: thing.unit || "", meaning: thing.meaning || "", levels: thing.levels || [], log: Boolean(thing.log),
      low: thing.low, high: thing.high, get values() { return values || (values = numbersOf(thing.values)); } };
  };
  const factors = campaign.factors.map(variable("factor")), responses = campaign.observables.map(variable("response"));
  const place = (name, meaning, values) => variable("place")({ name, meaning, values });
  const places = [place("point", "number of the design point", campaign.points)].concat(
    campaign.replicates > 1 ? [place("replicate", "repeat of the point", campaign.repeats)] : []);
  const outcomes = bytesOf(campaign.outcome_of.u8);
  const model = { index, campaign, rows: campaign.rows, factors, responses, places, variables: factors.concat(responses, places),
    id: idsOf(campaign.ids), outcome: (row) => campaign.outcome_of.of[outcomes[row]],
    keep: null /* rows that pass the filters of the case table; null: all */ };
  opened.set(index, model);
  return model;
}

function campaignTitle(campaign) { return data.databases.length > 1 ? `${campaign.name} (${campaign.database})` : campaign.name; }

// ---- numbers in words

const superscript = "⁰¹²³⁴⁵⁶⁷⁸⁹";
function power(exponent) { return "10" + (exponent < 0 ? "⁻" : "") + String(Math.abs(exponent)).replace(/\d/g, (d) => superscript[d]); }

function show(x, digits) {
  if (x === null || x === undefined || (typeof x === "number" && !Number.isFinite(x))) return "–";
  if (typeof x !== "number") return String(x);
  if (Number.isInteger(x) && Math.abs(x) < 1e9) return String(x);
  const size = Math.abs(x), precision = digits || 4;
  return size !== 0 && (size >= 1e5 || size < 1e-3) ? x.toExponential(precision - 2) : String(Number(x.toPrecision(precision)));
}

// The error to two digits, the value to the same place.
function withError(x, error) {
  if (!Number.isFinite(error) || !(error > 0)) return show(x);
  const place = 1 - Math.floor(Math.log10(error));
  return place < 0 || place > 6 ? `${show(x)} ± ${show(error, 2)}` : `${x.toFixed(place)} ± ${error.toFixed(place)}`;
}

function plural(n, word) { return `${n} ${word}${n === 1 ? "" : "s"}`; }
// J/m3 as J/m³, sqrt(2 L/g) as it is.
function unitText(unit) { return unit.replace(/([A-Za-z])(-?[2-6])(?![\d.])/g, (_, letter, digits) => letter + digits.replace(/\d/g, (d) => superscript[d]).replace("-", "⁻")); }
function unitOf(thing) { return thing.unit && thing.unit !== "1" ? ` (${unitText(thing.unit)})` : ""; }
function titled(thing) { return thing.name + unitOf(thing); }
function textOf(variable, row) {
  const x = variable.values[row];
  return variable.levels.length > 0 ? (variable.levels[x] === undefined ? "–" : variable.levels[x]) : show(x, 6);
}

// ---- units with the prefix that suits the largest number: 0.0036 m is drawn as 3.6 mm

const prefixes = { "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };
const prefixed = /^(m|s|N|Pa|J|W|Hz)(\/[A-Za-z0-9^]+)?$/;

function scaleFor(unit, numbers) {
  let largest = 0;
  for (const x of numbers) if (Number.isFinite(x) && Math.abs(x) > largest) largest = Math.abs(x);
  const plain = { factor: 1, unit: unit === "1" ? "" : unitText(unit) };
  if (!prefixed.test(unit) || largest === 0 || (largest >= 0.1 && largest < 1e4)) return plain;
  const exponent = Math.max(-9, Math.min(9, 3 * Math.floor(Math.log10(largest * (1 + 1e-9)) / 3)));
  return { factor: 10 ** -exponent, unit: prefixes[exponent] + unitText(unit) };
}

// A variable as an axis shows it: numbers times `factor`, and its title.
function quantity(variable, numbers) {
  const range = Number.isFinite(variable.high) && variable.high > variable.low ? [variable.low, variable.high] : numbers || variable.values;
  const { factor, unit } = variable.levels && variable.levels.length > 0 ? { factor: 1, unit: "" } : scaleFor(variable.unit || "", range);
  return { factor, unit, title: variable.name + (unit ? ` (${unit})` : ""), of: (x) => x * factor, says: (x) => show(x * factor) + (unit ? ` ${unit}` : "") };
}

// "distance from the wall (m)" of a curve: its words and its unit.
function axisOf(words, numbers) {
  const parts = /^(.*) \(([^()]*)\)$/.exec(words);
  return quantity({ name: parts ? parts[1] : words, unit: parts ? parts[2] : "", levels: [] }, numbers);
}
