// The page of one case: facts about it, and the player.
function value([name, number, unit]) {
  if (typeof number !== "number") {
    const [, file] = /^file:[0-9a-f]+:(.+)$/.exec(number) || [];
    return file ? [`${words(name)} `, el("span", { title: file }, file.replace(/^.*[/]/, ""))] : `${words(name)} ${number}`;
  }
  const [digits, ...rest] = measured(number, unit, 4).split(" ");
  return [`${words(name)} `, el("b", {}, digits), ` ${rest.join(" ")}`];
}

const keys = [["space", "play or pause"], ["← →", "previous or next frame"], ["Home End", "first or last frame"], ["+ −", "zoom"], ["c", "next colour"],
  ["w", "walls"], ["f", "frozen spheres"], ["n", "forces"], ["1 2 3 4", "views"]];

function facts(film) {
  const { about, spheres, particles, left_out: left } = film.header;
  const thinned = spheres < particles ? ` · ${spheres} of ${particles} particles, chosen at random` : "";
  const list = (entries) => el("div", { class: "watch-facts" }, entries.map((one) => el("div", {}, value(one))));
  return [
    el("div", {}, el("h1", {}, about.title), el("span", { class: "watch-quiet" }, ` ${about.subtitle || ""}${thinned}`)),
    about.message ? el("p", {}, about.message) : null,
    left.length > 0 ? el("p", { class: "watch-quiet" }, `Omitted to limit the size of the page: ${left.map(words).join(", ")}.`) : null,
    about.results.length > 0 ? el("div", { class: "watch-results" }, about.results.slice(0, 6).map((one) => el("span", {}, value(one)))) : null,
    el("details", {}, el("summary", {}, "Keys, inputs and results"),
      el("p", { class: "watch-quiet" }, "Drag to turn. Drag with the right button, Shift or two fingers to move. Turn the wheel or pinch to zoom. Click a sphere to see its numbers."),
      el("p", { class: "watch-keys watch-quiet" }, keys.map(([key, does]) => el("span", {}, el("kbd", {}, key), ` ${does}`))),
      list(about.inputs), list(about.results)),
  ].filter(Boolean);
}

// A button that reads another page of this kind and shows its case beside this one.
function comparison(compare) {
  const said = el("span", { class: "watch-problem-line" });
  const file = el("input", { type: "file", accept: ".html", hidden: true, change: async () => {
    said.textContent = "";
    try { await compare(await file.files[0].text()); } catch (error) { said.textContent = ` ${error.message}`; }
    file.value = "";
  } });
  return el("span", { class: "watch-compare" }, button("compare with another page …", () => file.click(), { title: "shows the case of another page of --watch beside this one" }), file, said);
}

async function start() {
  const film = await readFilm(document.getElementById("watch-film").textContent), place = document.getElementById("player");
  document.title = film.header.about.title;
  const shown = { player: new Player(place, film) };
  const [, share] = /^#t=([0-9.]+)/.exec(location.hash) || [];  // of the film
  const begin = () => (share ? shown.player.show(Number(share) * (shown.player.film.frames - 1)) : shown.player.startByItself());
  shown.compare = async (text) => {
    const other = await filmOfPage(text);
    shown.player.free();
    shown.player = pairOf(place, film, other);
    begin();
  };
  document.getElementById("facts").replaceChildren(...facts(film), comparison(shown.compare));
  begin();
  window.grainsweepWatch = shown;  // for the console
}

start().catch((error) => document.getElementById("player").replaceChildren(el("p", { class: "watch-problem" }, `This film cannot be shown: ${error.message}`)));
