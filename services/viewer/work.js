// What the drawer "Work" says: posture scores, stances, and where they are served.

/// Where posture scores are served: ?ergonomics=URL of the page, else port 8093 of the tracker's host.  Pure.
export function ergonomicsBase(page, tracker) {
  const stated = new URL(page).searchParams.get('ergonomics');
  if (stated) return new URL(stated, page).href.replace(/\/?$/, '/');
  const url = new URL(tracker);
  url.port = '8093';
  url.pathname = '/';
  url.search = '';
  return url.href;
}

/// A score as people read it, with the set that holds the true one with 90 %.  Pure.
export function scoreText({ method, scoreHigh, setFrom, setTo, shownScore }) {
  if (scoreHigh === undefined) return `${method}: –`;
  return `${method}: ${shownScore || scoreHigh} (${setFrom === setTo ? setFrom : `${setFrom} to ${setTo}`})`;
}

/// What is to be said about somebody's stance.  Pure.
export function stanceText({ ownStance, stanceTrouble }) {
  if (ownStance === 'asked') return 'stand upright, arms down, for two seconds …';
  if (ownStance === 'known') return 'angles count from their own stance';
  return stanceTrouble ? `no stance: ${stanceTrouble}` : 'angles are absolute: no stance yet';
}
