// The range of values that the colours of spheres cover: at first the usual one, then what the reader writes.

// Shade below which a share of the mobile spheres lies, in one frame; 0: none is there.
function shadeAt(film, data, frame, share) {
  const count = new Uint32Array(256), { spheres: n } = film;
  for (let i = 0; i < n; ++i) if (film.mobile[i]) ++count[data[frame * n + i]];
  const all = count.reduce((sum, c) => sum + c, 0) - count[0];
  let shade = 0, below = 0;
  while (all > 0 && below <= share * (all - 1)) below += count[++shade];
  return shade;
}

// {low, high}: of each frame the quantiles 0.02 and 0.98 over the spheres, of these the quartiles over the frames. A fall at
// the start or a few fast spheres do not darken the rest. Magnitudes begin at 0; values of both signs stay around 0.
function usualRange(film, shading, { data, still }) {
  const whole = { low: shading.low, high: shading.high };
  if (still) return whole;
  const over = (share, quartile) => {
    const shades = Array.from({ length: film.frames }, (_, frame) => shadeAt(film, data, frame, share)).filter((shade) => shade > 0).sort((a, b) => a - b);
    return shades.length > 0 ? valueOfShade(shading, shades[Math.round(quartile * (shades.length - 1))]) : NaN;
  };
  let low = shading.low === 0 ? 0 : over(0.02, 0.25), high = over(0.98, 0.75);
  if (shading.signed) low = -(high = Math.max(Math.abs(low), Math.abs(high)));
  return high > low ? { low, high } : whole;
}

// Share of the film's range at which the colours begin, and shares of the colours per share of the range.
function colourWindow({ low: least, high: most }, { low, high }) {
  const width = most - least;
  return width > 0 ? [(low - least) / width, width / (high - low)] : [0, 1];
}

// Two fields for the ends of the range; `set({low, high})` or `set(null)`, which means the usual range. `show(shading, range)` fills them.
function rangeChoice(set) {
  let factor = 1;
  const read = () => {
    const [low, high] = [from, to].map((field) => (field.value.trim() === "" ? NaN : Number(field.value) / factor));
    const bad = !(low < high);
    [from, to].forEach((field) => field.classList.toggle("watch-wrong", bad));
    if (!bad) set({ low, high });
  };
  const field = (label) => el("input", { type: "number", step: "any", "aria-label": label, change: read });
  const from = field("colours begin at"), to = field("colours end at"), unit = el("span");
  const root = el("span", { class: "choice watch-range" }, el("span", {}, "from"), from, el("span", {}, "to"), to, unit,
    button("reset", () => set(null), { title: "the usual range of this film" }));
  root.show = (shading, range) => {
    const scale = scaleFor(shading.unit, [range.low, range.high]);
    factor = scale.factor;
    [[from, range.low], [to, range.high]].forEach(([one, x]) => {
      one.value = Number((x * factor).toPrecision(3));
      one.classList.remove("watch-wrong");
    });
    unit.textContent = scale.unit;
  };
  return root;
}
