// Colours of spheres: a column of the film, or the place at the start, which shows mixing.

// [{key, label, unit, low, high, clipped, signed, shades() -> {data, still}}]
function shadings(film) {
  const { header, spheres: n } = film;
  if (n === 0) return [];
  const found = header.columns.map((column) => ({
    key: column.name, label: words(column.name), unit: column.unit, low: column.low, high: column.high,
    clipped: column.clipped, signed: column.low < 0,
    shades: () => ({ data: new Uint8Array(film.column(column.block, n)), still: false }),
  }));
  const { equal, largest } = header.diameter;
  if (!equal) found.push(stillShading(film, "diameter", "diameter", (i) => film.sizes[i] / 65535 * largest));
  return found.concat([0, 1, 2].map((axis) => placeAtStart(film, axis)));
}

// A shading that stays the same over time: `value` of each mobile sphere, null where it has none.
function stillShading(film, key, label, value) {
  const values = Array.from({ length: film.spheres }, (_, i) => (film.mobile[i] ? value(i) : null));
  const [low, high] = rangeOf(values.filter((x) => x !== null));
  const shade = (x) => (x === null ? 0 : 1 + Math.round(254 * (high > low ? (x - low) / (high - low) : 0)));
  return { key, label, unit: film.header.length_unit, low, high, clipped: false, signed: false,
    shades: () => ({ data: Uint8Array.from(values, shade), still: true }) };
}

function placeAtStart(film, axis) {
  const name = ["x", "y", "z"][axis];
  return stillShading(film, "start " + name, `${name} at the start`, (i) => {
    for (let frame = 0; frame < film.frames; ++frame) {
      const place = placeOf(film, frame, i);
      if (place) return place[axis];
    }
    return null;
  });
}

function valueOfShade({ low, high }, shade) { return low + (shade - 1) / 254 * (high - low); }

function sliceLabel(slice) {
  const name = words(slice.quantity || slice.name);
  return slice.component === 3 || slice.component === -1 ? name : `${name} ${["x", "y", "z"][slice.component]}`;
}
