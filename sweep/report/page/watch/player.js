// The player: a stage with a film on it, a bar to play it and what there is to choose. mount(element, film) is all that
// a page needs; it returns {show(frame), free()}.
(function (watch) {
  "use strict";
  const { el, choice, tick } = watch;
  const seconds = 9;  // that a film lasts at speed 1

  class Player {
    constructor(element, film) {
      this.film = film;
      this.moment = 0;
      this.speed = 1;
      this.playing = false;
      this.canvas = el("canvas", { class: "watch-canvas", tabindex: 0, role: "img", "aria-label": "the particles in three dimensions" });
      this.legends = el("div", { class: "watch-legends" });
      this.scaleBar = el("div", { class: "watch-scale" });
      this.compass = el("canvas", { class: "watch-compass", "aria-hidden": true });
      this.told = el("div", { class: "watch-told", hidden: true });
      this.stage = el("div", { class: "watch-stage" }, this.canvas, this.legends, this.scaleBar, this.compass, this.told);
      this.root = el("div", { class: "watch-player" }, this.stage);
      element.replaceChildren(this.root);
      this.painter = new watch.Painter(this.canvas, film);
      this.camera = new watch.Camera(this.painter.box());
      this.shadings = watch.shadings(film);
      this.root.append(this.bar(), this.choices());
      this.listen();
      this.colourBy(this.shadings.length > 0 ? this.shadings[0].key : "");
      if (film.spheres === 0 || film.header.slices.length > 0) this.chooseSlice(film.header.slices.length > 0 ? this.firstSlice() : -1);
      this.resize();
    }

    // ---- what there is to choose

    bar() {
      const { film } = this;
      this.play = el("button", { type: "button", class: "watch-play", title: "play or pause (space)" }, "▶");
      this.play.addEventListener("click", () => this.toggle());
      this.slider = el("input", { type: "range", min: 0, max: film.frames - 1, step: "any", value: 0, "aria-label": "time", class: "watch-slider" });
      this.slider.addEventListener("input", () => { this.pause(); this.show(Number(this.slider.value)); });
      this.clock = el("output", { class: "watch-clock" });
      const speeds = choice("Speed", [["0.25", "¼×"], ["0.5", "½×"], ["1", "1×"], ["2", "2×"], ["4", "4×"]], "1", (value) => {
        this.speed = Number(value);
        this.draw();
      });
      this.speeds = speeds.select;
      this.pace = el("span", { class: "watch-pace" });
      return el("div", { class: "watch-bar" }, this.play, this.slider, this.clock, speeds.node, this.pace);
    }

    /// How the film's time runs beside that of the process, at this moment: it need not be even.
    tellPace() {
      const { times, time_unit: unit } = this.film.header, k = Math.min(Math.floor(this.moment), times.length - 2);
      if (unit !== "s" || k < 0) return;
      const shown = seconds / this.speed / (times.length - 1), slower = shown / (times[k + 1] - times[k]);
      this.pace.textContent = slower >= 1.05 ? `slow motion 1 : ${watch.number(slower, 2)}`
        : slower <= 0.95 ? `time lapse ${watch.number(1 / slower, 2)} : 1` : "real time";
    }

    choices() {
      const { film, painter } = this, shown = [];
      if (this.shadings.length > 0) {
        this.colours = choice("Colour", this.shadings.map((s) => [s.key, s.label]), this.shadings[0].key, (key) => this.colourBy(key));
        shown.push(this.colours.node);
      }
      if (film.header.slices.length > 0) {
        const list = film.header.slices.map((slice, k) => [String(k), watch.sliceLabel(slice)]);
        this.slices = choice("Slice", [["-1", "none"]].concat(list), "-1", (value) => this.chooseSlice(Number(value)));
        this.planes = choice("across", [["0", "x"], ["1", "y"], ["2", "z"]], "0", (value) => { painter.show.plane = Number(value); this.draw(); });
        painter.show.plane = 0;
        shown.push(this.slices.node, this.planes.node);
      }
      if (film.walls.length > 0) {
        this.wallTick = tick("walls", true, (on) => { painter.show.walls = on; this.draw(); });
        shown.push(this.wallTick.node);
      }
      if (painter.hasFrozen) {
        this.frozenTick = tick("frozen spheres", true, (on) => { painter.show.frozen = on; this.draw(); });
        shown.push(this.frozenTick.node);
      }
      if (film.spheres > 0) {
        shown.push(this.cutChoice());
        if (painter.radius() < 0.012) shown.push(this.sizeChoice());
      }
      const views = ["oblique", "front", "side", "top"].map((name, k) => {
        const button = el("button", { type: "button", title: `key ${k + 1}` }, name);
        button.addEventListener("click", () => this.look(name));
        return button;
      });
      const picture = el("button", { type: "button", title: "save this view as a PNG file" }, "save picture");
      picture.addEventListener("click", () => this.savePicture());
      shown.push(el("span", { class: "watch-views" }, views), picture);
      return el("div", { class: "watch-choices" }, shown);
    }

    /// Small spheres are drawn larger than they are, and it says how much.
    sizeChoice() {
      const { painter } = this, size = el("input", { type: "range", min: 0, max: 2.5, step: 0.01, "aria-label": "size of the spheres" });
      const factor = el("span", { class: "watch-factor" });
      const apply = () => {
        painter.show.size = Math.exp(Number(size.value));
        factor.textContent = `×${watch.number(painter.show.size, 2)}`;
      };
      size.value = Math.log(Math.min(4, Math.max(1, 0.0065 / painter.radius())));
      size.addEventListener("input", () => { apply(); this.draw(); });
      apply();
      return el("label", { class: "watch-choice" }, el("span", {}, "Size"), size, factor);
    }

    /// A plane beyond which spheres are not drawn: into a packing one must look.
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
      const place = el("input", { type: "range", min: 0, max: 1, step: 0.002, value: 0.5, "aria-label": "where it is cut", hidden: true });
      place.addEventListener("input", () => { state.at = Number(place.value); apply(); });
      this.cut = choice("Cut", [["-1", "none"], ["0", "x"], ["1", "y"], ["2", "z"]], "-1", (value) => {
        state.axis = Number(value);
        place.hidden = state.axis < 0;
        apply();
      });
      return el("span", { class: "watch-cut" }, this.cut.node, place);
    }

    // ---- what is shown

    colourBy(key) {
      const shading = this.shadings.find((s) => s.key === key);
      if (!shading) return;
      this.shading = shading;
      const { data, still } = shading.shades();
      this.shades = data;
      this.stillShades = still;
      this.painter.setPalette("spheres", shading.signed ? "signed" : "spheres");
      this.painter.setShades(data, still);
      if (this.colours) this.colours.select.value = key;
      this.drawLegends();
      this.draw();
    }

    /// The magnitude of the velocity, where there is one.
    firstSlice() {
      return Math.max(0, this.film.header.slices.findIndex((slice) => slice.component === 3));
    }

    chooseSlice(k) {
      this.painter.show.slice = k;
      if (k >= 0) this.painter.setPalette("slices", this.film.header.slices[k].low < 0 ? "signed" : "slices");
      if (this.slices) this.slices.select.value = String(k);
      if (this.planes) this.planes.node.hidden = k < 0;
      this.drawLegends();
      this.draw();
    }

    drawLegends() {
      const legend = (title, unit, low, high, clipped, kind) => {
        const scale = watch.unitFor(Math.max(Math.abs(low), Math.abs(high)), unit);
        const end = (x, mark) => mark + watch.number(x * scale.factor);
        return el("div", { class: "watch-legend" },
          el("div", { class: "watch-legend-title" }, title + (scale.unit ? ` (${scale.unit})` : "")),
          el("div", { class: "watch-gradient", style: `background: ${watch.gradient(kind)}` }),
          el("div", { class: "watch-ends" }, el("span", {}, end(low, clipped && low < 0 ? "≤ " : "")), el("span", {}, end((low + high) / 2, "")),
            el("span", {}, end(high, clipped ? "≥ " : ""))));
      };
      const shown = [];
      if (this.shading && this.film.spheres > 0) {
        const { label, unit, low, high, clipped, signed } = this.shading;
        shown.push(legend(label, unit, low, high, clipped, signed ? "signed" : "spheres"));
      }
      const slice = this.film.header.slices[this.painter.show.slice];
      if (slice) shown.push(legend(`flow: ${watch.sliceLabel(slice)}`, slice.unit, slice.low, slice.high, slice.clipped, slice.low < 0 ? "signed" : "slices"));
      this.legends.replaceChildren(...shown);
    }

    look(name) { this.camera.look(name); this.draw(); }

    show(moment) {
      this.moment = Math.min(this.film.frames - 1, Math.max(0, moment));
      this.slider.value = this.moment;
      this.draw();
    }

    /// At the next repaint, however often it is asked before.
    draw() {
      if (this.asked) return;
      this.asked = requestAnimationFrame(() => { this.asked = 0; this.paint(); });
    }

    paint() {
      if (!this.canvas.width || !this.canvas.height) return;
      const seen = this.painter.paint(this.moment, this.camera, this.ground);
      this.matrices = seen;
      this.tellTime();
      this.tellPace();
      this.drawScale(seen);
      this.drawCompass(seen);
      if (!this.told.hidden) this.tell();
    }

    tellTime() {
      const { times, time_unit: unit } = this.film.header, k = Math.floor(this.moment), share = this.moment - k;
      const now = times[k] + share * ((times[k + 1] ?? times[k]) - times[k]), last = times[times.length - 1];
      const scale = watch.unitFor(last, unit), size = last * scale.factor;
      const digits = size > 0 ? Math.max(0, 2 - Math.floor(Math.log10(size))) : 0;
      this.clock.textContent = digits > 5 ? `${watch.number(now * scale.factor)} ${scale.unit}`
        : `${(now * scale.factor).toFixed(digits)} / ${size.toFixed(digits)} ${scale.unit}`;
    }

    drawScale({ tangent }) {
      const height = this.canvas.clientHeight, perPixel = 2 * this.camera.distance * tangent / height * this.painter.extent.size;
      const most = 110 * perPixel, power = 10 ** Math.floor(Math.log10(most));
      const length = [5, 2, 1].map((m) => m * power).find((l) => l <= most) || power;
      const scale = watch.unitFor(length, this.film.header.length_unit);
      this.scaleBar.style.width = `${length / perPixel}px`;
      this.scaleBar.textContent = `${watch.number(length * scale.factor, 2)} ${scale.unit}`;
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

    toggle() { if (this.playing) this.pause(); else this.start(); }

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

    /// As a page that was opened to be watched does, unless its reader asks for little motion.
    startByItself() { if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches) this.start(); }

    pause() {
      this.playing = false;
      this.play.textContent = "▶";
    }

    // ---- pointers and keys

    listen() {
      watch.steer(this.canvas, this.camera, () => this.draw(), (x, y) => this.pick(x, y));
      this.watching = new ResizeObserver(() => this.resize());
      this.watching.observe(this.stage);
      this.theme = window.matchMedia("(prefers-color-scheme: dark)");
      this.themeChanged = () => this.resize();
      this.theme.addEventListener("change", this.themeChanged);
      this.root.addEventListener("keydown", (event) => this.key(event));
    }

    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
      const onSlider = event.target.tagName === "INPUT" && event.target.type === "range";
      const step = (by) => { this.pause(); this.show(Math.round(this.moment) + by); };
      const cycle = () => {
        const at = this.shadings.indexOf(this.shading);
        if (at >= 0) this.colourBy(this.shadings[(at + 1) % this.shadings.length].key);
      };
      const flip = (one) => { if (one) one.box.click(); };
      const does = {
        " ": () => this.toggle(), Home: () => { this.pause(); this.show(0); }, End: () => { this.pause(); this.show(this.film.frames - 1); },
        "+": () => { this.camera.closer(1 / 1.15); this.draw(); }, "-": () => { this.camera.closer(1.15); this.draw(); },
        c: cycle, w: () => flip(this.wallTick), f: () => flip(this.frozenTick),
        1: () => this.look("oblique"), 2: () => this.look("front"), 3: () => this.look("side"), 4: () => this.look("top"), r: () => this.look("oblique"),
      };
      if (!onSlider) Object.assign(does, { ArrowLeft: () => step(-1), ArrowRight: () => step(1) });
      const act = does[event.key] || does[event.key.toLowerCase()];
      if (!act || (event.key === " " && event.target.tagName === "BUTTON")) return;
      event.preventDefault();
      act();
    }

    /// The nearest sphere under a point of the stage.
    pick(x, y) {
      const { film, painter } = this;
      painter.show.chosen = -1;
      this.told.hidden = true;
      if (film.spheres === 0 || !this.matrices) return;
      const { sub, dot, add, scale, unit } = watch.math, { eye, axes, tangent } = this.matrices;
      const { clientWidth: width, clientHeight: height } = this.canvas;
      const ray = unit(add(scale(-1, axes[2]), add(scale((2 * x / width - 1) * tangent * width / height, axes[0]), scale((1 - 2 * y / height) * tangent, axes[1]))));
      const frame = Math.round(this.moment), cut = painter.show.cut;
      let nearest = Infinity;
      const mobile = film.header.mobile ? film.column(film.header.mobile, 1, film.spheres) : null;
      for (let i = 0; i < film.spheres; ++i) {
        const place = watch.placeOf(film, frame, i);
        if (!place || (mobile && !painter.show.frozen && !mobile[i])) continue;
        const centre = painter.inPicture(place);
        if (cut && dot(cut, centre) > cut[3]) continue;
        const off = sub(centre, eye), along = dot(off, ray);
        const radius = Math.max(painter.radius() * painter.show.size * painter.sizes[i] / 65535 || painter.radius(), 3 * tangent / height * along);
        if (along > 0 && along < nearest && dot(off, off) - along * along < radius * radius) {
          nearest = along;
          painter.show.chosen = i;
        }
      }
      this.told.hidden = painter.show.chosen < 0;
      this.draw();
    }

    /// What is known of the chosen sphere.
    tell() {
      const { film } = this, i = this.painter.show.chosen, frame = Math.round(this.moment), place = watch.placeOf(film, frame, i);
      const rows = [];
      const row = (name, value, unit) => {
        const scale = watch.unitFor(Math.abs(value), unit);
        rows.push(el("tr", {}, el("td", {}, name), el("td", {}, `${watch.number(value * scale.factor)} ${scale.unit}`)));
      };
      const { largest } = film.header.diameter;
      if (largest > 0) row("diameter", this.painter.sizes[i] / 65535 * largest, film.header.length_unit);
      if (place) ["x", "y", "z"].forEach((name, a) => row(name, place[a], film.header.length_unit));
      if (this.shading && place) {
        const shade = this.shades[this.stillShades ? i : frame * film.spheres + i];
        if (shade > 0) row(this.shading.label, watch.valueOfShade(this.shading, shade), this.shading.unit);
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

    savePicture() {
      this.paint();
      this.canvas.toBlob((blob) => {
        const link = el("a", { href: URL.createObjectURL(blob), download: `${this.film.header.about.name || "particles"}.png` });
        link.click();
        URL.revokeObjectURL(link.href);
      });
    }

    free() {
      this.pause();
      this.watching.disconnect();
      this.theme.removeEventListener("change", this.themeChanged);
      this.painter.free();
      this.root.remove();
    }
  }

  /// film: as readFilm gives it.
  watch.mount = (element, film) => new Player(element, film);
})(window.grainsweepWatch = window.grainsweepWatch || {});
