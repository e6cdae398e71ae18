// How sure the tracker is of a joint: its covariance as an ellipsoid, and in words.  Pure: nothing here draws.

/// The 95 % quantile of chi squared with three degrees of freedom, square root: how many standard deviations the
/// ellipsoid reaches that holds the true place in 95 % of all cases.
export const REACH = Math.sqrt(7.8147);
const NAMES = ['cxx', 'cxy', 'cxz', 'cyy', 'cyz', 'czz'];

/// The terms [xx, xy, xz, yy, yz, zz] of a joint's covariance [m^2]; null where none is stated.
export function covarianceOf(joint) {
  const terms = NAMES.map((name) => Number(joint?.[name] ?? NaN));
  return terms.every(Number.isFinite) ? terms : null;
}

/// The lower triangle [l11, l21, l22, l31, l32, l33] with L L^T = covariance: L turns the unit sphere into the ellipsoid of one
/// standard deviation.  A covariance with no extent in some direction gives a flat one.
export function rootOf([xx, xy, xz, yy, yz, zz]) {
  const root = (square) => Math.sqrt(Math.max(square, 0));
  const over = (value, pivot) => (pivot > 0 ? value / pivot : 0);
  const l11 = root(xx);
  const l21 = over(xy, l11);
  const l31 = over(xz, l11);
  const l22 = root(yy - l21 * l21);
  const l32 = over(yz - l31 * l21, l22);
  return [l11, l21, l22, l31, l32, root(zz - l31 * l31 - l32 * l32)];
}

/// Standard deviations along the ellipsoid's axes [m], largest first: the roots of the eigenvalues, by the
/// trigonometric solution of the characteristic equation.
export function axesOf([xx, xy, xz, yy, yz, zz]) {
  const mean = (xx + yy + zz) / 3;
  const [a, b, c] = [xx - mean, yy - mean, zz - mean];
  const spread = Math.sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
  if (spread <= 1e-9 * mean || spread === 0) return [mean, mean, mean].map(Math.sqrt);
  const determinant = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / spread ** 3;
  const turn = Math.acos(Math.min(Math.max(determinant / 2, -1), 1)) / 3;
  return [0, -2, 2].map((k) => mean + 2 * spread * Math.cos(turn + (k * Math.PI) / 3))
    .sort((first, second) => second - first)
    .map((variance) => Math.sqrt(Math.max(variance, 0)));
}

/// Colours of people, by id, so that a person keeps his colour.
const PEOPLE = ['#f4f6f8', '#7cc7ff', '#ffd166', '#9be89b', '#ff9ecf', '#c9b6ff', '#ffb08a', '#8ee6dc'];
export const colourOf = (id) => PEOPLE[((Number(id) % PEOPLE.length) + PEOPLE.length) % PEOPLE.length];

const millimetres = (metres) => Math.round(1000 * metres);
const percent = (share) => `${Math.round(100 * share)} %`;

function sizeLine(joint) {
  const covariance = covarianceOf(joint);
  if (!covariance) return 'how sure: not stated';
  const [long, middle, short] = axesOf(covariance).map((sigma) => millimetres(REACH * sigma));
  return `95 % within ±${long} × ${middle} × ${short} mm`;
}

/// The sensors that a joint came from, [{ id, share }], largest share first; NaN where it is not known.
/// The shares are listed in the order of the ids; one sensor has all.
export function sharesOf(joint) {
  const ids = [...(joint.contributors ?? [])].sort();
  const shares = joint.shares ?? (ids.length === 1 ? [1] : []);
  return ids.map((id, i) => ({ id, share: Number(shares[i] ?? NaN) }))
    .sort((first, second) => (second.share - first.share) || 0);
}

function sensorsLine(joint) {
  const from = sharesOf(joint).map(({ id, share }) => (Number.isFinite(share) ? `${id} ${percent(share)}` : id));
  return from.length > 0 ? `from ${from.join(', ')}` : 'from no sensor: where it is expected';
}

/// How old a joint is [ms]: the frame's age, and how long before the frame a sensor last contributed; NaN: not known.
export function ageOfJoint(joint, frameAge) {
  const before = (joint.contributors ?? []).length > 0 ? 0 : Number(joint.age ?? NaN);
  return frameAge + 1000 * before;
}

function ageLine(body, joint, frameAge) {
  const age = ageOfJoint(joint, frameAge);
  return `${presence(body)}${Number.isFinite(age) ? `, ${Math.round(age)} ms old` : ''}`;
}

/// "seen", or for how long nobody has seen the person.
export function presence(body) {
  return body.carriedFor === undefined ? 'seen' : `out of sight for ${Number(body.carriedFor).toFixed(1)} s`;
}

/// One line about a person: who, seen or carried, how tall if that is stated, and how sure left and right are.
export function personLine(body) {
  const sides = Number(body.sidesConfidence ?? NaN);
  const stature = Number(body.stature ?? NaN);
  const sure = Number.isFinite(sides) ? `left and right ${Math.floor(100 * sides)} % certain` : 'left and right not looked at';
  return `person ${body.bodyId}: ${[presence(body), ...(Number.isFinite(stature) ? [`${Math.round(100 * stature)} cm`] : []), sure].join(', ')}`;
}

/// What is known of one joint, in lines.  `frameAge`: age of the frame [ms].
export function jointLines(body, name, frameAge) {
  const joint = body.joints[name];
  const state = joint.state === 'Tracked' ? '' : ' (inferred)';
  return [`${name}${state}, person ${body.bodyId}`, sizeLine(joint), sensorsLine(joint), ageLine(body, joint, frameAge)];
}
