"use strict";
// What a ray meets: the triangles themselves, a part's only where the ray goes through its box.

function meetsBox({ lo, hi }, from, along, nearest) {
  let enter = 0, leave = nearest;
  for (let axis = 0; axis < 3; ++axis) {
    const a = (lo[axis] - from[axis]) / along[axis], b = (hi[axis] - from[axis]) / along[axis];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave;
}

/** How far along the ray a triangle (its corners p, q, r) is met; Infinity where it isn't (Moeller and Trumbore 1997). */
function meetsTriangle(p, q, r, from, along) {
  const a = add(q, p, -1), b = add(r, p, -1), h = cross(along, b), det = dot(a, h);
  if (Math.abs(det) < 1e-14) return Infinity;
  const s = add(from, p, -1), u = dot(s, h) / det, k = cross(s, a), v = dot(along, k) / det;
  return u < 0 || v < 0 || u + v > 1 ? Infinity : dot(b, k) / det;
}

/** The nearest thing shown: {distance, place, patch, run, corners}, or null. */
function pick(model, shown, { from, along }) {
  let found = null, nearest = Infinity, opened = 0;  // opened: where the ray comes through the section
  if (shown.section) {
    const { normal, at } = shown.section, falls = dot(along, normal);
    if (falls < 0) opened = Math.max(0, (at - dot(from, normal)) / falls);
  }
  const corner = (c) => { const v = 3 * model.indices[c]; return [model.positions[v], model.positions[v + 1], model.positions[v + 2]]; };
  for (const patch of model.patches) {
    if (shown.hidden.has(patch.group)) continue;
    for (const run of patch.runs) {
      if (!meetsBox(run, from, along, nearest)) continue;
      for (let c = run.first; c < run.first + run.count; c += 3) {
        const corners = [corner(c), corner(c + 1), corner(c + 2)], distance = meetsTriangle(...corners, from, along);
        if (distance <= 1e-6 || distance >= nearest) continue;
        if (distance <= opened) continue;
        const place = add(from, along, distance);
        if (shown.section && dot(place, shown.section.normal) > shown.section.at) continue;
        nearest = distance;
        found = { distance, place, patch, run, corners };
      }
    }
  }
  // What the ray leaves before it enters is solid that the section opens.
  const inside = found && opened > 0 && shown.hidden.size === 0 && dot(cross(add(found.corners[1], found.corners[0], -1), add(found.corners[2], found.corners[0], -1)), along) > 0;
  if (inside) Object.assign(found, { distance: opened, place: add(from, along, opened), corners: [] });
  return found;
}
