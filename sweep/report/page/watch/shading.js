// What spheres are coloured by: a column of the film, or where each of them was at the start, which shows how they mix.
(function (watch) {
  "use strict";

  /// [{key, label, unit, low, high, clipped, signed, shades() -> {data, still}}]
  watch.shadings = function (film) {
    const { header, frames, spheres: n } = film;
    if (n === 0) return [];
    const found = header.columns.map((column) => ({
      key: column.name, label: watch.words(column.name), unit: column.unit, low: column.low, high: column.high,
      clipped: column.clipped, signed: column.low < 0,
      shades: () => ({ data: new Uint8Array(film.column(column.block, frames, n)), still: false }),
    }));
    if (!header.diameter.equal) found.push(diameters(film));
    return found.concat([0, 1, 2].map((axis) => placeAtStart(film, axis)));
  };

  function paletted(film, value, low, high) {
    const data = new Uint8Array(film.spheres);
    for (let i = 0; i < film.spheres; ++i) {
      const x = value(i);
      if (x !== null) data[i] = 1 + Math.round(254 * (high > low ? Math.min(1, Math.max(0, (x - low) / (high - low))) : 0));
    }
    return data;
  }

  function mobileOnly(film) {
    const mobile = film.header.mobile ? film.column(film.header.mobile, 1, film.spheres) : null;
    return (i) => !mobile || mobile[i] === 1;
  }

  function diameters(film) {
    const shares = film.column(film.header.diameter.block, 1, film.spheres), largest = film.header.diameter.largest;
    const isMobile = mobileOnly(film);
    let low = Infinity;
    shares.forEach((share, i) => { if (isMobile(i)) low = Math.min(low, share / 65535 * largest); });
    return { key: "diameter", label: "diameter", unit: film.header.length_unit, low, high: largest, clipped: false, signed: false,
      shades: () => ({ data: paletted(film, (i) => isMobile(i) ? shares[i] / 65535 * largest : null, low, largest), still: true }) };
  }

  function placeAtStart(film, axis) {
    const name = ["x", "y", "z"][axis], { low, step } = film.header.positions, isMobile = mobileOnly(film);
    const first = (i) => {
      for (let f = 0; f < film.frames; ++f)
        if (film.places[4 * (f * film.spheres + i) + 3]) return low[axis] + step[axis] * film.places[4 * (f * film.spheres + i) + axis];
      return null;
    };
    let least = Infinity, most = -Infinity;
    for (let i = 0; i < film.spheres; ++i) {
      const x = isMobile(i) ? first(i) : null;
      if (x !== null) { least = Math.min(least, x); most = Math.max(most, x); }
    }
    return { key: "start " + name, label: `${name} at the start`, unit: film.header.length_unit, low: least, high: most,
      clipped: false, signed: false,
      shades: () => ({ data: paletted(film, (i) => isMobile(i) ? first(i) : null, least, most), still: true }) };
  }

  /// The value that a shade stands for.
  watch.valueOfShade = (shading, shade) => shade === 0 ? NaN : shading.low + (shade - 1) / 254 * (shading.high - shading.low);

  watch.sliceLabel = function (slice) {
    const name = watch.words(slice.quantity || slice.name);
    return slice.component === 3 || slice.component === -1 ? name : `${name} ${["x", "y", "z"][slice.component]}`;
  };
})(window.grainsweepWatch = window.grainsweepWatch || {});
