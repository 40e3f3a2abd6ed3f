// A replay as the server sends it; the same layout is written by app/console/replay.py.

import { Lap } from '/stage/lap.js';

export class ReplayData {
  // bytes: ArrayBuffer.
  constructor(bytes) {
    const length = new DataView(bytes).getUint32(0, true);
    const facts = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
    const lapAt = 4 + length;
    const rowsAt = lapAt + facts.lap_bytes;
    const floats = new Float32Array(bytes.slice(rowsAt));
    const column = (name) => {
      const place = facts.columns.indexOf(name);
      return Float32Array.from({ length: facts.rows }, (_, row) => floats[row * facts.columns.length + place]);
    };
    this.lap = new Lap(bytes.slice(lapAt, rowsAt));
    this.hz = facts.hz;
    this.rows = facts.rows;
    this.doubt = facts.doubt;
    this.force = column('force_n');
    this.speed = column('speed_m_s');
    this.sigma = column('sigma_min');
    this.phases = spans(column('phase'), facts.phases, facts.hz);
    this.strokes = strokesOf(this.lap);
  }

  // The newest row at a time [s].
  row(time) {
    return Math.min(this.rows - 1, Math.max(0, Math.floor(time * this.hz + 1e-6)));
  }
}

export async function loadReplay(address) {
  const answer = await fetch(address, { credentials: 'same-origin' });
  if (!answer.ok) throw new Error((await answer.json().catch(() => ({}))).refused ?? `answer ${answer.status}`);
  return new ReplayData(await answer.arrayBuffer());
}

// Stretches of one phase: [{ name, from, to [s] }]; what lies outside of all phases is "free".
function spans(codes, names, hz) {
  const found = [];
  codes.forEach((code, row) => {
    const last = found.at(-1);
    if (last?.code === code) last.to = (row + 1) / hz;
    else found.push({ code, name: names[code], from: row / hz, to: (row + 1) / hz });
  });
  return found.filter(({ name }) => name !== 'free');
}

// What was painted at each row: { y, z, speed, lifted }, or null where the nozzle did not spray.
function strokesOf(lap) {
  const states = Array.from({ length: lap.count }, (_, row) => lap.at(row / lap.hz));
  return states.map(({ y, z, speed, spraying }, row) =>
    spraying ? { y, z, speed, lifted: !states[row + 1]?.spraying } : null,
  );
}
