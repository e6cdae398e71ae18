// The walk of a registration session from above: where somebody walked, seen by how many sensors, and how well each pair of
// sensors is linked.  +x is to the right, +z down, as the floor looks from the ceiling.
const SVG = 'http://www.w3.org/2000/svg';
const CELL = 0.5; // [m]
const GOOD_RADIUS = 0.05; // [m]; registration.good_position_m
const ROOM = 0.8; // around everything [m]

function shape(name, attributes, className = '') {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (className) element.setAttribute('class', className);
  return element;
}

/// Pure: what is to be drawn.  `places`: sensors of /registration by id; `session`: its resource.
export function mapOf(session, places = {}) {
  const cells = (session?.floorCells ?? []).map(({ x, z, seenBy }) => ({ x, z, level: Math.min(Number(seenBy), 3) }));
  const sensors = Object.entries(places).map(([id, { x, z }]) => ({ id, x: Number(x), z: Number(z) }));
  const at = Object.fromEntries(sensors.map((sensor) => [sensor.id, sensor]));
  const links = (session?.coverage ?? []).map(({ target, source, sightings, spread, expectedRadius }) => ({
    target, source, sightings, spread, expected: Number(expectedRadius), good: expectedRadius <= GOOD_RADIUS,
    from: at[target], to: at[source],
  }));
  const target = Number(session?.targetRadius ?? GOOD_RADIUS);
  const accuracy = (session?.accuracy ?? []).map(({ sensorId, expectedRadius }) => ({
    id: sensorId, target, radius: expectedRadius === undefined ? Infinity : Number(expectedRadius),
    good: Number(expectedRadius) <= target,
  })).sort((a, b) => b.radius - a.radius);
  return { cells, sensors, links, accuracy };
}

/// "s3: ±41 mm so far, ±30 wanted"
export function accuracyLine({ id, radius, target }) {
  if (radius === Infinity) return `${id}: no place yet`;
  return `${id}: ±${Math.round(1000 * radius)} mm so far, ±${Math.round(1000 * target)} wanted`;
}

function item(text, good) {
  const li = document.createElement('li');
  li.textContent = text;
  li.className = good ? 'good' : 'warn';
  return li;
}

/// "s1 – s2: 310 sightings, +-32 mm expected"; the pair that needs most first.
export function lineOf({ target, source, sightings, expected }) {
  const radius = expected < 1 ? `±${Math.round(1000 * expected)} mm` : 'more than 1 m';
  return `${target} – ${source}: ${sightings} common sightings, ${radius} expected`;
}

export function showCoverage(svg, list, session, places) {
  const { cells, sensors, links, accuracy } = mapOf(session, places);
  const points = [...cells, ...sensors];
  svg.toggleAttribute('hidden', points.length === 0 || links.length === 0);
  list.replaceChildren(
    ...accuracy.slice(0, 6).map((own) => item(accuracyLine(own), own.good)),
    ...links.sort((a, b) => b.expected - a.expected).slice(0, 6).map((link) => item(lineOf(link), link.good)),
  );
  if (points.length === 0) return svg.replaceChildren();
  const [left, right] = [Math.min(...points.map((p) => p.x)), Math.max(...points.map((p) => p.x))];
  const [top, bottom] = [Math.min(...points.map((p) => p.z)), Math.max(...points.map((p) => p.z))];
  svg.setAttribute('viewBox', `${left - ROOM} ${top - ROOM} ${right - left + 2 * ROOM} ${bottom - top + 2 * ROOM}`);
  svg.replaceChildren(
    ...cells.map(({ x, z, level }) => shape('rect', { x: x - CELL / 2, y: z - CELL / 2, width: CELL, height: CELL }, `seen-${level}`)),
    ...links.filter(({ from, to }) => from && to).map(({ from, to, good }) => shape('line',
      { x1: from.x, y1: from.z, x2: to.x, y2: to.z }, good ? 'linked' : 'weak')),
    ...sensors.flatMap(({ id, x, z }) => {
      const label = shape('text', { x: x + 0.18, y: z + 0.1 });
      label.textContent = id;
      return [shape('circle', { cx: x, cy: z, r: 0.12 }), label];
    }),
  );
}
