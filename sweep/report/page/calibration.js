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

function calibrationSection(campaign) {
  const { calibration } = campaign;
  if (!calibration) return null;
  const caption = (panel) => { const [a, b] = panel.split(","); return [b ? `${b} against ${a}` : a || calibration.factors[0].name, ""]; };
  return section("calibration", "Calibration", capital(calibration.says) + ".",
    calibration.notes.length === 0 ? null : el("div", { class: "verdict no" }, calibration.notes.map((note) => el("p", {}, note))),
    el("div", { class: "grid wide" }, calibration.posterior ? cardOf("Posterior", posteriorTable(calibration)) : null,
      calibration.levels.rows.length > 0 ? cardOf("Levels", calibration.levels) : null,
      cardOf("Targets", targetsTable(calibration)), cardOf("Waves", calibration.waves)),
    el("div", { class: "grid" }, paintedCards(campaign, "", "posterior", caption)));
}
