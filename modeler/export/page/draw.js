"use strict";
// Draws the model by WebGL 2.

class Renderer {
  constructor(canvas, model) {
    this.canvas = canvas;
    this.model = model;
    const gl = (this.gl = canvas.getContext("webgl2", { antialias: true, stencil: true, alpha: true, preserveDrawingBuffer: true }));
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.programs = {
      surface: this.program(surfaceVertex, surfaceFragment),
      depth: this.program(surfaceVertex, depthFragment),
      ground: this.program(planeVertex, groundFragment),
      cap: this.program(planeVertex, capFragment),
    };
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    this.attribute(0, model.positions, 3, gl.FLOAT);
    this.attribute(1, model.normals, 2, gl.BYTE);
    if (model.uvs) this.attribute(2, model.uvs, 2, gl.FLOAT);
    this.textures = model.pictures.map(() => ({}));
    this.triangleBuffer = this.elements(model.indices);
    this.edgeBuffer = this.elements(edgesOf(model));
    this.none = gl.createVertexArray();
    this.makeShadow();
    this.sun = unit([0.55, 0.75, 0.42]);
    const right = unit(cross([0, 1, 0], this.sun)), r = model.radius * 1.02;
    this.light = product(parallel(r, 0, 8 * r), viewMatrix(right, cross(this.sun, right), this.sun, add(model.middle, this.sun, 2 * r)));
    this.shown = { hidden: new Set(), section: null, edges: true, shadow: true, marked: -1, line: null };
    this.staleShadow = true;
  }

  program(vertex, fragment) {
    const { gl } = this, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const places = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
      const { name } = gl.getActiveUniform(program, i);
      places[name] = gl.getUniformLocation(program, name);
    }
    return { program, places };
  }

  attribute(index, data, size, type) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(index);
    gl.vertexAttribPointer(index, size, type, type === gl.BYTE, 0, 0);
  }

  elements(data) {
    const { gl } = this, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, data, gl.STATIC_DRAW);
    return buffer;
  }

  makeShadow() {
    const { gl } = this;
    this.depths = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.depths);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, 2048, 2048);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, axis, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    this.shadowTarget = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depths, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** A picture that repeats, as colours (sRGB) or as numbers. */
  texture(file, isColor) {
    const { gl } = this, made = this.textures[file], key = isColor ? "color" : "number";
    if (made[key]) return made[key];
    const texture = (made[key] = gl.createTexture());
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, isColor ? gl.SRGB8_ALPHA8 : gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, this.model.pictures[file]);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    const sharp = gl.getExtension("EXT_texture_filter_anisotropic");
    if (sharp) gl.texParameterf(gl.TEXTURE_2D, sharp.TEXTURE_MAX_ANISOTROPY_EXT, 8);
    return texture;
  }

  /** Sets what covers the patches of a material that are drawn next. */
  cover(places, material) {
    const { gl } = this, texture = material.texture, files = texture ? [texture.color, texture.normals, texture.roughness] : [-1, -1, -1];
    gl.uniform3f(places.mapped, ...files.map((file) => (file >= 0 ? 1 : 0)));
    gl.uniform2f(places.tiles, texture ? 1 / texture.width : 0, texture ? 1 / texture.height : 0);
    files.forEach((file, i) => {
      if (file < 0) return;
      gl.activeTexture(gl.TEXTURE1 + i);
      gl.bindTexture(gl.TEXTURE_2D, this.texture(file, i === 0));
    });
    gl.activeTexture(gl.TEXTURE0);
  }

  use({ program, places }, camera) {
    const { gl } = this;
    gl.useProgram(program);
    const section = this.shown.section || { normal: [0, 0, 0], at: 1 };
    const set = {
      camera: (p) => gl.uniformMatrix4fv(p, false, camera), light: (p) => gl.uniformMatrix4fv(p, false, this.light),
      sun: (p) => gl.uniform3fv(p, this.sun), eye: (p) => gl.uniform3fv(p, this.eye), depths: (p) => gl.uniform1i(p, 0),
      section: (p) => gl.uniform4f(p, ...section.normal, section.at), shadows: (p) => gl.uniform1f(p, this.shown.shadow ? 0.85 : 0),
      marked: (p) => gl.uniform3f(p, 0, 0, 0), flat_: (p) => gl.uniform1f(p, 0), color: (p) => gl.uniform3f(p, 0, 0, 0), finish: (p) => gl.uniform2f(p, 1, 0),
      mapped: (p) => gl.uniform3f(p, 0, 0, 0), tiles: (p) => gl.uniform2f(p, 0, 0),
      colorMap: (p) => gl.uniform1i(p, 1), normalMap: (p) => gl.uniform1i(p, 2), roughnessMap: (p) => gl.uniform1i(p, 3),
    };
    for (const [name, place] of Object.entries(places)) if (set[name]) set[name](place);
    return places;
  }

  get patches() {
    return this.model.patches.filter((patch) => !this.shown.hidden.has(patch.group));
  }

  drawSurface() {
    const { gl } = this;
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangleBuffer);
    for (const patch of this.patches) gl.drawElements(gl.TRIANGLES, 3 * patch.triangles, gl.UNSIGNED_INT, 4 * patch.first);
  }

  drawShadow() {
    const { gl } = this;
    this.staleShadow = false;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
    gl.viewport(0, 0, 2048, 2048);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.bindTexture(gl.TEXTURE_2D, null);
    this.use(this.programs.depth, this.light);
    this.drawSurface();
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, this.depths);
  }

  draw(camera) {
    const { gl, canvas } = this;
    this.eye = camera.eye;
    if (this.staleShadow) this.drawShadow();
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    this.drawMaterials(camera);
    if (this.shown.section && this.shown.hidden.size === 0) this.drawCap(camera);
    if (this.shown.edges) this.drawEdges(camera);
    this.drawGround(camera);
  }

  drawMaterials(camera) {
    const { gl, model } = this, places = this.use(this.programs.surface, camera.matrix);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangleBuffer);
    const mark = (patch, run) => (this.shown.marked >= 0 && run.part === this.shown.marked) || this.shown.markedGroup === patch.group || this.shown.markedMaterial === patch.material;
    for (const patch of this.patches) {
      const material = model.materials[patch.material];
      gl.uniform3fv(places.color, material.color);
      gl.uniform2f(places.finish, material.roughness, material.metallic);
      this.cover(places, material);
      gl.drawElements(gl.TRIANGLES, 3 * patch.triangles, gl.UNSIGNED_INT, 4 * patch.first);
      const runs = patch.runs.filter((run) => mark(patch, run));
      if (runs.length === 0) continue;
      gl.uniform3f(places.marked, 1, 0.32, 0.06);
      gl.depthFunc(gl.LEQUAL);
      for (const run of runs) gl.drawElements(gl.TRIANGLES, run.count, gl.UNSIGNED_INT, 4 * run.first);
      gl.depthFunc(gl.LESS);
      gl.uniform3f(places.marked, 0, 0, 0);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** Fills what the section opens: where more back faces than front faces lie behind it, the plane is inside. */
  drawCap(camera) {
    const { gl } = this, { normal, at } = this.shown.section, r = 2 * this.model.radius;
    gl.enable(gl.STENCIL_TEST);
    gl.enable(gl.CULL_FACE);
    gl.colorMask(false, false, false, false);
    gl.depthMask(false);
    gl.disable(gl.DEPTH_TEST);
    this.use(this.programs.depth, camera.matrix);
    gl.stencilFunc(gl.ALWAYS, 0, 255);
    for (const [side, change] of [[gl.FRONT, gl.INCR_WRAP], [gl.BACK, gl.DECR_WRAP]]) {
      gl.cullFace(side);
      gl.stencilOp(gl.KEEP, gl.KEEP, change);
      this.drawSurface();
    }
    gl.disable(gl.CULL_FACE);
    gl.colorMask(true, true, true, true);
    gl.depthMask(true);
    gl.enable(gl.DEPTH_TEST);
    gl.stencilFunc(gl.NOTEQUAL, 0, 255);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    const places = this.use(this.programs.cap, camera.matrix);
    gl.uniform3f(places.hatch, 0.87, 0.80, 0.76);
    const along = Math.abs(normal[1]) > 0.5 ? [1, 0, 0] : [0, 1, 0];
    const middle = add(this.model.middle, normal, at - dot(this.model.middle, normal));
    this.plane(places, middle, along.map((v) => v * r), cross(normal, along).map((v) => v * r));
    gl.disable(gl.STENCIL_TEST);
  }

  drawEdges(camera) {
    const { gl } = this, places = this.use(this.programs.surface, camera.matrix);
    gl.uniform3f(places.color, 0.05, 0.05, 0.06);
    gl.uniform1f(places.flat_, 0.45);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edgeBuffer);
    for (const patch of this.patches) gl.drawElements(gl.LINES, patch.edges, gl.UNSIGNED_INT, 4 * patch.firstEdge);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawGround(camera) {
    const { gl, model } = this;
    if (!this.shown.shadow || camera.eye[1] < model.lo[1]) return;
    const places = this.use(this.programs.ground, camera.matrix), r = 3 * model.radius;
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    this.plane(places, [model.middle[0], model.lo[1] - model.radius * 5e-4, model.middle[2]], [r, 0, 0], [0, 0, r]);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  plane(places, middle, along, across) {
    const { gl } = this;
    gl.uniform3fv(places.middle, middle);
    gl.uniform3fv(places.along, along);
    gl.uniform3fv(places.across, across);
    gl.bindVertexArray(this.none);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }
}
