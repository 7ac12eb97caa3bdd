// SPDX-License-Identifier: MIT OR Apache-2.0
// Controls: scenes, experiments (presets), knobs, speed, and how the state of the page becomes a link.

import { fixed } from './draw.mjs';
import { element, write } from './panels.mjs';

export const SPEEDS = [[0.01, '1/100'], [0.1, '1/10'], [0.25, '1/4'], [1, '1'], [2, '2'], [4, '4']];
const SPANS = [[10, '10 s'], [3, '3 s'], [1, '1 s'], [0.3, '0.3 s'], [0.1, '0.1 s']];

/** Fills a `select` with pairs `[value, text]`. */
export function fill(select, pairs, value) {
  select.replaceChildren(...pairs.map(([of, text]) => new Option(text, of)));
  select.value = String(value);
}

export const fillSpans = (select) => fill(select, SPANS, 10);

/** What a link says: scene or preset, and settings `key=value`. */
export function readLink(search) {
  const parameters = new URLSearchParams(search);
  const set = parameters.getAll('set').filter((pair) => pair.includes('=')).map((pair) => {
    const at = pair.indexOf('=');
    return [pair.slice(0, at), pair.slice(at + 1)];
  });
  return { preset: parameters.get('preset'), scene: parameters.get('scene'), set: Object.fromEntries(set) };
}

/** The inverse of {@link readLink}; parameters of other purposes, as a token, stay. */
export function writeLink(search, { preset, scene, set }) {
  const parameters = new URLSearchParams(search);
  for (const name of ['preset', 'scene', 'set']) parameters.delete(name);
  if (preset) parameters.set('preset', preset);
  else parameters.set('scene', scene);
  for (const [key, value] of Object.entries(set)) parameters.append('set', `${key}=${value}`);
  return `?${parameters.toString().replaceAll('%3D', '=')}`;
}

/** The buttons of the experiments. */
export class Presets {
  constructor(box, open) {
    Object.assign(this, { box, open });
  }

  build(presets, current) {
    this.box.replaceChildren(...presets.map((preset) => {
      const button = element('button', '', preset.label);
      button.type = 'button';
      button.title = preset.hint ?? '';
      button.setAttribute('aria-pressed', String(preset.name === current));
      button.onclick = () => this.open(preset);
      return button;
    }));
  }
}

/** Sliders of a source's inputs. A knob of a pad acts at once; one of the scene sets the scene up again. */
export class Knobs {
  constructor(box, model, { send, open }) {
    Object.assign(this, { box, model, send, open, values: new Map(), knobs: [], pending: new Map() });
  }

  build(set) {
    const { hello } = this.model;
    this.values.clear();
    const inputs = hello.inputs.map((input) => ({ ...input, ...describe(input) }));
    const scene = inputs.filter((input) => input.per !== 'pad');
    this.knobs = [...inputs.filter((input) => input.per === 'pad'), ...this.extra(inputs)].map((input) => this.knob(input));
    const again = scene.map((input) => this.knob({ ...input, value: set[input.name] ?? input.value, again: true }));
    const rows = this.knobs.map((knob) => knob.row);
    rows.push(this.buttons());
    if (again.length) rows.push(element('h3', '', 'These set the scene up again'), ...again.map((knob) => knob.row));
    this.box.replaceChildren(...rows);
  }

  /** Knobs that a source implies: the controller's target, and each wall's surface. */
  extra(inputs) {
    const { hello } = this.model;
    const has = (word) => inputs.some((input) => input.name.includes(word));
    const list = [];
    if (hello.controller && !has('target')) {
      list.push({ name: 'target', label: 'Target', unit: 'N', least: 0, most: hello.limits?.force_n ?? 0.9, value: 0, per: 'pad',
        message: (n, pad) => ({ type: 'target', pad, n }) });
    }
    hello.walls.forEach((wall) => list.push({ name: `wall.${wall.axis}`, label: `Wall at ${wall.axis}`, unit: 'mm', least: -50, most: 50,
      value: wall.mm ?? 0, message: (mm) => ({ type: 'wall', [`${wall.axis}_mm`]: mm }) }));
    return list;
  }

  knob(input) {
    const row = element('label', 'knob');
    const slider = element('input');
    const value = element('output');
    const decimals = Math.max(0, Math.ceil(-Math.log10((input.most - input.least) / 150)));
    Object.assign(slider, { type: 'range', min: input.least, max: input.most, step: 10 ** -decimals });
    row.append(element('span', '', input.label), slider, value);
    if (input.words) row.title = input.words;
    const show = () => write(value, `${fixed(Number(slider.value), decimals)} ${input.unit}`);
    const set = (number) => {
      slider.value = number;
      show();
    };
    slider.oninput = () => {
      show();
      if (!input.again) this.change(input, Number(slider.value));
    };
    if (input.again) slider.onchange = () => this.open({ [input.name]: Number(slider.value) });
    set(input.value);
    return { row, input, set };
  }

  buttons() {
    const row = element('p', 'buttons');
    const { walls } = this.model.hello;
    if (walls.length) {
      this.off = element('button', '', 'Walls off');
      this.off.onclick = () => this.send({ type: 'wall', ...(this.wallsOff ? this.surfaces() : { off: true }) });
      row.append(this.off);
    }
    const back = element('button', '', 'Let go');
    back.title = 'The scene’s script leads this pad again';
    back.onclick = () => this.send({ type: 'release', pad: this.model.pad });
    row.append(back);
    for (const button of row.children) button.type = 'button';
    return row;
  }

  get wallsOff() {
    const walls = this.model.latest?.walls ?? [];
    return walls.length > 0 && walls.every((mm) => mm == null);
  }

  surfaces() {
    const of = (wall) => this.values.get(`wall.${wall.axis}`) ?? wall.mm ?? 0;
    return Object.fromEntries(this.model.hello.walls.map((wall) => [`${wall.axis}_mm`, of(wall)]));
  }

  key(input) {
    return input.per === 'pad' ? `${this.model.pad} ${input.name}` : input.name;
  }

  /** Sends the newest value of a knob once per picture at most. */
  change(input, value) {
    const { pad } = this.model;
    this.values.set(this.key(input), value);
    if (!this.pending.size) requestAnimationFrame(() => this.flush());
    this.pending.set(this.key(input), input.message ? input.message(value, pad) : { type: 'set', pad, [input.name.replace(/^pad\./, '')]: value });
  }

  flush() {
    for (const message of this.pending.values()) this.send(message);
    this.pending.clear();
  }

  /** Shows the values of the chosen pad. */
  choose() {
    for (const { input, set } of this.knobs) set(this.values.get(this.key(input)) ?? input.value);
  }

  draw() {
    if (this.off?.isConnected) write(this.off, this.wallsOff ? 'Walls on' : 'Walls off');
  }
}

const WORDS = {
  load_g: ['Load', 'Weight with which the hand presses the pad on the sheet'],
  target_n: ['Target', 'Haptic force that the controller holds'],
  v_rms: ['Voltage', 'Haptic voltage across the pad'],
};

/** Label and explanation of an input; from its name where the source sends none. */
function describe(input) {
  const key = input.name.split('.').at(-1);
  const [label, words] = WORDS[key] ?? [key.replace(/_[a-z0-9]+$/, '').replaceAll('_', ' ')];
  return { label: input.label ?? label[0].toUpperCase() + label.slice(1), words: input.words ?? words };
}
