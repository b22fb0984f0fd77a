// The page: decodes its model beside itself, draws it, says what it is or what is wrong.

class Page {
  constructor() {
    const view = view_of_link(location.hash);
    this.canvas = document.getElementById("view");
    this.shading = view.shading || "lighting";
    delete view.shading;
    this.camera = new Camera(view, this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight));
    this.changed = false;
  }

  // Fulfilled when the whole model is on the screen; rejected, with what is wrong as message, when it can't be.
  async open() {
    this.start_drawing();
    const bytes = stream_bytes(document.getElementById("stream"));
    await decode_beside(bytes, (message) => this.take(message));
  }

  // What the decoder sends, one by one (decoder/worker.js).
  take({ progress, model, gaps }) {
    if (progress !== undefined) document.getElementById("progress").value = progress;
    if (!model && !gaps) return;
    this.upload(model, gaps);
    this.draw();
    if (model) this.model = model;
    if (gaps) this.gaps = gaps;
    this.describe();
    document.body.dataset.state = "drawn";
  }

  upload(model, gaps) {
    if (model) this.renderer.upload(model);
    if (gaps) this.renderer.upload_gaps(gaps);
  }

  start_drawing() {
    const gl = this.canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!gl) throw new Error("This page needs WebGL 2, which this browser does not have or has switched off.");
    this.renderer = new Renderer(gl);
    new ResizeObserver(() => this.draw_soon()).observe(this.canvas);
    follow_input(this.canvas, this.camera, () => this.draw_soon());
    for (const choice of document.querySelectorAll("input[name=shading]")) {
      choice.checked = choice.value === this.shading;
      choice.addEventListener("change", () => this.shade(choice.value));
    }
    document.getElementById("reset").addEventListener("click", () => {
      this.camera.reset();
      this.draw_soon();
    });
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.renderer = new Renderer(gl);
      this.upload(this.model, this.gaps);
      this.draw_soon();
    });
  }

  shade(shading) {
    this.shading = shading;
    this.draw_soon();
  }

  draw_soon() {
    if (this.changed) return;
    this.changed = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.changed = false;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * scale));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * scale));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.renderer.draw(this.camera, this.shading);
  }

  describe() {
    const { samples, bytes, patches, decode_seconds } = this.model;
    const number = (x) => x.toLocaleString("en");
    document.getElementById("facts").textContent =
      `${number(samples)} samples in ${number(bytes)} bytes (${((8 * bytes) / samples).toFixed(2)} bits each), ` +
      `${number(patches.length)} patches, decoded in ${decode_seconds.toFixed(1)} s`;
  }

  fail(message) {
    document.getElementById("message").textContent = message;
    document.body.dataset.state = "failed";
  }
}

function stream_bytes(element) {
  try {
    return Uint8Array.from(atob(element.textContent.trim()), (letter) => letter.charCodeAt(0));
  } catch {
    throw new Error("The model is damaged: its bytes are not whole.");
  }
}

// Hands on what the decoder sends, take(message); fulfilled behind the last. By a worker where the browser allows one, else
// by the page itself.
function decode_beside(bytes, take) {
  return new Promise((resolve, reject) => {
    const take_next = (message) => {
      try {
        if (message.error) throw new Error(message.error);
        take(message);
        if (message.gaps !== undefined) resolve();
      } catch (error) {
        reject(error);
      }
    };
    const decode_here = () => setTimeout(() => decode_in_steps(bytes, take_next));
    let worker;
    try {
      const source = new Blob([document.getElementById("decoder").textContent], { type: "text/javascript" });
      worker = new Worker(URL.createObjectURL(source));
    } catch {
      return decode_here();
    }
    worker.onmessage = ({ data }) => {
      take_next(data);
      if (data.error || data.gaps !== undefined) worker.terminate();
    };
    worker.onerror = (event) => {
      event.preventDefault();
      worker.terminate();
      decode_here();
    };
    worker.postMessage({ bytes });
  });
}

let page;

// Settled when the model is drawn or a message says why not. The model's bytes stand at the end of the document.
const opened = new Promise((resolve) => document.addEventListener("DOMContentLoaded", resolve)).then(() => {
  page = new Page();
  return page.open().catch((error) => page.fail(error.message));
});
