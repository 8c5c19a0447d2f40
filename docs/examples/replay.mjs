// Teaches the studio and replays what it learned, in plain JavaScript: nothing of ours is needed.
//
//     studio serve --no-page --remote 127.0.0.1:8766       (in another terminal)
//     node docs/examples/replay.mjs --teach [--synchronous | --blocking] [--url ws://...] [--token ...]
//
// It takes Node's own WebSocket (22 and later, or 20 with --experimental-websocket), else the
// module "ws". It prints whether the block is down, and that is its exit status.

import { createRequire } from "node:module";
import { parseArgs } from "node:util";

const RATE = 30; // joint targets a second
const SETTLE = 1.5; // [s] after the motion, in which the block falls or stays
const TICKS_BETWEEN_LOOKS = 5;
const PATIENCE = 60_000; // [ms] for an answer

function webSocket() {
  if (globalThis.WebSocket !== undefined) return globalThis.WebSocket;
  return createRequire(import.meta.url)("ws"); // NODE_PATH says where, as on Debian: /usr/share/nodejs
}

/** A connection to the studio: requests are numbered, and their answers awaited. */
class Studio {
  static async connect(url, token) {
    const studio = new Studio();
    const address = token === undefined ? url : `${url}?token=${encodeURIComponent(token)}`;
    studio.socket = new (webSocket())(address);
    studio.waiting = new Map();
    studio.number = 0;
    studio.socket.addEventListener("message", (event) => studio.hear(JSON.parse(event.data)));
    await new Promise((opened, failed) => {
      studio.greet = opened; // once its first message has come: the order of the joints
      studio.socket.addEventListener("error", () => failed(new Error(`no studio at ${url}`)));
    });
    studio.socket.addEventListener("close", (event) => {
      for (const { refuse } of studio.waiting.values()) refuse(new Error(`lost: ${event.reason}`));
    });
    return studio;
  }

  hear(message) {
    if (message.type === "welcome") {
      this.joints = message.joints;
      this.greet();
      return;
    }
    const key = message.id ?? message.type; // what answers no request is of a stream, or news
    const asked = this.waiting.get(key);
    if (asked === undefined) {
      if (message.type === "error") console.error(`studio: ${message.words}`);
      return;
    }
    this.waiting.delete(key);
    if (message.type === "error") asked.refuse(new Error(message.words));
    else asked.answer(message);
  }

  /** Blocking: send a request, wait for its answer. */
  ask(request) {
    const id = ++this.number;
    return new Promise((answer, refuse) => {
      const late = setTimeout(() => refuse(new Error(`no answer to ${request.type}`)), PATIENCE);
      const settle = (act) => (value) => (clearTimeout(late), act(value));
      this.waiting.set(id, { answer: settle(answer), refuse: settle(refuse) });
      this.send({ ...request, id });
    });
  }

  /** Streaming: wait for the next frame of a stream. */
  frame(stream) {
    return new Promise((answer, refuse) => this.waiting.set(stream, { answer, refuse }));
  }

  do(command) {
    return this.ask({ type: "do", command });
  }

  /** Non-blocking: send, and wait for nothing. */
  send(message) {
    this.socket.send(JSON.stringify(message));
  }

  /** `pass` lets some time pass. */
  async until(reached, pass) {
    for (;;) {
      const now = await this.ask({ type: "get", what: "snapshot" });
      if (reached(now)) return now;
      for (let tick = 0; tick < TICKS_BETWEEN_LOOKS; tick++) await pass();
    }
  }
}

const sleep = (milliseconds) => new Promise((over) => setTimeout(over, milliseconds));

async function takeControl(studio) {
  let role = await studio.ask({ type: "control", action: "ask" });
  while (!role.controls) {
    await sleep(200); // who controls is asked, and has 15 s to say no
    role = await studio.ask({ type: "control" });
  }
}

async function teach(studio, pass) {
  const before = (await studio.ask({ type: "get", what: "snapshot" })).entries.length;
  await studio.do({ type: "use_demonstrator" });
  await studio.do({ type: "record" });
  await studio.until((now) => now.entries.length > before, pass);
  await studio.do({ type: "train", learner: { name: "rbf", neurons: 50 } });
  await studio.until((now) => now.lesson !== null && now.learning.underway === null, pass);
}

/** The joint targets of every tick: the network's 142 rows, linear in between. */
function targetsOf(lesson) {
  const { joints, duration } = lesson.summary;
  const rows = lesson.curve;
  const ticks = Math.round(duration * RATE);
  return Array.from({ length: ticks + 1 }, (_, tick) => {
    const at = (tick / ticks) * (rows.length - 1);
    const first = Math.min(Math.floor(at), rows.length - 2);
    const share = at - first;
    const row = joints.map((_, j) => (1 - share) * rows[first][j] + share * rows[first + 1][j]);
    return Object.fromEntries(joints.map((joint, j) => [joint, row[j]]));
  });
}

function isThere(states, targets, joints) {
  if (states.stopped) throw new Error("somebody has stopped Baxter");
  const gaps = Object.keys(targets).map((joint) =>
    Math.abs(states.positions[joints.indexOf(joint)] - targets[joint]),
  );
  return states.driven !== null && states.driven.follows && Math.max(...gaps) < 0.02;
}

/** `pass` sends targets, lets one tick pass, and returns where the joints are then. */
async function replay(studio, motion, pass) {
  await studio.do({ type: "begin_driving" }); // after a Stop no target counts without it
  const begun = await studio.ask({ type: "get", what: "joint_states" });
  for (;;) {
    const states = await pass(motion[0]); // of a stream, a frame from before may be on its way
    if (states.tick > begun.tick && isThere(states, motion[0], studio.joints)) break;
  }
  const settling = new Array(Math.round(SETTLE * RATE)).fill(motion.at(-1));
  for (const targets of [...motion, ...settling]) await pass(targets);
}

const target = (targets) => ({ type: "set_joint_target", targets });

/** Synchronous: the world stands still between two steps. */
async function inSteps(studio) {
  await studio.ask({ type: "take_clock" });
  return async (targets) => {
    if (targets !== undefined) studio.send(target(targets));
    return (await studio.ask({ type: "step" })).state;
  };
}

/** Non-blocking, in real time: the joint states are a stream, which tells every tick. */
async function inRealTime(studio) {
  await studio.ask({ type: "subscribe", stream: "joint_states", rate: RATE });
  return async (targets) => {
    if (targets !== undefined) studio.send(target(targets));
    return studio.frame("joint_states");
  };
}

/** Blocking: each target is answered after the tick that took it. */
async function answered(studio) {
  return async (targets) => {
    if (targets === undefined) await sleep(1000 / RATE);
    else await studio.do(target(targets));
    return studio.ask({ type: "get", what: "joint_states" });
  };
}

const { values } = parseArgs({
  options: {
    url: { type: "string", default: "ws://127.0.0.1:8766" },
    token: { type: "string" },
    synchronous: { type: "boolean", default: false },
    blocking: { type: "boolean", default: false },
    teach: { type: "boolean", default: false },
  },
});
const studio = await Studio.connect(values.url, values.token);
await takeControl(studio);
const way = values.synchronous ? inSteps : values.blocking ? answered : inRealTime;
const pass = await way(studio);
if (values.teach) await teach(studio, pass);
const lesson = await studio.ask({ type: "fetch", what: "lesson" });
await studio.do({ type: "put_block_back" }); // a fresh world, the robot waits beside the block
await replay(studio, targetsOf(lesson), pass);
const block = await studio.ask({ type: "get", what: "block" });
console.log(`the block is ${block.down ? "down" : "still standing"}`);
studio.socket.close();
process.exitCode = block.down ? 0 : 1;
