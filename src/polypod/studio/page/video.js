// A video of the view, made by the browser as the view is drawn.

import { saveAs } from "/page/elements.js";
import { seekable } from "/page/webm.js";

const RATE = 60; // frames a second at most; the browser takes those that are drawn
const BITS = 12e6; // a second
const WHOLE_EVERY = 1000; // ms between pictures that need no other: players seek to them
const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

export class Video {
  // `changed` is called when it starts and ends.
  constructor(store, canvas, changed) {
    Object.assign(this, { store, canvas, changed });
    this.recorder = null;
    const possible = typeof MediaRecorder !== "undefined" && "captureStream" in canvas;
    this.type = possible ? TYPES.find((type) => MediaRecorder.isTypeSupported(type)) : undefined;
  }

  get possible() {
    return this.type !== undefined;
  }

  get running() {
    return this.recorder !== null;
  }

  // Seconds since it started.
  get seconds() {
    return this.running ? (performance.now() - this.started) / 1000 : 0;
  }

  start() {
    const pieces = [];
    try {
      const stream = this.canvas.captureStream(RATE);
      this.recorder = new MediaRecorder(stream, {
        mimeType: this.type, videoBitsPerSecond: BITS, videoKeyFrameIntervalDuration: WHOLE_EVERY,
      });
    } catch (error) {
      this.store.say(`This browser makes no video of the view: ${error.message}`);
      return;
    }
    this.recorder.ondataavailable = (event) => pieces.push(event.data);
    this.recorder.onstop = async () => {
      for (const track of this.recorder.stream.getTracks()) track.stop();
      this.recorder = null;
      this.changed();
      const film = new Blob(pieces, { type: this.type });
      if (this.type.startsWith("video/mp4")) saveAs(film, "walk.mp4");
      else saveAs(await seekable(film), "walk.webm");
    };
    this.recorder.onerror = () => this.store.say("The browser gave the video up.");
    this.started = performance.now();
    // In pieces, so that a long one need not be held whole by the encoder.
    this.recorder.start(1000);
    this.changed();
  }

  stop() {
    this.recorder?.stop();
  }
}
