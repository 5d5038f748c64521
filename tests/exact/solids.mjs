// The primitives of a solid tree (docs/solid-tree.md) as solids of manifold-3d, from unit shapes between -1 and 1, y up.
// Round ones are inscribed with so many sides; balls with 256 at most.
const mostBallSides = 256;

/// Columns of the matrix that takes the unit solid (−1 … 1, y up) to its place.
function placement({axes, centre, size}, scale = [1, 1, 1]) {
  const columns = axes.map((a, i) => a.map(v => v * size[i] / 2 * scale[i]).concat(0));
  return [...columns.flat(), ...centre, 1];
}

/// Coordinates that a grammar means to be equal differ by rounding; on this grid they are equal, and sums of them exact.
const snapped = x => Math.round(x * 2 ** 24) / 2 ** 24;

/// The solid with its faces on that grid, where they are parallel to the world's axes.
export function aligned(solid) {
  const axes = solid.axes.map(a => a.map(x => Math.abs(x) < 1e-12 ? 0 : Math.abs(x) > 1 - 1e-12 ? Math.sign(x) : x));
  if (!axes.flat().every(Number.isInteger)) return solid;
  const centre = [...solid.centre], size = [...solid.size];
  axes.forEach((a, i) => {
    const world = a.findIndex(x => x !== 0);
    const low = snapped(solid.centre[world] - size[i] / 2), high = snapped(solid.centre[world] + size[i] / 2);
    centre[world] = (low + high) / 2;
    size[i] = high - low;
  });
  return {...solid, axes, centre, size};
}

/// Solids of one tree, from unit shapes that are made once.
export class Solids {
  constructor({Manifold, CrossSection}, tree, sides) {
    this.Manifold = Manifold;
    this.CrossSection = CrossSection;
    this.sides = sides;
    this.bounds = tree.bounds;
    this.units = new Map();
  }
  unit(key, make) {
    if (!this.units.has(key)) this.units.set(key, make());
    return this.units.get(key);
  }
  /// Along y from −1 to 1: manifold's own cylinder runs along z.
  upright(low, high) {
    return this.Manifold.cylinder(2, low, high, this.sides, true).rotate([-90, 0, 0]);
  }
  /// A prism along z over a triangle.
  extruded(points) {
    return new this.CrossSection([points]).extrude(2, 0, 0, [1, 1], true);
  }
  ball() {
    return this.unit('ball', () => this.Manifold.sphere(1, Math.min(this.sides, mostBallSides)));
  }
  make(solid) {
    const {Manifold} = this;
    switch (solid.solid) {
      case 'cube': return this.unit('cube', () => Manifold.cube([2, 2, 2], true)).transform(placement(solid));
      case 'sphere':
      case 'ellipsoid': return this.ball().transform(placement(solid));
      case 'cylinder': return this.unit('cylinder', () => this.upright(1, 1)).transform(placement(solid));
      case 'cone': return this.unit('cone', () => this.upright(1, 0)).transform(placement(solid));
      case 'pyramid':
        return this.unit('pyramid', () => Manifold.hull([[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1], [0, 1, 0]]))
            .transform(placement(solid));
      case 'prism': return this.unit('prism', () => this.extruded([[-1, -1], [1, -1], [0, 1]])).transform(placement(solid));
      case 'wedge': return this.unit('wedge', () => this.extruded([[-1, -1], [1, -1], [-1, 1]])).transform(placement(solid));
      case 'torus': {
        const {tube} = solid;
        const ring = this.CrossSection.circle(tube, this.sides).translate([1 - tube, 0]);
        return ring.revolve(this.sides).rotate([-90, 0, 0]).transform(placement(solid, [1, 1 / tube, 1]));
      }
      case 'capsule': {
        const [x, y, z] = solid.size.map(s => s / 2), r = Math.min(x, y, z);
        const end = h => this.ball().translate([0, h / r, 0]);
        const hull = y > r ? Manifold.hull([end(y - r), end(r - y)]) : this.ball();
        return hull.transform(placement({...solid, size: [2 * x, 2 * r, 2 * z]}));
      }
      case 'halfspace': {
        // As much of it as lies about the model: a box below the plane.
        const {low, high} = this.bounds, middle = low.map((l, i) => (l + high[i]) / 2 - solid.centre[i]);
        const reach = 2 * Math.hypot(...low.map((l, i) => high[i] - l)) + 2 * Math.hypot(...middle);
        const centre = solid.centre.map((c, i) => c - solid.axes[1][i] * reach / 2);
        return this.make({...solid, solid: 'cube', centre, size: [2 * reach, reach, 2 * reach]});
      }
    }
    throw new Error(`no solid is called '${solid.solid}'`);
  }
}

export const isRound = node => ['sphere', 'ellipsoid', 'cylinder', 'cone', 'torus', 'capsule'].includes(node.solid);

/// The least extent of each node's solid in metres; 0 for booleans.
export function thicknesses(tree) {
  return tree.nodes.map(n => n.solid === 'torus' ? Math.min(n.size[1], n.tube * Math.min(n.size[0], n.size[2])) :
      n.solid === 'halfspace'                    ? 1e30 :
      n.solid                                    ? Math.min(...n.size) :
                                                   0);
}
