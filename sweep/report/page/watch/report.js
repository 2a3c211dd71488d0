// Films of some cases inside a report: where the report shows a case whose film it holds, the film is played there.
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
      player.startByItself();
    } catch (error) {
      stage.replaceChildren(el("p", { class: "watch-problem" }, `This film cannot be shown: ${error.message}`));
    }
  }

  /// Whether there is a film of the case.
  watch.hasFilm = (campaign, id) => films.has(`${campaign}/${id}`);
  watch.films = () => [...films.values()];

  function show({ campaign, case_id: id }) {
    const film = films.get(`${campaign}/${id}`), panel = document.getElementById("case-panel");
    close();
    document.body.classList.toggle("with-film", Boolean(film));
    if (!panel || !film) return;
    play(panel.querySelector(".watch") || panel.appendChild(el("div", { class: "watch" })), film);
  }
  document.addEventListener("grainsweep:case", (event) => show(event.detail));
  document.addEventListener("grainsweep:closed", () => show({}));
})(window.grainsweepWatch = window.grainsweepWatch || {});
