import { fieldsOf } from "../../model/text/schema_fields";
import type { Structure } from "../../model/structure/structure";
import { ObjectFields, type HelpByKey } from "./object_fields";
import { schema } from "./schema";

const shapes = fieldsOf(schema, schema).filter(({ key }) => key === "properties");

const markings = Object.fromEntries(
  ["never", "always", "reachable", "always_reachable", "leads_to"].map((key) => [key, { mono: true }]),
);

/** The properties to verify besides the default ones. */
export function PropertiesForm({ structure }: { structure: Structure }) {
  const count = structure.yaml.seq(["properties"])?.items.length ?? 0;
  const path = structure.agents.flatMap((one) => one.subsystems).flatMap((one) => one.behaviours)[0]?.path;
  const help: HelpByKey = {
    ...markings,
    properties: {
      one: "property",
      fresh: { value: { name: `property ${count + 1}`, always_reachable: path ?? "robot.control.run" } },
    },
  };
  return <ObjectFields structure={structure} at={[]} shapes={shapes} always="all" help={help} />;
}
