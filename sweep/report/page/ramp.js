// Scales of colours, from a few colours along them.
function rgb(hex) { return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)); }

// `count` colours [r, g, b], evenly along the scale.
function ramp(hexes, count) {
  const stops = hexes.map(rgb);
  return Array.from({ length: count }, (_, k) => {
    const at = (k / (count - 1)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at));
    return stops[i].map((c, j) => Math.round(c + (at - i) * (stops[i + 1][j] - c)));
  });
}
