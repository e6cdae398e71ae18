// Shows a message when the viewer itself cannot start: three.js is installed, not part of the sources.
(() => {
  const say = () => {
    if (window.chorusViewer) return;
    const headline = document.getElementById('headline');
    headline.textContent = 'The viewer cannot start: three.js is missing.';
    headline.className = 'bad';
    document.getElementById('next').textContent = 'Run npm ci --prefix services/viewer on the fusion server’s machine and load this page again.';
  };
  window.addEventListener('error', (event) => {
    if (event.target instanceof HTMLScriptElement) say();
  }, true);
  setTimeout(say, 8000);
})();
