// Reads a film: the header, and the packed columns of whole numbers (sweep/report/film_codec.hpp says how).
(function (watch) {
  "use strict";

  /// `frames` x `items` numbers packed from `at` on.
  function unpack(bytes, at, frames, items) {
    const values = new Uint16Array(frames * items);
    let hold = 0, held = 0;
    function bits(n) {
      while (held < n) { hold |= bytes[at++] << held; held += 8; }
      const value = hold & ((1 << n) - 1);
      hold >>>= n;
      held -= n;
      return value;
    }
    function zeros() {
      let count = 0;
      while (hold === 0) { count += held; hold = bytes[at++]; held = 8; }
      const first = 31 - Math.clz32(hold & -hold);
      hold >>>= first + 1;
      held -= first + 1;
      return count + first;
    }
    for (let frame = 0; frame < frames; ++frame) {
      const start = frame * items, before = start - items, earlier = before - items;
      const way = bits(2);
      for (let first = 0; first < items; first += 32) {
        const end = Math.min(first + 32, items), k = bits(5);
        for (let i = first; i < end; ++i) {
          let rest = 0;
          if (k !== 31) {
            const high = zeros();
            const z = high < 24 ? high << k | (k > 0 ? bits(k) : 0) : bits(17);
            rest = z & 1 ? -((z + 1) >> 1) : z >> 1;
          }
          let expected = 0;
          if (way === 0) expected = i > 0 ? values[start + i - 1] : 0;
          else if (way === 1) expected = values[before + i];
          else expected = Math.min(65535, Math.max(0, 2 * values[before + i] - values[earlier + i]));
          values[start + i] = expected + rest;
        }
      }
    }
    return values;
  }

  function bytesOfText(text) {
    const clean = text.trim();
    if (Uint8Array.fromBase64) return Uint8Array.fromBase64(clean);
    const raw = atob(clean), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
    return bytes;
  }

  /// A film as the page holds it, in base64.
  watch.readFilm = function (text) {
    const bytes = bytesOfText(text);
    if (String.fromCharCode(...bytes.subarray(0, 4)) !== "GSF1") throw new Error("this is no film");
    const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(4, true);
    const header = JSON.parse(new TextDecoder().decode(bytes.subarray(8, 8 + length)));
    const blocks = bytes.subarray(8 + length);
    const column = ([at], frames, items) => unpack(blocks, at, frames, items);
    const film = { header, frames: header.times.length, spheres: header.spheres, column };
    film.places = film.spheres > 0 ? interleaved(film) : null;
    film.walls = header.walls.map((wall) => readWall(film, wall));
    return film;
  };

  /// x, y, z of each sphere and whether it is there, four numbers per sphere, frame by frame.
  function interleaved(film) {
    const { header, frames, spheres: n } = film;
    const places = film.column(header.positions.block, frames, 3 * n);
    const present = header.present ? film.column(header.present, frames, n) : null;
    const all = new Uint16Array(4 * n * frames);
    for (let f = 0; f < frames; ++f) {
      for (let i = 0; i < n; ++i) {
        const at = 4 * (f * n + i);
        all[at] = places[3 * f * n + i];
        all[at + 1] = places[(3 * f + 1) * n + i];
        all[at + 2] = places[(3 * f + 2) * n + i];
        all[at + 3] = present ? present[f * n + i] : 1;
      }
    }
    return all;
  }

  function readWall(film, wall) {
    const n = wall.corners, frames = wall.moves ? wall.frames : 1;
    const places = film.column(wall.places, frames, 3 * n);
    const corners = new Float64Array(3 * n * frames);
    for (let f = 0; f < frames; ++f)
      for (let a = 0; a < 3; ++a)
        for (let i = 0; i < n; ++i)
          corners[3 * (f * n + i) + a] = wall.low[a] + wall.step[a] * places[(3 * f + a) * n + i];
    const cells = (list, size) => {
      const raw = film.column(list.block, 1, size * list.count), mixed = new Uint16Array(raw.length);
      for (let i = 0; i < list.count; ++i)
        for (let k = 0; k < size; ++k) mixed[size * i + k] = raw[k * list.count + i];
      return mixed;
    };
    return { name: wall.name, first: wall.first, frames: wall.frames, moves: wall.moves, count: n, corners,
      triangles: cells(wall.triangles, 3), edges: cells(wall.edges, 2) };
  }

  /// Where sphere i is in a frame, in the film's unit; null: not there.
  watch.placeOf = function (film, frame, i) {
    const at = 4 * (frame * film.spheres + i), { low, step } = film.header.positions;
    if (film.places[at + 3] === 0) return null;
    return [0, 1, 2].map((a) => low[a] + step[a] * film.places[at + a]);
  };
})(window.grainsweepWatch = window.grainsweepWatch || {});
