// Elements of a page in one line each; texts reach the page as text nodes only, never as markup.
(function (watch) {
  "use strict";
  watch.el = function (tag, attributes, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {}))
      if (value !== null && value !== undefined && value !== false) node.setAttribute(name, value === true ? "" : value);
    for (const child of children.flat()) {
      if (child === null || child === undefined) continue;
      node.append(child instanceof Node ? child : document.createTextNode(String(child)));
    }
    return node;
  };
  watch.choice = function (label, options, chosen, changed) {
    const select = watch.el("select", { "aria-label": label },
      options.map(([value, text]) => watch.el("option", { value, selected: value === chosen }, text)));
    select.addEventListener("change", () => changed(select.value));
    return { node: watch.el("label", { class: "watch-choice" }, watch.el("span", {}, label), select), select };
  };
  watch.tick = function (label, checked, changed) {
    const box = watch.el("input", { type: "checkbox", checked });
    box.addEventListener("change", () => changed(box.checked));
    return { node: watch.el("label", { class: "watch-tick" }, box, label), box };
  };
})(window.grainsweepWatch = window.grainsweepWatch || {});
