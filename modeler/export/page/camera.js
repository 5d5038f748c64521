"use strict";
// Vectors, matrices (by columns) and the camera.

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const l = Math.hypot(...a) || 1; return [a[0] / l, a[1] / l, a[2] / l]; };

function product(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; ++c)
    for (let r = 0; r < 4; ++r) for (let k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return out;
}

/** From the object's frame to that of an eye with these axes. */
function viewMatrix(right, up, back, eye) {
  return [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1];
}

function perspective(height, aspect, near, far) {
  const f = 1 / height;
  return [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
}

/** A box of half width r across, and from near to far, as light that comes from one side sees it. */
function parallel(r, near, far) {
  return [1 / r, 0, 0, 0, 0, 1 / r, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0, -(far + near) / (far - near), 1];
}

/** Looks at `target` from `distance`: yaw about y, pitch above the horizon. */
class Camera {
  constructor(model) {
    this.model = model;
    this.half = Math.tan(Math.PI / 10);  // half the height of the picture, a metre away
    this.yaw = 0.65;
    this.pitch = 0.42;
    this.aspect = 1;
    this.fit();
  }

  fit() {
    this.target = this.model.middle.slice();
    this.distance = this.model.radius / Math.sin(Math.atan(this.half * Math.min(1, this.aspect))) * 0.92;
  }

  update() {
    const cp = Math.cos(this.pitch);
    this.back = [cp * Math.sin(this.yaw), Math.sin(this.pitch), cp * Math.cos(this.yaw)];
    this.right = [Math.cos(this.yaw), 0, -Math.sin(this.yaw)];
    this.up = cross(this.back, this.right);
    this.eye = add(this.target, this.back, this.distance);
    const reach = this.distance + 4 * this.model.radius;
    const view = viewMatrix(this.right, this.up, this.back, this.eye);
    this.matrix = product(perspective(this.half, this.aspect, reach / 4000, reach), view);
  }

  /** The ray through a point of the picture, x and y from -1 to 1. */
  ray(x, y) {
    const side = add(this.right.map((v) => v * x * this.half * this.aspect), this.up, y * this.half);
    return { from: this.eye, along: unit(add(side, this.back, -1)) };
  }

  /** Where a point is in the picture, -1 to 1; null behind the eye. */
  project(p) {
    const m = this.matrix, at = (r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
    return at(3) > 0 ? [at(0) / at(3), at(1) / at(3)] : null;
  }

  orbit(dx, dy) {
    this.yaw -= dx * 0.006;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + dy * 0.006));
  }

  pan(dx, dy, height) {
    const metres = (2 * this.half * this.distance) / height;
    this.target = add(add(this.target, this.right, -dx * metres), this.up, dy * metres);
  }

  zoom(factor) {
    this.distance = Math.max(this.model.radius / 500, Math.min(20 * this.model.radius, this.distance * factor));
  }
}
