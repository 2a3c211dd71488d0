// Colours come from the style sheet, so that a figure follows the reader's theme; a figure saved to a file is on paper.
let drawnOn = document.documentElement;

function colour(name) { return getComputedStyle(drawnOn).getPropertyValue("--" + name).trim(); }

function onPaper(work) {
  const paper = el("div", { class: "paper", hidden: true });
  document.body.append(paper);
  drawnOn = paper;
  try {
    return work();
  } finally {
    drawnOn = document.documentElement;
    paper.remove();
  }
}

const rampSteps = 64;
function ramp() {
  const stops = colour("ramp").split(/\s+/).map((hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)));
  return Array.from({ length: rampSteps }, (_, k) => {
    const at = (k / (rampSteps - 1)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at));
    return "#" + stops[i].map((c, j) => Math.round(c + (at - i) * (stops[i + 1][j] - c)).toString(16).padStart(2, "0")).join("");
  });
}

function categories(count) {
  const named = colour("levels").split(/\s+/);
  return Array.from({ length: count }, (_, k) => (k < named.length ? named[k] : `hsl(${(40 + 137.508 * k) % 360}, 55%, 50%)`));
}

function withAlpha(hex, alpha) { return hex[0] === "#" ? hex + Math.round(255 * alpha).toString(16).padStart(2, "0") : hex; }

function rangeOf(numbers) {
  let low = Infinity, high = -Infinity;
  for (const x of numbers) if (Number.isFinite(x)) { if (x < low) low = x; if (x > high) high = x; }
  return low <= high ? [low, high] : [0, 1];
}

// How a variable colours things: levels as categories, numbers along the ramp, logarithmically where the factor is.
function colouring(variable, numbers) {
  if (variable.levels.length > 0) {
    const tones = categories(variable.levels.length);
    return { levels: variable.levels, tones, of: (x) => tones[x] };
  }
  const tones = ramp(), shown = quantity(variable, numbers), log = variable.log && rangeOf(numbers)[0] > 0;
  const [low, high] = rangeOf(numbers), at = log ? Math.log : (x) => x;
  const width = at(high) - at(low);
  return { tones, low, high, log, title: shown.title, scale: shown.of,
    of: (x) => tones[width > 0 ? Math.max(0, Math.min(rampSteps - 1, Math.floor((rampSteps * (at(x) - at(low))) / width))) : rampSteps >> 1] };
}
