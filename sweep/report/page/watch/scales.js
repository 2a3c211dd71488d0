// Scales of colour of the films, and numbers in words.

// From dark to bright, evenly to the eye and safe for the colour-blind, for sizes; from blue over white to red for
// numbers of both signs.
const scales = {
  spheres: ["#4a1f78", "#4b3086", "#3e4a89", "#31688e", "#26838f", "#1f9d8a", "#6cce5a", "#b6de2b", "#fee825"],
  slices: ["#0b0724", "#35115f", "#721f81", "#b73779", "#f1605d", "#feb078", "#fcfdbf"],
  signed: ["#2b4ab8", "#6f92f3", "#aac7fd", "#e4e4e8", "#f7b89c", "#e7745b", "#b40426"],
};

// 256 x 4 bytes.
function palette(kind) { return Uint8Array.from(ramp(scales[kind], 256).flatMap((tone) => [...tone, 255])); }
function gradient(kind) { return `linear-gradient(to right, ${scales[kind].join(", ")})`; }

// 1.09e+9 as 1.09·10⁹.
function number(x, digits = 3) { return show(x, digits).replace(/e(.+)$/, (_, exponent) => `·${power(Number(exponent))}`); }

// A number with its unit.
function measured(x, unit, digits) {
  const scale = scaleFor(unit, [x]);
  return `${number(x * scale.factor, digits)} ${scale.unit}`.trim();
}

function words(name) { return name.replace(/_/g, " "); }

// Colours with the numbers at their ends; `beyond`: whether smaller and larger values have the colours of the ends.
function legend(title, unit, low, high, [below, above], kind) {
  const scale = scaleFor(unit, [low, high]), end = (x, mark) => el("span", {}, mark + number(x * scale.factor));
  return el("div", { class: "watch-legend" },
    el("div", { class: "watch-legend-title" }, title + (scale.unit ? ` (${scale.unit})` : "")),
    el("div", { class: "watch-gradient", style: `background: ${gradient(kind)}` }),
    el("div", { class: "watch-ends" }, end(low, below ? "≤ " : ""), end((low + high) / 2, ""), end(high, above ? "≥ " : "")));
}

// Saves pictures as they are on the page, side by side or one above the other.
function saveTogether(name, canvases) {
  const places = canvases.map((one) => one.getBoundingClientRect()), ratio = canvases[0].width / places[0].width;
  const least = (key) => Math.min(...places.map((place) => place[key])), most = (key) => Math.max(...places.map((place) => place[key]));
  const whole = el("canvas", { width: Math.round(ratio * (most("right") - least("left"))), height: Math.round(ratio * (most("bottom") - least("top"))) });
  const pen = whole.getContext("2d");
  canvases.forEach((one, k) => pen.drawImage(one, ratio * (places[k].left - least("left")), ratio * (places[k].top - least("top"))));
  whole.toBlob((blob) => save(name, blob));
}
