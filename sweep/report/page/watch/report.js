// Plays the films in a report: in the case panel, when the selected case has one.
const films = new Map();  // by campaign and case
for (const script of document.querySelectorAll("script[data-film]")) {
  const { campaign, case: id, says } = script.dataset;
  films.set(`${campaign}/${id}`, { campaign, id, says, script });
}
let player = null;

// The machine of the shown campaign, above its figures.
let drawn = { campaign: null };
async function showMachine(campaign) {
  if (drawn.campaign === campaign) return;
  if (drawn.player) drawn.player.free();
  if (drawn.place) drawn.place.remove();
  const mine = drawn = { campaign }, film = films.get(`${campaign}/`);
  if (!film) return;
  const stage = el("div", { class: "watch-inset" });
  mine.place = el("section", { class: "watch-machine", "aria-label": film.says }, stage);
  document.getElementById("page").before(mine.place);
  try {
    const read = await readFilm(film.script.textContent);
    if (drawn === mine) mine.player = new Player(stage, read);
  } catch (error) {
    stage.replaceChildren(el("p", { class: "watch-problem" }, `This drawing cannot be shown: ${error.message}`));
  }
}

function close() {
  if (player) player.free();
  player = null;
}

async function play(place, { script }) {
  const stage = el("div", { class: "watch-inset" });
  place.replaceChildren(stage);
  try {
    const film = await readFilm(script.textContent);
    if (!stage.isConnected) return;  // another case was selected meanwhile
    player = new Player(stage, film);
    player.startByItself();
  } catch (error) {
    stage.replaceChildren(el("p", { class: "watch-problem" }, `This film cannot be shown: ${error.message}`));
  }
}

function showFilm({ campaign, case_id: id }) {
  const film = films.get(`${campaign}/${id}`), place = document.querySelector("#case-panel .watch");
  close();
  document.body.classList.toggle("with-film", Boolean(film));
  if (film) play(place, film);
}
document.addEventListener("grainsweep:case", (event) => showFilm(event.detail));
document.addEventListener("grainsweep:closed", () => showFilm({}));
window.grainsweepWatch = { hasFilm: (campaign, id) => films.has(`${campaign}/${id}`), films: () => [...films.values()].filter((film) => film.id !== ""), showMachine };
