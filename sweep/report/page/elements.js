// Elements of the pages; texts become text nodes only, never markup.
function el(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (typeof value === "function") node.addEventListener(name, value);
    else if (value !== null && value !== undefined && value !== false) node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return node;
}

function button(text, click, attributes) { return el("button", { type: "button", class: "plain", click, ...attributes }, text); }

// A choice among named things; `change` gets the chosen value as text.
function choice(label, options, value, change) {
  const select = el("select", { "aria-label": label, change: () => change(select.value) },
    options.map(([key, text]) => (Array.isArray(text)
      ? el("optgroup", { label: key }, text.map(([inner, words]) => el("option", { value: inner }, words)))
      : el("option", { value: key }, text))));
  select.value = value;
  return el("label", { class: "choice" }, el("span", {}, label), select);
}

function tick(label, checked, change) {
  return el("label", { class: "choice" }, el("input", { type: "checkbox", checked, change: (event) => change(event.target.checked) }), label);
}

function tile(number, label, bad) { return el("div", { class: bad ? "tile bad" : "tile" }, el("b", {}, number), el("span", {}, label)); }

// Hands bytes to the reader as a file.
function save(name, blob) {
  const link = el("a", { download: name, href: URL.createObjectURL(blob) });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function fileName(...parts) { return parts.filter(Boolean).join("_").replace(/[^A-Za-z0-9.-]+/g, "_"); }

function table(columns, rows) {
  const cell = (tag, value, kind) => el(tag, kind ? { class: kind } : {}, tag === "td" && !(value instanceof Node) ? show(value) : value);
  const head = el("tr", {}, columns.map(([title, kind]) => cell("th", title, kind)));
  const body = rows.map((row) => el("tr", {}, row.map((value, i) => cell("td", value, columns[i][1]))));
  return el("div", { class: "scroll" }, el("table", {}, el("thead", {}, head), el("tbody", {}, body)));
}
function section(id, title, says, ...content) {
  return el("section", { id }, el("h2", {}, title), says ? el("p", { class: "says" }, says) : null, content);
}
