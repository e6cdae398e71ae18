// Which part of the window the room is drawn in: the part that the panel leaves free.

const FOV = 45; // [deg] across the shorter side of the free part
const PANEL = 360; // [px] its width, with the gap beside it
const NARROW = 640; // [px] up to this width viewer.css puts the panel across the top, in so much of the height:
const TOP = 0.45;

/// {fov [deg], across the whole height; left, top: how much of the picture is pushed out of the panel's way [px]}.
export function framing(width, height) {
  const narrow = width <= NARROW;
  const [left, top] = [narrow ? 0 : PANEL, narrow ? TOP * height : 0];
  const free = Math.max(1, Math.min(width - left, height - top));
  const half = Math.tan((FOV * Math.PI) / 360) * Math.max(1, height / free);
  return { fov: Math.min(120, (Math.atan(half) * 360) / Math.PI), left: left / 2, top: top / 2 };
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
