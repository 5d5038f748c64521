// Exact constructive solid geometry of a solid tree (.csg.json, written by `sgm build`), by npm's manifold-3d: the truth
// that `bench --meshes` and tests hold meshes against.
//
//   node tests/exact/exact.mjs MODEL.csg.json [--sides 128] [--owners] [-o FEATURES.json] [--mesh MESH.bin]
//   node tests/exact/exact.mjs --check        ends with 0 where manifold-3d is installed
//
// FEATURES.json: {sides, triangles, euler, volume_m3, area_m2, crease_m, border_m, thickness_m: [per node],
//   creases: [[x y z, x y z, chain, degrees, convex 1|0, normal, normal]], corners: [[x y z, creases, metres]],
//   borders: [[x y z, x y z]]}
// A crease is an edge whose faces turn by more than 10 degrees, with the outward normals of both; creases stand in the
// order of chains from corner to corner. A corner is a vertex where three or more creases meet, or two at more than 30
// degrees, or whose angles miss 360 degrees by more than 6 (an apex); with it, how many creases meet there and the
// thickness of the thinnest solid that does. A border is an edge between two looks (colour, roughness, metal). The
// triangles are those of manifold's planar merge: coplanar ones of one solid are joined.
// Where two solids share a surface manifold takes either owner, in pieces. With --owners the one that stands first in the
// tree owns it; but where oblique and round surfaces touch, rounding then leaves films without volume inside the solid, so
// that such a model is good for looking up owners alone.
// MESH.bin, little-endian: uint32 vertices, triangles; float64 x y z a vertex; float64 x y z a triangle, its plane's
// normal; uint32 three corners a triangle; uint32 origin a triangle; uint32 1|0 a triangle: whether it is of a round solid.
//
// Round solids are inscribed: their corners lie on the true surface. n sides of radius r stay r(1 − cos(π/n)) inside:
// .0003 r at 128, 3e-7 r at 4096, and a cylinder's volume is (2π/n)²/6 too small: 4e-4 at 128, 4e-7 at 4096. Balls have n
// sides as well, but 256 at most.
// Exit codes: 1 bad input, 2 wrong usage, 3 manifold-3d isn't installed (npm install --prefix build manifold-3d).
// Run it from the repository's root.
import fs from 'node:fs';
import {pathToFileURL} from 'node:url';

import {areaOf, bordersOf, cross, eulerOf, featuresOf, lengthOf, looksOf, sub, withoutFilms} from './features.mjs';
import {aligned, isRound, Solids, thicknesses} from './solids.mjs';

async function loadManifold() {
  const path = ['build/', ''].map(folder => `${process.cwd()}/${folder}node_modules/manifold-3d/manifold.js`).find(fs.existsSync);
  if (!path) {
    console.error('manifold-3d is not installed: npm install --prefix build manifold-3d');
    process.exit(3);
  }
  const module = await (await import(pathToFileURL(path))).default();
  module.setup();
  return module;
}

/// Computed at once: manifold would else reorder what it is given.
function evaluated(a, b, op) {
  const made = a[op](b);
  made.numTri();
  return made;
}

function replaced(a, b, op) {
  const made = evaluated(a, b, op);
  a.delete();
  b.delete();
  return made;
}

/// The one look of a list of parts, or null where there are several.
const commonLook = parts => parts.every(p => p.look === parts[0].look) ? parts[0].look : null;

function batch(solids) {
  const made = module.Manifold.union(solids);
  made.numTri();
  solids.forEach(s => s.delete());
  return made;
}

/// Parts {solid, look} in the order of the tree, joined; with `owners`, the first of two that share a surface keeps it:
/// the second loses what lies in the first before they are joined. Of parts that look alike nobody sees which one that is.
function united(parts, owners) {
  if (parts.length === 1) return parts[0].solid;
  if (!owners) return batch(parts.map(p => p.solid));
  const groups = [];
  for (const p of parts) {
    if (p.look !== null && groups.at(-1)?.[0].look === p.look) groups.at(-1).push(p);
    else groups.push([p]);
  }
  return inHalves(groups.map(group => group.length === 1 ? group[0].solid : batch(group.map(p => p.solid))));
}

function inHalves(list) {
  if (list.length === 1) return list[0];
  const half = list.length >> 1, first = inHalves(list.slice(0, half)), second = inHalves(list.slice(half));
  const rest = evaluated(second, first, 'subtract');
  second.delete();
  return replaced(first, rest, 'add');
}

/// The whole tree as triangles.
function build(tree, sides, owners) {
  const solids = new Solids(module, tree, sides), nodeOf = new Map(), looks = looksOf(tree);
  const made = [];
  for (const [index, node] of tree.nodes.entries()) {
    if (node.solid) {
      const own = solids.make(aligned(node)).asOriginal();
      nodeOf.set(own.originalID(), index);
      made.push({solid: own, look: looks[node.origin]});
      continue;
    }
    const parts = node.of.map(i => made[i]), look = commonLook(parts), [first, ...rest] = parts;
    if (node.op === 'union') made.push({solid: united(parts, owners), look});
    else if (node.op === 'difference') made.push({solid: replaced(first.solid, united(rest, owners), 'subtract'), look});
    else if (node.op === 'intersection') made.push({solid: rest.reduce((a, b) => replaced(a, b.solid, 'intersect'), first.solid), look});
    else throw new Error(`node ${index}: no operation is called '${node.op}'`);
  }
  const whole = made.at(-1).solid;
  if (whole.isEmpty()) throw new Error('nothing solid is left');
  return {...withoutFilms(soupOf(whole, nodeOf)), volume: whole.volume()};
}

/// Arrays of the result: points, triangles over merged vertices, the node and the plane's normal of each triangle.
function soupOf(whole, nodeOf) {
  const mesh = whole.getMesh();
  const count = mesh.numVert, points = [];
  for (let v = 0; v < count; ++v) points.push(Array.from(mesh.vertProperties.subarray(v * mesh.numProp, v * mesh.numProp + 3)));
  const merged = Uint32Array.from({length: count}, (_, v) => v);
  for (let i = 0; i < mesh.mergeFromVert.length; ++i) merged[mesh.mergeFromVert[i]] = mesh.mergeToVert[i];
  const triangles = [], node = [], plane = [], planes = new Map();
  for (let run = 0; run < mesh.runOriginalID.length; ++run) {
    const of = nodeOf.get(mesh.runOriginalID[run]);
    for (let t = mesh.runIndex[run] / 3; t < mesh.runIndex[run + 1] / 3; ++t) {
      const corners = [0, 1, 2].map(k => merged[mesh.triVerts[3 * t + k]]);
      const [a, b, c] = corners.map(v => points[v]), area = cross(sub(b, a), sub(c, a));
      const key = `${mesh.runOriginalID[run]} ${mesh.faceID[t]}`;
      const sum = planes.get(key) ?? [0, 0, 0];
      planes.set(key, sum.map((s, i) => s + area[i]));
      triangles.push(corners);
      node.push(of);
      plane.push(key);
    }
  }
  for (const [key, sum] of planes) {
    const length = Math.hypot(...sum);
    planes.set(key, length > 0 ? sum.map(s => s / length) : sum);
  }
  return {points, triangles, node, normal: plane.map(key => planes.get(key))};
}

function writeMesh(file, soup, tree) {
  const {points, triangles, node, normal} = soup;
  const head = Uint32Array.of(points.length, triangles.length);
  const parts = [head, Float64Array.from(points.flat()), Float64Array.from(normal.flat()), Uint32Array.from(triangles.flat()),
                 Uint32Array.from(node, n => tree.nodes[n].origin),
                 Uint32Array.from(node, n => isRound(tree.nodes[n]) ? 1 : 0)];
  fs.writeFileSync(file, Buffer.concat(parts.map(p => Buffer.from(p.buffer))));
}

function parse(argv) {
  const options = {sides: 128};
  for (let i = 0; i < argv.length; ++i) {
    if (argv[i] === '--sides') options.sides = Number(argv[++i]);
    else if (argv[i] === '--owners') options.owners = true;
    else if (argv[i] === '--check') options.check = true;
    else if (argv[i] === '-o') options.out = argv[++i];
    else if (argv[i] === '--mesh') options.mesh = argv[++i];
    else if (options.file === undefined && !argv[i].startsWith('-')) options.file = argv[i];
    else options.file = null;
  }
  const good = options.check || options.file && Number.isInteger(options.sides) && options.sides >= 4 && options.sides % 4 === 0;
  if (!good) {
    console.error('usage: node exact.mjs MODEL.csg.json [--sides N, a multiple of 4] [--owners] [-o FEATURES.json] [--mesh MESH.bin]');
    process.exit(2);
  }
  return options;
}

const options = parse(process.argv.slice(2));
const module = await loadManifold();
if (options.check) process.exit(0);
try {
  const tree = JSON.parse(fs.readFileSync(options.file, 'utf8'));
  if (tree.format !== 'sgm solid tree' || tree.version !== 1) throw new Error(`${options.file} is no solid tree of version 1`);
  const soup = build(tree, options.sides, options.owners), features = featuresOf(soup, tree), borders = bordersOf(soup, tree);
  const result = {
    sides: options.sides,
    triangles: soup.triangles.length,
    euler: eulerOf(soup),
    volume_m3: soup.volume,
    area_m2: areaOf(soup),
    crease_m: lengthOf(features.creases),
    border_m: lengthOf(borders),
    thickness_m: thicknesses(tree),
    ...features,
    borders,
  };
  if (options.mesh) writeMesh(options.mesh, soup, tree);
  const text = JSON.stringify(result);
  if (options.out) fs.writeFileSync(options.out, text);
  else console.log(text);
} catch (error) {
  console.error(`exact.mjs: ${error.message}`);
  process.exit(1);
}
