// The drawer "Curves": the last minute as lines (npm uPlot), and limbs as worn sensors judged them, in a strip.
import uPlot from 'uplot';

import { KINDS, OF_JOINTS, linesOf, stripOf } from '../curves.js';
import { COLOURS } from '../judged.js';
import { BONES } from '../skeleton_view.js';
import { html, number, useEffect, useRef, useState } from './html.js';

const JOINTS = [...new Set(BONES.flat())];
const MINUTE_S = 60;
const HEIGHT_PX = 170;
const [INK, GRID, LIMIT] = ['#a3afbd', 'rgba(255, 255, 255, 0.12)', '#ff3b30'];
const DIGITS = { height: 2, speed: 2, rate: 1, age: 0, limbs: 1 };

const axis = (label) => ({ stroke: INK, label, labelSize: 18, size: label === 's' ? 28 : 48, grid: { stroke: GRID, width: 1 }, ticks: { stroke: GRID, width: 1 } });
const line = ({ name, colour }) => ({ label: name, stroke: colour, width: 1.5, points: { show: false } });

/// Canvases that are made meanwhile are drawn by the processor.  By graphics that a browser emulates, four drawings a second held the whole page
/// up: 3 frames a second instead of 20.  uPlot has no option for it.
function withPlainCanvas(make) {
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function plain(kind) { return getContext.call(this, kind, { willReadFrequently: true }); };
  try {
    return make();
  } finally {
    HTMLCanvasElement.prototype.getContext = getContext;
  }
}

function chartIn(element, unit, lines, limit) {
  const more = limit === null ? [] : [{ label: 'limit', stroke: LIMIT, dash: [6, 4], width: 1, points: { show: false } }];
  return withPlainCanvas(() => new uPlot({
    width: element.clientWidth, height: HEIGHT_PX, legend: { show: false }, cursor: { show: false }, pxAlign: 0,
    scales: { x: { time: false, range: [-MINUTE_S, 0] } }, axes: [axis('s'), axis(unit)], series: [{}, ...lines.map(line), ...more],
  }, undefined, element));
}

/// The lines as they are now; the chart is made anew when other lines are drawn or the drawer has another width.
function Chart({ told, unit, label }) {
  const place = useRef(null);
  const drawn = useRef(null);
  const { seconds, lines, limit } = told;
  useEffect(() => {
    const of = JSON.stringify([unit, limit, place.current.clientWidth, lines.map(({ name }) => name)]);
    if (drawn.current?.of !== of) {
      drawn.current?.chart.destroy();
      drawn.current = { of, chart: chartIn(place.current, unit, lines, limit) };
    }
    drawn.current.chart.setData([seconds, ...lines.map(({ values }) => values), ...(limit === null ? [] : [seconds.map(() => limit)])]);
  });
  useEffect(() => () => drawn.current?.chart.destroy(), []);
  return html`<div class="curves" ref=${place} role="img" aria-label=${label}></div>`;
}

function Strip({ rows }) {
  return html`<table id="strip" aria-label="limbs as worn sensors judged them in the last minute"><tbody>${rows.map(({ limb, runs }) => html`<tr key=${limb}><th scope="row">${limb}</th>
    <td><svg viewBox="-60 0 60 1" preserveAspectRatio="none" role="img" aria-label=${`now ${runs.at(-1)?.state ?? 'not judged'}`}>${runs.filter(({ state }) => state in COLOURS).map(({ state, from, to }) => html`
      <rect key=${from} x=${from} y="0" width=${Math.max(to - from, 0.1)} height="1" fill=${COLOURS[state]} />`)}</svg></td></tr>`)}</tbody></table>`;
}

/// `history`: of curves.js.  Rendered anew several times a second by the page.
export function Curves({ history, judged }) {
  const [kind, setKind] = useState(judged ? 'limbs' : 'height');
  const [joint, setJoint] = useState('Head');
  const now = performance.now();
  const [name, unit] = KINDS[kind];
  const told = linesOf(history, kind, joint, now);
  const kinds = Object.entries(KINDS).filter(([key]) => key !== 'limbs' || judged || kind === 'limbs');
  return html`<div id="curves-drawer">
    <div class="row">
      <label>of the last minute <select id="curves-kind" value=${kind} onChange=${(event) => setKind(event.target.value)}>${kinds.map(([key, [label]]) => html`<option key=${key} value=${key}>${label}</option>`)}</select></label>
      ${OF_JOINTS.includes(kind) && html`<label>joint <select id="curves-joint" value=${joint} onChange=${(event) => setJoint(event.target.value)}>${JOINTS.map((each) => html`<option key=${each} value=${each}>${each}</option>`)}</select></label>`}
    </div>
    <${Chart} told=${told} unit=${unit} label=${`${name} in the last minute, in ${unit}; the newest values are listed below`} />
    <ul id="curves-now" class="row" aria-label="newest values">${told.lines.map(({ name: own, colour, values }) => html`<li key=${own}>
      <svg class="swatch" viewBox="0 0 10 10" aria-hidden="true"><rect y="3" width="10" height="4" fill=${colour} /></svg> ${own} <strong>${number(values.at(-1) ?? NaN, DIGITS[kind])} ${unit}</strong></li>`)}
      ${told.lines.length === 0 && html`<li class="faint">nothing yet</li>`}${told.leftOut > 0 && html`<li class="warn">and ${told.leftOut} more, which are not drawn</li>`}</ul>
    ${kind === 'limbs' && html`<${Strip} rows=${stripOf(history, now)} />`}
  </div>`;
}
