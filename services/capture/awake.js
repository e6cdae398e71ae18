// Asks for the screen to stay on, where the browser can do that.

export class Awake {
  /// The lock comes later than it is asked for; meanwhile the page may have been stopped, or have asked again.
  async ask() {
    this.wanted = true;
    const lock = await globalThis.navigator?.wakeLock?.request('screen').catch(() => null);
    if (!lock) return;
    const spare = this.wanted ? this.lock : lock;
    if (this.wanted) this.lock = lock;
    spare?.release();
  }

  end() {
    this.wanted = false;
    this.lock?.release();
    this.lock = null;
  }
}
