// The whole page beside the scene: top, sensors, people, and one drawer at a time.
import { Guarded, Later, html } from './html.js';
import { Events } from './events.js';
import { FirstRun } from './first_run.js';
import { Judged } from './judged.js';
import { People, Tracker } from './people.js';
import { Sensors } from './sensors.js';
import { Top } from './top.js';
import { Verdict } from './verdict.js';
import { drawersOf } from '../drawers.js';

// What is not needed at once is loaded when it is opened.
const LATER = {
  sensors: () => import('./add.js').then(({ AddSensors }) => AddSensors),
  register: () => import('./register.js').then(({ Register }) => Register),
  world: () => import('./world.js').then(({ World }) => World),
  view: () => import('./look.js').then(({ Look }) => Look),
  curves: () => import('./curves.js').then(({ Curves }) => Curves),
  playback: () => import('./playback.js').then(({ LookAt }) => LookAt),
  record: () => import('./record.js').then(({ Record }) => Record),
  work: () => import('./work.js').then(({ Work }) => Work),
  hall: () => import('./hall.js').then(({ Hall }) => Hall),
  keys: () => import('./dialogs.js').then(({ Keys }) => Keys),
  token: () => import('./dialogs.js').then(({ Token }) => Token),
  phone: () => import('./phone.js').then(({ Phone }) => Phone),
};

/// The drawer that opens by itself: where somebody has to decide or to walk.  Pure.
export function wantedDrawer(registration) {
  const session = registration?.session?.state;
  return registration?.proposal || session === 'collecting' || session === 'solving' ? 'register' : null;
}

function Drawer({ open, known, act }) {
  if (open === 'sensors') return html`<${Later} key="sensors" load=${LATER.sensors} setup=${known.setup} sensors=${known.sensors} resource=${act.resource} />`;
  if (open === 'register') return html`<${Later} key="register" load=${LATER.register} registration=${known.registration} told=${known.told} resource=${act.resource} />`;
  if (open === 'world') return html`<${Later} key="world" load=${LATER.world} resource=${act.resource} onShown=${act.onOriginShown} />`;
  if (open === 'record') return html`<${Later} key="record" load=${LATER.record} recordings=${known.recordings} problem=${known.recordingsProblem} resource=${act.resource} onLook=${act.playback.open} />`;
  if (open === 'playback') return html`<${Later} key="playback" load=${LATER.playback} recordings=${known.recordings} problem=${known.recordingsProblem} shown=${known.playback} failed=${known.playbackProblem} resource=${act.resource} act=${act.playback} />`;
  if (open === 'work' && known.playback) return html`<p>Things and scores are those of the room as it is now, and a recording is shown.</p>`;
  if (open === 'work') return html`<${Later} key="work" load=${LATER.work} frame=${known.shownFrame} resource=${act.resource} />`;
  if (open === 'curves' && known.playback) return html`<p>Curves are those of the room as it is now, and a recording is shown.</p>`;
  if (open === 'curves') return html`<${Later} key="curves" load=${LATER.curves} history=${known.history} judged=${Boolean(known.evaluation)} />`;
  if (open === 'hall') return html`<${Later} key="hall" load=${LATER.hall} resource=${act.resource} />`;
  if (open === 'view') return html`<${Later} key="view" load=${LATER.view} switches=${known.switches} judged=${Boolean(known.evaluation) && !known.playback} onSwitch=${act.onSwitch} onView=${act.onView} onPicture=${act.onPicture} />`;
  return null;
}

function Dialogs({ known, act }) {
  if (known.asking) return html`<${Later} key="token" load=${LATER.token} reason=${known.asking.reason} onToken=${known.asking.answer} />`;
  if (known.dialog === 'keys') return html`<${Later} key="keys" load=${LATER.keys} onClose=${act.onClose} />`;
  if (known.dialog === 'phone') return html`<${Later} key="phone" load=${LATER.phone} href=${location.href} token=${act.token()} onClose=${act.onClose} />`;
  return null;
}

/// `known`: facts; `act`: what can be done.
export function Cockpit({ known, act }) {
  return html`
    <${Top} state=${known.state} alarms=${known.registration?.alarms} warning=${known.warning} sceneTrouble=${known.sceneTrouble} onKeys=${() => act.onDialog('keys')} onTheme=${act.onTheme} onPhone=${() => act.onDialog('phone')} />
    <main>
      <aside id="left" aria-label="sensors">
        <${Guarded}><${Sensors} known=${known} act=${act} /></${Guarded}>
      </aside>
      <aside id="right" aria-label="people and events">
        <${Guarded}><${People} frame=${known.shownFrame} known=${known.people} recorded=${Boolean(known.playback)} resource=${act.resource} onLook=${(id) => act.onView('person', id)} /></${Guarded}>
        ${!known.playback && html`<${Guarded}><${Judged} evaluation=${known.evaluation} /></${Guarded}>`}
        <${Guarded}><${Tracker} frame=${known.shownFrame} rate=${known.shownRate} age=${known.age} /></${Guarded}>
        ${!act.playback.only && html`<${Guarded}><${Events} events=${known.events} /></${Guarded}>`}
      </aside>
      <section id="drawer" aria-label="operate">
        <${Guarded}><${FirstRun} known=${known} onDrawer=${act.onDrawer} onDone=${act.onFirstRunDone} /></${Guarded}>
        <div role="tablist" aria-label="drawers">${drawersOf(known, act.playback.only).map(([key, label, letter]) => html`
          <button key=${key} type="button" role="tab" id="tab-${key}" aria-selected=${String(known.drawer === key)} aria-controls="drawer-body"
            title=${`key ${letter}`} onClick=${() => act.onDrawer(key)}>${label}${key === 'register' ? html` <${Verdict} registration=${known.registration} />` : ''}</button>`)}</div>
        <div id="drawer-body" role="tabpanel" tabindex="-1">${known.drawer && html`<${Guarded} key=${known.drawer}><${Drawer} open=${known.drawer} known=${known} act=${act} /></${Guarded}>`}</div>
      </section>
    </main>
    <${Dialogs} known=${known} act=${act} />`;
}
