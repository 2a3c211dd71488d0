// Reads a film: a header, and deflated columns of whole numbers (sweep/report/packed_column.hpp).
function unfiltered(bytes, items) {
  const values = new Uint16Array(bytes.length / 2), n = values.length;
  for (let i = 0; i < n; ++i) {
    const z = bytes[i] | bytes[n + i] << 8, expected = i >= items ? values[i - items] : i > 0 ? values[i - 1] : 0;
    values[i] = expected + (z >> 1 ^ -(z & 1));  // modulo 2^16
  }
  return values;
}

// The film that the page holds in base64.
async function readFilm(text) {
  const bytes = bytesOf(text.trim());
  if (String.fromCharCode(...bytes.subarray(0, 4)) !== "GSF2") throw new Error("this is no film");
  const length = new DataView(bytes.buffer).getUint32(4, true);
  const header = JSON.parse(new TextDecoder().decode(bytes.subarray(8, 8 + length)));
  let end = 8 + length;
  const blocks = await Promise.all(header.blocks.map((size) => inflated(bytes.subarray(end, end += size))));
  const column = (block, items) => unfiltered(blocks[block], items);  // frame by frame, `items` in each
  const film = { header, frames: header.times.length, spheres: header.spheres, column };
  if (film.spheres > 0) {
    film.places = interleaved(film);
    film.sizes = column(header.diameter.block, film.spheres);  // 65535: the largest
    film.mobile = header.mobile === undefined ? new Uint8Array(film.spheres).fill(1) : Uint8Array.from(column(header.mobile, film.spheres));
  }
  film.walls = header.walls.map((wall) => readWall(film, wall));
  film.forces = header.forces === undefined ? null : readForces(film, header.forces);
  return film;
}

// x, y, z and presence of each sphere, frame by frame.
function interleaved(film) {
  const { header, frames, spheres: n } = film;
  const places = film.column(header.positions.block, 3 * n);
  const present = header.present === undefined ? null : film.column(header.present, n);
  const all = new Uint16Array(4 * n * frames);
  for (let f = 0; f < frames; ++f)
    for (let i = 0; i < n; ++i) {
      const at = 4 * (f * n + i);
      for (let a = 0; a < 3; ++a) all[at + a] = places[(3 * f + a) * n + i];
      all[at + 3] = present ? present[f * n + i] : 1;
    }
  return all;
}

function readWall(film, wall) {
  const n = wall.corners, frames = wall.moves ? wall.frames : 1;
  const places = film.column(wall.places, 3 * n);
  const corners = new Float64Array(3 * n * frames);
  for (let f = 0; f < frames; ++f)
    for (let a = 0; a < 3; ++a)
      for (let i = 0; i < n; ++i)
        corners[3 * (f * n + i) + a] = wall.low[a] + wall.step[a] * places[(3 * f + a) * n + i];
  return { name: wall.name, first: wall.first, frames: wall.frames, moves: wall.moves, count: n, corners,
    triangles: film.column(wall.triangles, 3), edges: film.column(wall.edges, 2) };
}

// Contacts of two spheres: those of frame f are the numbers begins[f] to begins[f + 1].
function readForces(film, forces) {
  const begins = [0];
  forces.counts.forEach((count, f) => begins.push(begins[f] + count));
  const all = Math.max(1, begins[begins.length - 1]), first = film.column(forces.first, all), between = film.column(forces.between, all);
  return { begins, first, second: first.map((i, k) => i + between[k]), shades: film.column(forces.shades, all), low: forces.low, high: forces.high };
}

// Where sphere i is in a frame, in the film's unit; null: not there.
function placeOf(film, frame, i) {
  const at = 4 * (frame * film.spheres + i), { low, step } = film.header.positions;
  if (film.places[at + 3] === 0) return null;
  return [0, 1, 2].map((a) => low[a] + step[a] * film.places[at + a]);
}
