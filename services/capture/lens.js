// Which direction a pixel shows: the lens as the hello states it (proto/bridge.md, section 2).  Lengths in pixels, angles in degrees.

const RADIANS = Math.PI / 180;
const SAME_SHAPE = 0.01; // tolerance for the ratio of the sides
const KEYS = ['width', 'height', 'fx', 'fy', 'cx', 'cy'];

/// A usual webcam, if nothing better is known; sigma is a standard deviation.
export const USUAL_VIEW = { fov: 65, sigma: 6 };

/// The size at which a picture is looked at: at most `maxSide` in either direction.
export function sentSize({ width, height }, maxSide) {
  const scale = Math.min(1, maxSide / Math.max(width, height));
  return { width: Math.max(1, Math.round(width * scale)), height: Math.max(1, Math.round(height * scale)) };
}

/// From the field of view across the longer side.  Here and below [0, 0] is the corner of the upper left pixel, not its centre.
export function lensOfView({ fov, sigma }, sent) {
  const f = Math.max(sent.width, sent.height) / 2 / Math.tan((fov * RADIANS) / 2);
  return {
    intrinsics: { ...sent, fx: f, fy: f, cx: sent.width / 2, cy: sent.height / 2 },
    focalSigma: (sigma * RADIANS) / Math.sin(fov * RADIANS), // d ln f / d fov
  };
}

/// From a calibration for pictures of the same shape, whose coordinates count from pixel centres (OpenCV).  Throws what is wrong.
export function lensOfCalibration(calibration, picture, sent) {
  if (Math.abs((picture.width / picture.height) / (calibration.width / calibration.height) - 1) > SAME_SHAPE) {
    throw new Error(`The calibration is for pictures of ${calibration.width} x ${calibration.height}, and the camera gives ${picture.width} x ${picture.height}.`);
  }
  const [x, y] = [sent.width / calibration.width, sent.height / calibration.height];
  const { fx, fy, cx, cy, distortion, focal_sigma_percent: percent = 0 } = calibration;
  return {
    intrinsics: { ...sent, fx: fx * x, fy: fy * y, cx: (cx + 0.5) * x, cy: (cy + 0.5) * y, ...(distortion && { distortion }) },
    focalSigma: percent / 100,
  };
}

/// A file with the keys of device.camera.intrinsics (and focal_sigma_percent, how sure the focal length is), or a sensor's configuration that
/// has them.  Throws what is wrong.
export function readCalibration(text) {
  let root;
  try {
    root = JSON.parse(text);
  } catch {
    throw new Error('The file is no JSON.');
  }
  const found = root?.device?.camera?.intrinsics ?? root?.intrinsics ?? root;
  const wrong = KEYS.filter((key) => !Number.isFinite(found?.[key]));
  if (wrong.length > 0) throw new Error(`The file has no ${wrong.join(', ')}: it is not what chorus calibrate camera writes.`);
  if (KEYS.slice(0, 4).some((key) => found[key] < 1)) throw new Error('Sizes and focal lengths in the file must be at least one pixel.');
  const { distortion } = found;
  const five = Array.isArray(distortion) && distortion.length === 5 && distortion.every(Number.isFinite);
  if (distortion !== undefined && !five) throw new Error('The distortion in the file is not five numbers: k1 k2 p1 p2 k3.');
  const percent = found.focal_sigma_percent;
  if (percent !== undefined && !(percent >= 0 && percent <= 50)) throw new Error('How sure the focal length is must be 0 to 50 percent.');
  return { ...Object.fromEntries(KEYS.map((key) => [key, found[key]])), ...(five && { distortion }), ...(percent && { focal_sigma_percent: percent }) };
}

/// "71 x 43 degrees": what a lens sees.
export function viewOf({ width, height, fx, fy }) {
  const across = (side, f) => Math.round((2 * Math.atan(side / 2 / f)) / RADIANS);
  return `${across(width, fx)} x ${across(height, fy)} degrees`;
}
