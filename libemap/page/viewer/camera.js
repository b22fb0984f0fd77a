// The camera looks at the model's centre from an azimuth and an elevation, in degrees, at a distance in diagonals of the
// model's bounding box; +y is up. `emap render --camera` means the same by the same numbers.
"use strict";

const FIELD_OF_VIEW_DEGREES = 30;  // vertical
const START = { azimuth: 30, elevation: 15, distance: 2 };
const STEEPEST_ELEVATION = 89;
const NEAREST = 0.2, FARTHEST = 10;
const MODEL_RADIUS = 0.52;  // half a diagonal, and what a decoded surface may stick out

function radians(degrees) {
  return (degrees * Math.PI) / 180;
}

function limited(x, low, high) {
  return Math.min(Math.max(x, low), high);
}

class Camera {
  // given: what of azimuth, elevation and distance is not to be as usual. In views that are higher than wide (aspect: width /
  // height) one starts farther off, so that long models fit.
  constructor(given, aspect) {
    const distance = START.distance * Math.max(1, 0.8 / aspect);
    this.start = { ...START, distance, ...given };
    this.reset();
  }

  reset() {
    Object.assign(this, this.start);
    this.turn(0, 0);
    this.approach(1);
  }

  turn(azimuth_degrees, elevation_degrees) {
    this.azimuth = (this.azimuth + azimuth_degrees) % 360;
    this.elevation = limited(this.elevation + elevation_degrees, -STEEPEST_ELEVATION, STEEPEST_ELEVATION);
  }

  approach(factor) {
    this.distance = limited(this.distance * factor, NEAREST, FARTHEST);
  }

  position() {
    const azimuth = radians(this.azimuth), elevation = radians(this.elevation);
    const direction = [
      Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation), Math.cos(elevation) * Math.cos(azimuth),
    ];
    return direction.map((x) => x * this.distance);
  }

  // From the centred model of diagonal 1 to the screen, column by column. aspect: width / height.
  matrix(aspect) {
    const azimuth = radians(this.azimuth), elevation = radians(this.elevation);
    const [sin_a, cos_a, sin_e, cos_e] = [
      Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation),
    ];
    const right = [cos_a, 0, -sin_a], up = [-sin_e * sin_a, cos_e, -sin_e * cos_a];
    const back = [cos_e * sin_a, sin_e, cos_e * cos_a];
    const near = Math.max(this.distance - MODEL_RADIUS, this.distance / 200), far = this.distance + MODEL_RADIUS;
    const scale_y = 1 / Math.tan(radians(FIELD_OF_VIEW_DEGREES) / 2), scale_x = scale_y / aspect;
    const a = (far + near) / (near - far), b = (2 * far * near) / (near - far);
    // The eye's depth is back . x - distance.
    const column = (axis) => [scale_x * right[axis], scale_y * up[axis], a * back[axis], -back[axis]];
    return new Float32Array([...column(0), ...column(1), ...column(2), 0, 0, -a * this.distance + b, this.distance]);
  }
}

// The view that a link asks for behind its #: azimuth, elevation, distance and shading. What is no number is left out.
function view_of_link(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, "")), view = {};
  for (const name of ["azimuth", "elevation", "distance"])
    if (given.has(name) && given.get(name).trim() !== "" && Number.isFinite(Number(given.get(name))))
      view[name] = Number(given.get(name));
  if (SHADINGS.includes(given.get("shading"))) view.shading = given.get("shading");
  return view;
}
