// Draws the report from the figures in the page. Texts of the database reach the page as text nodes only, never as
// markup.
(function () {
  "use strict";
  const data = JSON.parse(document.getElementById("data").textContent);
  const page = document.getElementById("page");
  const chosen = { campaign: 0, observable: 0 };
  const statistics = [
    ["mean", "mean"], ["sd", "standard deviation (divides by N)"], ["skewness", "skewness (Pearson, 3 (mean − median)/sd)"],
    ["g1", "moment skewness g1"], ["kurtosis", "kurtosis (3 for a normal distribution)"]];
  let charts = [];
  let undrawn = [];  // a chart needs its canvas to stand in the page

  // ---- building blocks

  function el(tag, attributes, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
    for (const child of children.flat()) {
      if (child === null || child === undefined) continue;
      node.append(child instanceof Node ? child : document.createTextNode(String(child)));
    }
    return node;
  }

  function show(x) {
    if (x === null || x === undefined) return "–";
    if (typeof x !== "number") return String(x);
    if (Number.isInteger(x) && Math.abs(x) < 1e9) return String(x);
    const size = Math.abs(x);
    return size !== 0 && (size >= 1e5 || size < 1e-3) ? x.toExponential(2) : String(Number(x.toPrecision(4)));
  }

  function unitOf(thing) { return thing.unit && thing.unit !== "1" ? ` (${thing.unit})` : ""; }
  function titled(thing) { return thing.name + unitOf(thing); }
  function plural(n, word) { return `${n} ${word}${n === 1 ? "" : "s"}`; }

  function table(columns, rows) {
    const cell = (tag, value, kind) => el(tag, kind ? { class: kind } : {}, tag === "td" ? show(value) : value);
    const head = el("tr", {}, columns.map(([title, kind]) => cell("th", title, kind)));
    const body = rows.map((row) => el("tr", {}, row.map((value, i) => cell("td", value, columns[i][1]))));
    return el("div", { class: "scroll" }, el("table", {}, el("thead", {}, head), el("tbody", {}, body)));
  }

  function colour(name) { return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim(); }

  function card(title, subtitle, tall) {
    const canvas = el("canvas", { role: "img", "aria-label": title });
    const node = el("div", { class: "card" }, el("h3", {}, title), subtitle ? el("p", { class: "says" }, subtitle) : null,
      el("div", { class: tall ? "figure tall" : "figure" }, canvas));
    return { node, canvas };
  }

  // ---- what Chart.js has not: whiskers and a marked abscissa

  const whiskers = {
    id: "whiskers",
    afterDatasetsDraw(chart) {
      const { ctx } = chart;
      chart.data.datasets.forEach((set, index) => {
        if (!set.errors || !chart.isDatasetVisible(index)) return;
        const across = chart.options.indexAxis === "y";
        const scale = across ? chart.scales.x : chart.scales.y;
        ctx.save();
        ctx.strokeStyle = set.errorColour || colour("ink");
        ctx.lineWidth = 1.2;
        chart.getDatasetMeta(index).data.forEach((element, i) => {
          const value = typeof set.data[i] === "object" && set.data[i] !== null ? set.data[i].y : set.data[i];
          const error = set.errors[i];
          if (value === null || error === null || error === undefined) return;
          const low = scale.getPixelForValue(value - error), high = scale.getPixelForValue(value + error);
          ctx.beginPath();
          if (across) {
            ctx.moveTo(low, element.y); ctx.lineTo(high, element.y);
            ctx.moveTo(low, element.y - 4); ctx.lineTo(low, element.y + 4);
            ctx.moveTo(high, element.y - 4); ctx.lineTo(high, element.y + 4);
          } else {
            ctx.moveTo(element.x, low); ctx.lineTo(element.x, high);
            ctx.moveTo(element.x - 3, low); ctx.lineTo(element.x + 3, low);
            ctx.moveTo(element.x - 3, high); ctx.lineTo(element.x + 3, high);
          }
          ctx.stroke();
        });
        ctx.restore();
      });
    },
  };

  const marker = {
    id: "marker",
    afterDatasetsDraw(chart, _, options) {
      if (options.at === null || options.at === undefined) return;
      const x = chart.scales.x.getPixelForValue(options.at);
      const { ctx, chartArea } = chart;
      ctx.save();
      ctx.strokeStyle = colour("three");
      ctx.fillStyle = colour("three");
      ctx.setLineDash([5, 4]);
      ctx.beginPath();
      ctx.moveTo(x, chartArea.top);
      ctx.lineTo(x, chartArea.bottom);
      ctx.stroke();
      ctx.font = "11px system-ui, sans-serif";
      const right = x > (chartArea.left + chartArea.right) / 2;
      ctx.textAlign = right ? "right" : "left";
      ctx.fillText(options.label, x + (right ? -5 : 5), chartArea.top + 11);
      ctx.restore();
    },
  };

  function axis(title, more) {
    return Object.assign({
      title: { display: Boolean(title), text: title, color: colour("quiet") },
      ticks: { color: colour("quiet"), maxTicksLimit: 7, maxRotation: 0, includeBounds: false, callback(value) { return show(value); } },
      grid: { color: colour("grid"), borderColor: colour("line") },
    }, more || {});
  }

  function draw(canvas, config) {
    config.options = Object.assign({ responsive: true, maintainAspectRatio: false, animation: false }, config.options);
    config.options.plugins = Object.assign({ legend: { display: false } }, config.options.plugins);
    config.plugins = [whiskers, marker];
    undrawn.push(() => charts.push(new Chart(canvas, config)));
  }

  function levelAxis(factor) {
    return axis(factor.name, {
      type: "linear", min: -0.5, max: factor.levels.length - 0.5,
      ticks: { color: colour("quiet"), stepSize: 1, autoSkip: true, maxRotation: 40,
        callback(value) { return Number.isInteger(value) ? factor.levels[value] : null; } },
      afterBuildTicks(scale) { scale.ticks = factor.levels.map((_, value) => ({ value })); },
    });
  }

  function factorAxis(factor) {
    if (factor.levels.length > 0) return levelAxis(factor);
    const range = factor.high > factor.low ? { min: factor.low, max: factor.high } : {};
    return axis(titled(factor), Object.assign({ type: factor.log ? "logarithmic" : "linear" }, range));
  }

  // ---- figures

  function histogram(response) {
    const { low, high, counts } = response.histogram;
    const width = (high - low) / Math.max(1, counts.length);
    const total = counts.reduce((a, b) => a + b, 0);
    const c = card("Distribution", `${plural(total, "value")}` +
      (response.history.zero_share > 0 ? `, ${Number((100 * response.history.zero_share).toPrecision(2))} % of them zero` : ""), true);
    // Bars stand on a numeric axis, so that its ticks are round numbers.
    const centres = counts.map((_, i) => low + (i + 0.5) * width);
    draw(c.canvas, {
      type: "bar",
      data: { labels: centres, datasets: [{ data: counts.map((n, i) => ({ x: centres[i], y: n })), backgroundColor: colour("one"),
        barPercentage: 1, categoryPercentage: 0.94, grouped: true }] },
      options: {
        scales: {
          x: axis(titled(response), width > 0 ? { type: "linear", min: low, max: high, offset: false } : { type: "linear", offset: true }),
          y: axis("cases", { beginAtZero: true }) },
        plugins: { tooltip: { callbacks: {
          title: (items) => `${show(centres[items[0].dataIndex] - width / 2)} to ${show(centres[items[0].dataIndex] + width / 2)}`,
          label: (item) => plural(counts[item.dataIndex], "case") } } },
      },
    });
    return c.node;
  }

  function moment(campaign, history, [name, title]) {
    const { values, errors } = history.statistics[name];
    const c = card(title, history.statistics[name].text);
    const at = (offset) => history.points.map((x, i) => ({ x, y: values[i] === null || errors[i] === null ? null : values[i] + offset * errors[i] }));
    const edge = { borderWidth: 0, pointRadius: 0, pointHitRadius: 0, backgroundColor: colour("band"), spanGaps: false };
    draw(c.canvas, {
      type: "line",
      data: { datasets: [
        { data: history.points.map((x, i) => ({ x, y: values[i] })), borderColor: colour("one"), backgroundColor: colour("one"),
          borderWidth: 2, pointRadius: history.points.length > 40 ? 0 : 2.5, pointHitRadius: 8 },
        Object.assign({ data: at(1), fill: "+1" }, edge), Object.assign({ data: at(-1) }, edge)] },
      options: {
        scales: { x: axis("design points", { type: "linear", min: 0 }), y: axis("") },
        plugins: {
          marker: { at: campaign.stopped_at !== null ? campaign.stopped_at : history.converged_at,
            label: campaign.stopped_at !== null ? "stopped" : "converged" },
          tooltip: { filter: (item) => item.datasetIndex === 0, callbacks: {
            title: (items) => plural(items[0].parsed.x, "point"),
            label: (item) => `${show(values[item.dataIndex])} ± ${show(errors[item.dataIndex])}` } },
        },
      },
    });
    return c.node;
  }

  function effectRange(effects) {
    const ends = effects.flat().flatMap(([, mean, error]) => mean === null ? [] : [mean - (error || 0), mean + (error || 0)]);
    if (ends.length === 0) return {};
    const low = Math.min(...ends), high = Math.max(...ends), room = 0.05 * (high - low || Math.abs(high) || 1);
    return { suggestedMin: low - room, suggestedMax: high + room };
  }

  function effect(factor, bins, response, range) {
    const c = card(factor.name, factor.meaning);
    const tick = axis(titled(response), range);
    draw(c.canvas, {
      type: "line",
      data: { datasets: [{ data: bins.map(([x, y]) => ({ x, y })), errors: bins.map((bin) => bin[2]), errorColour: colour("quiet"),
        borderColor: colour("one"), backgroundColor: colour("one"), borderWidth: 2, pointRadius: 3, pointHitRadius: 8, clip: 6,
        showLine: factor.levels.length === 0 }] },
      options: { scales: { x: factorAxis(factor), y: tick },
        plugins: { tooltip: { callbacks: {
          title: (items) => factor.levels.length > 0 ? factor.levels[bins[items[0].dataIndex][0]] : `${factor.name} ${show(bins[items[0].dataIndex][0])}`,
          label: (item) => `${show(bins[item.dataIndex][1])} ± ${show(bins[item.dataIndex][2])}, ${plural(bins[item.dataIndex][3], "case")}` } } } },
    });
    return c.node;
  }

  function scatter(factor, bins, response) {
    const c = card(`${response.name} against ${factor.name}`);
    const spread = factor.levels.length > 0 ? 0.5 : 0;
    const points = [];
    response.drawn.forEach((y, i) => {
      // Cases of one level are spread sideways by a fixed sequence, so that they do not hide each other.
      if (y !== null) points.push({ x: factor.drawn[i] + spread * (((i * 0.618034) % 1) - 0.5), y });
    });
    const dot = points.length > 600 ? 1.5 : points.length > 150 ? 2.2 : 3;
    draw(c.canvas, {
      type: "scatter",
      data: { datasets: [
        { data: bins.map(([x, y]) => ({ x, y })), type: "line", showLine: factor.levels.length === 0, borderColor: colour("two"),
          backgroundColor: colour("two"), borderWidth: 2, pointRadius: factor.levels.length > 0 ? 5 : 0, pointStyle: "rectRot" },
        { data: points, backgroundColor: colour("dot"), borderWidth: 0, pointRadius: dot, clip: 6 }] },
      options: { scales: { x: factorAxis(factor), y: axis(titled(response)) },
        plugins: { tooltip: { callbacks: { label: (item) => `${show(item.raw.x)}: ${show(item.raw.y)}` } } } },
    });
    return c.node;
  }

  // One line per case; cases of one label, repeats, share a colour and a line of the legend.
  function curves(family) {
    const labels = [...new Set(family.curves.map((curve) => curve.label))];
    const tone = (label) => `hsl(${(212 + 137.508 * labels.indexOf(label)) % 360}, 62%, 48%)`;
    const c = card(titled(family), family.meaning + (family.at === null ? "" : `; at time ${show(family.at)}`), true);
    const xs = family.curves.flatMap((curve) => curve.x);
    const low = Math.min(...xs), high = Math.max(...xs);
    // Bins in a geometric series belong on a logarithmic axis: their last step is as large, relatively, as their first.
    const bins = [...new Set(xs)].sort((a, b) => a - b), end = bins.length - 1;
    const log = family.over_bins && low > 0 && end > 2 && Math.abs(Math.log(bins[1] / bins[0]) / Math.log(bins[end] / bins[end - 1]) - 1) < 0.1;
    const last = (item) => labels.indexOf(item.text) >= 0 && family.curves.findIndex((curve) => curve.label === item.text) === item.datasetIndex;
    draw(c.canvas, {
      type: "line",
      data: { datasets: family.curves.map((curve) => ({ label: curve.label, data: curve.x.map((x, i) => ({ x, y: curve.y[i] })),
        borderColor: tone(curve.label), backgroundColor: tone(curve.label), borderWidth: 1.6, pointRadius: curve.x.length < 2 ? 3 : 0, pointHitRadius: 6 })) },
      options: {
        scales: { x: axis(family.over, { type: log ? "logarithmic" : "linear", min: low, max: high }), y: axis("") },
        plugins: {
          legend: { display: labels.length <= 12, position: "bottom", labels: { filter: last, boxWidth: 14, color: colour("ink") } },
          tooltip: { callbacks: { title: (items) => `${family.over}: ${show(items[0].parsed.x)}`, label: (item) => `${item.dataset.label}: ${show(item.parsed.y)}` } } },
      },
    });
    return c.node;
  }

  function influenceFigure(influence) {
    const key = influence.method === "morris" ? "mu_star" : influence.method === "saltelli" ? "total" : "first";
    const factors = [...influence.factors].sort((a, b) => (b[key] || 0) - (a[key] || 0));
    const bar = (label, field, tone) => ({ label, data: factors.map((f) => f[field] === undefined ? null : f[field]),
      errors: factors.map((f) => f[field + "_error"]), errorColour: colour("ink"), backgroundColor: colour(tone), maxBarThickness: 22 });
    const sets = influence.method === "morris" ? [bar("mu* (mean size of the elementary effects)", "mu_star", "one"), bar("sigma (their scatter: bends and interactions)", "sigma", "two")]
      : influence.method === "saltelli" ? [bar("first order", "first", "one"), bar("total, with interactions", "total", "two")]
        : [bar("first order", "first", "one")];
    const c = card(influence.method === "morris" ? "Elementary effects over the whole range" : "Share of the variance", "", true);
    c.canvas.parentNode.style.height = `${70 + factors.length * (sets.length > 1 ? 54 : 34)}px`;
    draw(c.canvas, {
      type: "bar",
      data: { labels: factors.map((f) => f.name), datasets: sets },
      options: { indexAxis: "y",
        scales: { x: axis(influence.method === "morris" ? "effect" : "index", { beginAtZero: true, suggestedMax: influence.method === "morris"
          ? Math.max(...factors.map((f) => (f.mu_star || 0) + (f.mu_star_error || 0))) : 1 }),
          y: { ticks: { color: colour("ink") }, grid: { display: false } } },
        plugins: { legend: { display: sets.length > 1, labels: { color: colour("ink") } }, tooltip: { callbacks: {
          label: (item) => `${item.dataset.label}: ${show(item.raw)}` + (item.dataset.errors[item.dataIndex] ? ` ± ${show(item.dataset.errors[item.dataIndex])}` : "") } } } },
    });
    return c.node;
  }

  // ---- sections

  function section(title, says, ...content) {
    return el("section", {}, el("h2", {}, title), says ? el("p", { class: "says" }, says) : null, content);
  }

  function heading(campaign) {
    const tile = (number, label, bad) => el("div", { class: bad ? "tile bad" : "tile" }, el("b", {}, number), el("span", {}, label));
    const good = ["completed", "skipped", "abandoned", "not yet"];
    const tiles = campaign.outcomes.filter(([, count]) => count > 0)
      .map(([outcome, count]) => tile(count, outcome === "abandoned" ? "to be continued" : outcome.replace("_", " "), !good.includes(outcome)));
    const parts = [`${campaign.scene}, revision ${campaign.revision}`,
      `${campaign.design} design` + (campaign.sequences > 1 ? ` of ${campaign.sequences} independent sequences` : ""),
      plural(campaign.factors.length, "factor"),
      campaign.replicates > 1 ? plural(campaign.replicates, "repeat") + " of each point" : null,
      campaign.where ? `where ${campaign.where}` : null].filter(Boolean);
    const ranges = campaign.factors.map((f) => [f.name, f.unit,
      f.levels.length > 0 ? f.levels.join(", ") : `${show(f.low)} to ${show(f.high)}${f.log ? ", logarithmic" : ""}`, f.meaning]);
    return [el("h1", {}, campaign.name), el("p", { class: "says" }, parts.join(" · ")),
      campaign.summary ? el("p", {}, campaign.summary) : null,
      campaign.notes ? el("p", { class: "notes" }, campaign.notes) : null,
      el("div", { class: "tiles" }, tile(campaign.rows, "cases"), tiles,
        campaign.stopped_at !== null ? tile(campaign.stopped_at, "points when it converged and stopped") : null),
      el("details", { open: "" }, el("summary", {}, "What was varied"),
        el("div", { class: "card" }, table([["factor"], ["unit"], ["values"], ["meaning", "text"]], ranges),
          campaign.fixed_text ? el("p", { class: "says" }, "Fixed: ", el("code", {}, campaign.fixed_text)) : null,
          el("p", { class: "says" }, "Design: ", el("code", {}, campaign.design_text))))];
  }

  function verdict(history) {
    const kind = history.converged_at !== null ? "verdict yes" : history.judged ? "verdict no" : "verdict";
    return el("div", { class: kind }, history.verdict, history.notes.map((note) => el("div", { class: "warning" }, note)));
  }

  function distributionSection(response, sample) {
    const rows = statistics.map(([name, title]) => [title, response.history.statistics[name].text]);
    const says = response.meaning ? `${titled(response)}: ${response.meaning}` : titled(response);
    return section("Response", says, verdict(response.history), el("div", { class: "grid wide" }, histogram(response),
      el("div", { class: "card" }, el("h3", {}, "Moments"),
        el("p", { class: "says" }, `over ${plural(response.history.count, "value")}` + (sample ? ", with 95 % errors" : "") +
          (response.history.excluded > 0 ? `; ${plural(response.history.excluded, "case")} without a value left out` : "")),
        table([["statistic"], ["value", "number"]], rows))));
  }

  function momentsSection(campaign, response) {
    if (!campaign.sample) return null;
    return section("Convergence", "Moments of the first points of the design against their number, with 95 % errors. " +
      "A verdict uses complete blocks of a gapless beginning, so it does not depend on who finished first.",
      el("div", { class: "grid" }, statistics.map((statistic) => moment(campaign, response.history, statistic))));
  }

  function effectsSection(campaign, response) {
    const range = effectRange(response.effects);
    return section("Main effects", "Mean response in 16 bins of equal count (fewer for few cases, a level is a bin), one scale for all factors. " +
      "Whiskers: 95 % as of independent points, on the large side for low-discrepancy designs.",
      el("div", { class: "grid" }, campaign.factors.map((factor, j) => effect(factor, response.effects[j], response, range))));
  }

  function influenceSection(response) {
    const influence = response.influence;
    const rows = influence.factors.map((f) => influence.method === "morris" ? [f.name, f.mu_star_text, f.sigma]
      : influence.method === "saltelli" ? [f.name, f.first_text, f.total_text] : [f.name, f.first_text]);
    const n = "number";
    const columns = influence.method === "morris" ? [["factor"], ["mu*", n], ["sigma", n]]
      : influence.method === "saltelli" ? [["factor"], ["first order", n], ["total", n]] : [["factor"], ["first order", n]];
    const says = influence.method === "morris" ? "Change of the response when a factor moves over its range."
      : "Share of the variance of the response that a factor explains alone" + (influence.method === "saltelli" ? ", and with all its interactions." : "; what is missing to 1 is interactions and scatter.");
    return section("Sensitivity", says, el("div", { class: "grid wide" }, influenceFigure(influence),
      el("div", { class: "card" }, table(columns, rows), influence.notes.map((note) => el("p", { class: "says" }, note)))));
  }

  function scatterSection(campaign, response) {
    const thinned = campaign.drawn_rows < campaign.settled
      ? `${campaign.drawn_rows} of ${campaign.settled} cases are drawn, chosen at random; the lines and all figures are of all cases.`
      : "Every case, and the binned mean.";
    return section("Cases", thinned,
      el("div", { class: "grid" }, campaign.factors.map((factor, j) => scatter(factor, response.effects[j], response))));
  }

  function curvesSection(campaign) {
    const { completed, drawn, families } = campaign.curves;
    if (families.length === 0) return null;
    const says = drawn < completed ? `${drawn} of ${completed} completed cases, chosen at random.` : "Every completed case, a line each.";
    return section("Curves", says, el("div", { class: "grid wide" }, families.map(curves)));
  }

  function extremesSection(campaign, response) {
    const n = "number";
    const columns = [["point", n]].concat(campaign.replicates > 1 ? [["repeat", n]] : [],
      campaign.factors.map((f) => [f.name, f.levels.length > 0 ? "" : n]), [[response.name, n], ["case"]]);
    const rows = (list) => list.map((one) => [one.point].concat(campaign.replicates > 1 ? [one.replicate] : [], one.factors, [one.value, one.case.slice(0, 10)]));
    const part = (title, list) => el("div", { class: "card" }, el("h3", {}, title), table(columns, rows(list)));
    return section("Extremes", "grainsweep explain and replay take the id in the last column.",
      el("div", { class: campaign.factors.length > 3 ? "grid full" : "grid wide" }, part(`Largest ${response.name}`, response.largest), part(`Smallest ${response.name}`, response.smallest)));
  }

  function failuresSection(campaign) {
    const { count, listed } = campaign.failures;
    if (count === 0) return null;
    const columns = [["point", "number"], ["outcome"], ["attempts", "number"], ["reason", "text"]]
      .concat(campaign.factors.map((f) => [f.name, f.levels.length > 0 ? "" : "number"]), [["case"]]);
    const rows = listed.map((one) => [one.point, one.outcome, one.attempts, one.reason].concat(one.factors, [one.case.slice(0, 10)]));
    const says = listed.length < count ? `The first ${listed.length} of ${count}. ` : "";
    return section("Failed cases", says + "They are left out of all statistics.", el("div", { class: "card tail" }, table(columns, rows)));
  }

  function provenanceSection(campaign) {
    const columns = [["start"], ["version"], ["commit"], ["compiler"], ["flags", "text"], ["instructions"], ["processor", "text"], ["host"], ["settled", "number"]];
    const rows = campaign.runs.map((run) => [run.start, run.version, String(run.commit).replace(/^([0-9a-f]{12})[0-9a-f]*/, "$1"), run.compiler, run.flags, run.instruction_path, run.processor, run.host, run.settled]);
    return section("Provenance", "One line per run over this database.", el("div", { class: "card" }, table(columns, rows)),
      el("details", {}, el("summary", {}, "The campaign file"), el("pre", { class: "card" }, campaign.text)));
  }

  function render() {
    charts.forEach((chart) => chart.destroy());
    charts = [];
    undrawn = [];
    const campaign = data.campaigns[chosen.campaign];
    const response = campaign.observables[chosen.observable];
    page.replaceChildren(...heading(campaign).filter(Boolean));
    const sections = response && response.history.count > 0
      ? [distributionSection(response, campaign.sample), momentsSection(campaign, response), effectsSection(campaign, response),
        influenceSection(response), scatterSection(campaign, response), extremesSection(campaign, response)]
      : [el("p", {}, campaign.curves.completed === 0 ? "No case has an answer yet."
        : `${plural(campaign.curves.completed, "case")} of ${campaign.rows} have an answer, but not all repeats of the first point: statistics are over the gapless beginning of the design.`)];
    page.append(...sections.concat([curvesSection(campaign), failuresSection(campaign), provenanceSection(campaign)]).filter(Boolean));
    undrawn.forEach((start) => start());
  }

  function fillObservables() {
    const campaign = data.campaigns[chosen.campaign];
    const select = document.getElementById("observable");
    select.replaceChildren(...campaign.observables.map((o, i) => el("option", { value: i }, titled(o))));
    chosen.observable = campaign.main;
    select.value = String(campaign.main);
  }

  document.getElementById("database").textContent = data.database;
  document.title = `${data.database} · grainsweep report`;
  const campaigns = document.getElementById("campaign");
  campaigns.replaceChildren(...data.campaigns.map((c, i) => el("option", { value: i }, c.name)));
  document.getElementById("campaign-choice").hidden = data.campaigns.length < 2;
  campaigns.addEventListener("change", () => { chosen.campaign = Number(campaigns.value); fillObservables(); render(); });
  const observables = document.getElementById("observable");
  observables.addEventListener("change", () => { chosen.observable = Number(observables.value); render(); });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", render);
  fillObservables();
  render();
})();
