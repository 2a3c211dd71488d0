// Colour scales, and numbers in words: units with the prefix that suits them.
(function (watch) {
  "use strict";
  // From dark to bright, evenly to the eye and safe for the colour-blind, for what has a size; from blue over white to
  // red for what has a sign.
  const scales = {
    spheres: ["#4a1f78", "#4b3086", "#3e4a89", "#31688e", "#26838f", "#1f9d8a", "#6cce5a", "#b6de2b", "#fee825"],
    slices: ["#0b0724", "#35115f", "#721f81", "#b73779", "#f1605d", "#feb078", "#fcfdbf"],
    signed: ["#2b4ab8", "#6f92f3", "#aac7fd", "#e4e4e8", "#f7b89c", "#e7745b", "#b40426"],
  };

  function rgb(hex) { return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)); }

  /// 256 x 4 bytes.
  watch.palette = function (kind) {
    const stops = scales[kind].map(rgb);
    const bytes = new Uint8Array(256 * 4);
    for (let i = 0; i < 256; ++i) {
      const at = i / 255 * (stops.length - 1), k = Math.min(stops.length - 2, Math.floor(at)), share = at - k;
      for (let c = 0; c < 3; ++c) bytes[4 * i + c] = Math.round(stops[k][c] + share * (stops[k + 1][c] - stops[k][c]));
      bytes[4 * i + 3] = 255;
    }
    return bytes;
  };

  watch.gradient = function (kind) {
    return `linear-gradient(to right, ${scales[kind].join(", ")})`;
  };

  const prefixes = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
  const prefixed = new Set(["m", "s", "N", "Pa", "m/s", "J", "Hz"]);

  /// {factor, unit}: numbers up to `size` times the factor read well in the unit.
  watch.unitFor = function (size, unit) {
    if (!unit || unit === "1") return { factor: 1, unit: "" };
    const pretty = unit.replace("alpha", "α").replace("^2", "²").replace("DT", "ΔT");
    if (!prefixed.has(unit) || !(size > 0)) return { factor: 1, unit: pretty };
    const [value, prefix] = prefixes.find(([v]) => size >= v * 0.9999) || prefixes[prefixes.length - 1];
    return { factor: 1 / value, unit: prefix + pretty };
  };

  watch.number = function (x, digits = 3) {
    if (!Number.isFinite(x)) return "–";
    const size = Math.abs(x);
    if (size !== 0 && (size >= 1e5 || size < 1e-3)) {
      const [mantissa, power] = x.toExponential(digits - 1).split("e");
      return `${Number(mantissa)}·10${[...String(Number(power))].map((c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join("")}`;
    }
    return String(Number(x.toPrecision(digits))).replace("-", "−");
  };

  watch.words = (name) => name.replace(/_/g, " ");
})(window.grainsweepWatch = window.grainsweepWatch || {});
