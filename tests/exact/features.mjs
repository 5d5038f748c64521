// Features of a closed mesh {points, triangles, node, normal}: corners of triangles, the tree's node and the plane's
// normal of each triangle. What they are is said in exact.mjs.
import {thicknesses} from './solids.mjs';

const creaseDegrees = 10, turnDegrees = 30, deficitRadians = 0.1;

export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/// The look of each part of the tree, as text.
export function looksOf(tree) {
  return tree.parts.map(p => {
    const {color, roughness, metallic} = tree.materials[p.material];
    return JSON.stringify([color, roughness, metallic]);
  });
}

/// Leaves out components thinner than a micrometre on average: where round solids touch, rounding leaves such voids.
export function withoutFilms(soup) {
  const {points, triangles, node, normal} = soup, parent = Uint32Array.from(points, (_, v) => v);
  const root = v => {
    while (parent[v] !== v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const [a, b, c] of triangles) parent[root(a)] = parent[root(b)] = root(c);
  const area = new Float64Array(points.length), volume = new Float64Array(points.length);
  for (const corners of triangles) {
    const [a, b, c] = corners.map(v => points[v]), normal2 = cross(sub(b, a), sub(c, a)), r = root(corners[0]);
    area[r] += Math.hypot(...normal2) / 2;
    volume[r] += dot(sub(a, points[r]), normal2) / 6;
  }
  const stays = triangles.map(corners => Math.abs(volume[root(corners[0])]) > 1e-6 * area[root(corners[0])]);
  const kept = list => list.filter((_, t) => stays[t]);
  return {points, triangles: kept(triangles), node: kept(node), normal: kept(normal)};
}

/// V − E + F of the points in use.
export function eulerOf({triangles}) {
  return new Set(triangles.flat()).size - triangles.length / 2;
}

/// Every edge once: [smaller corner, larger one, triangle, its third corner, the other triangle].
function edgesOf({points, triangles}) {
  const edges = new Map();
  triangles.forEach((corners, t) => {
    for (let k = 0; k < 3; ++k) {
      const a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      const key = a < b ? a * points.length + b : b * points.length + a;
      if (edges.has(key)) edges.get(key).push(t);
      else edges.set(key, [Math.min(a, b), Math.max(a, b), t, c]);
    }
  });
  for (const e of edges.values())
    if (e.length !== 5) throw new Error('the exact mesh is not closed');
  return [...edges.values()];
}

/// 2π less the sum of the angles around each point: 0 on smooth ground.
function deficitsOf({points, triangles}) {
  const deficit = new Float64Array(points.length).fill(2 * Math.PI);
  for (const corners of triangles)
    for (let k = 0; k < 3; ++k) {
      const [a, b, c] = [0, 1, 2].map(i => points[corners[(k + i) % 3]]), u = sub(b, a), v = sub(c, a);
      deficit[corners[k]] -= Math.atan2(Math.hypot(...cross(u, v)), dot(u, v));
    }
  return deficit;
}

/// Orders creases along the chains that corners end; each gets its chain's number and runs along it.
function chained(creases, isCorner) {
  const at = new Map();
  creases.forEach((c, i) => c.ends.forEach(v => at.has(v) ? at.get(v).push(i) : at.set(v, [i])));
  const ordered = [], used = new Set();
  let chain = 0;
  const walk = (start, first) => {
    for (let v = start, i = first; i !== undefined && !used.has(i);) {
      const c = creases[i];
      used.add(i);
      if (c.ends[0] !== v) c.ends.reverse();
      ordered.push({...c, chain});
      v = c.ends[1];
      i = isCorner(v) ? undefined : at.get(v).find(j => !used.has(j));
    }
    ++chain;
  };
  for (const [v, list] of at)
    if (isCorner(v)) for (const i of list) if (!used.has(i)) walk(v, i);
  creases.forEach((c, i) => used.has(i) || walk(c.ends[0], i));
  return ordered;
}

/// Edges between two looks.
export function bordersOf(soup, tree) {
  const looks = looksOf(tree), look = t => looks[tree.nodes[soup.node[t]].origin];
  return edgesOf(soup).filter(([, , t, , u]) => look(t) !== look(u)).map(([a, b]) => [...soup.points[a], ...soup.points[b]]);
}

/// Creases and corners of a closed mesh.
export function featuresOf(soup, tree) {
  const {points, node, normal} = soup, creases = [], around = new Map();
  for (const [a, b, t, c, u] of edgesOf(soup)) {
    const cosine = Math.max(-1, Math.min(1, dot(normal[t], normal[u]))), degrees = Math.acos(cosine) * 180 / Math.PI;
    if (degrees <= creaseDegrees) continue;
    const convex = dot(normal[u], sub(points[c], points[a])) < 0 ? 1 : 0;
    creases.push({ends: [a, b], degrees, convex, normals: [...normal[t], ...normal[u]]});
    const d = sub(points[b], points[a]), length = Math.hypot(...d);
    for (const [v, sign] of [[a, 1], [b, -1]]) {
      if (!around.has(v)) around.set(v, []);
      around.get(v).push(d.map(x => sign * x / length));
    }
  }
  const thickness = thicknesses(tree), thinnest = points.map(() => 1e30);
  soup.triangles.forEach((corners, t) => corners.forEach(v => thinnest[v] = Math.min(thinnest[v], thickness[node[t]])));
  const deficit = deficitsOf(soup), straight = -Math.cos(turnDegrees * Math.PI / 180);
  const isCorner = v => {
    const ways = around.get(v) ?? [];
    return ways.length > 2 || ways.length === 2 && dot(ways[0], ways[1]) > straight ||
        Math.abs(deficit[v]) > deficitRadians && deficit[v] < 6;
  };
  return {
    creases: chained(creases, isCorner).map(c => [...points[c.ends[0]], ...points[c.ends[1]], c.chain, c.degrees, c.convex,
                                                  ...c.normals].map(rounded)),
    corners: points.map((p, v) => [...p, around.get(v)?.length ?? 0, thinnest[v]]).filter((p, v) => isCorner(v)),
  };
}

/// Points are floats already; seven digits of a normal will do.
const rounded = x => Number(x.toPrecision(9));

export const areaOf = ({points, triangles}) => triangles.reduce((sum, [a, b, c]) =>
    sum + Math.hypot(...cross(sub(points[b], points[a]), sub(points[c], points[a]))) / 2, 0);

export const lengthOf = segments => segments.reduce((sum, s) => sum + Math.hypot(s[0] - s[3], s[1] - s[4], s[2] - s[5]), 0);
