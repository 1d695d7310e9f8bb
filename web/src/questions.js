// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page asks the program, whether it waits for an answer, and how long the land took to follow.
const oneFrame = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));

export class Questions {
  /** Whether the program computes. */
  isWorking = false;
  /** Whether what is shown is of a try, which no scene before it is kept for. */
  isTrying = false;
  #studio;
  #unanswered = 0;
  #awaited = 0; // job whose end is to come
  #finished = 0; // job that ended last
  #sent = null; // the last edit: {at: when, job}
  #triesNow = false; // a try is not answered
  #nextTry = null; // the step of the try that follows

  /** studio: of studio.js */
  constructor(studio) {
    this.#studio = studio;
    studio.state.times = { first: null, full: null };
  }

  /** Whether an edit is not answered yet. */
  get isAsking() {
    return this.#unanswered > 0;
  }

  /** Whether an answer or a land is to come. */
  get isWaiting() {
    return this.isAsking || this.isWorking || this.#triesNow || this.#awaited > this.#finished;
  }

  /** What was on screen becomes what was before, unless it was tried. */
  keep() {
    if (!this.isTrying) this.#studio.scenes.keep();
  }

  #startTimes() {
    const { link, page, state } = this.#studio;
    page?.view.hurry?.(true);
    this.#sent = { at: performance.now(), job: link.job };
    state.times = { first: null, full: null };
  }

  /** Asks; gives a promise of the reply, which rejects with the program's words. */
  async ask(question) {
    this.keep();
    this.#startTimes();
    this.#nextTry = null;
    this.isTrying = false;
    const { link, page, state } = this.#studio;
    const { revision = -1 } = state;
    const { job } = link;
    ++this.#unanswered;
    try {
      const reply = await link.ask(question);
      if (reply.revision > revision) this.#awaited = reply.job ?? job + 1;
      return reply;
    } catch (error) {
      page?.view.hurry?.(false);
      throw error;
    } finally {
      --this.#unanswered;
    }
  }

  edit(...steps) {
    return this.ask({ do: 'edit', edit: { name: '', steps } });
  }

  /** Tries a step while a slider is drawn: one unanswered at most, the last wins. */
  try(step) {
    this.keep();
    this.isTrying = true;
    this.#nextTry = step;
    if (!this.#triesNow) this.#sendTry();
  }

  async #sendTry() {
    const { link, progress } = this.#studio;
    const step = this.#nextTry;
    this.#nextTry = null;
    this.#triesNow = true;
    this.#startTimes();
    const { job } = link;
    try {
      const reply = await link.ask({ do: 'try', edit: { name: '', steps: [step] } });
      this.#awaited = reply.job ?? job + 1;
    } catch (error) {
      progress.tell(error.message, { isBad: true });
    }
    this.#triesNow = false;
    if (this.#nextTry) this.#sendTry();
  }

  /** A job has ended. */
  end(job) {
    this.#studio.page?.view.hurry?.(false);
    this.isWorking = false;
    this.#finished = job;
  }

  /** The connection is lost: no job will end. */
  forget() {
    this.isWorking = false;
    this.#awaited = this.#finished = 0;
  }

  /** Heights of a job are shown with the next frame: takes the time since the edit. level: 'coarse' or 'full'. */
  async shown(level, job) {
    const sent = this.#sent;
    if (!sent || job < sent.job) return;
    await oneFrame();
    if (sent !== this.#sent) return;
    const { times } = this.#studio.state;
    const ms = Math.round(performance.now() - sent.at);
    times.first ??= ms;
    if (level === 'full') times.full = ms;
  }
}
