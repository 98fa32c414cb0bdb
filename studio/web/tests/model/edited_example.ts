import { readFileSync } from "node:fs";
import { findThing, readStructure, type Buffer, type Structure, type Subsystem } from "../../model/structure/structure";

/** The specification that the tests of edits begin with, and the elements of a structure by their paths. */
export const example = readFileSync(new URL("../../../../examples/01_line_follower/spec.yaml", import.meta.url), "utf8");
export const structure = readStructure(example);
export const subsystem = (of: Structure, path: string) => (findThing(of, path) as { of: Subsystem }).of;
export const behaviour = (of: Structure, path: string) => (findThing(of, path) as { of: Subsystem["behaviours"][number] }).of;
export const buffer = (of: Structure, path: string) => (findThing(of, path) as { of: Buffer }).of;
