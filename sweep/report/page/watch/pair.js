// Two films side by side: one camera, one clock, one range of colours and one scale of lengths.

function jointExtent(one, other) {
  const low = one.low.map((x, a) => Math.min(x, other.low[a])), high = one.high.map((x, a) => Math.max(x, other.high[a]));
  return { low, high, size: Math.max(...high.map((h, a) => h - low[a])), middle: high.map((h, a) => (h + low[a]) / 2) };
}

// The moment of a film at a time.
function momentAt({ times }, time) {
  const next = times.findIndex((t) => t > time);
  if (next < 0) return times.length - 1;
  return next === 0 ? 0 : next - 1 + (time - times[next - 1]) / (times[next] - times[next - 1]);
}

// Inputs that differ, in words, for both films; their cases where none does.
function captions(films) {
  const inputs = films.map(({ header }) => new Map(header.about.inputs.map((one) => [one[0], one])));
  const names = [...new Set(inputs.flatMap((all) => [...all.keys()]))].filter((name) => String(inputs[0].get(name)) !== String(inputs[1].get(name)));
  return films.map(({ header }, k) => (names.length === 0 ? [header.about.subtitle || header.about.title]
    : names.slice(0, 6).map((name) => (inputs[k].has(name) ? value(inputs[k].get(name)) : [`${words(name)}: none`]))));
}

// The longer film leads: it has the clock and the choices. The first stays on the left.
function pairOf(element, first, second) {
  const extent = jointExtent(extentOf(first), extentOf(second)), end = ({ header }) => header.times[header.times.length - 1];
  const [long, short] = end(second) > end(first) ? [second, first] : [first, second];
  const lead = new Player(element, long, { extent }), other = new Player(element, short, { extent, lead });
  if (short === first) lead.stages.prepend(other.stage);
  const shown = captions([first, second]);
  [first, second].forEach((film, k) => (film === long ? lead : other).stage.append(el("div", { class: "watch-caption" }, shown[k].map((one) => el("div", {}, one)))));
  lead.beside = other;
  lead.colourBy(lead.shading ? lead.shading.key : "");
  lead.resize();
  return lead;
}

// The film inside another page of this kind.
async function filmOfPage(text) {
  const [, film] = /id="watch-film">([^<]*)</.exec(text) || [];
  if (!film) throw new Error("the file is no page of --watch");
  return readFilm(film);
}
