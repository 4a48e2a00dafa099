/** The time that is shown, s, and whether it runs. */
export class Player {
  constructor(duration, step) {
    this.duration = duration;
    this.step = step; // s, of a frame
    this.time = 0;
    this.speed = 1;
    this.isPlaying = false;
    this.loops = true;
    this.onChange = () => {};
  }

  play(on = true) {
    if (on && this.time >= this.duration) this.time = 0;
    this.isPlaying = on && this.duration > 0;
    this.onChange();
  }

  /** To the nearest frame. */
  pauseAt(time) {
    this.isPlaying = false;
    const frame = Math.round(Math.min(this.duration, Math.max(0, time)) / this.step);
    this.time = Math.min(this.duration, frame * this.step);
    this.onChange();
  }

  stepBy(frames) {
    this.pauseAt(this.time + frames * this.step);
  }

  /** After `seconds` of the clock. */
  advance(seconds) {
    if (!this.isPlaying) return;
    this.time += this.speed * seconds;
    if (this.time < this.duration) return;
    if (this.loops) {
      this.time %= this.duration;
    } else {
      this.pauseAt(this.duration);
    }
  }
}

/** Where a time lies among the samples of a motion: after which one, and how far on the way to the next. */
export function sampleAt(motion, time, between) {
  const last = motion.samples - 1;
  const exact = Math.min(last, Math.max(0, time / motion.dt));
  const nearest = Math.round(exact);
  if (!between || Math.abs(exact - nearest) < 1e-6) return { sample: nearest, share: 0 };
  const sample = Math.min(last, Math.floor(exact));
  return { sample, share: sample < last ? exact - sample : 0 };
}
