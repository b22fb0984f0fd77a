// Draws a model (decoder/map_mesh.js) by WebGL 2: the maps and the planes are textures, each patch is one draw call over
// its supported samples.

const PLANES_WIDTH = 1024;  // texels; a multiple of the four that a patch takes

class Renderer {
  // gl: a WebGL 2 context.
  constructor(gl) {
    this.gl = gl;
    this.textures = [null, null];
    this.program = linked_program(gl, VERTEX_SHADER, FRAGMENT_SHADER);
    this.uniforms = Object.fromEntries(
      ["cells", "planes", "camera", "eye", "shading"].map((name) => [name, gl.getUniformLocation(this.program, name)]));
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(1, 1, 1, 1);
  }

  // Error: the model does not fit into the card's textures.
  upload(model) {
    this.upload_cells(model.cells);
    this.upload_planes(model);
    this.upload_indices(model);
  }

  upload_cells(given) {
    const gl = this.gl, count = given.length / 3, most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    this.cells_width = Math.min(most, 4096);
    const height = Math.max(1, Math.ceil(count / this.cells_width));
    if (height > most) throw new Error(`Maps of ${count} cells do not fit into this graphics card's textures.`);
    const cells = new Uint16Array(3 * this.cells_width * height);
    cells.set(given);
    this.set_texture(0, gl.RGB16UI, this.cells_width, height, gl.RGB_INTEGER, gl.UNSIGNED_SHORT, cells);
  }

  upload_planes(model) {
    const { gl, cells_width } = this;
    const height = Math.max(1, Math.ceil((4 * model.patches.length) / PLANES_WIDTH));
    const planes = new Float32Array(4 * PLANES_WIDTH * height);
    model.patches.forEach((patch, i) => {
      const place = [patch.columns, Math.floor(patch.first_cell / cells_width), patch.first_cell % cells_width, 0];
      patch.matrix.forEach((column, c) => planes.set([...column, place[c]], 16 * i + 4 * c));
    });
    this.set_texture(1, gl.RGBA32F, PLANES_WIDTH, height, gl.RGBA, gl.FLOAT, planes);
  }

  set_texture(unit, internal_format, width, height, format, type, values) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.deleteTexture(this.textures[unit]);
    this.textures[unit] = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.textures[unit]);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal_format, width, height, 0, format, type, values);
  }

  upload_indices(model) {
    const gl = this.gl;
    let bytes = 0;
    this.draws = model.patches.map(({ indices }) => {
      const offset = Math.ceil(bytes / 4) * 4;
      bytes = offset + indices.byteLength;
      return { offset, count: indices.length, type: indices.BYTES_PER_ELEMENT === 2 ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT };
    });
    this.patch_vertices = gl.createVertexArray();
    gl.bindVertexArray(this.patch_vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
    model.patches.forEach(({ indices }, i) => gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, this.draws[i].offset, indices));
  }

  // gaps: decoder/closed_surface.js
  upload_gaps(gaps) {
    const gl = this.gl;
    this.upload_cells(gaps.cells);
    this.gap_vertices = gl.createVertexArray();
    gl.bindVertexArray(this.gap_vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, gaps.corners, gl.STATIC_DRAW);
    gl.vertexAttribIPointer(0, 2, gl.UNSIGNED_INT, 0, 0);
    gl.enableVertexAttribArray(0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, gaps.indices, gl.STATIC_DRAW);
    this.gap_corners = gaps.indices.length;
  }

  // shading: one of SHADINGS.
  draw(camera, shading) {
    const gl = this.gl, width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.draws) return;
    gl.useProgram(this.program);
    gl.uniform1i(this.uniforms.cells, 0);
    gl.uniform1i(this.uniforms.planes, 1);
    gl.uniformMatrix4fv(this.uniforms.camera, false, camera.matrix(width / height));
    gl.uniform3fv(this.uniforms.eye, camera.position());
    gl.uniform1i(this.uniforms.shading, SHADINGS.indexOf(shading));
    gl.bindVertexArray(this.patch_vertices);
    this.draws.forEach(({ offset, count, type }, patch) => {
      gl.vertexAttribI4ui(0, patch, NO_CELL, 0, 0);
      gl.drawElements(gl.TRIANGLES, count, type, offset);
    });
    if (!this.gap_vertices) return;
    gl.bindVertexArray(this.gap_vertices);
    gl.drawElements(gl.TRIANGLES, this.gap_corners, gl.UNSIGNED_INT, 0);
  }
}

function linked_program(gl, vertex_source, fragment_source) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex_source], [gl.FRAGMENT_SHADER, fragment_source]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
      throw new Error(`a shader does not compile: ${gl.getShaderInfoLog(shader)}`);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
    throw new Error(`the shaders do not link: ${gl.getProgramInfoLog(program)}`);
  return program;
}
