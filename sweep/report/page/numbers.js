// Numbers and units in words, and bytes of base64 text: shared by all pages.
function bytesOf(text) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

// Bytes that zlib packed.
function inflated(bytes) {
  const stream = new Response(bytes).body.pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer().then((buffer) => new Uint8Array(buffer));
}

const superscript = "⁰¹²³⁴⁵⁶⁷⁸⁹";
function raised(digits) { return digits.replace("-", "⁻").replace(/\d/g, (d) => superscript[d]); }
function power(exponent) { return "10" + raised(String(exponent)); }

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
function capital(sentence) { return sentence.replace(/^./, (c) => c.toUpperCase()); }

// J/m3 as J/m³, L^2/alpha as L²/α, sqrt(2 L/g) as it is; nothing for a pure number.
function unitText(unit) {
  if (!unit || unit === "1") return "";
  return unit.replace(/([A-Za-z)])\^?(-?[2-6])(?![\d.])/g, (_, before, digits) => before + raised(digits))
    .replace(/alpha/g, "α").replace(/rho/g, "ρ").replace("DT", "ΔT");
}

function rangeOf(numbers) {
  let low = Infinity, high = -Infinity;
  for (const x of numbers) if (Number.isFinite(x)) { if (x < low) low = x; if (x > high) high = x; }
  return low <= high ? [low, high] : [0, 1];
}

// Ends of an axis for numbers that are all the same: the library would take one below and above, whatever they are.
function aroundOne(numbers, of) {
  const [low, high] = rangeOf(numbers), room = 0.1 * Math.abs(low) || 1;
  return low === high ? { min: of(low - room), max: of(high + room) } : {};
}

// Units with the prefix that suits the largest number: 0.0036 m is drawn as 3.6 mm.
const prefixes = { "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };
const prefixed = /^(m|s|N|Pa|J|W|Hz)(\/[A-Za-z0-9^]+)?$/;

function scaleFor(unit, numbers) {
  const largest = Math.max(...rangeOf(numbers).map(Math.abs));
  if (!prefixed.test(unit) || largest === 0 || (largest >= 0.1 && largest < 1e4)) return { factor: 1, unit: unitText(unit) };
  const exponent = Math.max(-9, Math.min(9, 3 * Math.floor(Math.log10(largest * (1 + 1e-9)) / 3)));
  return { factor: 10 ** -exponent, unit: prefixes[exponent] + unitText(unit) };
}
