import type { Channel } from "./structure";

/** Whether an end of a channel waits for the other. */
export const waits = ({ send, receive, model }: Channel) => send === "blocking" || receive !== "non_blocking" || model !== "";

/** The effect of the modes of a channel, as a sentence. */
export const channelMeaning = ({ send, receive, model, timeout }: Channel) =>
  model
    ? `It works as the communication model ${model} says.`
    : `The sender ${send === "blocking" ? "waits until the value is taken (B)" : "does not wait (N)"}, ` +
      `the receiver ${receive !== "non_blocking" ? "waits for a value (B)" : "does not wait (N)"}` +
      `${timeout ? `, at most ${timeout}` : ""}.`;
