// Series and profiles, one line per case, coloured by a factor, with a list of the cases. Pointing at a line or a name
// highlights it; clicking shows it alone, or with others clicked.
function curveFigure(model, family) {
  const settings = { by: chosen.curvesBy && model.factors.some((f) => f.name === chosen.curvesBy) ? chosen.curvesBy : family.by || model.factors[0].name };
  const xs = family.curves.flatMap((curve) => curve.x), ys = family.curves.flatMap((curve) => curve.y);
  const across = axisOf(family.over, xs), up = axisOf(titled(family), ys);
  const [low, high] = rangeOf(xs);
  // Bins in a geometric series belong on a logarithmic axis: their last step is as large, relatively, as their first.
  const bins = [...new Set(xs)].sort((a, b) => a - b), end = bins.length - 1;
  const log = family.over_bins && low > 0 && end > 2 && Math.abs(Math.log(bins[1] / bins[0]) / Math.log(bins[end] / bins[end - 1]) - 1) < 0.1;
  const alone = new Set();
  let pointed = -1;
  const factor = () => model.factors.find((f) => f.name === settings.by);
  const tonesOf = () => colouring(factor(), family.curves.map((curve) => factor().values[curve.row]));
  const look = (k, tones) => {
    const curve = family.curves[k], tone = tones.of(factor().values[curve.row]);
    const front = pointed === k || (pointed < 0 && (alone.size === 0 || alone.has(k)));
    return { borderColor: front || tone[0] !== "#" ? tone : withAlpha(tone, 0.16), borderWidth: pointed === k ? 3.2 : alone.has(k) ? 2.4 : 1.6, order: front ? 0 : 1 };
  };
  const build = () => {
    const tones = tonesOf();
    return {
      type: "line",
      data: { datasets: family.curves.map((curve, k) => Object.assign({ label: curve.label, data: curve.x.map((x, i) => ({ x: across.of(x), y: curve.y[i] === null ? null : up.of(curve.y[i]) })),
        pointRadius: curve.x.length < 2 ? 3 : 0, pointHitRadius: 6, pointBackgroundColor: tones.of(factor().values[curve.row]) }, look(k, tones))) },
      options: {
        layout: { padding: tones.levels ? {} : { right: 74, top: 20 } },
        interaction: { mode: "nearest", intersect: false },
        onHover: (event, hits, chart) => point(hits.length > 0 && event.type !== "mouseout" ? hits[0].datasetIndex : -1, chart),
        onClick: (event, hits) => { if (hits.length > 0) keep(hits[0].datasetIndex); },
        scales: { x: axis(across.title, { type: log ? "logarithmic" : "linear", min: across.of(low), max: across.of(high) }), y: axis(up.unit) },
        plugins: {
          colourBar: tones.levels ? {} : { tones },
          tooltip: { callbacks: { title: (items) => `${across.title}: ${show(items[0].parsed.x)}`, label: (item) => `${item.dataset.label}: ${show(item.parsed.y)}` } } },
      },
    };
  };
  const dress = () => {
    const tones = tonesOf();
    if (self.chart) {
      self.chart.data.datasets.forEach((set, k) => Object.assign(set, look(k, tones)));
      self.chart.update("none");
    }
    all.hidden = alone.size === 0;
    names.forEach((name, k) => {
      const tone = tones.of(factor().values[family.curves[k].row]);
      name.firstChild.style.background = tone;
      name.classList.toggle("away", alone.size > 0 && !alone.has(k));
      name.classList.toggle("pointed", pointed === k);
    });
  };
  const point = (k) => { if (k !== pointed) { pointed = k; dress(); } };
  const keep = (k) => { if (alone.has(k)) alone.delete(k); else alone.add(k); pointed = -1; dress(); };
  const order = family.curves.map((_, k) => k);
  const names = family.curves.map((curve, k) => el("button", { type: "button", class: "name", mouseenter: () => point(k), mouseleave: () => point(-1), click: () => keep(k) }, el("i"), el("span")));
  const list = el("div", { class: "names" });
  const sortNames = () => {
    order.sort((a, b) => factor().values[family.curves[a].row] - factor().values[family.curves[b].row]);
    list.replaceChildren(...order.map((k) => names[k]));
    // The factor that colours comes first, the others small behind it.
    const first = factor(), shown = quantity(first), others = model.factors.filter((f) => f !== first);
    const words = (f, row) => (f.levels.length > 0 ? textOf(f, row) : quantity(f).says(f.values[row]));
    names.forEach((name, k) => {
      const { row } = family.curves[k], rest = others.map((f) => `${f.name} ${words(f, row)}`);
      name.lastChild.replaceChildren(el("b", {}, first.levels.length > 0 ? words(first, row) : shown.says(first.values[row])), " ", el("small", {}, rest.join(", ")));
      name.title = [`${first.name} ${words(first, row)}`, ...rest].join("\n");
    });
  };
  const recolour = (value) => { settings.by = chosen.curvesBy = value; sortNames(); self.redraw(); dress(); };
  const all = button("Show all", () => { alone.clear(); dress(); }, { hidden: true });
  const controls = el("div", { class: "controls" }, choice("colour", model.factors.map((f) => [f.name, quantity(f).title]), settings.by, recolour), all);
  const self = figure(up.title, family.meaning + (family.at === null ? "" : `; at time ${show(family.at)}`), build, { tall: true, controls, below: list });
  self.canvas.addEventListener("mouseleave", () => point(-1));
  sortNames();
  dress();
  return self.node;
}
