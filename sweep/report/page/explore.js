// Any variable against any other, coloured by a third, and maps of a response over two factors.
function randomRows(rows, most) {
  if (rows.length <= most) return rows;
  const draw = (row) => { let h = Math.imul(row + 1, 2654435761); h ^= h >>> 15; h = Math.imul(h, 2246822519); return (h ^ (h >>> 13)) >>> 0; };
  return [...rows].sort((a, b) => draw(a) - draw(b)).slice(0, most).sort((a, b) => a - b);
}

function keptRows(model) {
  const rows = [];
  for (let row = 0; row < model.rows; ++row) if (!model.keep || model.keep[row]) rows.push(row);
  return rows;
}

// Cases of one level are spread sideways by a fixed sequence, so that they do not hide each other.
function spread(variable, row) { return variable.levels.length > 0 ? 0.5 * (((row * 0.618034) % 1) - 0.5) : 0; }

function variableChoices(model, more) {
  const named = (list) => list.map((variable) => [variable.name, quantity(variable).title]);
  return (more || []).concat([["Factors", named(model.factors)], ["Responses", named(model.responses)], ["Design", named(model.places)]]);
}

function named(model, name) { return model.variables.find((variable) => variable.name === name); }

// A variable on a logarithmic axis: numbers that are not positive have no place on it.
function onLogAxis(variable) {
  if (variable.log || variable.levels.length > 0) return variable;
  const values = Float64Array.from(variable.values, (x) => (x > 0 ? x : NaN));
  return Object.assign({}, variable, { values, log: true, low: undefined, high: undefined });
}

const dotSize = (count) => (count > 4000 ? 1.5 : count > 600 ? 2 : count > 150 ? 2.6 : 3.4);

// Triangles, as on a player's button, on the cases that have a film.
function filmMarks(points, radius) {
  return { label: "has a film", data: points, pointStyle: "triangle", rotation: 90, pointRadius: radius + 4, pointHoverRadius: radius + 6, backgroundColor: colour("two"),
    borderColor: colour("card"), borderWidth: 1, clip: 8, order: -1 };
}

function explorer(model, other) {
  const view = chosen.view;
  let drawn = 0;
  const datasets = () => {
    const placed = (name, log) => (log ? onLogAxis(named(model, name)) : named(model, name));
    const x = placed(view.x, view.logX), y = placed(view.y, view.logY), by = view.by ? named(model, view.by) : null;
    const [across, up] = [quantity(x), quantity(y)];
    const rows = keptRows(model).filter((row) => Number.isFinite(x.values[row]) && Number.isFinite(y.values[row]) && (!by || Number.isFinite(by.values[row])));
    const point = (row) => ({ x: across.of(x.values[row]) + spread(x, row), y: up.of(y.values[row]) + spread(y, row), row });
    const radius = dotSize(rows.length), base = { parsing: false, borderWidth: 0, pointRadius: radius, pointHoverRadius: radius + 2, clip: 6 };
    drawn = rows.length;
    const tones = by ? colouring(by, by.values) : null;
    let sets;
    if (tones && tones.levels) {
      sets = tones.levels.map((label, level) => Object.assign({ label, data: rows.filter((row) => by.values[row] === level).map(point), backgroundColor: tones.tones[level] }, base));
    } else {
      sets = [Object.assign({ label: model.campaign.name, data: rows.map(point), backgroundColor: tones ? rows.map((row) => tones.of(by.values[row])) : colour("dot") }, base)];
    }
    const filmed = filmedRows(model).filter((row) => rows.includes(row));
    if (filmed.length > 0) sets.push(filmMarks(filmed.map(point), radius));
    if (other && named(other.model, view.x) && named(other.model, view.y)) {
      const [a, b] = [named(other.model, view.x), named(other.model, view.y)];
      const level = (from, to, index) => (to.levels.length > 0 ? to.levels.indexOf(from.levels[index]) : index);
      const points = [];
      for (let row = 0; row < other.model.rows; ++row) {
        const p = { x: across.of(level(a, x, a.values[row])) + spread(x, row), y: up.of(level(b, y, b.values[row])) + spread(y, row) };
        if (Number.isFinite(p.x) && Number.isFinite(p.y)) points.push(p);
      }
      sets.push(Object.assign({}, base, { label: campaignTitle(other.model.campaign), data: points, backgroundColor: "transparent", borderColor: withAlpha(colour("two"), 0.75), borderWidth: 1 }));
    }
    return { sets, tones, x, y, by, across, up };
  };
  // Of a failed case that has no value up, at the lower edge.
  const failedPlaces = (x, y, across, up) => failedRows(model).filter((row) => Number.isFinite(x.values[row]) && (!model.keep || model.keep[row]))
    .map((row) => Object.assign({ x: across.of(x.values[row]) + spread(x, row) }, Number.isFinite(y.values[row]) ? { y: up.of(y.values[row]) + spread(y, row) } : {}));
  const build = () => {
    const { sets, tones, x, y, by, across, up } = datasets();
    const bar = tones && !tones.levels;
    const at = () => {
      if (!selected || selected.index !== model.index) return null;
      return { x: across.of(x.values[selected.row]) + spread(x, selected.row), y: up.of(y.values[selected.row]) + spread(y, selected.row) };
    };
    return {
      type: "scatter",
      data: { datasets: sets },
      plugins: [crossesAt(failedPlaces(x, y, across, up))],
      options: {
        layout: { padding: bar ? { right: 74, top: 20 } : {} },
        scales: { x: variableAxis(x), y: variableAxis(y) },
        onClick: (event, hits) => { const hit = hits.find((one) => sets[one.datasetIndex].data[one.index].row !== undefined); if (hit) selectCase(model, sets[hit.datasetIndex].data[hit.index].row); },
        onHover: (event, hits) => { event.native.target.style.cursor = hits.length > 0 ? "pointer" : "default"; },
        plugins: {
          colourBar: bar ? { tones } : {}, ring: { at },
          legend: { display: sets.length > 1, position: "bottom", labels: { color: colour("ink"), usePointStyle: true, boxWidth: 6, boxHeight: 6 } },
          tooltip: { callbacks: { label: (item) => {
            const row = item.raw.row;
            if (row === undefined) return item.dataset.label;
            return [`${x.name}: ${textOf(x, row)}`, `${y.name}: ${textOf(y, row)}`].concat(by ? [`${by.name}: ${textOf(by, row)}`] : [], [`case ${model.id(row).slice(0, 10)}`]);
          } } },
        },
      },
    };
  };
  const note = el("p", { class: "says" });
  const tell = () => { note.textContent = plural(drawn, "case") + (model.keep ? " within the filters of the table below" : "") + ". Click a point to open its case." + (failedRows(model).length > 0 ? " Crosses: failed cases." : ""); };
  const change = (key) => (value) => { view[key] = value; self.redraw(); tell(); };
  const controls = el("div", { class: "controls" }, choice("across", variableChoices(model), view.x, change("x")), tick("logarithmic", view.logX, change("logX")),
    choice("up", variableChoices(model), view.y, change("y")), tick("logarithmic", view.logY, change("logY")),
    choice("colour", variableChoices(model, [["", "none"]]), view.by, change("by")));
  const self = figure("Cases", "", build, { height: 420, controls, below: note });
  drawn = datasets().sets.reduce((sum, set) => sum + (set.data.length > 0 && set.data[0].row !== undefined ? set.data.length : 0), 0);
  tell();
  return { node: self.node, redraw() { self.redraw(); tell(); } };
}

const failures = ["unstable", "rejected", "crashed", "timed_out"];

// Some of the cases that failed, for crosses.
function failedRows(model) {
  return randomRows(Array.from({ length: model.rows }, (_, row) => row).filter((row) => failures.includes(model.outcome(row))), 500);
}

// The response against one factor: cases and binned mean, crosses where cases failed.
function scatter(model, factor, means, response) {
  const across = quantity(factor), values = named(model, response.name), up = quantity(values);
  return figure(`${response.name} against ${factor.name}`, "", () => {
    const rows = randomRows(keptRows({ rows: model.campaign.settled }).filter((row) => Number.isFinite(values.values[row])), 1500);
    const points = rows.map((row) => ({ x: across.of(factor.values[row]) + spread(factor, row), y: up.of(values.values[row]), row }));
    return {
      type: "scatter",
      plugins: [crossesAt(failedRows(model).map((row) => ({ x: across.of(factor.values[row]) + spread(factor, row) })))],
      data: { datasets: [
        { data: means.map(([x, y]) => ({ x: across.of(x), y: y === null ? null : up.of(y) })), type: "line", showLine: factor.levels.length === 0, borderColor: colour("two"),
          backgroundColor: colour("two"), borderWidth: 2, pointRadius: factor.levels.length > 0 ? 5 : 0, pointStyle: "rectRot" },
        { data: points, backgroundColor: colour("dot"), borderWidth: 0, pointRadius: dotSize(points.length), clip: 6 }] },
      options: { scales: { x: variableAxis(factor), y: values.log ? variableAxis(values) : axis(up.title, aroundOne(rows.map((row) => values.values[row]), up.of)) },
        onClick: (event, hits) => { const hit = hits.find((one) => one.datasetIndex === 1); if (hit) selectCase(model, points[hit.index].row); },
        plugins: { tooltip: { callbacks: { label: (item) => `${show(item.raw.x)}: ${show(item.raw.y)}` } } } },
    };
  }).node;
}

// Crosses, black on white to stand out on every colour.
function drawCrosses(ctx, places) {
  for (const [width, tone] of [[4, "#ffffff"], [1.8, "#000000"]]) {
    ctx.lineWidth = width;
    ctx.strokeStyle = tone;
    ctx.beginPath();
    for (const [x, y] of places) for (const up of [-1, 1]) { ctx.moveTo(x - 4, y - 4 * up); ctx.lineTo(x + 4, y + 4 * up); }
    ctx.stroke();
  }
}

// A plugin of a chart: crosses at `places`, each { x } or { x, y } in units of the axes; without y at the lower edge.
function crossesAt(places) {
  return { id: "crosses", afterDatasetsDraw({ ctx, scales, chartArea }) {
    ctx.save();
    drawCrosses(ctx, places.map(({ x, y }) => [scales.x.getPixelForValue(x), y === undefined ? chartArea.bottom : scales.y.getPixelForValue(y)]));
    ctx.restore();
  } };
}

// A chart of cells { x0, x1, y0, y1, value, ... } in units of the axes `x` and `y`; cells without a value stay empty.
// `gap`: pixels between them. `over` draws on them; `label` returns the lines of a cell's tooltip.
function cellChart({ x, y, cells, tones, gap, over, label }) {
  const squares = { id: "squares", beforeDatasetsDraw({ ctx, scales }) {
    const boxes = cells.map((cell) => ({ cell, left: scales.x.getPixelForValue(cell.x0), right: scales.x.getPixelForValue(cell.x1),
      bottom: scales.y.getPixelForValue(cell.y0), top: scales.y.getPixelForValue(cell.y1) }));
    ctx.save();
    for (const { cell, left, right, bottom, top } of boxes) {
      if (cell.value === null) continue;
      ctx.fillStyle = tones.of(cell.value);
      ctx.fillRect(left + gap / 2, top + gap / 2, right - left - gap, bottom - top - gap);
    }
    over(ctx, boxes, scales);
    ctx.restore();
  } };
  const points = cells.map((cell) => ({ x: (cell.x0 + cell.x1) / 2, y: (cell.y0 + cell.y1) / 2, cell }));
  return { type: "scatter", data: { datasets: [{ data: points, pointRadius: 0, pointHoverRadius: 0, pointHitRadius: 40 }] },
    options: { layout: { padding: { right: 74, top: 20 } }, interaction: { mode: "nearest", intersect: false }, scales: { x, y },
      plugins: { colourBar: cells.some((cell) => cell.value !== null) ? { tones } : {}, tooltip: { callbacks: { label: (item) => label(item.raw.cell) } } } },
    plugins: [squares] };
}

// ---- maps over two factors

// Black or white, which is the more readable on a colour (relative luminance of WCAG 2).
function inkOn(hex) {
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255).map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.2 ? "#10161b" : "#ffffff";
}

function cellsOf(factor, rows) {
  if (factor.levels.length > 0) return { edges: factor.levels.map((_, i) => i - 0.5).concat(factor.levels.length - 0.5), of: (x) => x };
  const distinct = [...new Set(rows.map((row) => factor.values[row]))].sort((a, b) => a - b);
  if (distinct.length <= 12) {  // a lattice: edges half-way between its values
    const middle = distinct.slice(1).map((x, i) => (x + distinct[i]) / 2), end = distinct.length - 1;
    const outer = end > 0 ? [distinct[0] - (middle[0] - distinct[0]), distinct[end] + (distinct[end] - middle[end - 1])] : [distinct[0] - 0.5, distinct[0] + 0.5];
    return { edges: [outer[0], ...middle, outer[1]], of: (x) => distinct.indexOf(x) };
  }
  const count = Math.max(3, Math.min(14, Math.floor(Math.sqrt(rows.length / 8))));
  const at = factor.log && factor.low > 0 ? Math.log : (x) => x, back = at === Math.log ? Math.exp : (x) => x;
  const [low, high] = factor.high > factor.low ? [factor.low, factor.high] : rangeOf(distinct);
  const edges = Array.from({ length: count + 1 }, (_, i) => back(at(low) + ((at(high) - at(low)) * i) / count));
  return { edges, of: (x) => Math.max(0, Math.min(count - 1, Math.floor((count * (at(x) - at(low))) / (at(high) - at(low))))) };
}

// Mean, its standard error and the number of cases, cell by cell.
function cellMeans(model, a, b, response) {
  const rows = keptRows(model).filter((row) => [a, b, response].every((one) => Number.isFinite(one.values[row])));
  const across = cellsOf(a, rows), up = cellsOf(b, rows), cells = new Map();
  for (const row of rows) {
    const i = across.of(a.values[row]), j = up.of(b.values[row]), key = `${i} ${j}`, y = response.values[row];
    if (!cells.has(key)) cells.set(key, { i, j, count: 0, mean: 0, squares: 0 });
    const cell = cells.get(key), before = y - cell.mean;
    cell.count += 1;
    cell.mean += before / cell.count;
    cell.squares += before * (y - cell.mean);
  }
  for (const cell of cells.values()) {
    cell.error = cell.count > 1 ? Math.sqrt(cell.squares / (cell.count - 1) / cell.count) : null;
    cell.pure = response.pure === null ? null : Math.sqrt(response.pure / cell.count);
  }
  return { across: across.edges, up: up.edges, cells: [...cells.values()] };
}

const mapFigures = [["mean", "mean"], ["error", "standard error of the mean"], ["pure", "standard error by the pure error"], ["count", "number of cases"]];

function factorMap(model, observable) {
  const view = chosen.map, response = Object.assign(Object.create(named(model, observable.name)), { pure: observable.pure_error });
  const offered = mapFigures.filter(([key]) => key !== "pure" || observable.pure_error !== null);
  if (!offered.some(([key]) => key === view.shows)) view.shows = "mean";
  const build = () => {
    const a = named(model, view.a), b = named(model, view.b), map = cellMeans(model, a, b, response);
    const [across, up, value] = [quantity(a), quantity(b), quantity(response)];
    const cells = map.cells.map((cell) => ({ x0: across.of(map.across[cell.i]), x1: across.of(map.across[cell.i + 1]),
      y0: up.of(map.up[cell.j]), y1: up.of(map.up[cell.j + 1]), value: cell[view.shows], ...cell }));
    const title = view.shows === "count" ? { name: "cases", unit: "", levels: [] } : { name: view.shows === "mean" ? response.name : "standard error", unit: response.unit, levels: [] };
    const over = (ctx, boxes) => {
      ctx.textAlign = "center";
      for (const { cell, left, right, top, bottom } of boxes) {
        if (cell.value === null || bottom - top < 34) continue;
        const error = cell.pure === null ? cell.error : cell.pure, x = (left + right) / 2, y = (top + bottom) / 2;
        ctx.fillStyle = inkOn(tones.of(cell.value));
        // The longest text that fits.
        const write = (size, at, ...texts) => {
          ctx.font = `${size}px system-ui, sans-serif`;
          const text = texts.find((one) => ctx.measureText(one).width < right - left - 8);
          if (text) ctx.fillText(text, x, at);
        };
        const short = show(value.of(cell.mean), 3);
        write(12, y - 1, error === null ? short : withError(value.of(cell.mean), value.of(error)), short);
        write(10.5, y + 13, plural(cell.count, "case"), String(cell.count));
      }
    };
    const side = (factor, shown, edges, k) => `${factor.name}: ${factor.levels.length > 0 ? shown.says(k) : `${shown.says(edges[k])} to ${shown.says(edges[k + 1])}`}`;
    const label = (cell) => [side(a, across, map.across, cell.i), side(b, up, map.up, cell.j), `mean ${value.says(cell.mean)}, ${plural(cell.count, "case")}`]
      .concat(cell.error === null ? [] : [`standard error ${value.says(cell.error)}`], cell.pure === null ? [] : [`by the pure error ${value.says(cell.pure)}`]);
    const ends = (factor, shown, edges) => (factor.levels.length > 0 ? {} : { min: shown.of(edges[0]), max: shown.of(edges[edges.length - 1]) });
    const tones = colouring(title, cells.map((cell) => cell.value).filter((x) => x !== null));
    const chart = cellChart({ x: Object.assign(variableAxis(a), ends(a, across, map.across)), y: Object.assign(variableAxis(b), ends(b, up, map.up)), cells, tones, gap: 1, over, label });
    chart.plugins.push(crossesAt(failedRows(model).map((row) => ({ x: across.of(a.values[row]), y: up.of(b.values[row]) }))));
    return chart;
  };
  const change = (key) => (value) => { view[key] = value; self.redraw(); };
  const factors = model.factors.map((factor) => [factor.name, quantity(factor).title]);
  const controls = el("div", { class: "controls" }, choice("across", factors, view.a, change("a")), choice("up", factors, view.b, change("b")), choice("shown", offered, view.shows, change("shows")));
  const says = `Cells show mean ± standard error and the number of cases. The error follows from ${observable.pure_error === null ? "the values in the cell" : "the scatter of single runs (pure error)"}.` + (failedRows(model).length > 0 ? " Crosses: failed cases." : "");
  const self = figure(`Map of ${response.name}`, says, build, { height: 420, controls });
  return self;
}
