// Plays the films in a report: in the case panel, when the selected case has one.
const films = new Map();  // by campaign and case
for (const script of document.querySelectorAll("script[data-film]")) {
  const { campaign, case: id, says } = script.dataset;
  films.set(`${campaign}/${id}`, { campaign, id, says, script });
}
let player = null;

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
window.grainsweepWatch = { hasFilm: (campaign, id) => films.has(`${campaign}/${id}`), films: () => [...films.values()] };
