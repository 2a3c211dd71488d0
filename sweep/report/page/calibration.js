// The result of a calibration: its waves, its targets, and the posterior over each pair of factors.
function cardOf(title, { columns, rows }) {
  return el("div", { class: "card" }, el("h3", {}, title),
    table(columns.map((name, j) => [name, rows.length > 0 && typeof rows[0][j] === "number" ? "number" : ""]), rows));
}

// Rows with a unit, in the prefix that suits them; `numbers(row)`: what the prefix follows.
function inSuitedUnits({ columns, rows }, numbers, scaled) {
  const unit = columns.indexOf("unit");
  return { columns, rows: rows.map((row) => {
    const shown = scaleFor(row[unit], numbers(row));
    return row.map((cell, j) => (j === unit ? shown.unit : scaled.includes(columns[j]) ? scaledText(cell, shown.factor) : cell));
  }) };
}
function posteriorTable({ factors, posterior }) {
  const range = (row) => { const one = factors.find((f) => f.name === row[0]); return one ? [one.low, one.high] : [Number(row[2])]; };
  return inSuitedUnits(posterior, range, ["mean", "sd", "5 %", "95 %"]);
}
function targetsTable({ targets }) {
  const measured = targets.columns.indexOf("measured");
  return inSuitedUnits(targets, (row) => [parseFloat(row[measured])], ["measured", "discrepancy", "model", "fresh runs"]);
}

// Settings that were run, and draws of the posterior.
function posteriorFigure(calibration, i, j) {
  const [a, b] = [calibration.factors[i], calibration.factors[j]];
  const across = quantity(a), up = quantity(b);
  const dots = (rows) => rows.map((row) => ({ x: across.of(row[i]), y: up.of(row[j]) }));
  return figure(`${b.name} against ${a.name}`, "", () => ({
    type: "scatter",
    data: { datasets: [
      { label: "posterior", data: dots(calibration.draws), backgroundColor: colour("two"), borderWidth: 0, pointRadius: 2, clip: 6 },
      { label: "settings run", data: dots(calibration.settings), backgroundColor: colour("dot"), borderWidth: 0, pointRadius: 3, clip: 6 }] },
    options: { scales: { x: variableAxis(a), y: variableAxis(b) },
      plugins: { legend: { display: true, position: "bottom", labels: { color: colour("ink"), usePointStyle: true, boxWidth: 6, boxHeight: 6 } },
        tooltip: { callbacks: { label: (item) => `${item.dataset.label}: ${show(item.raw.x)}, ${show(item.raw.y)}` } } } },
  })).node;
}

// The posterior of a factor beside its prior.
function marginalFigure(calibration, j) {
  const factor = calibration.factors[j], shown = quantity(factor), { from, to, prior, posterior } = calibration.marginals[j];
  const middle = (k) => shown.of(factor.log ? Math.sqrt(from[k] * to[k]) : (from[k] + to[k]) / 2);
  const line = prior.flatMap((share, k) => [{ x: shown.of(from[k]), y: share }, { x: shown.of(to[k]), y: share }]);
  return figure(factor.name, "", () => ({
    data: { datasets: [
      { type: "line", label: "prior", data: line, borderColor: colour("dot"), borderWidth: 1.5, pointRadius: 0 },
      { type: "bar", label: "posterior", data: posterior.map((share, k) => ({ x: middle(k), y: share })), backgroundColor: colour("two"), barPercentage: 1, categoryPercentage: 1 }] },
    options: { scales: { x: variableAxis(factor), y: axis("probability") },
      plugins: { legend: { display: true, position: "bottom", labels: { color: colour("ink"), usePointStyle: true, boxWidth: 6, boxHeight: 6 } } } },
  })).node;
}

function calibrationSection(campaign) {
  const { calibration } = campaign;
  if (!calibration) return null;
  const pairs = [];
  for (let j = 1; j < calibration.factors.length; ++j) for (let i = 0; i < j; ++i) pairs.push([i, j]);
  const figures = calibration.draws.length === 0 ? []
    : [...calibration.factors.map((factor, j) => marginalFigure(calibration, j)), ...pairs.map(([i, j]) => posteriorFigure(calibration, i, j))];
  return section("calibration", "Calibration", capital(calibration.says) + ".",
    calibration.notes.length === 0 ? null : el("div", { class: "verdict no" }, calibration.notes.map((note) => el("p", {}, note))),
    el("div", { class: "grid wide" }, calibration.posterior ? cardOf("Posterior", posteriorTable(calibration)) : null,
      calibration.levels.rows.length > 0 ? cardOf("Levels", calibration.levels) : null,
      cardOf("Targets", targetsTable(calibration)), cardOf("Waves", calibration.waves)),
    el("div", { class: "grid" }, figures));
}
