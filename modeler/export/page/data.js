"use strict";
// Reads what modeler/export/page_data.cpp packs: its comment says how.

/** The model in a base64 text: {name, facts, materials, groups, parts, patches, positions, normals, indices, lo, hi}. */
async function readModel(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const model = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  let at = 4 + length;
  const plane = () => bytes.subarray(at, (at += model.vertices));
  const unzigzag = (v) => (v >>> 1) ^ -(v & 1);

  model.positions = new Float32Array(3 * model.vertices);
  for (let axis = 0; axis < 3; ++axis) {
    const low = plane(), high = plane();
    for (let v = 0, steps = 0; v < model.vertices; ++v) {
      steps = (steps + unzigzag(low[v] | (high[v] << 8))) & 0xffff;
      model.positions[3 * v + axis] = (model.origin[axis] + steps) * model.step;
    }
  }
  model.normals = new Int8Array(2 * model.vertices);
  for (let axis = 0; axis < 2; ++axis) {
    const change = plane();
    for (let v = 0, value = 0; v < model.vertices; ++v) model.normals[2 * v + axis] = value = (value + unzigzag(change[v])) << 24 >> 24;
  }

  const number = () => {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = bytes[at++];
      value |= (byte & 127) << shift;
      if (byte < 128) return value >>> 0;
    }
  };
  model.indices = new Uint32Array(3 * model.triangles);
  let vertex = 0, corner = 0;
  for (const patch of model.patches) {
    patch.first = corner;
    let fresh = 0;
    for (let i = 0; i < 3 * patch.triangles; ++i) {
      const back = number();
      model.indices[corner++] = vertex + fresh - back;
      if (back === 0) ++fresh;
    }
    vertex += fresh;
  }
  addRuns(model);
  model.pictures = [];
  if (model.files) {
    addTextureCoordinates(model, number);
    for (const { type, length } of model.files) {
      const blob = new Blob([bytes.subarray(at, (at += length))], { type });
      model.pictures.push(await createImageBitmap(blob, { premultiplyAlpha: "none", colorSpaceConversion: "none" }));
    }
  }
  model.size = [0, 1, 2].map((axis) => model.hi[axis] - model.lo[axis]);
  model.middle = [0, 1, 2].map((axis) => (model.hi[axis] + model.lo[axis]) / 2);
  model.radius = Math.hypot(...model.size) / 2 || 1;
  return model;
}

/** Metres along the chart of every vertex, by the numbers that follow. */
function addTextureCoordinates(model, number) {
  model.uvs = new Float32Array(2 * model.vertices);
  for (let v = 0, chart = 0; v < model.vertices; ++v) {
    const change = number(), p = [0, 1, 2].map((axis) => model.positions[3 * v + axis]);
    chart += (change >>> 1) ^ -(change & 1);
    const axes = model.charts[chart];
    for (const k of [0, 1]) model.uvs[2 * v + k] = (dot(p, axes.slice(5 * k, 5 * k + 3)) - axes[5 * k + 3]) * axes[5 * k + 4];
  }
}

/** Gives every patch its runs of triangles of one part, each with the box around it. */
function addRuns(model) {
  for (const patch of model.patches) {
    let first = patch.first;
    patch.runs = [];
    for (let i = 0; i < patch.parts.length; i += 2) {
      const run = { part: patch.parts[i], first, count: 3 * patch.parts[i + 1], lo: [Infinity, Infinity, Infinity], hi: [-Infinity, -Infinity, -Infinity] };
      first += run.count;
      for (let c = run.first; c < first; ++c)
        for (let axis = 0; axis < 3; ++axis) {
          const p = model.positions[3 * model.indices[c] + axis];
          if (p < run.lo[axis]) run.lo[axis] = p;
          if (p > run.hi[axis]) run.hi[axis] = p;
        }
      patch.runs.push(run);
    }
  }
}

/** Corners of the edges to draw: where materials meet, and where the surface turns by more than 20 degrees. */
function edgesOf(model) {
  const { indices, positions } = model, open = new Map(), places = new Map(), number = new Map();
  const placeOf = (v) => {
    if (number.has(v)) return number.get(v);
    const key = positions[3 * v] + "," + positions[3 * v + 1] + "," + positions[3 * v + 2];
    if (!places.has(key)) places.set(key, places.size);
    number.set(v, places.get(key));
    return places.get(key);
  };
  const keyOf = (a, b) => Math.min(a, b) * 4294967296 + Math.max(a, b);
  const normalOf = (t) => {
    const [p, q, r] = [0, 1, 2].map((c) => { const v = 3 * indices[t + c]; return [positions[v], positions[v + 1], positions[v + 2]]; });
    return unit(cross(add(q, p, -1), add(r, p, -1)));
  };
  // First those that only one triangle of their patch has, by vertices; then the two sides of each, by places.
  for (const patch of model.patches) {
    const single = new Map();
    for (let t = patch.first; t < patch.first + 3 * patch.triangles; t += 3)
      for (let i = 0; i < 3; ++i) {
        const key = keyOf(indices[t + i], indices[t + ((i + 1) % 3)]);
        if (!single.delete(key)) single.set(key, t);
      }
    for (const [key, triangle] of single) {
      const a = Math.floor(key / 4294967296), b = key % 4294967296, place = keyOf(placeOf(a), placeOf(b));
      if (!open.has(place)) open.set(place, []);
      open.get(place).push({ a, b, triangle, patch });
    }
  }
  const shown = new Map(model.patches.map((patch) => [patch, []]));
  for (const sides of open.values()) {
    const [one, other] = sides;
    if (sides.length === 2 && one.patch.material === other.patch.material && dot(normalOf(one.triangle), normalOf(other.triangle)) > 0.94) continue;
    for (const { a, b, patch } of sides) shown.get(patch).push(a, b);
  }
  const list = [];
  for (const patch of model.patches) {
    patch.firstEdge = list.length;
    patch.edges = shown.get(patch).length;
    for (const v of shown.get(patch)) list.push(v);
  }
  return new Uint32Array(list);
}
