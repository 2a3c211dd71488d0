// One response: distribution, convergence of its moments, main effects and sensitivity. The same response of another
// campaign is drawn over it.
const statistics = [
  ["mean", "mean"], ["sd", "standard deviation (divisor N)"], ["skewness", "skewness (Pearson, 3 (mean − median)/sd)"],
  ["g1", "moment skewness g1"], ["kurtosis", "kurtosis (3 for a normal distribution)"]];

function histogram(response, other) {
  const parts = [response, other].filter(Boolean).map((one) => {
    const { low, high, counts } = one.histogram;
    return { low, high, counts, width: (high - low) / Math.max(1, counts.length), total: counts.reduce((a, b) => a + b, 0) };
  });
  const [own, second] = parts, shown = quantity(Object.assign({ levels: [] }, response, { low: undefined, high: undefined }), [own.low, own.high]);
  const says = `${plural(own.total, "value")}` + (response.history.zero_share > 0 ? `, ${Number((100 * response.history.zero_share).toPrecision(2))} % zero` : "");
  return figure("Distribution", says, () => {
    const height = (part, n) => (second ? n / part.total : n);
    const centres = own.counts.map((_, i) => shown.of(own.low + (i + 0.5) * own.width));
    const edge = (x) => ({ x: shown.of(x), y: 0 });
    const steps = second ? [edge(second.low), ...second.counts.flatMap((n, i) => [0, 1].map((side) => ({ x: shown.of(second.low + (i + side) * second.width), y: height(second, n) * (own.width / second.width || 1) }))), edge(second.high)] : [];
    const low = Math.min(...parts.map((p) => p.low)), high = Math.max(...parts.map((p) => p.high));
    return {
      type: "bar",
      // Bars stand on a numeric axis, so that its ticks are round numbers.
      data: { labels: centres, datasets: [{ data: own.counts.map((n, i) => ({ x: centres[i], y: height(own, n) })), backgroundColor: colour("one"), barPercentage: 1, categoryPercentage: 0.94, grouped: true }]
        .concat(second ? [{ type: "line", data: steps, borderColor: colour("two"), borderWidth: 2, pointRadius: 0, pointHitRadius: 0 }] : []) },
      options: {
        scales: { x: axis(shown.title, high > low ? { type: "linear", min: shown.of(low), max: shown.of(high), offset: false } : Object.assign({ type: "linear", offset: false }, aroundOne([low], shown.of))),
          y: axis(second ? "share of the cases" : "cases", { beginAtZero: true }) },
        plugins: { tooltip: { filter: (item) => item.datasetIndex === 0, callbacks: {
          title: (items) => (items.length > 0 ? `${shown.says(own.low + items[0].dataIndex * own.width)} to ${shown.says(own.low + (items[0].dataIndex + 1) * own.width)}` : ""),
          label: (item) => plural(own.counts[item.dataIndex], "case") } } },
      },
    };
  }, { tall: true }).node;
}

// How a statistic of a response is shown: mean and standard deviation in its unit, the others are numbers.
function statisticOf(response, name) {
  const { factor, unit } = ["mean", "sd"].includes(name) ? quantityOf(response) : { factor: 1, unit: "" };
  return { factor, unit, says: (text) => scaledText(text, factor) + (unit ? ` ${unit}` : "") };
}

function moment(campaign, response, other, [name, title]) {
  const { history } = response, shown = statisticOf(response, name);
  return figure(title, shown.says(history.statistics[name].text), () => {
    const line = (of, tone) => {
      const [values, errors] = ["values", "errors"].map((key) => of.statistics[name][key].map((x) => (x === null ? null : x * shown.factor))), { points } = of;
      const at = (offset) => points.map((x, i) => ({ x, y: values[i] === null || errors[i] === null ? null : values[i] + offset * errors[i] }));
      const edge = { borderWidth: 0, pointRadius: 0, pointHitRadius: 0, backgroundColor: withAlpha(colour(tone), 0.17), spanGaps: false };
      return [{ data: points.map((x, i) => ({ x, y: values[i] })), errorsOf: errors, borderColor: colour(tone), backgroundColor: colour(tone), borderWidth: 2, pointRadius: points.length > 40 ? 0 : 2.5, pointHitRadius: 8 },
        Object.assign({ data: at(1), fill: "+1" }, edge), Object.assign({ data: at(-1) }, edge)];
    };
    const datasets = line(history, "one").concat(other ? line(other, "two") : []);
    return {
      type: "line",
      data: { datasets },
      options: {
        scales: { x: axis("design points", { type: "linear", min: 0 }), y: axis(shown.unit, aroundOne(datasets.flatMap(({ data }) => data.map(({ y }) => y)), (y) => y)) },
        plugins: {
          marker: { at: campaign.stopped_at !== null ? campaign.stopped_at : history.converged_at, label: campaign.stopped_at !== null ? "stopped" : "converged" },
          tooltip: { filter: (item) => item.datasetIndex % 3 === 0, callbacks: {
            title: (items) => (items.length > 0 ? plural(items[0].parsed.x, "point") : ""),
            label: (item) => withError(item.parsed.y, item.dataset.errorsOf[item.dataIndex]) + (shown.unit ? ` ${shown.unit}` : "") } },
        },
      },
    };
  }).node;
}

function effectRange(effects) {
  const ends = effects.flat().flatMap(([, mean, error]) => (mean === null ? [] : [mean - (error || 0), mean + (error || 0)]));
  if (ends.length === 0) return {};
  const [low, high] = rangeOf(ends), room = 0.05 * (high - low || Math.abs(high) || 1);
  return { low: low - room, high: high + room };
}

// The other campaign's bins, where it varied the same factor; levels by their words.
function effectOf(other, factor) {
  if (!other) return null;
  const j = other.model.factors.findIndex((one) => one.name === factor.name && (one.levels.length > 0) === (factor.levels.length > 0));
  if (j < 0) return null;
  const bins = other.response.effects[j];
  if (factor.levels.length === 0) return bins;
  return bins.map(([x, ...rest]) => [factor.levels.indexOf(other.model.factors[j].levels[x]), ...rest]).filter(([x]) => x >= 0);
}

function effect(factor, bins, response, range, others) {
  const across = quantity(factor), up = quantity(Object.assign({ levels: [] }, response, { low: undefined, high: undefined }), [range.low, range.high]);
  return figure(factor.name, factor.meaning, () => {
    const line = (of, tone) => ({ bins: of, data: of.map(([x, y]) => ({ x: across.of(x), y: y === null ? null : up.of(y) })), errors: of.map((bin) => (bin[2] === null ? null : up.of(bin[2]))), errorColour: colour(tone === "one" ? "quiet" : tone),
      borderColor: colour(tone), backgroundColor: colour(tone), borderWidth: 2, pointRadius: 3, pointHitRadius: 8, clip: 6, showLine: factor.levels.length === 0 });
    return {
      type: "line",
      data: { datasets: [line(bins, "one")].concat(others ? [line(others, "two")] : []) },
      options: { scales: { x: variableAxis(factor), y: axis(up.title, { min: up.of(range.low), max: up.of(range.high) }) },
        plugins: { tooltip: { callbacks: {
          title: (items) => { const x = items[0].dataset.bins[items[0].dataIndex][0]; return `${factor.name} ${across.says(x)}`; },
          label: (item) => {
            const [, mean, error, count, pure] = item.dataset.bins[item.dataIndex];
            return [(error === null ? show(up.of(mean)) : withError(up.of(mean), up.of(error))) + (up.unit ? ` ${up.unit}` : "") + `, ${plural(count, "case")}`].concat(
              pure === null ? [] : [`pure error: ± ${up.says(pure)}`]);
          } } } } },
    };
  }).node;
}

// How indices are shown: shares as they are, effects in the unit of the response.
function influenceOf(response) { return response.influence.shares ? { factor: 1, unit: "" } : quantityOf(response); }

function influenceFigure(response) {
  const { influence } = response, { by, shares, shows } = influence, two = shows.length > 1, shown = influenceOf(response);
  const scaled = (x) => (typeof x === "number" ? x * shown.factor : x);
  const factors = influence.factors.map((f) => Object.fromEntries(Object.entries(f).map(([key, x]) => [key, scaled(x)]))).sort((a, b) => (b[by] || 0) - (a[by] || 0));
  if (factors.every((f) => typeof f[by] !== "number")) return null;
  const most = shares ? 1 : Math.max(...factors.map((f) => (f[by] || 0) + (f[by + "_error"] || 0)));
  return figure(shares ? "Share of the variance" : "Elementary effects", "", () => {
    const bar = (label, field, tone) => ({ label, data: factors.map((f) => (f[field] === undefined ? null : f[field])), errors: factors.map((f) => f[field + "_error"]),
      errorColour: colour("ink"), backgroundColor: colour(tone), maxBarThickness: 22 });
    const sets = shows.map((one, k) => bar(one.label, one.key, ["one", "two"][k]));
    return {
      type: "bar",
      data: { labels: factors.map((f) => f.name), datasets: sets },
      options: { indexAxis: "y",
        scales: { x: axis(shares ? "index" : `effect${shown.unit ? ` (${shown.unit})` : ""}`, { beginAtZero: true, suggestedMax: most }), y: { ticks: { color: colour("ink") }, grid: { display: false } } },
        plugins: { legend: { display: two, labels: { color: colour("ink") } }, tooltip: { callbacks: {
          label: (item) => `${item.dataset.label}: ${show(item.raw)}` + (item.dataset.errors[item.dataIndex] ? ` ± ${show(item.dataset.errors[item.dataIndex])}` : "") } } } },
    };
  }, { height: 70 + factors.length * (two ? 54 : 34) }).node;
}

// Parts of the variance, as one bar.
function varianceBar(variance) {
  const parts = [["main effects", variance.main_effects, "one"], ["interactions", variance.interactions, "two"],
    ["scatter of single runs", variance.scatter, "four"]].filter(([, share]) => share !== null);
  if (parts.length === 1 && variance.unexplained !== null) parts.push(["unexplained", variance.unexplained, "four"]);
  if (parts.length < 2) return null;
  const percent = (share) => `${(100 * Math.max(0, share)).toFixed(share < 0.1 ? 1 : 0)} %`;
  return el("div", { class: "shares" },
    el("div", { class: "stack", role: "img", "aria-label": parts.map(([name, share]) => `${name} ${percent(share)}`).join(", ") },
      parts.map(([, share, tone]) => el("span", { style: `flex-grow: ${Math.max(0, share)}; background: var(--${tone})` }))),
    el("div", { class: "keys" }, parts.map(([name, share, tone]) => el("span", {}, el("i", { style: `background: var(--${tone})` }), `${name} ${percent(share)}`))));
}
