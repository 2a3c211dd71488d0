// The page of one case: what it is, and the player. With #selftest it says in an attribute of its root what it drew.
(function (watch) {
  "use strict";
  const { el } = watch;
  const errors = [];
  window.addEventListener("error", (event) => errors.push(event.message));
  window.addEventListener("unhandledrejection", (event) => errors.push(String(event.reason)));

  function value([name, number, unit]) {
    if (typeof number !== "number") return `${watch.words(name)} ${number}`;
    const scale = watch.unitFor(Math.abs(number), unit);
    return [`${watch.words(name)} `, el("b", {}, watch.number(number * scale.factor, 4)), scale.unit ? " " + scale.unit : ""];
  }

  function facts(film) {
    const { about, spheres, particles, left_out: left } = film.header;
    const thinned = spheres < particles ? ` · ${spheres} of ${particles} particles are drawn, chosen at random` : "";
    const lines = [
      el("div", {}, el("h1", {}, about.title), el("span", { class: "watch-quiet" }, about.subtitle ? ` ${about.subtitle}${thinned}` : thinned)),
      about.message ? el("p", {}, about.message) : null,
      left.length > 0 ? el("p", { class: "watch-quiet" }, `Left out to keep the page small: ${left.map(watch.words).join(", ")}.`) : null,
      about.results.length > 0 ? el("div", { class: "watch-results" }, about.results.slice(0, 6).map((one) => el("span", {}, value(one)))) : null,
      el("details", {}, el("summary", {}, "inputs, results and keys"),
        el("div", { class: "watch-facts" }, about.inputs.map((one) => el("div", {}, value(one)))),
        el("div", { class: "watch-facts" }, about.results.map((one) => el("div", {}, value(one)))),
        el("p", { class: "watch-keys watch-quiet" }, "turn: drag or one finger · shift: right button, Shift or two fingers · closer: wheel or pinch · a click names a sphere · ",
          [["space", "play"], ["← →", "frame"], ["Home End", "first, last"], ["+ −", "closer, farther"], ["c", "colour"], ["w", "walls"], ["f", "frozen spheres"], ["1 2 3 4", "views"]]
            .map(([keys, does]) => [el("kbd", {}, keys), ` ${does}  `]))),
    ];
    document.getElementById("facts").replaceChildren(...lines.filter(Boolean));
  }

  /// Pixels of a moment.
  function pixels(player, moment) {
    const { gl, canvas } = player.painter, bytes = new Uint8Array(4 * canvas.width * canvas.height);
    player.moment = moment;
    player.paint();
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes;
  }

  function differing(a, b) {
    let count = 0;
    for (let i = 0; i < a.length; i += 4) count += a[i] !== b[i] || a[i + 1] !== b[i + 1] || a[i + 2] !== b[i + 2] ? 1 : 0;
    return count;
  }

  function selfTest(player) {
    const { film } = player, last = film.frames - 1, ground = player.ground.map((c) => Math.round(255 * c));
    const first = pixels(player, 0), end = pixels(player, last);
    let painted = 0;
    for (let i = 0; i < first.length; i += 4) painted += Math.abs(first[i] - ground[0]) + Math.abs(first[i + 1] - ground[1]) > 2 ? 1 : 0;
    const told = { frames: film.frames, spheres: film.spheres, pixels: first.length / 4, painted, differing: differing(first, end) };
    if (film.spheres > 0) {
      const sum = (frame) => {
        let all = [0, 0, 0], count = 0;
        for (let i = 0; i < film.spheres; ++i) {
          const place = watch.placeOf(film, frame, i);
          if (place) { all = all.map((s, a) => s + place[a]); ++count; }
        }
        return { count, mean: all.map((s) => s / Math.max(count, 1)) };
      };
      told.first = sum(0);
      told.last = sum(last);
      const middle = Math.floor(last / 2), before = pixels(player, middle);
      told.colours = player.shadings.map((shading) => { player.colourBy(shading.key); return [shading.key, differing(before, pixels(player, middle))]; });
      player.colourBy(player.shadings[0].key);
      player.painter.show.walls = false;
      told.walls = differing(before, pixels(player, middle));
      player.painter.show.walls = true;
    }
    told.slices = film.header.slices.map((slice, k) => {
      player.chooseSlice(-1);
      const without = pixels(player, last);
      player.chooseSlice(k);
      return differing(without, pixels(player, last));
    });
    player.camera.turn(0.7, 0.2);
    told.turned = differing(end, pixels(player, last));
    told.graphics = player.painter.gl.getError();
    return told;
  }

  try {
    const film = watch.readFilm(document.getElementById("watch-film").textContent);
    document.title = film.header.about.title;
    facts(film);
    const player = watch.mount(document.getElementById("player"), film);
    watch.player = player;
    const start = /^#t=([0-9.]+)/.exec(location.hash);  // a share of the film
    if (start) player.show(Number(start[1]) * (film.frames - 1));
    else if (location.hash !== "#selftest") player.startByItself();
    if (location.hash === "#selftest") {
      try {
        document.documentElement.dataset.selftest = JSON.stringify(selfTest(player));
      } catch (error) {
        errors.push(String(error));
      }
    }
  } catch (error) {
    errors.push(String(error));
    document.getElementById("player").replaceChildren(el("p", { class: "watch-problem" }, `This film cannot be shown: ${error.message}`));
  }
  document.documentElement.dataset.errors = JSON.stringify(errors);
})(window.grainsweepWatch = window.grainsweepWatch || {});
