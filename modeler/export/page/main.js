"use strict";
// The panel, the pointer and what they change.

const element = (id) => document.getElementById(id);
const metres = (v) => (Math.abs(v) < 10 ? v.toFixed(3) : v.toFixed(2)).replace(/\.?0+$/, "") + " m";

function make(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

function rgb(color) {
  const byte = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
  return `rgb(${color.map(byte).join(",")})`;
}

class Page {
  constructor(model) {
    this.model = model;
    this.canvas = element("view");
    this.renderer = new Renderer(this.canvas, model);
    this.shown = this.renderer.shown;
    this.camera = new Camera(model);
    this.points = [];
    this.pointers = new Map();
    this.fillFacts();
    this.fillParts();
    this.fillMaterials();
    this.listenToPanel();
    this.listenToPointer();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.resize();
    this.camera.fit();
  }

  refresh() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.camera.update();
      this.renderer.draw(this.camera);
      this.placeLabel();
      this.canvas.dataset.drawn = Number(this.canvas.dataset.drawn || 0) + 1;
    });
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    this.camera.aspect = this.canvas.width / this.canvas.height;
    this.refresh();
  }

  fillFacts() {
    const { model } = this, size = model.size.map((v) => metres(v).slice(0, -2)).join(" × ") + " m";
    const fill = (id, facts) => element(id).append(...facts.flatMap(([name, value]) => [make("dt", { textContent: name }), make("dd", { textContent: value })]));
    fill("facts", [["size", size], ["triangles", model.triangles.toLocaleString("en")], ...Object.entries(model.facts)]);
    fill("parameters", Object.entries(model.parameters));
    element("parameters").parentElement.hidden = Object.keys(model.parameters).length === 0;
  }

  fillParts() {
    const { groups } = this.model;
    this.below = groups.map((group, at) => groups.map((other, i) => i).filter((i) => this.isWithin(i, at)));
    const used = new Set(this.model.patches.map((patch) => patch.group));
    for (let i = 0; i < groups.length; ++i) {
      if (!this.below[i].some((at) => used.has(at))) continue;
      const box = make("input", { type: "checkbox", checked: true, ariaLabel: "show " + groups[i].name });
      const name = make("span", { className: "name", textContent: groups[i].name, title: groups[i].path || groups[i].name });
      const row = make("li", {}, box, name, make("span", { className: "count", textContent: groups[i].count > 1 ? "× " + groups[i].count : "" }));
      row.style.paddingLeft = 14 * this.depthOf(i) + "px";
      groups[i].box = box;
      box.onchange = () => this.show(this.below[i], box.checked);
      row.onmouseenter = () => this.mark({ markedGroup: i });
      row.onmouseleave = () => this.mark({});
      name.onclick = () => this.show(this.below[i], !box.checked);
      element("parts").append(row);
    }
  }

  isWithin(i, group) {
    const { groups } = this.model;
    while (i !== group && groups[i].parent !== i) i = groups[i].parent;
    return i === group;
  }

  depthOf(i) {
    const { groups } = this.model;
    return groups[i].parent === i ? 0 : 1 + this.depthOf(groups[i].parent);
  }

  show(list, visible) {
    for (const i of list) {
      if (visible) this.shown.hidden.delete(i);
      else this.shown.hidden.add(i);
      if (this.model.groups[i].box) this.model.groups[i].box.checked = visible;
    }
    this.renderer.staleShadow = true;
    this.refresh();
  }

  mark(what) {
    Object.assign(this.shown, { marked: -1, markedGroup: -1, markedMaterial: -1 }, what);
    this.refresh();
  }

  fillMaterials() {
    const used = new Set(this.model.patches.map((patch) => patch.material));
    this.model.materials.forEach((material, i) => {
      if (!used.has(i)) return;
      const swatch = make("span", { className: "swatch" });
      swatch.style.background = rgb(material.color);
      const row = make("li", { title: `roughness ${+material.roughness.toFixed(2)}, metalness ${+material.metallic.toFixed(2)}` }, swatch, make("span", { className: "name", textContent: material.name }));
      row.onmouseenter = () => this.mark({ markedMaterial: i });
      row.onmouseleave = () => this.mark({});
      element("materials").append(row);
    });
  }

  listenToPanel() {
    element("fold").onclick = () => document.querySelector("aside").classList.toggle("folded");
    element("fit").onclick = () => { this.camera.fit(); this.refresh(); };
    element("all").onclick = () => this.show(this.model.groups.map((group, i) => i), true);
    element("edges").onchange = (e) => { this.shown.edges = e.target.checked; this.refresh(); };
    element("shadow").onchange = (e) => { this.shown.shadow = e.target.checked; this.refresh(); };
    for (const id of ["axes", "cut", "turn"]) element(id).oninput = () => this.cut();
    element("measure").onclick = () => this.measure(!this.measuring);
    window.addEventListener("keydown", (e) => {
      if (e.key === "f") element("fit").click();
      if (e.key === "m") this.measure(!this.measuring);
      if (e.key === "Escape") this.measure(false);
    });
  }

  cut() {
    const axis = Number(document.querySelector("[name=axis]:checked").value), slider = element("cut"), { lo, hi } = this.model;
    slider.disabled = axis < 0;
    this.shown.section = null;
    element("cutAt").value = "";
    if (axis >= 0) {
      const at = lo[axis] + ((hi[axis] - lo[axis]) * slider.value) / 1000, sign = element("turn").checked ? -1 : 1;
      this.shown.section = { normal: [0, 1, 2].map((i) => (i === axis ? sign : 0)), at: sign * at };
      element("cutAt").value = metres(at);
    }
    this.renderer.staleShadow = true;
    this.refresh();
  }

  measure(on) {
    this.measuring = on;
    this.points = [];
    element("measure").ariaPressed = String(on);
    element("measured").value = on ? "click the first point" : "";
    this.canvas.classList.toggle("measuring", on);
    this.placeLabel();
  }

  /** Takes a point of the surface, or the corner of its triangle where that is within ten pixels. */
  take(hit) {
    const onScreen = (p) => { const at = this.camera.project(p); return [at[0] * this.canvas.clientWidth / 2, at[1] * this.canvas.clientHeight / 2]; };
    const seen = onScreen(hit.place);
    const near = hit.corners.map((p) => ({ p, off: Math.hypot(onScreen(p)[0] - seen[0], onScreen(p)[1] - seen[1]) })).sort((a, b) => a.off - b.off)[0];
    if (this.points.length === 2) this.points = [];
    this.points.push(near && near.off < 10 ? near.p : hit.place);
    if (this.points.length === 1) element("measured").value = "click the second point";
    else {
      const d = add(this.points[1], this.points[0], -1);
      element("measured").value = `${metres(Math.hypot(...d))} (${d.map((v) => metres(v).slice(0, -2)).join(", ")})`;
    }
    this.refresh();
  }

  placeLabel() {
    const label = element("label"), ends = this.points.map((p) => this.camera.project(p));
    const seen = ends.length > 0 && ends.every((end) => end), line = document.querySelector("#ruler line");
    label.hidden = !seen;
    line.style.display = seen && ends.length === 2 ? "" : "none";
    if (!seen) return;
    const pixels = ends.map(([x, y]) => [(x + 1) / 2 * this.canvas.clientWidth, (1 - y) / 2 * this.canvas.clientHeight]);
    const last = pixels[pixels.length - 1];
    for (const [name, value] of Object.entries({ x1: pixels[0][0], y1: pixels[0][1], x2: last[0], y2: last[1] })) line.setAttribute(name, value);
    label.textContent = ends.length === 2 ? metres(Math.hypot(...add(this.points[1], this.points[0], -1))) : "•";
    label.style.left = (pixels[0][0] + last[0]) / 2 + "px";
    label.style.top = (pixels[0][1] + last[1]) / 2 + "px";
  }

  hitAt(event) {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    return pick(this.model, this.shown, this.camera.ray((2 * event.offsetX) / w - 1, 1 - (2 * event.offsetY) / h));
  }

  tell(hit) {
    const footer = element("picked");
    footer.replaceChildren();
    this.mark(hit ? { marked: hit.run.part } : {});
    if (!hit) return;
    const part = this.model.parts[hit.run.part], { materials, groups } = this.model;
    footer.append(make("b", { textContent: part.path || groups[hit.patch.group].name }), [part.rule && "rule " + part.rule, part.file && `${part.file}:${part.line}`, materials[hit.patch.material].name].filter(Boolean).join(" · "));
  }

  listenToPointer() {
    const { canvas, pointers } = this;
    canvas.onpointerdown = (e) => { canvas.setPointerCapture(e.pointerId); pointers.set(e.pointerId, e); this.moved = pointers.size > 1 ? 99 : 0; };
    canvas.onpointermove = (e) => { if (pointers.has(e.pointerId)) this.drag(e); };
    canvas.onpointerup = canvas.onpointercancel = (e) => {
      pointers.delete(e.pointerId);
      if (e.type === "pointercancel" || this.moved > 4 || e.button !== 0) return;
      const hit = this.hitAt(e);
      if (!this.measuring) this.tell(hit);
      else if (hit) this.take(hit);
    };
    canvas.oncontextmenu = (e) => e.preventDefault();
    canvas.addEventListener("wheel", (e) => { e.preventDefault(); this.camera.zoom(Math.exp(Math.sign(e.deltaY) * Math.min(Math.abs(e.deltaY), 120) * 0.0012)); this.refresh(); }, { passive: false });
  }

  drag(e) {
    const before = this.pointers.get(e.pointerId), dx = e.clientX - before.clientX, dy = e.clientY - before.clientY;
    this.moved += Math.abs(dx) + Math.abs(dy);
    if (this.pointers.size === 2) {
      const other = [...this.pointers.values()].find((p) => p.pointerId !== e.pointerId), apart = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
      this.camera.zoom(apart(before) / Math.max(1, apart(e)));
      this.camera.pan(dx / 2, dy / 2, this.canvas.clientHeight);
    } else if (e.buttons & 6 || e.shiftKey) this.camera.pan(dx, dy, this.canvas.clientHeight);
    else this.camera.orbit(dx, dy);
    this.pointers.set(e.pointerId, e);
    this.refresh();
  }
}

readModel(element("data").textContent).then((model) => {
  element("told").textContent = "";
  window.sgmPage = new Page(model);
}).catch((problem) => { element("told").textContent = "The model can't be shown: " + problem.message; });
