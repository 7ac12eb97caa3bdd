// SPDX-License-Identifier: MIT OR Apache-2.0
// The page: connects the source to the model, the model to what is drawn, and controls to commands.

import { fill, fillSpans, Knobs, Presets, readLink, SPEEDS, writeLink } from './controls.mjs';
import { fixed, readColours } from './draw.mjs';
import { Loupe } from './loupe.mjs';
import { Model, STALE_MS } from './model.mjs';
import { Bars, element, Events, PadTable, Speech, write } from './panels.mjs';
import { Leader, leadByPointer, listenToKeys } from './pointer.mjs';
import { Link, STATES } from './protocol.mjs';
import { Sheet } from './sheet.mjs';
import { SlotPlot } from './slot.mjs';
import { Strips } from './strips.mjs';

const $ = (id) => document.getElementById(id);
/** Numbers change this often at most, so that they can be read. */
const TEXT_MS = 100;
const NOTICE_MS = 6000;

const model = new Model();
const sheet = new Sheet($('sheet'), model);
const loupe = new Loupe($('loupe'), model);
const strips = new Strips($('strips'), model, draw);
const slotPlot = new SlotPlot($('slot'), $('slot-channels'), $('slot-facts'));
const bars = new Bars($('bars'), model);
const pads = new PadTable($('pads'), model, choose);
const events = new Events($('events'), model, ({ time_s }) => freeze(time_s));
const speech = new Speech($('speech'), model);
const leader = new Leader(model, send);
const knobs = new Knobs($('knobs'), model, { send, open: (set) => open({ ...chosen, set: { ...chosen.set, ...set } }) });
const presets = new Presets($('presets'), (preset) => open({ preset: preset.name, scene: preset.scene, set: { ...preset.set } }));

/** What is open: as a link says it. */
let chosen = { preset: null, scene: null, set: {} };
let asked = readLink(location.search);
let [speed, paused, recording] = [1, false, false];
let [drawing, textAt, framesAt, noticeTimer] = [false, 0, performance.now(), 0];

readColours();
fill($('speed'), SPEEDS, 1);
fillSpans($('span'));
for (const [word, words] of Object.entries(STATES)) $('glossary').append(element('dt', '', word), element('dd', '', words));
const link = new Link(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/ws${location.search}`, accept, connected);

/** Sends a command; a refusal is shown. */
function send(command) {
  return link.send(command).catch((error) => notice(error.message));
}

function notice(text) {
  $('notice').textContent = text;
  $('notice').hidden = false;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => ($('notice').hidden = true), NOTICE_MS);
}

function connected(yes) {
  model.lost = !yes;
  if (!yes) [recording, paused] = [false, false];
  honest();
  draw();
}

const MESSAGES = {
  hello: acceptHello,
  frames(message) {
    if (!model.hello) return;
    model.acceptFrames(message);
    framesAt = performance.now();
    if (model.stale) honest();
    draw();
  },
  status(message) {
    model.status = message;
    draw();
  },
  event(message) {
    model.acceptEvent(message);
    events.draw();
  },
  slot: (message) => slotPlot.show(message, model.hello.pads),
  recorded: download,
  error: (message) => notice(message.message),
};

function accept(message) {
  MESSAGES[message.type]?.(message);
}

function acceptHello(hello) {
  model.acceptHello(hello);
  if (chosen.scene !== hello.scene) chosen = { preset: null, scene: hello.scene, set: {} };
  const preset = hello.presets.find(({ name }) => name === chosen.preset);
  document.body.className = hello.truth ? '' : 'no-truth';
  document.title = `${hello.scene} – hapticore live`;
  fill($('scene'), hello.scenes.map((name) => [name, name]), hello.scene);
  write($('facts'), [`${hello.fidelity} core`, `profile ${hello.profile}`, `slots of ${hello.slot_us} µs`].join(' · '));
  write($('hint'), preset?.hint ?? hint(hello));
  presets.build(hello.presets, chosen.preset);
  knobs.build(chosen.set);
  bars.build();
  pads.build();
  strips.build();
  slotPlot.clear();
  speech.clear();
  events.draw();
  choose(model.pad);
  honest();
  openAsked(hello);
}

/** What to do with a scene that no preset explains. */
function hint(hello) {
  const wall = hello.walls.length ? ' into the hatched wall: the deeper it goes, the harder the sheet brakes it.'
    : ': the core measures where it is, and how hard the sheet holds it.';
  return `${hello.title ?? hello.scene}. Drag a pad${wall}`;
}

/** Opens what the page's address asks for, once. */
function openAsked(hello) {
  const { preset, scene, set } = asked;
  asked = {};
  const known = hello.presets.find(({ name }) => name === preset);
  if (preset && !known) notice(`preset: expected one of ${hello.presets.map(({ name }) => name).join(', ')}, got ${preset}`);
  if (known) open({ preset, scene: known.scene, set: { ...known.set, ...set } });
  else if (scene && (scene !== hello.scene || Object.keys(set).length)) open({ preset: null, scene, set });
}

async function open(wanted) {
  const before = chosen;
  chosen = { preset: wanted.preset ?? null, scene: wanted.scene, set: wanted.set ?? {} };
  notice(`Setting up ${wanted.scene} …`);
  try {
    await link.send({ type: 'open', scene: wanted.scene, set: chosen.set });
    $('notice').hidden = true;
    history.replaceState(null, '', writeLink(location.search, chosen));
  } catch (error) {
    chosen = before;
    if (model.hello) $('scene').value = model.hello.scene;
    notice(error.message);
  }
}

function choose(number) {
  model.pad = number;
  const { name } = model.hello.pads[number];
  write($('strips-pad'), `of the pad ${number + 1} ${name}`);
  write($('knobs-pad'), `pad ${number + 1} ${name}`);
  write($('loupe-facts'), `20 mm around the finger of pad ${number + 1}`);
  knobs.choose();
  textAt = 0;
  draw();
}

function freeze(time_s) {
  model.freeze(time_s);
  draw();
}

function toggleFreeze() {
  if (model.frozen) follow();
  else freeze();
}

/** The picture follows the source again. */
function follow() {
  model.follow();
  draw();
}

/** Says plainly whether what the page shows is of now. */
function honest() {
  model.stale = !model.lost && !paused && model.latest !== null && performance.now() - framesAt > STALE_MS;
  const old = model.latest ? ' The values below are old.' : '';
  const text = model.lost ? `No connection to hapticore.${old} Trying again every second …`
    : model.stale ? `No new values from the source.${old}` : '';
  $('banner').hidden = !text;
  write($('banner'), text);
  document.body.classList.toggle('lost', model.lost || model.stale);
}

setInterval(() => {
  const before = model.stale;
  honest();
  if (before !== model.stale) draw();
  if (model.hello) speech.hear(performance.now());
}, 300);

/** Draws once with the next picture of the screen. */
function draw() {
  if (drawing || !model.hello) return;
  drawing = true;
  requestAnimationFrame(paint);
}

function paint(now) {
  drawing = false;
  sheet.draw();
  loupe.draw();
  strips.draw();
  bars.draw();
  $('sheet').dataset.slot = model.shown?.slot ?? '';
  if (now - textAt >= TEXT_MS) {
    textAt = now;
    paintText();
  } else {
    clearTimeout(paint.later);
    paint.later = setTimeout(paintText, TEXT_MS);
  }
}

function paintText() {
  if (!model.hello) return;
  pads.draw();
  strips.drawValues();
  knobs.draw();
  const { shown, status, frozen } = model;
  write($('speed-now'), paused ? 'paused' : status.speed == null ? '' : `${fixed(status.speed, 2)} × real time`);
  $('speed-now').classList.toggle('bad', !paused && status.speed < 0.95 * speed);
  write($('slot-now'), shown ? `slot ${shown.slot} · ${fixed(shown.time_s, 2)} s` : '');
  write($('answer-now'), link.answer_ms == null ? '' : `answers in ${fixed(link.answer_ms, 0)} ms`);
  $('freeze').setAttribute('aria-pressed', String(frozen));
  write($('freeze'), frozen ? 'Follow' : 'Freeze');
  document.body.classList.toggle('frozen', frozen);
}

function setPaused(yes) {
  paused = yes;
  write($('pause'), yes ? 'Run' : 'Pause');
  if (!yes) framesAt = performance.now();
  textAt = 0;
  draw();
  return send({ type: 'pace', speed: yes ? 0 : speed });
}

async function oneSlot() {
  follow();
  if (!paused) await setPaused(true);
  await send({ type: 'step', slots: 1 });
  await send({ type: 'slot' });
}

async function toggleRecord() {
  await send({ type: 'record', to: recording ? 'scene' : 'start' });
  recording = !recording && link.connected;
  write($('record'), recording ? 'Stop and save' : 'Record');
  $('record').classList.toggle('on', recording);
}

function download({ name, text }) {
  const anchor = element('a');
  anchor.href = URL.createObjectURL(new Blob([text], { type: 'text/plain' }));
  anchor.download = name;
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 1000);
  notice(`Saved ${name}. Run it with: hapticore simulate ${name}`);
}

async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    notice(`Copied: ${text}`);
  } catch {
    notice(`Copy this: ${text}`);
  }
}

leadByPointer($('sheet'), leader, {
  take: (event) => sheet.hit(event), toMm: (event) => sheet.toMm(event),
  onTake(pad) {
    if (model.frozen) follow();
    choose(pad);
  },
});
leadByPointer($('loupe'), leader, {
  take: () => model.pad,
  toMm: (event) => [event.clientX / loupe.scale, -event.clientY / loupe.scale],
  onTake() {
    if (model.frozen) follow();
  },
});
listenToKeys({
  model, leader, choose, freeze: toggleFreeze, slot: oneSlot,
  onLead() {
    if (model.frozen) follow();
  },
});

$('scene').onchange = (event) => open({ preset: null, scene: event.target.value, set: {} });
$('speed').onchange = (event) => {
  speed = Number(event.target.value);
  setPaused(false);
};
$('span').onchange = (event) => {
  strips.span_s = Number(event.target.value);
  draw();
};
$('pause').onclick = () => setPaused(!paused);
$('one-slot').onclick = oneSlot;
$('take-slot').onclick = () => send({ type: 'slot' });
$('freeze').onclick = toggleFreeze;
$('record').onclick = toggleRecord;
$('copy-command').onclick = () => copy(model.hello?.command ?? '');
$('copy-link').onclick = () => copy(location.origin + location.pathname + writeLink('', chosen));
addEventListener('resize', draw);
window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  readColours();
  if (!model.hello) return;
  strips.build();
  slotPlot.build();
  draw();
});
