// Mouse, touch and keys: drag turns, wheel and two fingers come nearer, arrows and + - 0 do the same.

const DEGREES_PER_PIXEL = 0.35;
const KEY_DEGREES = 5;
const KEY_ZOOM = 1.1;
const KEYS = {
  ArrowLeft: (camera) => camera.turn(-KEY_DEGREES, 0),
  ArrowRight: (camera) => camera.turn(KEY_DEGREES, 0),
  ArrowUp: (camera) => camera.turn(0, KEY_DEGREES),
  ArrowDown: (camera) => camera.turn(0, -KEY_DEGREES),
  "+": (camera) => camera.approach(1 / KEY_ZOOM),
  "=": (camera) => camera.approach(1 / KEY_ZOOM),
  "-": (camera) => camera.approach(KEY_ZOOM),
  "0": (camera) => camera.reset(),
  Home: (camera) => camera.reset(),
};

// moved(): called after each change of the camera.
function follow_input(canvas, camera, moved) {
  const pointers = new Map();  // where each finger or button that is down was last
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const here = { x: event.clientX, y: event.clientY };
    if (pointers.size === 1) {
      camera.turn((last.x - here.x) * DEGREES_PER_PIXEL, (here.y - last.y) * DEGREES_PER_PIXEL);
      pointers.set(event.pointerId, here);
    } else if (pointers.size === 2) {
      const before = spread();
      pointers.set(event.pointerId, here);
      if (spread() > 0) camera.approach(before / spread());
    }
    moved();
  });
  for (const name of ["pointerup", "pointercancel"])
    canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const pixels = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY : event.deltaY * 30;
    camera.approach(Math.exp(limited(pixels, -300, 300) * 0.0015));
    moved();
  }, { passive: false });
  canvas.addEventListener("dblclick", () => {
    camera.reset();
    moved();
  });
  canvas.addEventListener("keydown", (event) => {
    if (!KEYS[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    KEYS[event.key](camera);
    moved();
  });
}
