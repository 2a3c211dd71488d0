// Colours come from the style sheet and follow the reader's theme. A figure saved to a file has the colours of paper.
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
function rampTones() {
  return ramp(colour("ramp").split(/\s+/), rampSteps).map((tone) => "#" + tone.map((c) => c.toString(16).padStart(2, "0")).join(""));
}

function categories(count) {
  const named = colour("levels").split(/\s+/);
  return Array.from({ length: count }, (_, k) => (k < named.length ? named[k] : `hsl(${(40 + 137.508 * k) % 360}, 55%, 50%)`));
}

function withAlpha(hex, alpha) { return hex[0] === "#" ? hex + Math.round(255 * alpha).toString(16).padStart(2, "0") : hex; }

// How a variable colours things: levels as categories, numbers along the ramp, logarithmically where the factor is.
function colouring(variable, numbers) {
  if (variable.levels.length > 0) {
    const tones = categories(variable.levels.length);
    return { levels: shownLevels(variable).texts, tones, of: (x) => tones[x] };
  }
  const tones = rampTones(), shown = quantity(variable, numbers), log = variable.log && rangeOf(numbers)[0] > 0;
  const [low, high] = rangeOf(numbers), at = log ? Math.log : (x) => x;
  const width = at(high) - at(low);
  return { tones, low, high, log, title: shown.title, scale: shown.of,
    of: (x) => tones[width > 0 ? Math.max(0, Math.min(rampSteps - 1, Math.floor((rampSteps * (at(x) - at(low))) / width))) : rampSteps >> 1] };
}
