// Figures that the program painted: SVG in the data of the page, as grainsweep figure writes it.
async function unpacked(data) {
  await Promise.all(data.campaigns.map(async (campaign) => {
    campaign.figures = JSON.parse(new TextDecoder().decode(await inflated(bytesOf(campaign.figures))));
  }));
  return data;
}

const drawingElements = ["svg", "g", "path", "circle", "text", "tspan"];
function drawingOf(text) {
  const svg = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  if (![svg, ...svg.querySelectorAll("*")].every((one) => drawingElements.includes(one.localName))) throw new Error("this is no figure");
  svg.removeAttribute("width");
  svg.removeAttribute("height");
  return document.importNode(svg, true);
}

function figureCard(title, says, savers, ...content) {
  return el("figure", { class: "card" }, el("div", { class: "caption" }, el("h3", {}, title), el("span", { class: "savers" },
    ["SVG", "PNG"].map((kind, k) => button(kind, savers[k], { class: "save", title: `Save this figure as ${kind}` })))),
  says ? el("p", { class: "says" }, says) : null, content);
}

// `drawn`: [name, SVG], one below the other; the first is saved.
function picture(title, says, drawn) {
  const [[, text]] = drawn, named = (name) => (name ? `${title}, ${name}` : title);
  return figureCard(title, says, [() => saveText(title, text), () => savePixels(title, text)], drawn.map(([name, svg]) => [name ? el("p", { class: "says" }, name) : null,
    el("div", { class: "drawing", role: "img", "aria-label": named(name) }, drawingOf(svg))]));
}

function savedAs(title, extension) { return `${fileName(data.campaigns[chosen.campaign].name, title)}.${extension}`; }

function saveText(title, svg) { save(savedAs(title, "svg"), new Blob([svg], { type: "image/svg+xml" })); }

// White paper, 300 dots per inch.
function savePixels(title, svg) {
  const [width, height] = /viewBox="0 0 ([\d.]+) ([\d.]+)"/.exec(svg).slice(1).map((points) => Math.round((points * 300) / 72));
  const canvas = el("canvas", { width, height }), context = canvas.getContext("2d"), image = new Image(), address = `data:image/svg+xml,${encodeURIComponent(svg)}`;
  image.addEventListener("load", () => {
    context.fillStyle = "#ffffff";
    context.fillRect(0, 0, width, height);
    context.drawImage(image, 0, 0, width, height);
    canvas.toBlob((blob) => save(savedAs(title, "png"), blob), "image/png");
  });
  image.src = address;
}

function failedSays(failed) { return failed ? " Crosses: failed cases. No response is drawn where a case is likelier to fail than not." : ""; }

let figures = [];  // those that a script draws
const pageShown = [];

// Replaces the page by the parts that `build` makes, and lists its sections in the navigation.
function showPage(build) {
  document.getElementById("database").textContent = data.databases.join(", ");
  figures.forEach((one) => one.drop());
  figures = [];
  const page = document.getElementById("page");
  page.replaceChildren(...build().filter(Boolean));
  const sections = [...page.querySelectorAll("section[id]")], title = (one) => one.querySelector("h2").textContent;
  const list = choice("Go to", [["", "…"], ...sections.map((one) => [one.id, title(one)])], "", (id) => {
    sections.find((one) => one.id === id)?.scrollIntoView({ behavior: "smooth" });
    list.control.value = "";
  });
  document.getElementById("sections").replaceChildren(list, ...sections.map((one) =>
    el("button", { type: "button", click: () => one.scrollIntoView({ behavior: "smooth" }) }, title(one))));
  pageShown.forEach((work) => work());
}
