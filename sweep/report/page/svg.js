// Records what is drawn on a canvas as SVG: lines, areas and texts. The canvas draws on and keeps its state; transform,
// colours, font and dashes of a shape are read from it. Covers the calls of Chart.js and of these figures.
function svgRecorder(context) {
  const shapes = [], open = [0];  // clip groups opened since each save()
  let path = "", clips = 0;
  const round = (x) => Math.round(100 * x) / 100;
  const quoted = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");
  const at = (x, y) => {
    const point = context.getTransform().transformPoint({ x, y });
    return `${round(point.x)} ${round(point.y)}`;
  };
  // A canvas returns its styles as #rrggbb or rgba(r, g, b, a).
  const paint = (kind, style) => {
    const [, rgb, alpha] = /^rgba\((.*), ([\d.]+)\)$/.exec(style) || [];
    const opacity = context.globalAlpha * (rgb ? Number(alpha) : 1);
    return ` ${kind}="${rgb ? `rgb(${rgb})` : style}"` + (opacity < 1 ? ` ${kind}-opacity="${round(opacity)}"` : "");
  };
  const shape = (style) => { if (path) shapes.push(`<path d="${path}"${style}/>`); };
  const recorders = {
    save() { open.push(0); },
    restore() { if (open.length > 1) for (let ends = open.pop(); ends > 0; --ends) shapes.push("</g>"); },
    clip() {
      shapes.push(`<clipPath id="clip${clips}"><path d="${path}"/></clipPath><g clip-path="url(#clip${clips++})">`);
      open[open.length - 1] += 1;
    },
    beginPath() { path = ""; },
    moveTo(x, y) { path += `M${at(x, y)}`; },
    lineTo(x, y) { path += `${path ? "L" : "M"}${at(x, y)}`; },
    bezierCurveTo(a, b, c, d, x, y) { path += `C${at(a, b)} ${at(c, d)} ${at(x, y)}`; },
    closePath() { path += "Z"; },
    rect(x, y, w, h) { path += `M${at(x, y)}L${at(x + w, y)}L${at(x + w, y + h)}L${at(x, y + h)}Z`; },
    // Two halves: one arc command cannot close a circle.
    arc(x, y, r, from, to, backwards) {
      const full = 2 * Math.PI, turn = backwards ? from - to : to - from;
      const angle = (backwards ? -1 : 1) * (turn >= full ? full : ((turn % full) + full) % full);
      const point = (share) => at(x + r * Math.cos(from + share * angle), y + r * Math.sin(from + share * angle));
      const half = (share) => `A${round(r)} ${round(r)} 0 0 ${backwards ? 0 : 1} ${point(share)}`;
      path += (path ? "L" : "M") + point(0) + half(0.5) + half(1);
    },
    fill() { shape(paint("fill", context.fillStyle)); },
    stroke() {
      const dash = context.getLineDash();
      shape(` fill="none"${paint("stroke", context.strokeStyle)} stroke-width="${round(context.lineWidth)}"` +
        ` stroke-linejoin="${context.lineJoin}" stroke-linecap="${context.lineCap}"` + (dash.length > 0 ? ` stroke-dasharray="${dash.join(" ")}"` : ""));
    },
    fillRect(...box) { const before = path; path = ""; recorders.rect(...box); recorders.fill(); path = before; },
    strokeRect(...box) { const before = path; path = ""; recorders.rect(...box); recorders.stroke(); path = before; },
    fillText(text, x, y) {
      const [, style, size, family] = /^(.*?)([\d.]+)px (.*)$/.exec(context.font), { a, b, c, d, e, f } = context.getTransform();
      const anchor = { center: "middle", right: "end", end: "end" }[context.textAlign] || "start";
      const down = { top: 0.8, hanging: 0.8, middle: 0.35, bottom: -0.2 }[context.textBaseline] || 0;
      shapes.push(`<text transform="matrix(${[a, b, c, d, e, f].map((one) => Number(one.toFixed(4))).join(" ")})" x="${round(x)}" y="${round(y + down * size)}"` +
        ` font-size="${size}" font-family="${quoted(family)}"${/bold|[5-9]00/.test(style) ? ' font-weight="bold"' : ""} text-anchor="${anchor}"` +
        `${paint("fill", context.fillStyle)}>${quoted(text)}</text>`);
    },
  };
  for (const [name, record] of Object.entries(recorders)) {
    const draw = context[name];
    context[name] = (...all) => {
      if (all[0] instanceof Path2D) throw new Error("the points of a Path2D cannot be recorded");
      record(...all);
      return draw.apply(context, all);
    };
  }
  return (title, width, height) => `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">` +
    `<title>${quoted(title)}</title>\n<rect width="100%" height="100%" fill="#ffffff"/>\n${shapes.join("\n")}\n</svg>\n`;
}
