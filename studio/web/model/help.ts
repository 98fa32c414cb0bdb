import { layerTitle, pageName } from "./net/labels";
import type { NetModel, Page, PageNode, PageTransition } from "./net/net";

/** The meaning of a drawn element in a sentence, shown when the pointer is over it. */
export function help(net: NetModel, path: string): string {
  const element = net.find(path);
  if (!element) return "";
  const page = net.page(element.page);
  if (element.kind === "page") return pageHelp(net.page(net.pageByPath.get(path)!));
  if (element.kind === "transition") return `${path}: ${transitionHelp(page, page.transitions[element.index]!)}`;
  return `${path}: ${placeHelp(page, page.nodes[element.index]!, element.index)}`;
}

const insides: Record<Page["layer"], string> = {
  system: "all agents run side by side",
  agent: "its subsystems run side by side",
  subsystem: "one of its behaviours runs at a time",
  behaviour: "in each iteration it computes, sends and receives",
  communication: "it sends to or receives from channels",
};
const pageHelp = (page: Page) => `${page.path || pageName(page)}: ${layerTitle[page.layer]}; ${insides[page.layer]}.`;

function placeHelp(page: Page, node: PageNode, index: number): string {
  const of = pageName(page);
  switch (node.operation?.kind) {
    case "transition_function":
      return `while a token is here, the transition function of ${of} computes.`;
    case "next_iteration":
      return "a token here begins the next iteration.";
    case "write":
      return "while a token is here, the output buffer is written into the memory of the channel.";
    case "read":
      return "while a token is here, the memory of the channel is read into the input buffer.";
  }
  if (node.fusion !== null)
    return "memory of a channel, one place that several nets see; a token says that this is its state now.";
  if (index === page.input) return `a token here starts ${of}.`;
  if (index === page.output) return `a token here says that ${of} has ended.`;
  return "a place; a token here says that this is so now.";
}

function transitionHelp(page: Page, { role, condition }: PageTransition): string {
  const text = condition?.text ?? "";
  if (condition?.truth === "never") return "can never fire: its condition is always false.";
  switch (condition?.kind) {
    case "go_on":
      return "fires if the behaviour goes on: it has neither ended nor failed.";
    case "terminal":
      return `fires if the terminal condition holds${text ? ` (${text})` : ""}: the behaviour ends.`;
    case "error":
      return `fires if the error condition holds${text ? ` (${text})` : ""}: the behaviour ends with an error.`;
    case "elapsed":
      return "fires when the timeout of the channel has passed.";
    case "send":
      return `begins to send if ${text}.`;
    case "skip":
      return `sends nothing in this iteration if ${text}.`;
    case "next":
      return text ? `leads to the next behaviour if ${text}.` : "leads to the next behaviour.";
  }
  if (role === "start_system" || role === "start_agent") return `starts all that is in ${pageName(page)} at the same time.`;
  if (role === "start") return `starts the first behaviour of ${pageName(page)}.`;
  if (role === "end_system" || role === "end_agent") return `fires when all that is in ${pageName(page)} has ended.`;
  return "fires when each place before it holds a token; takes those tokens and puts one into each place after it.";
}
