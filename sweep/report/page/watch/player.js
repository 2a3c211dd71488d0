// The player: a stage with the film, a bar to play it, and choices.
const seconds = 9;  // duration of a film at speed 1

class Player {
  // `extent`: what is seen, where it is not that of the film alone; `lead`: the player beside which this one shows its film.
  constructor(element, film, { extent = extentOf(film), lead = null } = {}) {
    this.film = film;
    this.moment = 0;
    this.speed = 1;
    this.playing = false;
    this.canvas = el("canvas", { class: "watch-canvas", tabindex: 0, role: "img", "aria-label": "particles in three dimensions" });
    this.legends = el("div", { class: "watch-legends" });
    this.scaleBar = el("div", { class: "watch-scale" });
    this.compass = el("canvas", { class: "watch-compass", "aria-hidden": true });
    this.told = el("div", { class: "watch-told", hidden: true });
    this.stage = el("div", { class: "watch-stage" }, this.canvas, this.legends, this.scaleBar, this.compass, this.told);
    this.lead = lead || this;
    this.stages = lead ? lead.stages : el("div", { class: "watch-stages" });
    this.root = lead ? lead.root : el("div", { class: "watch-player" }, this.stages);
    this.stages.append(this.stage);
    if (!lead) element.replaceChildren(this.root);
    this.painter = new Painter(this.canvas, film, extent);
    this.camera = lead ? lead.camera : new Camera(this.painter.box());
    this.shadings = shadings(film);
    this.ranges = new Map();  // of the colours, by shading
    if (!lead) this.root.append(this.bar(), this.choices());
    this.listen();
    this.colourBy(this.shadings.length > 0 ? this.shadings[0].key : "");
    if (film.spheres === 0 || film.header.slices.length > 0) this.chooseSlice(film.header.slices.length > 0 ? this.firstSlice() : -1);
    this.resize();
  }

  // ---- choices

  bar() {
    const { film } = this;
    this.play = button("▶", () => this.toggle(), { class: "watch-play", title: "play or pause (space)" });
    this.slider = el("input", { type: "range", min: 0, max: film.frames - 1, step: "any", value: 0, "aria-label": "time", class: "watch-slider",
      input: () => { this.pause(); this.show(Number(this.slider.value)); } });
    this.clock = el("output", { class: "watch-clock" });
    const speeds = choice("Speed", [["0.25", "¼×"], ["0.5", "½×"], ["1", "1×"], ["2", "2×"], ["4", "4×"]], "1", (value) => {
      this.speed = Number(value);
      this.draw();
    });
    this.pace = el("span", { class: "watch-pace" });
    return el("div", { class: "watch-bar" }, this.play, this.slider, this.clock, speeds, this.pace);
  }

  // The pace of the film relative to the process at this moment.
  tellPace() {
    const { times, time_unit: unit } = this.film.header, k = Math.min(Math.floor(this.moment), times.length - 2);
    if (unit !== "s" || k < 0) return;
    const shown = seconds / this.speed / (times.length - 1), slower = shown / (times[k + 1] - times[k]);
    this.pace.textContent = slower >= 1.05 ? `slow motion 1 : ${number(slower, 2)}`
      : slower <= 0.95 ? `time lapse ${number(1 / slower, 2)} : 1` : "real time";
  }

  choices() {
    const { film, painter } = this, shown = [];
    if (this.shadings.length > 0) {
      this.colours = choice("Colour", this.shadings.map((s) => [s.key, s.label]), this.shadings[0].key, (key) => this.colourBy(key));
      this.rangeFields = rangeChoice((range) => this.setRange(range));
      shown.push(this.colours, this.rangeFields);
    }
    if (film.header.slices.length > 0) {
      const list = film.header.slices.map((slice, k) => [String(k), sliceLabel(slice)]);
      this.slices = choice("Slice", [["-1", "none"]].concat(list), "-1", (value) => this.chooseSlice(Number(value)));
      this.planes = choice("across", [["0", "x"], ["1", "y"], ["2", "z"]], "0", (value) => { painter.show.plane = Number(value); this.draw(); });
      painter.show.plane = 0;
      shown.push(this.slices, this.planes);
    }
    if (film.walls.length > 0) {
      this.wallTick = tick("walls", true, (on) => { painter.show.walls = on; this.draw(); });
      shown.push(this.wallTick);
      const named = this.wallsByName();
      if (named) shown.push(named);
    }
    if (film.forces) {
      this.forceTick = tick("forces", false, (on) => { painter.show.forces = on; this.drawLegends(); this.draw(); });
      shown.push(this.forceTick);
    }
    if (film.spheres > 0 && film.mobile.includes(0)) {
      this.frozenTick = tick("frozen spheres", true, (on) => { painter.show.frozen = on; this.draw(); });
      shown.push(this.frozenTick);
    }
    if (film.spheres > 0) {
      shown.push(this.cutChoice());
      if (painter.radius() < 0.012) shown.push(this.sizeChoice());
    }
    const looks = Object.keys(views).map((name, k) => button(name, () => this.look(name), { title: `key ${k + 1}` }));
    shown.push(el("span", { class: "watch-views" }, looks), button("save picture", () => this.savePicture(), { title: "save this view as a PNG file" }));
    return el("div", { class: "watch-choices" }, shown);
  }

  // A switch for each wall; the copies of a repeated one share theirs.
  wallsByName() {
    const names = [...new Set(this.film.walls.map((wall) => wallGroup(wall.name)))].sort(), { hidden } = this.painter.show;
    if (names.length < 2) return null;
    const ticks = names.map((name) => tick(words(name), true, (on) => { if (on) hidden.delete(name); else hidden.add(name); this.draw(); }));
    return el("details", { class: "watch-walls" }, el("summary", {}, "walls by name"), el("div", {}, ticks));
  }

  // Small spheres are enlarged; the factor stands beside the slider.
  sizeChoice() {
    const { painter } = this, size = el("input", { type: "range", min: 0, max: 2.5, step: 0.01, "aria-label": "size of the spheres", input: () => { apply(); this.draw(); } });
    const factor = el("span", { class: "watch-factor" });
    const apply = () => {
      painter.show.size = Math.exp(Number(size.value));
      factor.textContent = `×${number(painter.show.size, 2)}`;
    };
    size.value = Math.log(Math.min(4, Math.max(1, 0.0065 / painter.radius())));
    apply();
    return el("label", { class: "choice" }, el("span", {}, "Size"), size, factor);
  }

  // A plane beyond which spheres are hidden, to look into a packing.
  cutChoice() {
    const state = { axis: -1, at: 0.5 }, { painter } = this;
    const apply = () => {
      const box = painter.box();
      if (state.axis < 0) { painter.show.cut = null; this.draw(); return; }
      const normal = [0, 0, 0], flip = state.axis === 1 ? -1 : 1;  // the front half goes
      normal[state.axis] = flip;
      const at = box.low[state.axis] + state.at * (box.high[state.axis] - box.low[state.axis]);
      painter.show.cut = [...normal, flip * at];
      this.draw();
    };
    const place = el("input", { type: "range", min: 0, max: 1, step: 0.002, value: 0.5, "aria-label": "position of the cut", hidden: true,
      input: () => { state.at = Number(place.value); apply(); } });
    const cut = choice("Cut", [["-1", "none"], ["0", "x"], ["1", "y"], ["2", "z"]], "-1", (value) => {
      state.axis = Number(value);
      place.hidden = state.axis < 0;
      apply();
    });
    return el("span", { class: "watch-cut" }, cut, place);
  }

  // ---- the shown state

  colourBy(key) {
    const shading = this.shadings.find((s) => s.key === key);
    if (!shading) return;
    this.shading = shading;
    const shades = shading.shades();
    this.shades = shades.data;
    this.stillShades = shades.still;
    this.usual = usualRange(this.film, shading, shades);
    this.painter.setPalette("spheres", shading.signed ? "signed" : "spheres");
    this.painter.setShades(shades.data, shades.still);
    if (this.colours) this.colours.control.value = key;
    if (this.beside) this.beside.colourBy(key);
    this.setRange(this.ranges.get(key) || null);
  }

  // null: the usual one, of both films where two are shown.
  setRange(range) {
    const { shading, beside } = this;
    if (range) this.ranges.set(shading.key, range); else this.ranges.delete(shading.key);
    const both = beside && beside.shading && beside.shading.key === shading.key ? [this.usual, beside.usual] : [this.usual];
    this.range = range || { low: Math.min(...both.map((one) => one.low)), high: Math.max(...both.map((one) => one.high)) };
    if (both.length > 1) beside.setRange(this.range);
    this.painter.show.colours = colourWindow(shading, this.range);
    if (this.rangeFields) this.rangeFields.show(shading, this.range);
    this.drawLegends();
    this.draw();
  }

  // The magnitude of the velocity, where there is one.
  firstSlice() {
    return Math.max(0, this.film.header.slices.findIndex((slice) => slice.component === 3));
  }

  chooseSlice(k) {
    this.painter.show.slice = k;
    if (k >= 0) this.painter.setPalette("slices", this.film.header.slices[k].low < 0 ? "signed" : "slices");
    if (this.slices) this.slices.control.value = String(k);
    if (this.beside && k < this.beside.film.header.slices.length) this.beside.chooseSlice(k);
    if (this.planes) this.planes.hidden = k < 0;
    this.drawLegends();
    this.draw();
  }

  drawLegends() {
    const shown = [];
    if (this.shading && this.film.spheres > 0) {
      const { label, unit, low, high, clipped, signed } = this.shading, { range } = this;
      const beyond = [low < range.low || clipped && signed, high > range.high || clipped];
      shown.push(legend(label, unit, range.low, range.high, beyond, signed ? "signed" : "spheres"));
    }
    const slice = this.film.header.slices[this.painter.show.slice];
    if (slice) shown.push(legend(`flow: ${sliceLabel(slice)}`, slice.unit, slice.low, slice.high, [slice.clipped && slice.low < 0, slice.clipped], slice.low < 0 ? "signed" : "slices"));
    if (this.film.forces && this.painter.show.forces) {
      const { low, high } = this.film.forces;
      shown.push(el("div", { class: "watch-legend" }, `widest line: ${measured(Math.max(Math.abs(low), Math.abs(high)), "N", 3)} between particles`));
    }
    this.legends.replaceChildren(...shown);
  }

  look(name) { this.camera.look(name); this.draw(); }

  // A picture that stands is one of a simulated time; only a playing film moves between two of them.
  show(moment) {
    this.moment = Math.min(this.film.frames - 1, Math.max(0, Math.round(moment)));
    this.slider.value = this.moment;
    this.draw();
  }

  // Paints at the next repaint, once for all requests before.
  draw() {
    if (this.lead !== this) { this.lead.draw(); return; }
    if (this.asked) return;
    this.asked = requestAnimationFrame(() => { this.asked = 0; this.paint(); });
  }

  paint() {
    if (!this.canvas.width || !this.canvas.height) return;
    const seen = this.painter.paint(this.moment, this.camera, this.ground);
    this.matrices = seen;
    if (this.lead === this) {
      this.tellTime();
      this.tellPace();
      if (this.beside) this.beside.follow(this);
    }
    this.drawScale(seen);
    this.drawCompass(seen);
    if (!this.told.hidden) this.tell();
  }

  // Shows the moment of the leading player, as that one shows its own.
  follow({ painter, time }) {
    const { chosen } = this.painter.show, { slices } = this.film.header;
    Object.assign(this.painter.show, painter.show, { chosen, colours: this.painter.show.colours });
    if (painter.show.slice >= slices.length) this.painter.show.slice = -1;
    this.moment = momentAt(this.film.header, time());
    this.paint();
  }

  time = () => {
    const { times } = this.film.header, k = Math.floor(this.moment);
    return times[k] + (this.moment - k) * ((times[k + 1] ?? times[k]) - times[k]);
  };

  tellTime() {
    const { times, time_unit: unit } = this.film.header, now = this.time(), last = times[times.length - 1];
    const scale = scaleFor(unit, [last]), size = last * scale.factor;
    const digits = size > 0 ? Math.max(0, 2 - Math.floor(Math.log10(size))) : 0;
    this.clock.textContent = digits > 5 ? `${number(now * scale.factor)} ${scale.unit}`
      : `${(now * scale.factor).toFixed(digits)} / ${size.toFixed(digits)} ${scale.unit}`;
  }

  drawScale({ tangent }) {
    const height = this.canvas.clientHeight, perPixel = 2 * this.camera.distance * tangent / height * this.painter.extent.size;
    const most = 110 * perPixel, power = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].map((m) => m * power).find((l) => l <= most) || power;
    this.scaleBar.style.width = `${length / perPixel}px`;
    this.scaleBar.textContent = measured(length, this.film.header.length_unit, 2);
  }

  drawCompass({ axes }) {
    const size = 68, ratio = devicePixelRatio || 1, c = this.compass;
    if (c.width !== size * ratio) c.width = c.height = size * ratio;
    const g = c.getContext("2d"), style = getComputedStyle(this.root);
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, size, size);
    g.font = "600 12px system-ui, sans-serif";
    g.textAlign = "center";
    g.textBaseline = "middle";
    const arrows = ["x", "y", "z"].map((name, a) => ({ name, x: axes[0][a], y: -axes[1][a], depth: axes[2][a] }));
    arrows.sort((one, other) => one.depth - other.depth).forEach(({ name, x, y }) => {
      g.strokeStyle = g.fillStyle = style.getPropertyValue("--watch-" + name).trim();
      g.lineWidth = 2;
      g.beginPath();
      g.moveTo(size / 2, size / 2);
      g.lineTo(size / 2 + 20 * x, size / 2 + 20 * y);
      g.stroke();
      if (Math.hypot(x, y) > 0.15) g.fillText(name, size / 2 + 28 * x, size / 2 + 28 * y);
    });
  }

  // ---- playing

  toggle() {
    if (!this.playing) { this.start(); return; }
    this.pause();
    this.show(this.moment);
  }

  start() {
    if (this.film.frames < 2) return;
    if (this.moment >= this.film.frames - 1) this.moment = 0;
    this.playing = true;
    this.play.textContent = "❚❚";
    let last = null;
    const step = (now) => {
      if (!this.playing) return;
      if (!this.canvas.clientHeight) { this.pause(); return; }  // out of sight
      const passed = last === null ? 0 : Math.min(0.1, (now - last) / 1000);
      last = now;
      let next = this.moment + passed * this.speed * (this.film.frames - 1) / seconds;
      if (next >= this.film.frames - 1) { next = this.film.frames - 1; this.pause(); }
      this.moment = next;
      this.slider.value = next;
      this.paint();
      if (this.playing) requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  // Plays unless the reader prefers reduced motion.
  startByItself() { if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches) this.start(); }

  pause() {
    this.playing = false;
    this.play.textContent = "▶";
  }

  // ---- pointers and keys

  listen() {
    steer(this.canvas, this.camera, () => this.draw(), (x, y) => this.pick(x, y));
    this.watching = new ResizeObserver(() => this.resize());
    this.watching.observe(this.stage);
    this.theme = window.matchMedia("(prefers-color-scheme: dark)");
    this.themeChanged = () => this.resize();
    this.theme.addEventListener("change", this.themeChanged);
    if (this.lead === this) this.root.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    if (event.target.type === "number") return;
    const onSlider = event.target.tagName === "INPUT" && event.target.type === "range";
    const step = (by) => { this.pause(); this.show(Math.round(this.moment) + by); };
    const cycle = () => {
      const at = this.shadings.indexOf(this.shading);
      if (at >= 0) this.colourBy(this.shadings[(at + 1) % this.shadings.length].key);
    };
    const flip = (one) => one?.control.click();
    const does = {
      " ": () => this.toggle(), Home: () => { this.pause(); this.show(0); }, End: () => { this.pause(); this.show(this.film.frames - 1); },
      "+": () => { this.camera.closer(1 / 1.15); this.draw(); }, "-": () => { this.camera.closer(1.15); this.draw(); },
      c: cycle, w: () => flip(this.wallTick), f: () => flip(this.frozenTick), n: () => flip(this.forceTick),
      1: () => this.look("oblique"), 2: () => this.look("front"), 3: () => this.look("side"), 4: () => this.look("top"), r: () => this.look("oblique"),
    };
    if (!onSlider) Object.assign(does, { ArrowLeft: () => step(-1), ArrowRight: () => step(1) });
    const act = does[event.key] || does[event.key.toLowerCase()];
    if (!act || (event.key === " " && event.target.tagName === "BUTTON")) return;
    event.preventDefault();
    act();
  }

  // The nearest sphere under a point of the stage.
  pick(x, y) {
    const { film, painter } = this;
    painter.show.chosen = -1;
    this.told.hidden = true;
    if (film.spheres === 0 || !this.matrices) return;
    const { eye, axes, tangent } = this.matrices;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ray = unit(add(scale(-1, axes[2]), add(scale((2 * x / width - 1) * tangent * width / height, axes[0]), scale((1 - 2 * y / height) * tangent, axes[1]))));
    const frame = Math.round(this.moment), cut = painter.show.cut;
    let nearest = Infinity;
    for (let i = 0; i < film.spheres; ++i) {
      const place = placeOf(film, frame, i);
      if (!place || !(painter.show.frozen || film.mobile[i])) continue;
      const centre = painter.inPicture(place);
      if (cut && dot(cut, centre) > cut[3]) continue;
      const off = sub(centre, eye), along = dot(off, ray);
      const radius = Math.max(painter.radius() * painter.show.size * film.sizes[i] / 65535 || painter.radius(), 3 * tangent / height * along);
      if (along > 0 && along < nearest && dot(off, off) - along * along < radius * radius) {
        nearest = along;
        painter.show.chosen = i;
      }
    }
    this.told.hidden = painter.show.chosen < 0;
    this.draw();
  }

  // Shows the numbers of the chosen sphere.
  tell() {
    const { film } = this, i = this.painter.show.chosen, frame = Math.round(this.moment), place = placeOf(film, frame, i);
    const rows = [];
    const row = (name, value, unit) => rows.push(el("tr", {}, el("td", {}, name), el("td", {}, measured(value, unit))));
    const { largest } = film.header.diameter;
    if (largest > 0) row("diameter", this.film.sizes[i] / 65535 * largest, film.header.length_unit);
    if (place) ["x", "y", "z"].forEach((name, a) => row(name, place[a], film.header.length_unit));
    if (this.shading && place) {
      const shade = this.shades[this.stillShades ? i : frame * film.spheres + i];
      if (shade > 0) row(this.shading.label, valueOfShade(this.shading, shade), this.shading.unit);
    }
    this.told.replaceChildren(el("b", {}, place ? `sphere ${i}` : `sphere ${i} has left`), el("table", {}, rows));
  }

  resize() {
    const ratio = Math.min(devicePixelRatio || 1, 2), { clientWidth: width, clientHeight: height } = this.stage;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const colour = getComputedStyle(this.root).getPropertyValue("--watch-ground").trim();
    this.ground = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255);
    this.paint();  // at once: a resized canvas is empty
  }

  // With the film beside it.
  savePicture() {
    if (!this.playing) this.show(this.moment);
    this.paint();
    saveTogether(`${this.film.header.about.name || "particles"}.png`, [...this.stages.querySelectorAll(".watch-canvas")]);
  }

  free() {
    if (this.beside) this.beside.free();
    this.pause();
    this.watching.disconnect();
    this.theme.removeEventListener("change", this.themeChanged);
    this.painter.free();
    this.root.remove();
  }
}
