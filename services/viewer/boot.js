// Shows a message when the page itself cannot start: its libraries are installed, they are not part of the sources.
(() => {
  const say = () => {
    if (window.chorusViewer) return;
    const headline = document.getElementById('headline');
    headline.textContent = 'The cockpit cannot start: its libraries are missing.';
    headline.className = 'bad';
    document.getElementById('next').textContent = 'Run npm ci --prefix services/viewer on the fusion server’s machine and load this page again.';
  };
  window.addEventListener('error', (event) => {
    if (event.target instanceof HTMLScriptElement) say();
  }, true);
  setTimeout(say, 8000);
})();
