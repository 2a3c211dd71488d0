// Figures of response models: cells over two factors, and a curve with its bands against one.

// The place of a setting on the axis of a factor; of a level, its index.
function placeOf(factor, x) { return factor.numbers.length > 0 ? factor.numbers.indexOf(x) : x; }
function shownOf(factor) { return factor.levels.length > 0 ? { of: (x) => placeOf(factor, x), says: (x) => quantity(factor).says(placeOf(factor, x)) } : quantity(factor); }

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

function failedSays(failed) { return failed.length > 0 ? " Crosses: failed cases. No response is drawn where a case is likelier to fail than not." : ""; }

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

// Cells of a map { across, up, across_edges, up_edges, columns, rows } coloured by `values`. A line encloses the cells
// that are `inside`, a ring marks the `setting`, a cross each of the `failed` cases.
function cellMap(map, factors, values, { title, says, variable, tones, inside, setting, failed, more }) {
  const a = factors[map.across], b = factors[map.up], across = shownOf(a), up = shownOf(b);
  const edge = (factor, shown, edges, k) => (factor.levels.length > 0 ? k - 0.5 : shown.of(edges[k]));
  const value = quantity(variable, values.filter((x) => x !== null));
  const within = (i, j) => Boolean(inside) && i < map.columns && j < map.rows && inside(j * map.columns + i);
  const cells = values.map((one, k) => {
    const i = k % map.columns, j = Math.floor(k / map.columns);
    return { k, i, j, value: one, x0: edge(a, across, map.across_edges, i), x1: edge(a, across, map.across_edges, i + 1), y0: edge(b, up, map.up_edges, j), y1: edge(b, up, map.up_edges, j + 1) };
  });
  const over = (ctx, boxes, scales) => {
    const place = (one) => [scales.x.getPixelForValue(across.of(one[map.across])), scales.y.getPixelForValue(up.of(one[map.up]))];
    ctx.strokeStyle = colour("ink");
    ctx.lineWidth = 2.5;
    ctx.beginPath();
    for (const { cell: { i, j }, left, right, bottom, top } of boxes) {
      const here = within(i, j);
      if (i + 1 < map.columns && within(i + 1, j) !== here) { ctx.moveTo(right, bottom); ctx.lineTo(right, top); }
      if (j + 1 < map.rows && within(i, j + 1) !== here) { ctx.moveTo(left, top); ctx.lineTo(right, top); }
    }
    ctx.stroke();
    drawCrosses(ctx, failed.map((one) => place(one.setting)));
    if (setting && setting[map.across] !== null && setting[map.up] !== null) for (const [width, tone] of [[5, "#ffffff"], [2.5, "#000000"]]) strokedRing(ctx, ...place(setting), width, tone);
  };
  const at = (factor, low, high, k) => `${factor.name} ${factor.levels.length > 0 ? quantity(factor).says(k) : show((low + high) / 2)}`;
  const label = (cell) => [`${at(a, cell.x0, cell.x1, cell.i)}, ${at(b, cell.y0, cell.y1, cell.j)}`,
    `${variable.name} ${cell.value === null ? "–" : value.says(cell.value)}`].concat(more ? more(cell.k) : []);
  const build = () => cellChart({ x: variableAxis(a), y: variableAxis(b), cells, tones: tones(), gap: -0.5, over, label });
  return figure(title, says, build, { height: 520 }).node;
}

// `lines.mean` against a factor with the 95 % bands of the mean (shaded) and of a single run (dashed), and
// `lines.averaged`; of levels a bar, whiskers and a diamond each. `failed`: the factor's values in failed cases, crosses at
// the lower edge.
function bandCurve(factor, ats, lines, { title, value, limits, marker, failed }) {
  const shown = shownOf(factor), xs = ats.map((x) => shown.of(x));
  const of = (pick) => xs.map((x, i) => ({ x, y: pick(i) }));
  const build = () => {
    const tone = colour("one"), edge = { borderWidth: 0, pointRadius: 0, pointHitRadius: 0, backgroundColor: withAlpha(tone, 0.17) };
    const dashed = { borderColor: tone, borderWidth: 1, borderDash: [4, 4], pointRadius: 0, pointHitRadius: 0 };
    const line = (numbers, name, borderColor) => ({ label: name, data: of((i) => (numbers[i] === null ? null : value.of(numbers[i]))), borderColor, backgroundColor: borderColor, borderWidth: 2, pointRadius: 0, pointHitRadius: 8 });
    const about = (sign, width) => of((i) => (lines.mean[i] === null ? null : value.of(lines.mean[i] + sign * lines[width][i])));
    const levels = factor.levels.length > 0, sets = [line(lines.mean, "slice", tone)];
    if (levels && !lines.mean_half_width) Object.assign(sets[0], { type: "bar", barThickness: 32, grouped: false, borderWidth: 0 });
    else if (levels) {
      Object.assign(sets[0], { showLine: false, pointStyle: "line", pointRadius: 16, errorColour: tone,
        errors: lines.run_half_width ? lines.run_half_width.map((width) => (width === null ? null : value.of(width) - value.of(0))) : undefined });
      sets.push({ type: "bar", data: about(-1, "mean_half_width").map(({ x, y }, i) => ({ x, y: y === null ? null : [y, about(1, "mean_half_width")[i].y] })),
        backgroundColor: withAlpha(tone, 0.3), barThickness: 32, grouped: false, order: 1 });
    }
    for (const [width, style] of [["mean_half_width", edge], ["run_half_width", dashed]])
      if (lines[width] && !levels) sets.push(Object.assign({ data: about(1, width) }, width === "mean_half_width" ? { fill: "+1" } : {}, style), Object.assign({ data: about(-1, width) }, style));
    if (lines.averaged) sets.push(Object.assign(line(lines.averaged, "averaged", colour("two")), levels ? { showLine: false, pointStyle: "rectRot", pointRadius: 5 } : {}));
    return { type: "line", data: { datasets: sets }, plugins: [crossesAt(failed.map((x) => ({ x: shown.of(x) })))], options: { scales: { x: variableAxis(factor), y: axis(value.title, Object.assign({ beginAtZero: false, grace: levels && !limits?.max ? "8%" : 0 }, limits)) },
      plugins: Object.assign(marker ? { marker: { at: shown.of(marker.at), label: marker.label } } : {}, { tooltip: { filter: (item) => Boolean(item.dataset.label),
        callbacks: lines.averaged ? { label: (item) => `${item.dataset.label}: ${show(item.parsed.y)}` } : {} } }) } };
  };
  return figure(title, null, build).node;
}
