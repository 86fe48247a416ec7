// SPDX-License-Identifier: Apache-2.0
// The sound of slip: filtered noise, as loud as the power that friction takes. Only on request.
export class SlipSound {
  private context: AudioContext | undefined;
  private gain: GainNode | undefined;

  set(on: boolean): void {
    if (!on) {
      void this.context?.close();
      this.context = this.gain = undefined;
      return;
    }
    const context = new AudioContext();
    const buffer = context.createBuffer(1, context.sampleRate, context.sampleRate);
    const samples = buffer.getChannelData(0);
    for (let i = 0; i < samples.length; ++i) samples[i] = Math.random() * 2 - 1;
    const noise = new AudioBufferSourceNode(context, { buffer, loop: true });
    const filter = new BiquadFilterNode(context, { type: 'bandpass', frequency: 900, Q: 0.8 });
    this.gain = new GainNode(context, { gain: 0 });
    noise.connect(filter).connect(this.gain).connect(context.destination);
    noise.start();
    this.context = context;
  }

  /** What is heard now, 0 to 1; undefined: it is off. */
  get loudness(): number | undefined {
    return this.gain?.gain.value;
  }

  /** `share`: of the loudest, 0 to 1. */
  play(share: number): void {
    if (this.context === undefined) return;
    this.gain?.gain.setTargetAtTime(Math.min(1, share) * 0.5, this.context.currentTime, 0.02);
  }
}
