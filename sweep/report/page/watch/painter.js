// Draws one moment of a film: spheres, walls, a slice of the flow. Everything is on the graphics processor from the
// start; a frame only says where in the buffers to read.

const wallColours = {
  hot_wall: [0.85, 0.2, 0.15, 0.2], cold_wall: [0.15, 0.4, 0.9, 0.2], blade: [0.55, 0.62, 0.72, 0.5],
  base: [0.66, 0.68, 0.71, 0.5], cell: [0.45, 0.62, 0.82, 0.3],
};
// Copies of a repeated wall are called NAME_1, NAME_2, ...
const wallGroup = (name) => name.replace(/_[0-9]+$/, "");
const wallColour = (name) => wallColours[name] || [0.6, 0.63, 0.68, 0.28];

class Painter {
  constructor(canvas, film, extent) {
    this.canvas = canvas;
    this.film = film;
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("this browser does not offer WebGL 2");
    this.gl = gl;
    this.programs = programs(gl);
    this.extent = extent;
    this.show = { frozen: true, walls: true, forces: false, hidden: new Set(), slice: -1, plane: 1, size: 1, cut: null, chosen: -1, colours: [0, 1] };
    if (film.spheres > 0) this.prepareSpheres();
    if (film.forces) this.forces = { corners: this.buffer(new Float32Array([0, -1, 1, -1, 0, 1, 1, 1])), lines: gl.createBuffer() };
    this.prepareWalls();
    this.prepareSlices();
    this.setPalette("spheres", "spheres");
  }

  // World -> units of the picture.
  inPicture(x) { return x.map((value, a) => (value - this.extent.middle[a]) / this.extent.size); }
  box() {
    return { low: this.inPicture(this.extent.low), high: this.inPicture(this.extent.high) };
  }

  buffer(data, target) {
    const { gl } = this, made = gl.createBuffer(), kind = target || gl.ARRAY_BUFFER;
    gl.bindBuffer(kind, made);
    gl.bufferData(kind, data, gl.STATIC_DRAW);
    return made;
  }

  texture(width, height, format, data, filter) {
    const { gl } = this, made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, format === gl.RED ? gl.R8 : gl.RGBA, width, height, 0, format, gl.UNSIGNED_BYTE, data);
    for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, filter], [gl.TEXTURE_MAG_FILTER, filter],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_2D, key, value);
    return made;
  }

  setPalette(which, kind) {
    const { gl } = this;
    this.palettes = this.palettes || {};
    if (this.palettes[which]) gl.deleteTexture(this.palettes[which]);
    this.palettes[which] = this.texture(256, 1, gl.RGBA, palette(kind), gl.LINEAR);
  }

  prepareSpheres() {
    const { film } = this;
    this.spheres = {
      corners: this.buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1])),
      places: this.buffer(film.places),
      sizes: this.buffer(film.sizes),
      mobile: this.buffer(film.mobile),
      shades: this.buffer(new Uint8Array(film.spheres)), still: true,
    };
  }

  // One byte per sphere, of every frame or (`still`) once for all.
  setShades(shades, still) {
    const { gl, spheres } = this;
    gl.deleteBuffer(spheres.shades);
    spheres.shades = this.buffer(shades);
    spheres.still = still;
  }

  prepareWalls() {
    const { gl } = this;
    this.walls = this.film.walls.map((wall) => {
      const places = new Float32Array(wall.corners.length);
      for (let i = 0; i < places.length; ++i)
        places[i] = (wall.corners[i] - this.extent.middle[i % 3]) / this.extent.size;
      const round = !wall.moves && wall.triangles.length > 600;
      return Object.assign({}, wall, { all: places, places: this.buffer(places), round, colour: wallColour(wall.name),
        normals: this.buffer(round ? normals(places, wall.triangles) : new Float32Array(places.length)),
        triangleIndices: this.buffer(wall.triangles, gl.ELEMENT_ARRAY_BUFFER),
        edgeIndices: this.buffer(wall.edges, gl.ELEMENT_ARRAY_BUFFER) });
    });
  }

  prepareSlices() {
    this.slices = this.film.header.slices.map((slice) => {
      const axes = [0, 1, 2].map((axis) => {
        const [u, v] = [0, 1, 2].filter((a) => a !== axis), faces = [slice.faces[u], slice.faces[v]];
        const corners = [], cells = [], indices = [], n = faces.map((f) => f.length);
        const middle = (slice.faces[axis][0] + slice.faces[axis][slice.faces[axis].length - 1]) / 2;
        for (let j = 0; j < n[1]; ++j)
          for (let i = 0; i < n[0]; ++i) {
            const x = [0, 0, 0];
            x[axis] = middle; x[u] = faces[0][i]; x[v] = faces[1][j];
            corners.push(...this.inPicture(x));
            cells.push(i / (n[0] - 1), j / (n[1] - 1));
            if (i + 1 < n[0] && j + 1 < n[1]) {
              const at = i + n[0] * j;
              indices.push(at, at + 1, at + n[0], at + 1, at + n[0] + 1, at + n[0]);
            }
          }
        return { width: n[0] - 1, height: n[1] - 1, count: indices.length, corners: this.buffer(new Float32Array(corners)),
          cells: this.buffer(new Float32Array(cells)), indices: this.buffer(new Uint16Array(indices), this.gl.ELEMENT_ARRAY_BUFFER), textures: null };
      });
      return { slice, axes };
    });
  }

  // One texture per frame of a plane, made when it is first looked at.
  textures(which, axis) {
    const { slice, axes } = this.slices[which], plane = axes[axis];
    if (!plane.textures) {
      const values = this.film.column(slice.planes[axis], plane.width * plane.height);
      plane.textures = [];
      for (let f = 0; f < this.film.frames; ++f)
        plane.textures.push(this.texture(plane.width, plane.height, this.gl.RED,
          new Uint8Array(values.subarray(f * plane.width * plane.height, (f + 1) * plane.width * plane.height)), this.gl.LINEAR));
    }
    return plane.textures;
  }

  attribute(location, buffer, size, type, normalised, stride, offset, divisor) {
    const { gl } = this;
    if (location === undefined) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, type, normalised, stride, offset);
    gl.vertexAttribDivisor(location, divisor);
    this.used.push(location);
  }

  begin({ program, at }, camera) {
    const { gl } = this;
    (this.used || []).forEach((location) => { gl.vertexAttribDivisor(location, 0); gl.disableVertexAttribArray(location); });
    this.used = [];
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.view, false, camera.view);
    gl.uniformMatrix4fv(at.projection, false, camera.projection);
  }

  // `moment`: frame number with the share of the way to the next one. `ground`: [r, g, b].
  paint(moment, camera, ground) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...ground, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const frame = Math.min(this.film.frames - 1, Math.floor(moment)), next = Math.min(this.film.frames - 1, frame + 1);
    const between = moment - frame, matrices = camera.matrices(canvas.width, canvas.height);
    if (this.film.spheres > 0) this.paintSpheres(frame, next, between, matrices);
    if (this.film.forces && this.show.forces) this.paintForces(frame, next, between, matrices);
    if (this.show.slice >= 0) this.paintSlice(frame, next, between, matrices);
    if (this.show.walls) this.paintWalls(frame, next, between, matrices, ground);
    return matrices;
  }

  paintSpheres(frame, next, between, matrices) {
    const { gl, film, spheres, show } = this, { program, in: input, at } = this.programs.spheres, n = film.spheres;
    this.begin(this.programs.spheres, matrices);
    const { low, step } = film.header.positions, size = this.extent.size;
    gl.uniform3fv(at.low, this.inPicture(low));
    gl.uniform3fv(at.scale, step.map((s) => s / size));
    gl.uniform3fv(at.period, film.header.periods.map((p) => p / size));
    gl.uniform1f(at.between, between);
    gl.uniform1f(at.radius, this.radius() * show.size * (show.forces ? 0.3 : 1));  // forces lie inside of the spheres
    gl.uniform1f(at.least, 2.2 * matrices.tangent / this.canvas.height);
    gl.uniform1f(at.showFrozen, show.frozen ? 1 : 0);
    gl.uniform4fv(at.cut, show.cut ? show.cut : [0, 0, 0, 1]);
    gl.uniform2fv(at.colours, show.colours);
    gl.uniform1i(at.chosen, show.chosen);
    gl.uniform3fv(at.frozenColour, [0.6, 0.61, 0.63]);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.palettes.spheres);
    gl.uniform1i(at.palette, 0);
    this.attribute(input.corner, spheres.corners, 2, gl.FLOAT, false, 0, 0, 0);
    this.attribute(input.place, spheres.places, 4, gl.UNSIGNED_SHORT, false, 0, 8 * n * frame, 1);
    this.attribute(input.next, spheres.places, 4, gl.UNSIGNED_SHORT, false, 0, 8 * n * next, 1);
    this.attribute(input.size, spheres.sizes, 1, gl.UNSIGNED_SHORT, true, 0, 0, 1);
    this.attribute(input.mobile, spheres.mobile, 1, gl.UNSIGNED_BYTE, false, 0, 0, 1);
    this.attribute(input.shade, spheres.shades, 1, gl.UNSIGNED_BYTE, false, 0, spheres.still ? 0 : n * frame, 1);
    this.attribute(input.nextShade, spheres.shades, 1, gl.UNSIGNED_BYTE, false, 0, spheres.still ? 0 : n * next, 1);
    gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, n);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  }

  // Lines between the centres of touching spheres, of the contacts of the frame before the moment. The widest is as
  // wide as half of the largest sphere.
  paintForces(frame, next, between, matrices) {
    const { gl, film } = this, { in: input, at } = this.programs.forces, { begins, first, second, shades, low, high } = film.forces;
    const begin = begins[frame], count = begins[frame + 1] - begin, largest = Math.max(Math.abs(low), Math.abs(high));
    if (count === 0 || !(largest > 0)) return;
    const { low: from, step } = film.header.positions, { periods } = film.header, n = film.spheres;
    const place = (i, a) => {
      const now = 4 * (n * frame + i), then = 4 * (n * next + i);
      let way = film.places[then + 3] ? step[a] * (film.places[then + a] - film.places[now + a]) : 0;
      if (periods[a] > 0) way -= periods[a] * Math.round(way / periods[a]);
      return from[a] + step[a] * film.places[now + a] + between * way;
    };
    const lines = new Float32Array(8 * count);
    for (let k = 0; k < count; ++k) {
      const i = first[begin + k], j = second[begin + k], force = low + (shades[begin + k] - 1) / 254 * (high - low);
      for (let a = 0; a < 3; ++a) {
        const x = place(i, a);
        let way = place(j, a) - x;
        if (periods[a] > 0) way -= periods[a] * Math.round(way / periods[a]);
        lines[8 * k + a] = (x - this.extent.middle[a]) / this.extent.size;
        lines[8 * k + 3 + a] = lines[8 * k + a] + way / this.extent.size;
      }
      lines[8 * k + 6] = 0.25 * this.radius() * this.show.size * Math.min(1, Math.abs(force) / largest);
      lines[8 * k + 7] = force < 0 ? 1 : 0;
    }
    this.begin(this.programs.forces, matrices);
    gl.uniform4fv(at.cut, this.show.cut ? this.show.cut : [0, 0, 0, 1]);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.forces.lines);
    gl.bufferData(gl.ARRAY_BUFFER, lines, gl.DYNAMIC_DRAW);
    this.attribute(input.corner, this.forces.corners, 2, gl.FLOAT, false, 0, 0, 0);
    this.attribute(input.from, this.forces.lines, 3, gl.FLOAT, false, 32, 0, 1);
    this.attribute(input.to, this.forces.lines, 3, gl.FLOAT, false, 32, 12, 1);
    this.attribute(input.width, this.forces.lines, 1, gl.FLOAT, false, 32, 24, 1);
    this.attribute(input.attracts, this.forces.lines, 1, gl.FLOAT, false, 32, 28, 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }

  // Of the largest sphere, in the picture's unit; where the scene names none, a small share of what is seen.
  radius() {
    const { largest } = this.film.header.diameter;
    return largest > 0 ? largest / 2 / this.extent.size : 0.004;
  }

  paintSlice(frame, next, between, matrices) {
    const { gl } = this, { in: input, at } = this.programs.slices;
    const plane = this.slices[this.show.slice].axes[this.show.plane], textures = this.textures(this.show.slice, this.show.plane);
    this.begin(this.programs.slices, matrices);
    [textures[frame], textures[next], this.palettes.slices].forEach((texture, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    });
    gl.uniform1i(at.now, 0);
    gl.uniform1i(at.after, 1);
    gl.uniform1i(at.palette, 2);
    gl.uniform1f(at.between, between);
    gl.uniform1f(at.opacity, 0.92);
    this.attribute(input.corner, plane.corners, 3, gl.FLOAT, false, 0, 0, 0);
    this.attribute(input.cell, plane.cells, 2, gl.FLOAT, false, 0, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, plane.indices);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.drawElements(gl.TRIANGLES, plane.count, gl.UNSIGNED_SHORT, 0);
    gl.disable(gl.BLEND);
  }

  paintWalls(frame, next, between, matrices, ground) {
    const line = ground[0] < 0.5 ? [0.75, 0.8, 0.86, 0.8] : [0.3, 0.35, 0.42, 0.8];
    const { gl } = this, { in: input, at } = this.programs.walls;
    this.begin(this.programs.walls, matrices);
    gl.uniform1f(at.top, this.box().high[2] + 0.02);
    gl.uniform4fv(at.cut, this.show.cut ? this.show.cut : [0, 0, 0, 1]);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    gl.depthMask(false);
    for (const wall of this.walls) {
      if (frame < wall.first || frame >= wall.first + wall.frames || this.show.hidden.has(wallGroup(wall.name))) continue;
      if (wall.moves) this.moveWall(wall, frame, next, between);
      this.attribute(input.corner, wall.places, 3, gl.FLOAT, false, 0, 0, 0);
      this.attribute(input.normal, wall.normals, 3, gl.FLOAT, false, 0, 0, 0);
      gl.uniform1f(at.smooth_, wall.round ? 1 : 0);
      if (wall.triangles.length > 0) {
        gl.uniform4fv(at.tint, wall.colour);
        gl.uniform1f(at.lit, 1);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, wall.triangleIndices);
        gl.drawElements(gl.TRIANGLES, wall.triangles.length, gl.UNSIGNED_SHORT, 0);
      }
      if (wall.edges.length > 0) {
        gl.uniform4fv(at.tint, line);
        gl.uniform1f(at.lit, 0);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, wall.edgeIndices);
        gl.drawElements(gl.LINES, wall.edges.length, gl.UNSIGNED_SHORT, 0);
      }
    }
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  // Puts the wall's corners where they are between two frames.
  moveWall(wall, frame, next, between) {
    const { gl } = this, size = 3 * wall.count, corners = new Float32Array(size);
    const a = size * (frame - wall.first), b = size * Math.min(next - wall.first, wall.frames - 1);
    for (let i = 0; i < size; ++i) corners[i] = wall.all[a + i] + between * (wall.all[b + i] - wall.all[a + i]);
    gl.bindBuffer(gl.ARRAY_BUFFER, wall.places);
    gl.bufferData(gl.ARRAY_BUFFER, corners, gl.DYNAMIC_DRAW);
  }

  free() {
    const lost = this.gl.getExtension("WEBGL_lose_context");
    if (lost) lost.loseContext();
  }
}

// What the camera looks at: where the spheres of the first frame are and those of the others but for a few that fly,
// or the flow's box; of walls those that end near there. A machine that is drawn is seen as a whole, unless its particles
// would be lost in it.
function extentOf(film) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const take = (a, x) => { low[a] = Math.min(low[a], x); high[a] = Math.max(high[a], x); };
  if (film.spheres > 0) {
    const { header, places, spheres: n } = film, { low: from, step } = header.positions;
    for (let a = 0; a < 3; ++a) {
      const all = [];
      const every = Math.max(1, Math.floor(n * film.frames / 60000));
      for (let i = 0; i < n * film.frames; i += every) if (places[4 * i + 3]) all.push(places[4 * i + a]);
      all.sort((x, y) => x - y);
      const at = (share) => from[a] + step[a] * all[Math.round(share * (all.length - 1))];
      take(a, at(0.002));
      take(a, at(0.998));
      for (let i = 0; i < n; ++i) if (places[4 * i + 3]) take(a, from[a] + step[a] * places[4 * i + a]);
      low[a] -= header.diameter.largest / 2;
      high[a] += header.diameter.largest / 2;
    }
  }
  for (const slice of film.header.slices)
    slice.faces.forEach((faces, a) => { take(a, faces[0]); take(a, faces[faces.length - 1]); });
  const size = Math.max(...high.map((h, a) => h - low[a]), 1e-12);
  const nothing = film.spheres === 0 && film.header.slices.length === 0, mostTimes = 8;
  const walls = film.walls.map((wall) => [0, 1, 2].map((a) => {
    let least = Infinity, most = -Infinity;
    for (let i = a; i < wall.corners.length; i += 3) { least = Math.min(least, wall.corners[i]); most = Math.max(most, wall.corners[i]); }
    return [least, most];
  }));
  const across = (a) => Math.max(...walls.map((ends) => ends[a][1])) - Math.min(...walls.map((ends) => ends[a][0]));
  const lost = film.spheres > 0 && Math.max(...[0, 1, 2].map(across)) > mostTimes * size;
  const whole = nothing || film.header.about.drawing && !lost;
  for (const ends of walls) {
    if (whole || ends.every(([least, most], a) => least > low[a] - 0.25 * size && most < high[a] + 0.25 * size))
      ends.forEach(([least, most], a) => { take(a, least); take(a, most); });
  }
  return { low, high, size: Math.max(...high.map((h, a) => h - low[a]), 1e-12), middle: high.map((h, a) => (h + low[a]) / 2) };
}

function normals(places, triangles) {
  const all = new Float32Array(places.length);
  const at = (i) => [places[3 * i], places[3 * i + 1], places[3 * i + 2]];
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [triangles[t], triangles[t + 1], triangles[t + 2]];
    const area = cross(sub(at(b), at(a)), sub(at(c), at(a)));
    for (const i of [a, b, c]) for (let k = 0; k < 3; ++k) all[3 * i + k] += area[k];
  }
  return all;
}
