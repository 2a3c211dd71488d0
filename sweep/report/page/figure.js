// Figures in which readers act, drawn by Chart.js when they come into view and saved as SVG or PNG.
// The scale of colours, at the right of the figure.
const colourBar = {
  id: "colourBar",
  afterDraw(chart, _, options) {
    const { tones } = options;
    if (!tones) return;
    const { ctx, chartArea } = chart, left = chartArea.right + 14, width = 12, height = chartArea.bottom - chartArea.top;
    const steps = tones.tones.length;
    ctx.save();
    tones.tones.forEach((tone, k) => {
      ctx.fillStyle = tone;
      ctx.fillRect(left, chartArea.bottom - ((k + 1) * height) / steps, width, height / steps + 0.5);
    });
    ctx.font = "11px system-ui, sans-serif";
    ctx.fillStyle = colour("quiet");
    ctx.textBaseline = "middle";
    const at = tones.log ? Math.log : (x) => x, low = at(tones.low), high = at(tones.high);
    const k = tones.scale(1);
    const ticks = high > low ? (tones.log ? logTicks(tones.low * k, tones.high * k) : roundTicks(tones.low * k, tones.high * k, 5)) : [tones.low * k];
    for (const tick of ticks) {
      const y = chartArea.bottom - (high > low ? ((at(tick / k) - low) / (high - low)) * height : height / 2);
      ctx.fillRect(left + width, y - 0.5, 4, 1);
      ctx.fillText(show(tick), left + width + 7, y);
    }
    ctx.textAlign = "right";
    ctx.fillText(tones.title, chart.width - 4, Math.max(7, chartArea.top - 12));
    ctx.restore();
  },
};

function strokedRing(ctx, x, y, width, tone) {
  ctx.lineWidth = width;
  ctx.strokeStyle = tone;
  ctx.beginPath();
  ctx.arc(x, y, 8, 0, 2 * Math.PI);
  ctx.stroke();
}

// A ring around the selected case.
const ring = {
  id: "ring",
  afterDatasetsDraw(chart, _, options) {
    const at = options.at && options.at();
    if (!at || !Number.isFinite(at.x) || !Number.isFinite(at.y)) return;
    const { ctx, scales } = chart;
    ctx.save();
    strokedRing(ctx, scales.x.getPixelForValue(at.x), scales.y.getPixelForValue(at.y), 2, colour("ink"));
    ctx.restore();
  },
};

function roundTicks(low, high, most) {
  const raw = (high - low) / most, size = 10 ** Math.floor(Math.log10(raw));
  const step = size * [1, 2, 5, 10].find((m) => m * size >= raw * (1 - 1e-9)), ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-9) + 1e-12 * step; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}

// Decades where there are three or more of them, else 1, 2 and 5 of each; at most nine.
function logTicks(low, high) {
  const decades = Math.log10(high / low), steps = decades >= 3 ? [1] : decades >= 0.6 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9];
  const ticks = [];
  for (let e = Math.floor(Math.log10(low) + 1e-9); e <= Math.log10(high) + 1e-9; ++e)
    for (const m of steps) {
      const x = Number((m * 10 ** e).toPrecision(12));
      if (x >= low * (1 - 1e-9) && x <= high * (1 + 1e-9)) ticks.push(x);
    }
  const every = Math.ceil(ticks.length / 9);
  return ticks.filter((_, i) => i % every === 0);
}

// With as many digits as tell it from the next one.
function tickText(x, log, ticks) {
  const exponent = Math.round(Math.log10(Math.abs(x))), step = !log && ticks.length > 1 ? Math.abs(ticks[1].value - ticks[0].value) : 0;
  if (step > 0 && Math.abs(x) > 1000 * step) return show(x, Math.min(12, 1 + Math.ceil(Math.log10(Math.abs(x) / step))));
  return log && Math.abs(exponent) >= 4 && Math.abs(Math.abs(x) / 10 ** exponent - 1) < 1e-9 ? power(exponent) : show(x);
}

function axis(title, more) {
  const log = more && more.type === "logarithmic";
  return Object.assign({
    title: { display: Boolean(title), text: title, color: colour("quiet") },
    ticks: { color: colour("quiet"), maxTicksLimit: log ? 12 : 7, maxRotation: 0, includeBounds: false, callback: (value, _, ticks) => tickText(value, log, ticks) },
    grid: { color: colour("grid"), borderColor: colour("line") },
  }, log ? { afterBuildTicks(scale) { scale.ticks = logTicks(scale.min, scale.max).map((value) => ({ value })); } } : {}, more || {});
}

// The axis of a variable; its numbers are drawn multiplied by quantity(variable).factor.
function variableAxis(variable, numbers) {
  if (variable.levels.length > 0)
    return axis(quantity(variable).title, {
      type: "linear", min: -0.5, max: variable.levels.length - 0.5, offset: false,
      ticks: { color: colour("quiet"), stepSize: 1, autoSkip: true, maxRotation: 40, callback: (value) => (Number.isInteger(value) ? shownLevels(variable).texts[value] : null) },
      afterBuildTicks(scale) { scale.ticks = variable.levels.map((_, value) => ({ value })); },
    });
  const shown = quantity(variable, numbers);
  const log = variable.log && rangeOf(numbers || variable.values)[0] > 0;
  const range = variable.high > variable.low ? { min: shown.of(variable.low), max: shown.of(variable.high) } : aroundOne(numbers || variable.values, shown.of);
  return axis(shown.title, Object.assign({ type: log ? "logarithmic" : "linear" }, range));
}

function configured(build) {
  const config = build();
  config.options = Object.assign({ responsive: true, maintainAspectRatio: false, animation: false }, config.options);
  config.options.plugins = Object.assign({ legend: { display: false } }, config.options.plugins);
  config.plugins = [colourBar, ring].concat(config.plugins || []);
  return config;
}

// Draws the figures out of view one by one while the browser is idle.
const whenIdle = window.requestIdleCallback || ((work) => setTimeout(work, 50));
let idling = false;
function drawTheRest() {
  if (idling) return;
  idling = true;
  whenIdle(() => {
    idling = false;
    const next = figures.find((one) => !one.chart);
    if (!next) return;
    next.draw();
    drawTheRest();
  });
}

const inView = new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) entry.target.figure.draw();
}, { rootMargin: "300px" });

// `build` makes the configuration of Chart.js for the present theme and data.
function figure(title, says, build, more) {
  const { tall, height, controls, below } = more || {};
  const canvas = el("canvas", { role: "img", "aria-label": title });
  const box = el("div", { class: tall ? "figure tall" : "figure", style: height ? `height: ${height}px` : null }, canvas);
  const self = { canvas, chart: null, title,
    draw() { if (!self.chart) self.chart = new Chart(canvas, configured(build)); return self.chart; },
    redraw() {
      if (!self.chart) return;
      self.chart.destroy();
      self.chart = null;
      const { top, bottom } = box.getBoundingClientRect();
      if (bottom > -300 && top < window.innerHeight + 300) self.draw();
      else { inView.unobserve(box); inView.observe(box); drawTheRest(); }
    },
    drop() { inView.unobserve(box); if (self.chart) self.chart.destroy(); self.chart = null; } };
  self.node = figureCard(title, says, [() => saveSvg(self, build), () => savePng(self, build)], controls || null, box, below || null);
  box.figure = self;
  figures.push(self);
  inView.observe(box);
  return self;
}

// Draws the figure once more, in the colours of paper and on a canvas of its own, for `use`.
function redrawn(self, build, ratio, use) {
  const canvas = el("canvas", { width: Math.max(420, self.canvas.clientWidth), height: Math.max(240, self.canvas.clientHeight) });
  onPaper(() => {
    const config = configured(build);
    // With `segment` Chart.js draws lines on the canvas itself, not through a Path2D, whose points cannot be read.
    Object.assign(config.options, { responsive: false, devicePixelRatio: ratio, events: [], segment: {} });
    const chart = new Chart(canvas, config);
    try {
      use(canvas, chart);
    } finally {
      chart.destroy();
    }
  });
}

function saveSvg(self, build) {
  redrawn(self, build, 1, (canvas, chart) => {
    const svg = svgRecorder(chart.ctx);
    chart.draw();
    saveText(self.title, svg(self.title, canvas.width, canvas.height));
  });
}

function savePng(self, build) {
  redrawn(self, build, 3, (canvas, { ctx }) => {
    ctx.globalCompositeOperation = "destination-over";  // white behind what is drawn
    ctx.fillStyle = "#ffffff";
    ctx.resetTransform();
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    canvas.toBlob((blob) => save(savedAs(self.title, "png"), blob), "image/png");
  });
}

window.addEventListener("beforeprint", () => figures.forEach((one) => one.draw()));
Chart.defaults.font.family = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', sans-serif";
pageShown.push(() => setTimeout(drawTheRest, 600));  // after the figures in view
