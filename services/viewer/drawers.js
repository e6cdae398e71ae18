// The drawers of the cockpit: which there are, and their keys.  Pure.
const DRAWERS = [['sensors', 'Sensors', 's'], ['register', 'Register', 'r'], ['world', 'World', 'w'], ['record', 'Record', 'e'],
  ['playback', 'Look at a recording', 'l'], ['work', 'Work', 'p'], ['curves', 'Curves', 'c'], ['hall', 'Hall', 'g'], ['view', 'View', 'v']];
const OF_RECORDINGS = ['playback', 'view']; // what there is without a room

/// [name, label, key] of each drawer there is; `site`: the hall, if the room is part of one; `only`: there is no room behind the recording.
export const drawersOf = ({ site }, only) => DRAWERS.filter(([name]) => (only ? OF_RECORDINGS.includes(name) : name !== 'hall' || site));
export const drawerOfKey = (key, known, only) => drawersOf(known, only).find(([, , own]) => own === key)?.[0] ?? null;
