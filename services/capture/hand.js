// Sends the photo of a hand to the sensor that serves this page, and shows the skeleton or why there is none.
import { atTheDoor } from './link.js';
import { fromLink, loadToken, saveToken } from './settings.js';
import { LINK } from './state.js';

const ROOT = new URL('../', location.href);
const LONGEST_SIDE = 1600; // the scan itself works at 1200
const ANSWER_WITHIN_MS = 90_000; // a photo may wait for others, and the network starts with the first one

const element = (id) => document.getElementById(id);
const brought = fromLink(location.hash);
history.replaceState(null, '', location.pathname); // a token does not stay in the address
if (brought.token) saveToken(brought.token);
element('token').value = loadToken();

function say(tone, sentence, next = '') {
  element('headline').textContent = sentence;
  element('headline').className = tone;
  element('next').textContent = next;
}

/// The file as a JPEG of at most LONGEST_SIDE, upright, as base64.
async function photoOf(file) {
  let bitmap;
  try {
    bitmap = await createImageBitmap(file, { imageOrientation: 'from-image' });
  } catch {
    throw new Error('This browser cannot read that file as a picture. Take the photo as JPEG.');
  }
  const factor = Math.min(1, LONGEST_SIDE / Math.max(bitmap.width, bitmap.height));
  const canvas = document.createElement('canvas');
  canvas.width = Math.round(bitmap.width * factor);
  canvas.height = Math.round(bitmap.height * factor);
  const pencil = canvas.getContext('2d');
  pencil.imageSmoothingQuality = 'high';
  pencil.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  bitmap.close();
  return canvas.toDataURL('image/jpeg', 0.93).replace(/^[^,]*,/, '');
}

/// The sensor's answer to one message.
function asked(message) {
  const url = new URL('scan', ROOT);
  url.protocol = url.protocol.replace('http', 'ws');
  const escaped = encodeURIComponent(loadToken()).replace(/[()']/g, (c) => '%' + c.charCodeAt(0).toString(16));
  const socket = new WebSocket(url.href, escaped ? ['chorus.scan', `chorus.token.${escaped}`] : ['chorus.scan']);
  return new Promise((resolve, reject) => {
    const late = setTimeout(() => { reject(new Error('The sensor has not answered for a minute and a half. Send the photo again.')); socket.close(); }, ANSWER_WITHIN_MS);
    socket.onopen = () => socket.send(JSON.stringify(message));
    socket.onmessage = ({ data }) => { clearTimeout(late); resolve(JSON.parse(data)); socket.close(); };
    socket.onclose = () => { clearTimeout(late); reject(new Error('The sensor does not take photos of hands, or is not reached any more. chorus-sensor has to come with its cameras (package chorus-camera).')); };
  });
}

const download = (id, text, type) => { element(id).href = `data:${type};charset=utf-8,${encodeURIComponent(text)}`; };

function show({ bvh, htr, picture, report }) {
  download('bvh', bvh, 'text/plain');
  download('htr', htr, 'text/plain');
  download('json', JSON.stringify(report, null, 1), 'application/json');
  element('drawn').src = `data:image/jpeg;base64,${picture}`;
  element('notes').replaceChildren(...report.notes.map((note) => Object.assign(document.createElement('li'), { textContent: note })));
  const rows = ['thumb', 'index', 'middle', 'ring', 'little'].map((finger) => {
    const row = document.createElement('tr');
    row.append(Object.assign(document.createElement('th'), { textContent: finger, scope: 'row' }));
    for (const part of report.fingers[finger].partsMm) row.append(Object.assign(document.createElement('td'), { textContent: `${part.toFixed(1)} mm` }));
    return row;
  });
  element('lengths').replaceChildren(...rows);
  const size = report.relative ? 'no scale: only the proportions are measured' : `${report.lengthMm.toFixed(0)} mm from wrist to tip, scale: ${report.scale.from}`;
  say('good', `A ${report.side} hand, its ${report.seen} seen.`, `${size[0].toUpperCase()}${size.slice(1)}. Compare the picture before you trust it.`);
  element('result').hidden = false;
}

async function measure(file) {
  element('result').hidden = true;
  say('calm', 'Sending the photo …');
  const door = await atTheDoor(ROOT, loadToken());
  if (door.state !== 'open') return say('bad', ...(LINK[door.state] ?? [door.detail]));
  const message = { type: 'scan', scale: element('scale').value, view: element('facing').value, photo: await photoOf(file) };
  say('calm', 'Measuring …', 'A second or two; the first photo takes longer.');
  const answer = await asked(message);
  if (answer.type === 'hand') return show(answer);
  return say('bad', 'This photo is refused.', answer.detail[0].toUpperCase() + answer.detail.slice(1) + (/[.?]$/.test(answer.detail) ? '' : '.'));
}

element('photo').addEventListener('change', async () => {
  const [file] = element('photo').files;
  element('photo').value = ''; // the same file may be sent again
  if (!file) return;
  element('photo').disabled = true;
  await measure(file).catch((error) => say('bad', 'This photo is not measured.', error.message));
  element('photo').disabled = false;
});
element('token').addEventListener('change', () => saveToken(element('token').value.trim()));
window.addEventListener('hashchange', () => location.reload());
say('calm', 'Ready.', 'The photo is sent to the computer that serves this page, and is not kept there.');
