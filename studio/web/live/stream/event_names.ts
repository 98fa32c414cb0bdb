import type { Events } from "../../model/protocol";

const listened: Record<keyof Events, true> = {
  hello: true,
  spec: true,
  layout: true,
  verify: true,
  build: true,
  log: true,
  run: true,
  firings: true,
  values: true,
  arrays: true,
  pose: true,
  scene: true,
  poses: true,
  subsystems: true,
  deployment: true,
  parameters: true,
  driving: true,
  sweep: true,
};

/** All events of the server. */
export const eventNames = Object.keys(listened) as (keyof Events)[];
