// SPDX-License-Identifier: MIT OR Apache-2.0
// Over a plot: the nearest point's series and values. Dragging a rectangle enlarges it, a double click shows all again.
"use strict";
const box = document.body.appendChild(Object.assign(document.createElement("div"), { id: "at", hidden: true }));
// Ranges of values and of the drawing along an axis: least and largest value, where these lie.
const axis = (svg, of) => svg.dataset[of].split(" ").map(Number);
const place = (svg, event) => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
const value = (svg, of, at) => {
  const [low, high, start, end] = axis(svg, of);
  const within = low + (high - low) * (at - start) / (end - start);
  const shown = Number((svg.dataset.log.includes(of) ? 10 ** within : within).toPrecision(4));
  const title = svg.dataset[of + "Title"];
  return title && `${title}: ${String(shown).replace("-", "\u2212")}`;
};
const points = new Map();
const read = svg => {
  if (!points.has(svg)) {
    const of = [];
    for (const line of svg.querySelectorAll("polyline, circle")) {
      const colour = /k\d+( dash| dot)?/.exec(line.getAttribute("class") || "");
      if (!colour || ["k1", "k2"].includes(colour[0])) continue;
      const all = line.points ? Array.from(line.points) : [{ x: line.cx.baseVal.value, y: line.cy.baseVal.value }];
      for (const at of all) of.push([at.x, at.y, colour[0]]);
    }
    points.set(svg, of);
  }
  return points.get(svg);
};
const name = (svg, colour) => {
  const of = svg.closest("figure").querySelectorAll(".legend li");
  const named = Array.from(of).filter(li => (" " + li.querySelector("svg > *").getAttribute("class") + " ").includes(` ${colour} `));
  return named.map(li => li.textContent).join(" / ");
};
const show = (svg, event) => {
  const at = place(svg, event), scale = svg.getScreenCTM().a;
  const far = ([x, y]) => Math.hypot(x - at.x, y - at.y);
  const near = read(svg).reduce((best, point) => far(point) < far(best) ? point : best, [1e9, 1e9, ""]);
  const [x, y, colour] = far(near) * scale < 30 ? near : [at.x, at.y, ""];
  const lines = [name(svg, colour), value(svg, "x", x), value(svg, "y", y)];
  box.textContent = lines.filter(line => line).join("\n");
  box.hidden = false;
  const left = Math.min(event.clientX + 14, innerWidth - box.offsetWidth - 4);
  box.style.left = `${left}px`;
  box.style.top = `${Math.max(4, event.clientY - box.offsetHeight - 10)}px`;
};
for (const svg of document.querySelectorAll("svg[data-x]")) {
  const whole = svg.getAttribute("viewBox");
  let from = null;
  svg.addEventListener("pointermove", event => show(svg, event));
  svg.addEventListener("pointerleave", () => { box.hidden = true; });
  svg.addEventListener("pointerdown", event => {
    if (event.pointerType === "mouse") from = place(svg, event);
    show(svg, event);
  });
  svg.addEventListener("pointerup", event => {
    if (!from) return;
    const to = place(svg, event), [width, height] = [Math.abs(to.x - from.x), Math.abs(to.y - from.y)];
    if (Math.max(width, height) > 20) {
      const [, , wide, high] = whole.split(" ").map(Number), scale = Math.max(width / wide, height / high);
      const [x, y] = [(from.x + to.x - wide * scale) / 2, (from.y + to.y - high * scale) / 2];
      svg.setAttribute("viewBox", `${x} ${y} ${wide * scale} ${high * scale}`);
      box.hidden = true;
      svg.classList.add("close");
    }
    from = null;
  });
  svg.addEventListener("dblclick", () => { svg.setAttribute("viewBox", whole); svg.classList.remove("close"); });
}
