// Figures of response models: a map of cells over two factors, a curve with its bands against one.

// Where a setting stands on the axis of a factor: a level by its place among them.
function placeOf(factor, x) { return factor.numbers.length > 0 ? factor.numbers.indexOf(x) : x; }
function shownOf(factor) { return factor.levels.length > 0 ? { of: (x) => placeOf(factor, x), says: (x) => factor.levels[placeOf(factor, x)] } : quantity(factor); }

// Crosses at places of a canvas, white below black: seen on every colour.
function drawCrosses(ctx, places) {
  for (const [width, tone] of [[4, "#ffffff"], [1.8, "#000000"]]) {
    ctx.lineWidth = width;
    ctx.strokeStyle = tone;
    ctx.beginPath();
    for (const [x, y] of places) for (const up of [-1, 1]) { ctx.moveTo(x - 4, y - 4 * up); ctx.lineTo(x + 4, y + 4 * up); }
    ctx.stroke();
  }
}

function failedSays(failed) { return failed.length > 0 ? " Crosses: failed cases; no response is drawn where the nearest cases failed." : ""; }

// Cells of a map { across, up, across_edges, up_edges, columns, rows } coloured by `values`; a line surrounds the cells
// that are `inside`, a ring marks the `setting`, a cross each of the `failed` cases.
function cellMap(map, factors, values, { title, says, variable, tones, inside, setting, failed, more }) {
  const a = factors[map.across], b = factors[map.up], across = shownOf(a), up = shownOf(b);
  const edge = (factor, shown, edges, k) => (factor.levels.length > 0 ? k - 0.5 : shown.of(edges[k]));
  const at = (i, j) => j * map.columns + i, value = quantity(variable, values.filter((x) => x !== null));
  const within = (i, j) => Boolean(inside) && i >= 0 && j >= 0 && i < map.columns && j < map.rows && inside(at(i, j));
  const cells = [];
  for (let j = 0; j < map.rows; ++j) for (let i = 0; i < map.columns; ++i) cells.push({ i, j, value: values[at(i, j)] });
  const build = () => {
    const colours = tones();
    const box = (scales, { i, j }) => [edge(a, across, map.across_edges, i), edge(a, across, map.across_edges, i + 1)].map((x) => scales.x.getPixelForValue(x))
      .concat([edge(b, up, map.up_edges, j), edge(b, up, map.up_edges, j + 1)].map((y) => scales.y.getPixelForValue(y)));
    const ring = (ctx, x, y, width, tone) => {
      ctx.lineWidth = width;
      ctx.strokeStyle = tone;
      ctx.beginPath();
      ctx.arc(x, y, 8, 0, 2 * Math.PI);
      ctx.stroke();
    };
    const squares = { id: "squares", beforeDatasetsDraw(chart) {
      const { ctx, scales } = chart;
      ctx.save();
      for (const cell of cells) {
        if (cell.value === null) continue;
        const [x0, x1, y0, y1] = box(scales, cell);
        ctx.fillStyle = colours.of(cell.value);
        ctx.fillRect(x0, y1, x1 - x0 + 0.5, y0 - y1 + 0.5);
      }
      ctx.strokeStyle = colour("ink");
      ctx.lineWidth = 2.5;
      ctx.beginPath();
      for (const cell of cells) {
        const [x0, x1, y0, y1] = box(scales, cell), here = within(cell.i, cell.j);
        if (cell.i + 1 < map.columns && within(cell.i + 1, cell.j) !== here) { ctx.moveTo(x1, y0); ctx.lineTo(x1, y1); }
        if (cell.j + 1 < map.rows && within(cell.i, cell.j + 1) !== here) { ctx.moveTo(x0, y1); ctx.lineTo(x1, y1); }
      }
      ctx.stroke();
      drawCrosses(ctx, failed.map((one) => [scales.x.getPixelForValue(across.of(one.setting[map.across])), scales.y.getPixelForValue(up.of(one.setting[map.up]))]));
      if (setting) {
        const x = scales.x.getPixelForValue(across.of(setting[map.across])), y = scales.y.getPixelForValue(up.of(setting[map.up]));
        ring(ctx, x, y, 5, "#ffffff");
        ring(ctx, x, y, 2.5, "#000000");
      }
      ctx.restore();
    } };
    const centre = (factor, shown, edges, k) => (factor.levels.length > 0 ? k : shown.of((edges[k] + edges[k + 1]) / 2));
    const points = cells.map((cell) => ({ x: centre(a, across, map.across_edges, cell.i), y: centre(b, up, map.up_edges, cell.j), cell }));
    return { type: "scatter", data: { datasets: [{ data: points, pointRadius: 0, pointHoverRadius: 0, pointHitRadius: 20 }] },
      options: { layout: { padding: { right: 74, top: 20 } }, interaction: { mode: "nearest", intersect: false }, scales: { x: variableAxis(a), y: variableAxis(b) },
        plugins: { colourBar: { tones: colours }, tooltip: { callbacks: { label: (item) => {
          const { cell } = item.raw;
          return [`${a.name} ${a.levels.length > 0 ? a.levels[cell.i] : show(item.raw.x)}, ${b.name} ${b.levels.length > 0 ? b.levels[cell.j] : show(item.raw.y)}`,
            `${variable.name} ${cell.value === null ? "–" : value.says(cell.value)}`].concat(more ? more(at(cell.i, cell.j)) : []);
        } } } } }, plugins: [squares] };
  };
  return figure(title, says, build, { height: 520 }).node;
}

// A line through `lines.mean` against a factor, with the 95 % band of the mean and, dashed, the one of a single run; a
// second line through `lines.averaged`. `failed`: the factor's values in failed cases, crosses at the lower edge.
function bandCurve(factor, ats, lines, { title, value, limits, marker, failed }) {
  const shown = shownOf(factor), xs = ats.map((x) => shown.of(x));
  const of = (pick) => xs.map((x, i) => ({ x, y: pick(i) }));
  const build = () => {
    const tone = colour("one"), edge = { borderWidth: 0, pointRadius: 0, pointHitRadius: 0, backgroundColor: withAlpha(tone, 0.17) };
    const dashed = { borderColor: tone, borderWidth: 1, borderDash: [4, 4], pointRadius: 0, pointHitRadius: 0 };
    const line = (numbers, name, borderColor) => ({ label: name, data: of((i) => (numbers[i] === null ? null : value.of(numbers[i]))), borderColor, backgroundColor: borderColor, borderWidth: 2,
      pointRadius: factor.levels.length > 0 ? 3 : 0, pointHitRadius: 8 });
    const about = (sign, width) => of((i) => (lines.mean[i] === null ? null : value.of(lines.mean[i] + sign * lines[width][i])));
    const sets = [line(lines.mean, "slice", tone)];
    for (const [width, style] of [["mean_half_width", edge], ["run_half_width", dashed]])
      if (lines[width]) sets.push(Object.assign({ data: about(1, width) }, width === "mean_half_width" ? { fill: "+1" } : {}, style), Object.assign({ data: about(-1, width) }, style));
    if (lines.averaged) sets.push(line(lines.averaged, "averaged", colour("two")));
    const crosses = { id: "crosses", afterDatasetsDraw({ ctx, scales, chartArea }) {
      ctx.save();
      drawCrosses(ctx, failed.map((x) => [scales.x.getPixelForValue(shown.of(x)), chartArea.bottom]));
      ctx.restore();
    } };
    return { type: "line", data: { datasets: sets }, plugins: [crosses], options: { scales: { x: variableAxis(factor), y: axis(value.title, limits || {}) },
      plugins: Object.assign(marker ? { marker: { at: shown.of(marker.at), label: marker.label } } : {}, { tooltip: { filter: (item) => Boolean(item.dataset.label),
        callbacks: lines.averaged ? { label: (item) => `${item.dataset.label}: ${show(item.parsed.y)}` } : {} } }) } };
  };
  return figure(title, null, build).node;
}
