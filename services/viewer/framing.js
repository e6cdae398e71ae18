// Which part of the window the room is drawn in: the part that the panels leave free.

const FOV = 45; // [deg] across the shorter side of the free part

/// {fov [deg], across the whole height; left, top: how much of the picture is pushed out of the panels' way [px]}.
/// `margins`: what the panels cover at each side [px].
export function framing(width, height, { left = 0, right = 0, top = 0, bottom = 0 } = {}) {
  const free = Math.max(1, Math.min(width - left - right, height - top - bottom));
  const half = Math.tan((FOV * Math.PI) / 360) * Math.max(1, height / free);
  return { fov: Math.min(120, (Math.atan(half) * 360) / Math.PI), left: (left - right) / 2, top: (top - bottom) / 2 };
}

/// The middle of the sensors and of what each looks at, and how far all that reaches [m].
export function roomOf(places) {
  const AHEAD = 2.5; // [m] where a sensor sees people best
  const points = places.flatMap(({ x, z, qx, qy, qz, qw }) => [
    { x, z }, { x: x + AHEAD * 2 * (qx * qz + qw * qy), z: z + AHEAD * (1 - 2 * (qx * qx + qy * qy)) },
  ]);
  const middle = (axis) => points.reduce((sum, point) => sum + point[axis], 0) / Math.max(1, points.length);
  const centre = { x: middle('x'), z: middle('z') };
  return { centre, reach: Math.max(2.2, ...points.map((point) => Math.hypot(point.x - centre.x, point.z - centre.z))) };
}
