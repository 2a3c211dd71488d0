// Films of some cases inside a report. Where the report shows a case whose film it holds, the film is played beneath it;
// the list of all such cases stands at the foot of the page.
(function (watch) {
  "use strict";
  const { el } = watch;
  const films = new Map();  // by campaign and case: {name, text, says}
  for (const script of document.querySelectorAll("script[data-film]")) {
    const { campaign, case: id, says } = script.dataset;
    films.set(`${campaign}/${id}`, { campaign, id, says, script });
  }
  let player = null;

  function close() {
    if (player) player.free();
    player = null;
  }

  function play(place, { script }) {
    close();
    const stage = el("div", { class: "watch-inset" });
    place.replaceChildren(stage);
    try {
      player = watch.mount(stage, watch.readFilm(script.textContent));
    } catch (error) {
      stage.replaceChildren(el("p", { class: "watch-problem" }, `This film cannot be shown: ${error.message}`));
    }
    return player;
  }

  /// Whether there is a film of the case.
  watch.hasFilm = (campaign, id) => films.has(`${campaign}/${id}`);
  watch.films = () => [...films.values()];

  document.addEventListener("grainsweep:case", (event) => {
    const { campaign, case_id: id } = event.detail, film = films.get(`${campaign}/${id}`);
    const panel = document.getElementById("case-panel");
    if (!panel) return;
    close();
    let place = panel.querySelector(".watch");
    if (!place) panel.append(place = el("div", { class: "watch" }));
    if (film) play(place, film);
    else place.replaceChildren();
  });
})(window.grainsweepWatch = window.grainsweepWatch || {});
