// A drawing context that writes SVG: the figures are drawn on it by the same program as on the screen, and what comes out
// are lines, areas and texts. It knows what Chart.js and the figures of this page use of CanvasRenderingContext2D.
class SvgPath {
  constructor() { this.steps = []; }
  moveTo(x, y) { this.steps.push(["M", x, y]); }
  lineTo(x, y) { this.steps.push([this.steps.length > 0 ? "L" : "M", x, y]); }
  bezierCurveTo(...p) { this.steps.push(["C", ...p]); }
  quadraticCurveTo(...p) { this.steps.push(["Q", ...p]); }
  rect(x, y, w, h) { this.moveTo(x, y); this.lineTo(x + w, y); this.lineTo(x + w, y + h); this.lineTo(x, y + h); this.closePath(); }
  closePath() { this.steps.push(["Z"]); }
  arc(x, y, r, from, to, backwards) {
    const full = 2 * Math.PI;
    let sweep = backwards ? from - to : to - from;
    sweep = sweep >= full ? full : ((sweep % full) + full) % full;
    // Quarter circles as cubic curves: an arc command cannot be transformed point by point.
    const parts = Math.max(1, Math.ceil(sweep / (Math.PI / 2) - 1e-9)), step = ((backwards ? -1 : 1) * sweep) / parts;
    const k = (4 / 3) * Math.tan(step / 4);
    this.lineTo(x + r * Math.cos(from), y + r * Math.sin(from));
    for (let i = 0, a = from; i < parts; ++i, a += step) {
      const b = a + step;
      this.bezierCurveTo(x + r * (Math.cos(a) - k * Math.sin(a)), y + r * (Math.sin(a) + k * Math.cos(a)),
        x + r * (Math.cos(b) + k * Math.sin(b)), y + r * (Math.sin(b) - k * Math.cos(b)), x + r * Math.cos(b), y + r * Math.sin(b));
    }
  }
}

class SvgContext {
  constructor(canvas, width, height) {
    this.canvas = canvas;
    this.width = width;
    this.height = height;
    this.ruler = document.createElement("canvas").getContext("2d");
    this.body = [];
    this.clips = new Map();
    this.stack = [];
    this.path = new SvgPath();
    this.state = { matrix: [1, 0, 0, 1, 0, 0], clip: null, dash: [] };
    Object.assign(this, { fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, lineCap: "butt", lineJoin: "miter", miterLimit: 10, lineDashOffset: 0,
      font: "10px sans-serif", textAlign: "start", textBaseline: "alphabetic", globalAlpha: 1, globalCompositeOperation: "source-over" });
  }
  static styles = ["fillStyle", "strokeStyle", "lineWidth", "lineCap", "lineJoin", "miterLimit", "lineDashOffset", "font", "textAlign", "textBaseline", "globalAlpha"];

  save() { this.stack.push([{ ...this.state }, SvgContext.styles.map((name) => this[name])]); }
  restore() {
    const [state, styles] = this.stack.pop() || [this.state, SvgContext.styles.map((name) => this[name])];
    this.state = state;
    SvgContext.styles.forEach((name, i) => { this[name] = styles[i]; });
  }
  setTransform(...m) { this.state.matrix = typeof m[0] === "object" ? [m[0].a, m[0].b, m[0].c, m[0].d, m[0].e, m[0].f] : m; }
  resetTransform() { this.state.matrix = [1, 0, 0, 1, 0, 0]; }
  transform(a, b, c, d, e, f) {
    const [A, B, C, D, E, F] = this.state.matrix;
    this.state.matrix = [A * a + C * b, B * a + D * b, A * c + C * d, B * c + D * d, A * e + C * f + E, B * e + D * f + F];
  }
  translate(x, y) { this.transform(1, 0, 0, 1, x, y); }
  scale(x, y) { this.transform(x, 0, 0, y, 0, 0); }
  rotate(angle) { this.transform(Math.cos(angle), Math.sin(angle), -Math.sin(angle), Math.cos(angle), 0, 0); }

  beginPath() { this.path = new SvgPath(); }
  moveTo(x, y) { this.path.moveTo(x, y); }
  lineTo(x, y) { this.path.lineTo(x, y); }
  bezierCurveTo(...p) { this.path.bezierCurveTo(...p); }
  quadraticCurveTo(...p) { this.path.quadraticCurveTo(...p); }
  rect(...p) { this.path.rect(...p); }
  arc(...p) { this.path.arc(...p); }
  closePath() { this.path.closePath(); }
  setLineDash(dash) { this.state.dash = [...dash]; }
  getLineDash() { return [...this.state.dash]; }
  measureText(text) { this.ruler.font = this.font; return this.ruler.measureText(text); }
  clearRect() {}

  static number(x) { return String(Math.round(100 * x) / 100); }
  at(x, y) {
    const [a, b, c, d, e, f] = this.state.matrix;
    return `${SvgContext.number(a * x + c * y + e)} ${SvgContext.number(b * x + d * y + f)}`;
  }
  outline(path) {
    return path.steps.map(([kind, ...p]) => {
      const points = [];
      for (let i = 0; i < p.length; i += 2) points.push(this.at(p[i], p[i + 1]));
      return kind + points.join(" ");
    }).join("");
  }
  // Any colour of the style sheet as #rrggbb and an opacity.
  paint(kind, style) {
    this.ruler.fillStyle = "#000";
    this.ruler.fillStyle = style;
    const tone = this.ruler.fillStyle, parts = /^rgba\((\d+), (\d+), (\d+), ([\d.]+)\)$/.exec(tone);
    const solid = parts ? "#" + parts.slice(1, 4).map((c) => Number(c).toString(16).padStart(2, "0")).join("") : tone;
    const opacity = (parts ? Number(parts[4]) : 1) * this.globalAlpha;
    return ` ${kind}="${solid}"` + (opacity < 1 ? ` ${kind}-opacity="${SvgContext.number(opacity)}"` : "");
  }
  clipped() { return this.state.clip === null ? "" : ` clip-path="url(#clip${this.state.clip})"`; }
  clip(path) {
    const text = `${this.clipped()}><path d="${this.outline(path instanceof SvgPath ? path : this.path)}"/>`;
    if (!this.clips.has(text)) this.clips.set(text, this.clips.size);
    this.state.clip = this.clips.get(text);
  }
  fill(path) {
    const d = this.outline(path instanceof SvgPath ? path : this.path);
    if (d) this.body.push(`<path d="${d}"${this.paint("fill", this.fillStyle)}${this.clipped()}/>`);
  }
  stroke(path) {
    const d = this.outline(path instanceof SvgPath ? path : this.path);
    if (!d || this.lineWidth <= 0) return;
    const dash = this.state.dash.length > 0 ? ` stroke-dasharray="${this.state.dash.join(" ")}"` : "";
    this.body.push(`<path d="${d}" fill="none"${this.paint("stroke", this.strokeStyle)} stroke-width="${SvgContext.number(this.lineWidth)}"` +
      ` stroke-linejoin="${this.lineJoin}" stroke-linecap="${this.lineCap}"${dash}${this.clipped()}/>`);
  }
  fillRect(x, y, w, h) { const path = new SvgPath(); path.rect(x, y, w, h); this.fill(path); }
  strokeRect(x, y, w, h) { const path = new SvgPath(); path.rect(x, y, w, h); this.stroke(path); }
  strokeText() {}
  fillText(text, x, y) {
    const size = Number((/([\d.]+)px/.exec(this.font) || [0, 10])[1]), family = this.font.replace(/^.*?px(\/\S+)?\s*/, "");
    const weight = /\b(bold|[5-9]00)\b/.test(this.font.split("px")[0]) ? ' font-weight="bold"' : "";
    const anchor = { center: "middle", right: "end", end: "end" }[this.textAlign] || "start";
    const down = { top: 0.8, hanging: 0.8, middle: 0.35, bottom: -0.2, ideographic: -0.2 }[this.textBaseline] || 0;
    const [a, b, c, d] = this.state.matrix.map(SvgContext.number), [e, f] = this.at(x, y).split(" ");
    const place = `${a} ${b} ${c} ${d}` === "1 0 0 1" ? `x="${e}" y="${SvgContext.number(Number(f) + down * size)}"`
      : `transform="matrix(${a} ${b} ${c} ${d} ${e} ${f})" y="${SvgContext.number(down * size)}"`;
    const safe = (words) => String(words).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");
    this.body.push(`<text ${place} font-size="${size}" font-family="${safe(family)}"${weight} text-anchor="${anchor}"` +
      `${this.paint("fill", this.fillStyle)}${this.clipped()}>${safe(text)}</text>`);
  }

  text(title) {
    const clips = [...this.clips].map(([text, id]) => `<clipPath id="clip${id}"${text}</clipPath>`).join("");
    const safe = String(title).replace(/&/g, "&amp;").replace(/</g, "&lt;");
    return `<svg xmlns="${svgSpace}" width="${this.width}" height="${this.height}" viewBox="0 0 ${this.width} ${this.height}">` +
      `<title>${safe}</title><defs>${clips}</defs>\n<rect width="100%" height="100%" fill="#ffffff"/>\n${this.body.join("\n")}\n</svg>\n`;
  }
}
